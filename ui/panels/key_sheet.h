// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>

class QTreeWidget;

namespace glisson::panels {

class Keys;

/// The sheet under F1: what keys and mouse do, from the same tables as the tools; a double-click on a key changes it.
class KeySheet : public QDialog {
  Q_OBJECT
 public:
  explicit KeySheet(Keys& keys, QWidget* parent = nullptr);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void fill();
  void fillMenus();
  void change(int command);
  Keys& keys_;
  QTreeWidget *table_, *menus_;
};

}  // namespace glisson::panels
