// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/undo_stack.h"

#include <utility>

namespace glisson::commands {

void UndoStack::push(std::unique_ptr<Command> command, Outlines& contours) {
  acts_.resize(done_);
  command->apply(contours);
  acts_.push_back(std::move(command));
  if (acts_.size() > limit_) acts_.pop_front();
  done_ = acts_.size();
}

std::optional<Eigen::Vector3d> UndoStack::undo(Outlines& contours) {
  if (!canUndo()) return std::nullopt;
  --done_;
  acts_[done_]->revert(contours);
  return acts_[done_]->where_lps_mm();
}

std::optional<Eigen::Vector3d> UndoStack::redo(Outlines& contours) {
  if (!canRedo()) return std::nullopt;
  acts_[done_]->apply(contours);
  return acts_[done_++]->where_lps_mm();
}

void UndoStack::clear() {
  acts_.clear();
  done_ = 0;
}

}  // namespace glisson::commands
