// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>

#include "commands/command.h"

namespace glisson::commands {

/// Marks a slice, or takes its mark away.
class ChangeMark final : public Command {
 public:
  /// where: a point of the slice, LPS mm.
  ChangeMark(const Outlines& outlines, int slice, std::optional<SliceMark> mark, Eigen::Vector3d where_lps_mm)
      : slice_(slice), after_(mark), where_lps_mm_(std::move(where_lps_mm)) {
    const auto found = outlines.marks.find(slice);
    if (found != outlines.marks.end()) before_ = found->second;
  }
  void apply(Outlines& outlines) override { set(outlines, after_); }
  void revert(Outlines& outlines) override { set(outlines, before_); }
  std::string text() const override { return after_ ? "mark slice" : "unmark slice"; }
  Eigen::Vector3d where_lps_mm() const override { return where_lps_mm_; }

 private:
  void set(Outlines& outlines, std::optional<SliceMark> mark) const {
    if (mark)
      outlines.marks[slice_] = *mark;
    else
      outlines.marks.erase(slice_);
  }
  int slice_;
  std::optional<SliceMark> before_, after_;
  Eigen::Vector3d where_lps_mm_;
};

}  // namespace glisson::commands
