// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/retract_page.h"

#include <QButtonGroup>
#include <QSlider>
#include <QSplitter>
#include <tuple>

#include "panels/contact_table.h"
#include "panels/form.h"
#include "panels/grey_window.h"
#include "panels/live_bar.h"
#include "panels/palette_choice.h"
#include "panels/placement_editor.h"
#include "panels/retractor_form.h"
#include "panels/trust_panel.h"
#include "session/session.h"
#include "views/scene_view.h"
#include "views/slice_view.h"

namespace glisson::panels {

RetractPage::RetractPage(session::Session& session, QWidget* parent)
    : QWidget(parent),
      session_(session),
      scene_(new views::SceneView),
      slice_(new views::SliceView),
      live_(new LiveBar(session, *scene_)),
      placement_(new PlacementEditor(session, *scene_, *slice_)) {
  scene_->setObjectName(QStringLiteral("retractView"));
  scene_->setAccessibleName(tr("The retraction in 3-D"));
  slice_->setObjectName(QStringLiteral("placementSlice"));
  slice_->setAccessibleName(tr("MRI slice with bar and holds"));
  slice_->setContours(&session_.contours(), nullptr);
  auto* centre = new QWidget;
  auto* column = new QVBoxLayout(centre);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(makeModes());
  auto* views = new QSplitter;
  views->setHandleWidth(3);
  views->setChildrenCollapsible(false);
  views->addWidget(scene_);
  views->addWidget(slice_);
  views->setStretchFactor(0, 3);
  views->setStretchFactor(1, 2);
  column->addWidget(views, 1);
  column->addWidget(placement_);
  playBar_ = makePlayBar();
  column->addWidget(playBar_);
  column->addWidget(live_);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  row->addWidget(centre, 1);
  row->addWidget(makeSide());
  connect(&session_, &session::Session::runFinished, this, &RetractPage::showResult);
  connect(&session_, &session::Session::loaded, this, [this] {
    views::ShownVolume mri;
    mri.values = session_.images().mri;
    mri.title = tr("MRI");
    if (mri.values) std::tie(mri.low, mri.high) = windowOf(*mri.values);
    slice_->setVolume(std::move(mri));
    showResult();
  });
  connect(&session_, &session::Session::contoursChanged, slice_, qOverload<>(&QWidget::update));
  connect(&session_, &session::Session::statusChanged, this, [this] {
    run_->setEnabled(!session_.busy());
    showModes();
    showOutdated();
    showDrafts();
  });
  clock_.setInterval(40);
  connect(&clock_, &QTimer::timeout, this, [this] { time_->setValue(time_->value() >= 100 ? 0 : time_->value() + 2); });
  setPlacing(true);
}

void RetractPage::showEvent(QShowEvent*) {
  scene_->setPalette3D(chosenPalette());
  if (place_->isChecked()) placement_->setActive(true);
}

// Before a run there is nothing but the model to look at; after it, either is shown.
void RetractPage::setPlacing(bool placing) {
  const bool run = session_.picture() != nullptr;
  placing = placing || !run;
  (placing ? place_ : moved_)->setChecked(true);
  moved_->setEnabled(run);
  showModes();
  slice_->setVisible(placing);
  if (placing) {
    setPlaying(false);
    live_->setLive(false);
  }
  playBar_->setVisible(run && !placing);
  live_->setVisible(run && !placing);
  placement_->setActive(placing && isVisible());
  placement_->setVisible(placing);
  if (!placing) scene_->setScene(session_.picture());
}

// Above the views, so that neither the laying nor the moving has to be looked for.
QWidget* RetractPage::makeModes() {
  auto* bar = new QWidget;
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(14, 8, 14, 8);
  place_ = button("placeButton", tr("Place by hand"), {},
                  tr("Shows the liver at rest: lay the bar, turn its hoist, hold the liver, in 3-D or on a slice"));
  moved_ = button("movedButton", tr("Play and move live"), {},
                  tr("Shows the last run: play it, go through it, take the retractor into your hand"));
  auto* modes = new QButtonGroup(this);
  for (QPushButton* mode : {place_, moved_}) {
    mode->setCheckable(true);
    modes->addButton(mode);
    row->addWidget(mode);
  }
  modeWords_ = labelled({}, "faint");
  modeWords_->setObjectName(QStringLiteral("modeWords"));
  row->addSpacing(8);
  row->addWidget(modeWords_, 1);
  connect(place_, &QPushButton::clicked, this, [this] { setPlacing(true); });
  connect(moved_, &QPushButton::clicked, this, [this] { setPlacing(false); });
  return bar;
}

void RetractPage::showModes() {
  const bool stale = session_.status(session::Step::Retract).state == session::StepState::Stale;
  if (!session_.picture())
    modeWords_->setText(tr("Drag bar, bar ends, hoist and holds; then Run."));
  else if (stale)
    modeWords_->setText(tr("Changed since the run: Run again to see what it does."));
  else
    modeWords_->setText(place_->isChecked() ? tr("Drag bar, bar ends, hoist and holds; then Run.") : QString());
}

void RetractPage::showOutdated() {
  const QString words = TrustPanel::outdated(session_);
  for (QWidget* shown : {static_cast<QWidget*>(numbers_), static_cast<QWidget*>(contact_)})
    shown->setEnabled(words.isEmpty());
  scene_->setOutdated(words);
}

/// What is drawn and does not count is said before it is run without.
void RetractPage::showDrafts() {
  QStringList slices;
  for (const int k : session_.coverage().drafts) slices << QString::number(k + 1);
  drafts_->setVisible(!slices.isEmpty());
  drafts_->setText(slices.isEmpty() ? QString()
                                    : tr("Drafts do not count (slices %1): accept or delete them on Segment first.")
                                          .arg(slices.join(QStringLiteral(", "))));
}

QWidget* RetractPage::makePlayBar() {
  auto* bar = new QWidget;
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(14, 8, 14, 8);
  play_ = button("playButton", {}, QStringLiteral("play"), tr("Play the retraction"));
  play_->setEnabled(false);
  row->addWidget(play_);
  time_ = new QSlider(Qt::Horizontal);
  time_->setObjectName(QStringLiteral("timeSlider"));
  time_->setRange(0, 100);
  time_->setValue(100);
  time_->setEnabled(false);
  row->addWidget(time_, 1);
  fraction_ = new QLabel(QStringLiteral("100 %"));
  fraction_->setMinimumWidth(52);
  fraction_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  row->addWidget(fraction_);
  notCourse_ = labelled({}, "faint");
  notCourse_->hide();
  row->addWidget(notCourse_);
  // Playing shows the run; the hand shows the tool: one at a time.
  connect(live_, &LiveBar::liveChanged, this, [this](bool live) {
    if (live) setPlaying(false);
    playBar_->setVisible(!live && scene_->hasScene() && moved_->isChecked());
  });
  connect(play_, &QPushButton::clicked, this, [this] { setPlaying(!clock_.isActive()); });
  connect(time_, &QSlider::valueChanged, this, [this](int value) {
    fraction_->setText(tr("%1 %").arg(value));
    scene_->setFraction(value / 100.0);
  });
  return bar;
}

QWidget* RetractPage::makeSide() {
  auto* frame = new SidePanel;
  QVBoxLayout* side = frame->column();
  side->addWidget(labelled(tr("Retraction"), "heading"));
  side->addWidget(new RetractorForm(session_));
  side->addSpacing(8);
  side->addWidget(section(tr("Solution")));
  numbers_ = labelled({}, "faint");
  numbers_->setObjectName(QStringLiteral("solutionNumbers"));
  side->addWidget(numbers_);
  contact_ = new ContactTable(session_);
  side->addWidget(contact_);
  side->addWidget(section(tr("How far to trust it")));
  trust_ = new TrustPanel(session_, QStringLiteral("retractValidity"));
  side->addWidget(trust_);
  connect(trust_, &TrustPanel::runWanted, this, &RetractPage::runWanted);
  side->addStretch();
  drafts_ = labelled({}, "caution");
  drafts_->setObjectName(QStringLiteral("draftsNote"));
  side->addWidget(drafts_);
  run_ = button("runButton", tr("Run"), QStringLiteral("run"), tr("Build, retract and compare (Ctrl+R)"));
  run_->setProperty("primary", true);
  side->addWidget(run_);
  connect(run_, &QPushButton::clicked, this, &RetractPage::runWanted);
  return frame;
}

void RetractPage::setPlaying(bool playing) {
  playing ? clock_.start() : clock_.stop();
  play_->setIcon(icon(playing ? QStringLiteral("pause") : QStringLiteral("play")));
}

void RetractPage::showResult() {
  setPlaying(false);
  const auto result = session_.result();
  contact_->show_();
  trust_->show_();
  showOutdated();
  setPlacing(false);
  play_->setEnabled(scene_->hasScene());
  time_->setEnabled(scene_->hasScene());
  time_->setValue(100);
  const bool bar = result && result->primary.contact;
  notCourse_->setVisible(bar || (result && result->primary.steps > 0));
  notCourse_->setText(bar ? tr("Straight from first touch to the end, not the course of the bar.")
                          : tr("Straight to the end of the time steps, not their course."));
  if (!result) {
    numbers_->setText(tr("Not run yet."));
    return;
  }
  const retraction::Result& r = result->primary;
  numbers_->setText(tr("%1: %2 iterations, residual %3\n%4 degrees of freedom\nLoad %5 N, reaction %6 N\n"
                       "Largest strain %7 %, rotation %8°")
                        .arg(QString::fromStdString(r.solver.kind))
                        .arg(r.solver.iterations)
                        .arg(r.solver.residual, 0, 'e', 1)
                        .arg(r.dofs)
                        .arg(r.load_N.norm(), 0, 'f', 2)
                        .arg(r.reaction_N.norm(), 0, 'f', 2)
                        .arg(100.0 * r.max_strain, 0, 'f', 1)
                        .arg(r.max_rotation_deg, 0, 'f', 1));
}

}  // namespace glisson::panels
