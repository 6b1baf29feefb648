// SPDX-License-Identifier: GPL-3.0-or-later

// What the window asks: about work that is not saved or would be replaced, and about the elastogram.
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QMessageBox>
#include <QPushButton>

#include "elastography/stiffness_map.h"
#include "panels/form.h"
#include "panels/main_window.h"

namespace glisson::panels {

using session::Question;

bool MainWindow::confirmed(const char* name, const QString& title, const QString& text, const QString& more,
                           const QString& yes) {
  QMessageBox box(QMessageBox::Warning, title, text, QMessageBox::Cancel, this);
  box.setObjectName(QString::fromLatin1(name));
  box.setInformativeText(more);
  box.addButton(yes, QMessageBox::AcceptRole)->setObjectName(QStringLiteral("yesButton"));
  box.setDefaultButton(QMessageBox::Cancel);
  box.exec();
  return box.clickedButton() && box.buttonRole(box.clickedButton()) == QMessageBox::AcceptRole;
}

bool MainWindow::mayDiscard() {
  session::Unsaved unsaved = session_.unsaved();
  unsaved.outlines = unsaved.outlines || session_.tool().drawing().cols() > 0;
  if (!unsaved.any()) return true;
  const QString what = unsaved.outlines && unsaved.settings ? tr("Outlines and parameters of this case are not saved.")
                       : unsaved.outlines                   ? tr("Outlines of this case are not saved.")
                                                            : tr("Parameters of this case are not saved.");
  QMessageBox box(QMessageBox::Question, tr("Not saved"), what,
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
  box.setObjectName(QStringLiteral("unsavedBox"));
  box.setInformativeText(unsaved.settings
                             ? tr("Parameters are roles and answers about series, the model, bar, hoist and holds.")
                             : tr("Drafts and marks of slices are among them."));
  box.setDefaultButton(QMessageBox::Save);
  const int answer = box.exec();
  if (answer == QMessageBox::Discard) return true;
  if (answer != QMessageBox::Save) return false;
  session_.park();
  return saveInto(session_.readOnly() ? QString() : session_.caseFolder());
}

bool MainWindow::mayReplaceOutlines() {
  const std::size_t there = session_.contours().polygons.size();
  return there == 0 ||
         confirmed("replaceBox", tr("Import outlines"),
                   tr("%1 outlines are there. Those of the file take their place.").arg(static_cast<qulonglong>(there)),
                   tr("Undo brings them back, as long as this case is open."), tr("Replace"));
}

void MainWindow::askAboutImages() {
  const std::optional<Question>& question = session_.images().question;
  if (!question || question->kind == Question::Kind::None) return;
  if (question->kind == Question::Kind::Meaning) {
    askForMeaning(question->text);
    return;
  }
  auto* box = new QMessageBox(QMessageBox::Warning, tr("MRI and elastogram"), question->text,
                              QMessageBox::Yes | QMessageBox::No, this);
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setObjectName(QStringLiteral("togetherBox"));
  box->setInformativeText(
      tr("Use them together all the same? Yes is kept in the case and in the record of every run. No leaves the "
         "elastogram out: outlines can be drawn, stiffness is not measured."));
  box->setDefaultButton(QMessageBox::No);
  connect(box, &QMessageBox::finished, this, [this](int answer) { session_.useTogether(answer == QMessageBox::Yes); });
  box->open();
}

// Nothing is chosen beforehand: a number without its quantity and unit is never compared with anything.
void MainWindow::askForMeaning(const QString& text) {
  auto* dialog = new QDialog(this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setObjectName(QStringLiteral("meaningDialog"));
  dialog->setWindowTitle(tr("What does the elastogram hold?"));
  auto* layout = new QVBoxLayout(dialog);
  layout->addWidget(labelled(text, "text"));
  auto* form = new QFormLayout;
  auto* quantity = new QComboBox;
  quantity->setObjectName(QStringLiteral("meaningQuantity"));
  quantity->addItem(tr("Shear modulus µ"), static_cast<int>(StiffnessQuantity::Shear));
  quantity->addItem(tr("Young's modulus E"), static_cast<int>(StiffnessQuantity::Youngs));
  quantity->setPlaceholderText(tr("Choose"));
  auto* unit = new QComboBox;
  unit->setObjectName(QStringLiteral("meaningUnit"));
  for (const char* known : {"kPa", "Pa", "0.01kPa", "0.001kPa"}) unit->addItem(QString::fromLatin1(known));
  unit->setEditable(true);
  unit->setInsertPolicy(QComboBox::NoInsert);
  for (QComboBox* box : {quantity, unit}) box->setCurrentIndex(-1);
  unit->setToolTip(tr("Pa, kPa, or a factor before kPa: 0.01kPa where 350 stands for 3.5 kPa"));
  form->addRow(tr("Quantity"), quantity);
  form->addRow(tr("Unit"), unit);
  layout->addLayout(form);
  layout->addWidget(
      labelled(tr("MR elastography reports the shear modulus unless it says otherwise; Young's modulus is "
                  "about three times as large. The answer is kept in the case."),
               "faint"));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  layout->addWidget(buttons);
  QPushButton* ok = buttons->button(QDialogButtonBox::Ok);
  const auto check = [quantity, unit, ok] {
    bool known = quantity->currentIndex() >= 0;
    try {
      elastography::unitFactor_kPa(unit->currentText().trimmed().toStdString());
    } catch (const std::exception&) {
      known = false;
    }
    ok->setEnabled(known);
  };
  check();
  connect(quantity, &QComboBox::currentIndexChanged, dialog, check);
  connect(unit, &QComboBox::currentTextChanged, dialog, check);
  connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
  connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
  connect(dialog, &QDialog::accepted, this, [this, quantity, unit] {
    const auto chosen = static_cast<StiffnessQuantity>(quantity->currentData().toInt());
    attempt(tr("What does the elastogram hold?"), [&] { session_.setMeaning(chosen, unit->currentText().trimmed()); });
  });
  dialog->open();
}

}  // namespace glisson::panels
