// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/contact_table.h"

#include <QHeaderView>
#include <QTreeWidget>

#include "panels/form.h"
#include "session/said.h"
#include "session/session.h"

namespace glisson::panels {

namespace {

using retraction::RigidContact;

QString number(double value, int decimals, const QString& unit) {
  return QString::number(value, 'f', decimals) + QChar(0x00a0) + unit;
}

QString verdict(const RigidContact& c) {
  switch (c.outcome) {
    case mechanics::ContactOutcome::Reached:
      return c.capacityExceeded ? ContactTable::tr("past its largest force") : ContactTable::tr("bears");
    case mechanics::ContactOutcome::Slips: return ContactTable::tr("slips");
    case mechanics::ContactOutcome::Folds: return ContactTable::tr("folds the liver");
    case mechanics::ContactOutcome::Cuts: return ContactTable::tr("cuts into the liver");
    case mechanics::ContactOutcome::LoadsNotBorne:
    case mechanics::ContactOutcome::Stopped: break;
  }
  return ContactTable::tr("no answer");
}

QString capacity(const RigidContact& c) {
  return c.slipped() || c.capacityExceeded ? number(c.capacity_N, 1, QStringLiteral("N")) : ContactTable::tr("not met");
}

QString nameOf(retraction::Kinematics kinematics) {
  switch (kinematics) {
    case retraction::Kinematics::Corotational: return ContactTable::tr("corotational");
    case retraction::Kinematics::Hyperelastic: return ContactTable::tr("hyperelastic");
    case retraction::Kinematics::Linear:
    case retraction::Kinematics::Auto: break;
  }
  return ContactTable::tr("linear");
}

}  // namespace

QString whyNoDifference(const pipeline::RunResult& result) {
  QStringList words;
  for (const Diagnostic& d : result.diagnostics)
    if (d.code == DiagnosticCode::DifferenceWithheld || d.code == DiagnosticCode::RetractorSlips ||
        d.code == DiagnosticCode::RetractorFolds || d.code == DiagnosticCode::RetractorCuts)
      words << sentence(session::said(d));
  return words.join(QLatin1Char('\n'));
}

ContactTable::ContactTable(session::Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  rows_ = new QTreeWidget;
  rows_->setObjectName(QStringLiteral("contactRows"));
  rows_->setAccessibleName(tr("Contact of bar and liver"));
  rows_->setHeaderLabels({tr("Bar"), tr("MRE"), tr("Atlas")});
  rows_->setRootIsDecorated(false);
  rows_->setUniformRowHeights(true);
  rows_->setSelectionMode(QAbstractItemView::NoSelection);
  rows_->setFocusPolicy(Qt::NoFocus);
  rows_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  rows_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  rows_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  rows_->header()->setStretchLastSection(true);
  column->addWidget(rows_);
  words_ = labelled({}, "faint");
  words_->setObjectName(QStringLiteral("contactWords"));
  column->addWidget(words_);
  show_();
}

void ContactTable::show_() {
  rows_->clear();
  rows_->hide();
  const auto result = session_.result();
  if (!result) {
    words_->setText(QStringLiteral("–"));
    return;
  }
  QStringList words;
  if (const QString why = whyNoDifference(*result); !why.isEmpty()) words << why;
  const retraction::Result& mre = result->primary;
  if (mre.contact) {
    const RigidContact* atlas = result->atlas && result->atlas->contact ? &*result->atlas->contact : nullptr;
    const auto row = [&](const QString& name, auto&& of) {
      rows_->addTopLevelItem(new QTreeWidgetItem({name, of(*mre.contact), atlas ? of(*atlas) : QString()}));
    };
    row(tr("Travel"), [](const RigidContact& c) { return number(c.travel_mm, 1, QStringLiteral("mm")); });
    row(tr("Hoist"), [](const RigidContact& c) { return number(c.force_N.dot(c.hoist), 1, QStringLiteral("N")); });
    row(tr("Resultant"), [](const RigidContact& c) { return number(c.force_N.norm(), 1, QStringLiteral("N")); });
    row(tr("Area"), [](const RigidContact& c) { return number(1e-2 * c.area_mm2, 1, QStringLiteral("cm²")); });
    row(tr("Pressure"), [](const RigidContact& c) { return number(c.pressureMax_kPa, 1, QStringLiteral("kPa")); });
    row(tr("Capacity"), capacity);
    row(tr("Place"), verdict);
    const int height = rows_->sizeHintForRow(0);
    rows_->setFixedHeight(rows_->header()->sizeHint().height() + rows_->topLevelItemCount() * height + 4);
    rows_->show();
    if (result->difference && result->difference->travel_mm)
      words << (*result->difference->travel_mm < 0.0 ? tr("With the atlas stiffness the bar travels %1 mm further.")
                                                     : tr("With the measured stiffness the bar travels %1 mm further."))
                   .arg(std::abs(*result->difference->travel_mm), 0, 'f', 1);
  } else if (mre.retractorPoint_mm) {
    words << tr("The bar is a spread patch here: a pressure on %1 cm² at rest.")
                 .arg(1e-2 * mre.contactArea_mm2, 0, 'f', 1);
  }
  words << tr("Kinematics: %1 (%2).").arg(nameOf(mre.kinematics), QString::fromStdString(result->kinematicsWhy));
  words_->setText(words.join(QLatin1Char('\n')));
}

}  // namespace glisson::panels
