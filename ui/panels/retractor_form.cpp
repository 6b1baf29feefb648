// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/retractor_form.h"

#include <QCheckBox>
#include <QComboBox>
#include <QStandardItemModel>

#include "panels/form.h"
#include "session/session.h"
#include "session/setup_of.h"

namespace glisson::panels {

namespace {

QString why(retraction::RigidRefusal refusal) {
  switch (refusal) {
    case retraction::RigidRefusal::Model:
      return RetractorForm::tr("A rigid bar is offered for voxel FEM only: choose it on the Model page.");
    case retraction::RigidRefusal::TimeSteps:
      return RetractorForm::tr("A rigid bar is offered at rest only: leave out the time steps on the Model page.");
    case retraction::RigidRefusal::Condensed:
      return RetractorForm::tr("A condensed response has no rigid bar: choose another solver on the Model page.");
    case retraction::RigidRefusal::Corotational: break;
  }
  return RetractorForm::tr(
      "A rigid bar is offered for automatic, hyperelastic or linear deformation: choose one on the Model page.");
}

/// Enabled, or disabled with the reason in its tip.
void apply(QWidget* control, const QString& tip, const QString& reason) {
  control->setEnabled(reason.isEmpty());
  control->setToolTip(reason.isEmpty() ? tip : tip + QStringLiteral("\n") + reason);
}

QComboBox* choice(const char* objectName, const QStringList& items) {
  auto* box = new QComboBox;
  box->setObjectName(QString::fromLatin1(objectName));
  box->addItems(items);
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box->setMinimumContentsLength(12);
  return box;
}

}  // namespace

RetractorForm::RetractorForm(session::Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(8);
  column->addWidget(section(tr("Nathanson retractor")));
  column->addWidget(makeBar());
  column->addWidget(labelled(tr("The same for MRE and atlas."), "faint"));
  column->addWidget(section(tr("Liver and abdomen")));
  column->addWidget(makeTissue());
  for (QDoubleSpinBox* box : {diameter_, length_, spread_, force_, travel_, tension_, abdomen_})
    connect(box, &QDoubleSpinBox::valueChanged, this, &RetractorForm::take);
  for (QComboBox* box : {contact_, shape_, drive_})
    connect(box, &QComboBox::currentIndexChanged, this, &RetractorForm::take);
  connect(capsule_, &QCheckBox::toggled, this, &RetractorForm::take);
  connect(&session_, &session::Session::parametersChanged, this, &RetractorForm::show_);
  show_();
}

QWidget* RetractorForm::makeBar() {
  auto* held = new QWidget;
  auto* form = new QFormLayout(held);
  form->setContentsMargins(0, 0, 0, 0);
  contact_ = choice("contactKind", {tr("Rigid bar"), tr("Spread patch (as published)")});
  form->addRow(tr("Contact"), contact_);
  shape_ = choice("barShape", {tr("Straight"), tr("Hook")});
  form->addRow(tr("Shape"), shape_);
  diameter_ = quantity("retractorDiameter", 1, 60, 1, 1, QStringLiteral("mm"), tr("Diameter of the bar"));
  form->addRow(tr("Diameter"), diameter_);
  length_ = quantity("retractorLength", 5, 300, 5, 0, QStringLiteral("mm"), tr("Length of the bar that bears"));
  form->addRow(tr("Length"), length_);
  spread_ = quantity("retractorSpread", 0, 60, 1, 1, QStringLiteral("mm"), {});
  form->addRow(tr("Wrap"), spread_);
  drive_ = choice("forceKind", {tr("The liver's weight"), tr("Given force"), tr("Given travel")});
  form->addRow(tr("Hoist"), drive_);
  force_ = quantity("retractorForce", 0.01, 500, 1, 2, QStringLiteral("N"), {});
  form->addRow(tr("Force"), force_);
  travel_ = quantity("retractorTravel", 1, 200, 5, 1, QStringLiteral("mm"), {});
  form->addRow(tr("Travel"), travel_);
  return held;
}

QWidget* RetractorForm::makeTissue() {
  auto* held = new QWidget;
  auto* form = new QFormLayout(held);
  form->setContentsMargins(0, 0, 0, 0);
  capsule_ = new QCheckBox(tr("Glisson's capsule"));
  capsule_->setObjectName(QStringLiteral("capsule"));
  form->addRow(capsule_);
  tension_ = quantity("capsuleTension", 0.001, 10, 0.05, 3, QStringLiteral("N/mm"), {});
  form->addRow(tr("Its stiffness"), tension_);
  abdomen_ = quantity("abdomenStiffness", 0.001, 100, 0.05, 3, QStringLiteral("kPa/mm"),
                      tr("Elastic resistance per area of the posterior and superior surface (Winkler foundation)"));
  form->addRow(tr("Resistance"), abdomen_);
  return held;
}

// What is disabled shows what the scene takes; what was chosen is kept for when it applies again.
void RetractorForm::take() {
  if (filling_) return;
  session::Parameters p = session_.parameters();
  p.retractorDiameter_mm = diameter_->value();
  p.retractorLength_mm = length_->value();
  p.retractorSpread_mm = spread_->value();
  if (contact_->isEnabled())
    p.contact = session::contactNames[static_cast<std::size_t>(contact_->currentIndex())].first;
  if (shape_->isEnabled()) p.shape = session::shapeNames[static_cast<std::size_t>(shape_->currentIndex())].first;
  const session::Drive drive = session::driveNames[static_cast<std::size_t>(drive_->currentIndex())].first;
  if (drive != session::offered(session_.parameters()).drive) p.drive = drive;
  p.force_N = force_->value();
  p.travel_mm = travel_->value();
  if (capsule_->isEnabled()) p.capsule = capsule_->isChecked();
  p.capsule_N_per_mm = tension_->value();
  p.abdomen_kPa_per_mm = abdomen_->value();
  session_.setParameters(p);
}

void RetractorForm::show_() {
  filling_ = true;
  const session::Parameters p = session::offered(session_.parameters());
  contact_->setCurrentIndex(p.contact == retraction::ContactKind::Rigid ? 0 : 1);
  shape_->setCurrentIndex(p.shape == retraction::BarShape::Straight ? 0 : 1);
  drive_->setCurrentIndex(static_cast<int>(p.drive));
  diameter_->setValue(p.retractorDiameter_mm);
  length_->setValue(p.retractorLength_mm);
  spread_->setValue(p.retractorSpread_mm);
  force_->setValue(p.force_N);
  travel_->setValue(p.travel_mm);
  capsule_->setChecked(p.capsule);
  tension_->setValue(p.capsule_N_per_mm);
  abdomen_->setValue(p.abdomen_kPa_per_mm);
  showWhatApplies();
  filling_ = false;
}

void RetractorForm::showWhatApplies() {
  const session::Parameters p = session::offered(session_.parameters());
  const auto refusal = session::rigidRefusal(session_.parameters());
  const bool rigid = p.contact == retraction::ContactKind::Rigid;
  const QString ofRigid = rigid     ? QString()
                          : refusal ? why(*refusal)
                                    : tr("A spread patch has none: choose the rigid bar.");
  apply(contact_,
        tr("Rigid bar: a body of its own that pushes and does not pull, without friction, in large deformation. Spread "
           "patch: a pressure on the liver at rest, as in the published study."),
        refusal ? why(*refusal) : QString());
  apply(shape_, tr("Hook: the same length bent to a quarter turn, as the blade of a Nathanson retractor"), ofRigid);
  apply(spread_, tr("Tissue wraps round the bar: how far its pressure reaches beyond it; 0 is a bare bar"),
        rigid ? tr("A rigid bar touches where it touches: only a spread patch has a wrap.") : QString());
  drive_->setToolTip(tr("What both livers are given: a force, or the bar's way from its first touch"));
  auto* drives = qobject_cast<QStandardItemModel*>(drive_->model());
  drives->item(static_cast<int>(session::Drive::Travel))->setEnabled(rigid);
  drives->item(static_cast<int>(session::Drive::Travel))->setToolTip(ofRigid);
  apply(force_, tr("Hoisting force, towards anterior in the transverse plane"),
        p.drive == session::Drive::Force ? QString() : tr("Choose \"Given force\" to set it."));
  apply(travel_, tr("Way of the bar from its first touch, along the hoist"),
        !ofRigid.isEmpty()                  ? ofRigid
        : p.drive == session::Drive::Travel ? QString()
                                            : tr("Choose \"Given travel\" to set it."));
  const QString ofCapsule = tr("Stiff skin of the liver, which carries tension along its surface");
  apply(capsule_, ofCapsule, ofRigid);
  apply(tension_, tr("Young's modulus of the capsule times its thickness"),
        !ofRigid.isEmpty() ? ofRigid
        : p.capsule        ? QString()
                           : tr("The capsule is left out."));
}

}  // namespace glisson::panels
