// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/work_dialog.h"

#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QVBoxLayout>
#include <cmath>

#include "panels/form.h"
#include "session/said.h"

namespace glisson::panels {

WorkDialog::WorkDialog(const char* name, const QString& title, QWidget* parent)
    : QDialog(parent),
      held_(new QWidget),
      line_(new QWidget),
      form_(new QVBoxLayout(held_)),
      progress_(new QProgressBar),
      what_(new QLabel),
      cancel_(button("workCancel", tr("Cancel"), {}, tr("Stops the work; what is complete stays"))),
      buttons_(new QDialogButtonBox(QDialogButtonBox::Close)) {
  setObjectName(QString::fromLatin1(name));
  setWindowTitle(title);
  form_->setContentsMargins(0, 0, 0, 0);
  progress_->setObjectName(QStringLiteral("workProgress"));
  progress_->setRange(0, 1000);
  progress_->setTextVisible(false);
  progress_->setFixedWidth(160);
  cancel_->setAutoDefault(false);
  auto* row = new QHBoxLayout(line_);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(progress_);
  row->addWidget(what_, 1);
  row->addWidget(cancel_);
  line_->hide();
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(18, 16, 18, 14);
  column->setSpacing(10);
  column->addWidget(held_, 1);
  column->addWidget(line_);
  column->addWidget(buttons_);
  QPushButton* close = buttons_->button(QDialogButtonBox::Close);
  close->setText(tr("Close"));
  close->setAutoDefault(false);
  connect(buttons_, &QDialogButtonBox::rejected, this, &WorkDialog::reject);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    worker_.cancel();
    cancel_->setEnabled(false);
    what_->setText(tr("Cancelling"));
  });
  connect(&worker_, &session::Worker::progressed, this,
          [this](double fraction, const QString& what, double secondsLeft) {
            progress_->setValue(static_cast<int>(std::lround(1000.0 * fraction)));
            if (!worker_.cancelling()) what_->setText(what + session::timeLeft(secondsLeft));
          });
}

QPushButton* WorkDialog::addStart(const char* name, const QString& text) {
  auto* start = buttons_->addButton(text, QDialogButtonBox::ActionRole);
  start->setObjectName(QString::fromLatin1(name));
  start->setProperty("primary", true);
  start->setDefault(true);
  return start;
}

QLineEdit* WorkDialog::pathLine(const char* name, const QString& tip, const std::function<QString()>& ask,
                                QVBoxLayout* into) {
  auto* line = new QLineEdit;
  line->setObjectName(QString::fromLatin1(name));
  line->setToolTip(tip);
  line->setAccessibleName(tip);
  auto* choose = new QPushButton(tr("Choose…"));
  choose->setObjectName(QString::fromLatin1(name) + QStringLiteral("Choose"));
  choose->setAutoDefault(false);
  auto* row = new QHBoxLayout;
  row->addWidget(line, 1);
  row->addWidget(choose);
  into->addLayout(row);
  connect(choose, &QPushButton::clicked, this, [line, ask] {
    const QString path = ask();
    if (!path.isEmpty()) line->setText(path);
  });
  connect(line, &QLineEdit::textChanged, this, [this] { refresh(); });
  return line;
}

void WorkDialog::work(const QString& what, session::Worker::Job job, std::function<void(const QString&)> done) {
  if (worker_.busy()) return;
  worker_.start(std::move(job), [this, done = std::move(done)](std::exception_ptr failure) {
    showWork(false);
    const QString reason =
        session::wasCancelled(failure) ? tr("cancelled") : session::withoutOptions(session::reasonOf(failure));
    done(reason);
    refresh();
    emit ended(reason);
  });
  what_->setText(what);
  showWork(true);
  refresh();
}

void WorkDialog::showWork(bool on) {
  progress_->setValue(0);
  cancel_->setEnabled(on);
  held_->setEnabled(!on);
  line_->setVisible(on);
}

void WorkDialog::reject() {
  if (worker_.busy())
    worker_.cancel();
  else
    QDialog::reject();
}

}  // namespace glisson::panels
