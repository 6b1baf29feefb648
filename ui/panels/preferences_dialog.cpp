// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/preferences_dialog.h"

#include <QAction>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QPushButton>
#include <QVBoxLayout>

#include "panels/form.h"

namespace glisson::panels {

PreferencesDialog::PreferencesDialog(QWidget* parent) : QDialog(parent), form_(new QFormLayout) {
  setObjectName(QStringLiteral("preferencesDialog"));
  setWindowTitle(tr("Preferences"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(18, 16, 18, 14);
  column->setSpacing(12);
  form_->setHorizontalSpacing(18);
  form_->setVerticalSpacing(10);
  column->addLayout(form_);
  column->addWidget(labelled(
      tr("Kept for the next start. Parameters of a patient are no preferences: they are in its case."), "faint"));
  column->addStretch();
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  buttons->button(QDialogButtonBox::Close)->setText(tr("Close"));
  column->addWidget(buttons);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  setMinimumWidth(440);
}

void PreferencesDialog::addChoice(const char* name, const QString& what, const QList<QAction*>& entries) {
  auto* box = new QComboBox;
  box->setObjectName(QString::fromLatin1(name));
  box->setAccessibleName(what);
  const auto follow = [box, entries] {
    for (int n = 0; n < entries.size(); ++n)
      if (entries[n]->isChecked()) box->setCurrentIndex(n);
  };
  for (QAction* entry : entries) {
    box->addItem(entry->text().remove(QLatin1Char('&')));
    connect(entry, &QAction::toggled, box, follow);
  }
  follow();
  connect(box, &QComboBox::activated, this, [entries](int n) { entries[n]->trigger(); });
  form_->addRow(what, box);
}

void PreferencesDialog::addSheet(const QString& what, QAction* entry, const QString& text) {
  auto* open = new QPushButton(text);
  open->setObjectName(entry->objectName() + QStringLiteral("Button"));
  open->setAutoDefault(false);
  connect(open, &QPushButton::clicked, entry, &QAction::trigger);
  form_->addRow(what, open);
}

}  // namespace glisson::panels
