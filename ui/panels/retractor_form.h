// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;

namespace glisson::session {
class Session;
}

namespace glisson::panels {

/// What the Retract page sets: the bar, how it meets the liver and what drives it, Glisson's capsule, the abdomen. What
/// does not apply is disabled, and its tip says why.
class RetractorForm : public QWidget {
  Q_OBJECT
 public:
  explicit RetractorForm(session::Session& session, QWidget* parent = nullptr);

 private:
  QWidget* makeBar();
  QWidget* makeTissue();
  void take();
  void show_();
  void showWhatApplies();
  session::Session& session_;
  QComboBox *contact_, *shape_, *drive_;
  QDoubleSpinBox *diameter_, *length_, *spread_, *force_, *travel_, *tension_, *abdomen_;
  QCheckBox* capsule_;
  bool filling_ = false;
};

}  // namespace glisson::panels
