// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QKeySequence>
#include <QList>
#include <QObject>
#include <array>
#include <optional>

#include "tools/keymap.h"

class QKeyEvent;

namespace glisson::panels {

/// Which key does what: tools/keymap.h as shipped, with what the user has changed (kept in the settings).
class Keys : public QObject {
  Q_OBJECT
 public:
  explicit Keys(QObject* parent = nullptr);

  const QList<QKeySequence>& of(tools::Command command) const { return keys_[static_cast<std::size_t>(command)]; }
  /// What a key means; nothing for a key without meaning.
  std::optional<tools::Command> commandFor(const QKeyEvent& event) const;
  /// The first key, as this platform writes it.
  QString text(tools::Command command) const;
  /// "Undo (Ctrl+Z)", for tooltips.
  QString tip(tools::Command command) const;
  /// Gives a command one key in place of those it had. Where another command has it, nothing changes and that one is
  /// returned.
  std::optional<tools::Command> set(tools::Command command, const QKeySequence& key);
  void reset();  ///< as shipped

 signals:
  void changed();

 private:
  void load();
  std::array<QList<QKeySequence>, tools::commandCount> keys_;
};

/// What a command does, in the user's language.
QString nameOf(tools::Command command);

}  // namespace glisson::panels
