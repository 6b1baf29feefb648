// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <QList>

class QAction;
class QComboBox;
class QFormLayout;

namespace glisson::panels {

/// What is remembered of the window, in one place: theme, language, right drag; keys and servers have sheets of their
/// own. Each choice is an entry of a menu, done at once; there is nothing to be confirmed.
class PreferencesDialog : public QDialog {
  Q_OBJECT
 public:
  explicit PreferencesDialog(QWidget* parent = nullptr);
  /// A choice among entries of a menu that exclude each other.
  void addChoice(const char* name, const QString& what, const QList<QAction*>& entries);
  /// A button that brings up a sheet.
  void addSheet(const QString& what, QAction* entry, const QString& text);

 private:
  QFormLayout* form_;
};

}  // namespace glisson::panels
