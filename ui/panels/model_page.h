// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;
class QLabel;
class QSpinBox;
class QTreeWidget;

namespace glisson::session {
class Session;
}

namespace glisson::panels {

/// Model: what the liver is made of and how it is computed, and the plan that follows: each step, needed or left out,
/// and why.
class ModelPage : public QWidget {
  Q_OBJECT
 public:
  explicit ModelPage(session::Session& session, QWidget* parent = nullptr);

 signals:
  void runWanted();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  QWidget* makeSide();
  void addSolver();  ///< and what else the run is to say
  void take();       ///< form to session
  void show_();      ///< session to form
  void showPlan();
  void showNumbers();
  void showWhatFits();  ///< enables what the chosen method offers
  session::Session& session_;
  QTreeWidget* plan_;
  QLabel* numbers_;
  QComboBox *method_, *kinematics_, *solver_, *motion_, *stiffness_;
  QDoubleSpinBox *poisson_, *density_, *cell_, *atlas_, *tetEdge_, *tetToolEdge_, *step_, *end_;
  QSpinBox* frames_;
  QCheckBox *register_, *howSure_;
  QFormLayout *mesh_ = nullptr, *solution_ = nullptr;
  bool filling_ = false;
};

}  // namespace glisson::panels
