// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "commands/command.h"

namespace glisson::commands {

/// What was done, to take it back and do it again.
class UndoStack {
 public:
  /// limit: acts kept; older ones are forgotten (they stay done).
  explicit UndoStack(std::size_t limit = 1000) : limit_(limit) {}

  /// Applies the command and remembers it. Acts that were undone can no longer be redone.
  void push(std::unique_ptr<Command> command, Outlines& contours);

  /// Takes back the latest act; returns a point (LPS mm) on the slice it concerned, nothing where there was none.
  std::optional<Eigen::Vector3d> undo(Outlines& contours);
  std::optional<Eigen::Vector3d> redo(Outlines& contours);

  /// Where the next undo or redo will act: that slice is shown first.
  std::optional<Eigen::Vector3d> whereUndo() const {
    return canUndo() ? std::optional(acts_[done_ - 1]->where_lps_mm()) : std::nullopt;
  }
  std::optional<Eigen::Vector3d> whereRedo() const {
    return canRedo() ? std::optional(acts_[done_]->where_lps_mm()) : std::nullopt;
  }

  bool canUndo() const { return done_ > 0; }
  bool canRedo() const { return done_ < acts_.size(); }
  std::string undoText() const { return canUndo() ? acts_[done_ - 1]->text() : std::string(); }
  std::string redoText() const { return canRedo() ? acts_[done_]->text() : std::string(); }
  std::size_t size() const { return acts_.size(); }
  void clear();

 private:
  std::deque<std::unique_ptr<Command>> acts_;
  std::size_t done_ = 0;  ///< acts_[0 .. done_) are applied
  std::size_t limit_;
};

}  // namespace glisson::commands
