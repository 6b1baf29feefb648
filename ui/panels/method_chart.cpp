// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/method_chart.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QProgressBar>
#include <QTreeWidget>
#include <cmath>

#include "panels/form.h"
#include "session/session.h"
#include "views/picture_view.h"

namespace glisson::panels {

namespace {

QString seconds(double s) {
  return s < 1.0 ? MethodChart::tr("%1 ms").arg(1e3 * s, 0, 'f', 0) : MethodChart::tr("%1 s").arg(s, 0, 'f', 1);
}

QString millimetres(double mm) {
  return std::isfinite(mm) ? MethodChart::tr("%1 mm").arg(mm, 0, 'g', 2) : MethodChart::tr("no answer");
}

}  // namespace

MethodChart::MethodChart(session::Session& session, QWidget* parent)
    : QWidget(parent), session_(session), picture_(new views::PictureView), rows_(new QTreeWidget) {
  picture_->setObjectName(QStringLiteral("methodPicture"));
  rows_->setObjectName(QStringLiteral("methodRows"));
  rows_->setAccessibleName(tr("Error and run time of every method"));
  rows_->setHeaderLabels({tr("Method"), tr("Largest error"), tr("Run time"), tr("Resolution"), tr("Unknowns")});
  rows_->setRootIsDecorated(false);
  rows_->setAlternatingRowColors(true);
  rows_->setUniformRowHeights(true);
  rows_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  words_ = labelled({}, "faint");
  words_->setObjectName(QStringLiteral("methodWords"));
  start_ = button("methodStart", tr("Measure on this patient"), QStringLiteral("run"),
                  tr("Runs every method on this liver against a solution eight times as fine; about a minute"));
  cancel_ = button("methodCancel", tr("Cancel"), QStringLiteral("stop"), tr("Stops measuring"));
  progress_ = new QProgressBar;
  progress_->setObjectName(QStringLiteral("methodProgress"));
  progress_->setRange(0, 1000);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 8);
  column->addWidget(picture_, 3);
  column->addWidget(rows_, 1);
  auto* foot = new QVBoxLayout;
  foot->setContentsMargins(14, 4, 14, 0);
  foot->addWidget(words_);
  auto* row = new QHBoxLayout;
  row->addWidget(start_);
  row->addWidget(progress_, 1);
  row->addWidget(cancel_);
  row->addStretch();
  foot->addLayout(row);
  column->addLayout(foot);
  connect(start_, &QPushButton::clicked, this, &MethodChart::measure);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    worker_.cancel();
    cancel_->setEnabled(false);
  });
  connect(&worker_, &session::Worker::progressed, this,
          [this](double fraction, const QString& what, double secondsLeft) {
            progress_->setValue(static_cast<int>(std::lround(1000.0 * fraction)));
            progress_->setFormat(what + session::timeLeft(secondsLeft));
          });
  connect(&session_, &session::Session::runFinished, this, &MethodChart::forget);
  connect(&session_, &session::Session::loaded, this, &MethodChart::forget);
  forget();
}

void MethodChart::forget() {
  worker_.cancel();
  study_.reset();
  show_();
}

void MethodChart::measure() {
  if (worker_.busy() || !session_.result()) return;
  const std::filesystem::path scene =
      std::filesystem::path(session_.runFolder().toStdString()).parent_path() / "case.json";
  session::MethodWords words;
  words.title = tr("Error against run time on this patient").toStdString();
  words.time = tr("Run time, model and solve (s)").toStdString();
  words.error = tr("Largest displacement error (mm)").toStdString();
  words.ofDefault = tr("the default").toStdString();
  words.ofChoice = tr("your choice").toStdString();
  words.both = tr("the default, your choice").toStdString();
  auto made = std::make_shared<session::MethodStudy>();
  auto drawn = std::make_shared<render::Picture>();
  worker_.start(
      [made, drawn, scene, words, parameters = session_.parameters()](const Progress& progress) {
        *made = session::studyMethods(scene, parameters, words, progress.part(0.0, 0.99));
        *drawn = render::draw(made->chart, {1100, 820});
      },
      [this, made, drawn, result = session_.result()](std::exception_ptr failure) {
        if (!failure && result == session_.result()) {
          study_ = made;
          picture_->setPicture(*drawn);
        }
        show_();
        if (failure) {
          const QString reason = session::reasonOf(failure);
          if (!reason.isEmpty()) picture_->setHint(reason);
          emit stopped(reason);
        } else if (study_) {
          emit ready();
        }
      });
  cancel_->setEnabled(true);
  show_();
}

void MethodChart::show_() {
  const bool busy = worker_.busy();
  start_->setVisible(!busy && !study_);
  start_->setEnabled(session_.result() != nullptr);
  progress_->setVisible(busy);
  cancel_->setVisible(busy);
  rows_->setVisible(study_ != nullptr);
  words_->setVisible(study_ != nullptr);
  if (!study_) {
    picture_->clear();
    picture_->setHint(session_.result() ? tr("How exact is each method on this liver, and how long does it take?")
                                        : tr("Run the retraction first."));
    return;
  }
  rows_->clear();
  const std::vector<study::Row>& all = study_->study.rows;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const study::Row& r = all[i];
    QString name = QString::fromStdString(r.method);
    if (study_->ofDefault == i) name += tr("  (default)");
    if (study_->ofChoice == i) name += tr("  (your choice)");
    auto* item = new QTreeWidgetItem(rows_, {name, millimetres(r.max_error_mm), seconds(r.total_s()),
                                             QString::fromStdString(r.resolution), QString::number(r.dofs)});
    QFont font = item->font(0);
    font.setBold(study_->ofDefault == i || study_->ofChoice == i);
    item->setFont(0, font);
    item->setToolTip(0, QString::fromStdString(r.note.empty() ? r.reference : r.reference + "; " + r.note));
  }
  words_->setText(verdict());
}

QString MethodChart::verdict() const {
  const auto& rows = study_->study.rows;
  QStringList words;
  words << tr("Error: the largest distance from %1, over %2 places.")
               .arg(QString::fromStdString(study_->study.reference))
               .arg(static_cast<qulonglong>(study_->study.points));
  const auto say = [&](const QString& who, const study::Row& r) {
    words << tr("%1 errs by at most %2 in %3%4.")
                 .arg(who, millimetres(r.max_error_mm), seconds(r.total_s()),
                      r.pareto ? tr("; nothing else is both faster and closer") : QString());
  };
  if (study_->ofDefault) say(tr("The default method"), rows[*study_->ofDefault]);
  if (study_->ofChoice && study_->ofChoice != study_->ofDefault) say(tr("Your choice"), rows[*study_->ofChoice]);
  if (!study_->ofChoice) words << tr("The method that you chose is not among those measured.");
  if (!study_->study.skipped.empty())
    words << tr("%1 variants were left out.").arg(static_cast<qulonglong>(study_->study.skipped.size()));
  return words.join(QLatin1Char(' '));
}

}  // namespace glisson::panels
