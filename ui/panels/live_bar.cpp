// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/live_bar.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QSlider>
#include <cmath>

#include "panels/form.h"
#include "session/session.h"
#include "views/scene_view.h"

namespace glisson::panels {

namespace {

constexpr int reach_mm = 80;        // of the sliders
constexpr double perStep_mm = 0.1;  // of a slider
constexpr qint64 pause_ms = 1000;   // longer than this between pictures is no frame rate

/// Tenths of a millimetre; nothing is "-0.0".
QString tenths(double mm) {
  return QString::number(std::round(10.0 * mm) / 10.0 + 0.0, 'f', 1);
}

}  // namespace

LiveBar::LiveBar(session::Session& session, views::SceneView& scene, QWidget* parent)
    : QWidget(parent), session_(session), scene_(scene) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 0, 14, 8);
  column->setSpacing(4);
  auto* row = new QHBoxLayout;
  live_ = button("liveButton", tr("Move live"), {},
                 tr("Drag the retractor in the picture, or use the sliders: both livers follow"));
  live_->setCheckable(true);
  live_->setEnabled(false);
  row->addWidget(live_);
  const std::array names = {tr("right – left"), tr("front – back"), tr("down – up")};
  for (std::size_t a = 0; a < 3; ++a) {
    row->addSpacing(10);
    row->addWidget(labelled(names[a], "faint"));
    slider_[a] = new QSlider(Qt::Horizontal);
    slider_[a]->setObjectName(QStringLiteral("liveSlider%1").arg(QLatin1Char("LPS"[a])));
    slider_[a]->setAccessibleName(tr("Tool, %1, mm").arg(names[a]));
    slider_[a]->setRange(qRound(-reach_mm / perStep_mm), qRound(reach_mm / perStep_mm));
    slider_[a]->setSingleStep(qRound(1.0 / perStep_mm));
    slider_[a]->setPageStep(qRound(5.0 / perStep_mm));
    slider_[a]->setEnabled(false);
    row->addWidget(slider_[a], 1);
    value_[a] = new QLabel;
    value_[a]->setMinimumWidth(64);
    value_[a]->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    row->addWidget(value_[a]);
    connect(slider_[a], &QSlider::valueChanged, this, &LiveBar::take);
  }
  reset_ = button("liveReset", tr("As run"), {}, tr("Back to the force or the travel of the run"));
  reset_->setEnabled(false);
  row->addSpacing(10);
  comparison_ = new QComboBox;
  comparison_->setObjectName(QStringLiteral("liveComparison"));
  comparison_->setAccessibleName(tr("What both livers share"));
  comparison_->addItem(tr("equal force"), QVariant::fromValue(static_cast<int>(session::LiveComparison::EqualForce)));
  comparison_->addItem(tr("equal travel"), QVariant::fromValue(static_cast<int>(session::LiveComparison::EqualTravel)));
  comparison_->setToolTip(
      tr("Equal force: the liver with textbook stiffness is pulled as hard as the measured one, as in "
         "the run. Equal travel: the tool goes as far in both"));
  comparison_->setEnabled(false);
  row->addWidget(comparison_);
  row->addWidget(reset_);
  column->addLayout(row);
  numbers_ = labelled(tr("Run the retraction; then the retractor can be moved by hand."), "faint");
  numbers_->setObjectName(QStringLiteral("liveNumbers"));
  column->addWidget(numbers_);
  speed_ = labelled({}, "faint");
  speed_->setObjectName(QStringLiteral("liveSpeed"));
  column->addWidget(speed_);
  connect(live_, &QPushButton::toggled, this, &LiveBar::setLive);
  connect(reset_, &QPushButton::clicked, this, &LiveBar::reset);
  connect(comparison_, &QComboBox::currentIndexChanged, this, [this] { ask(target_); });
  connect(&scene_, &views::SceneView::toolDragged, this, &LiveBar::moveTool);
  connect(&scene_, &views::SceneView::rendered, this, &LiveBar::pictureDrawn);
  connect(&session_, &session::Session::runFinished, this, &LiveBar::build);
  connect(&session_, &session::Session::loaded, this, &LiveBar::build);
  connect(&worker_, &session::Worker::progressed, this, [this](double fraction, const QString&, double secondsLeft) {
    numbers_->setText(tr("Preparing to move live: %1 %").arg(qRound(100.0 * fraction)) +
                      session::timeLeft(secondsLeft));
  });
}

bool LiveBar::isLive() const {
  return live_->isChecked();
}

void LiveBar::build() {
  setLive(false);
  hand_.reset();
  frame_.reset();
  live_->setEnabled(false);
  speed_->clear();
  if (worker_.busy()) {
    again_ = true;
    worker_.cancel();
    return;
  }
  const auto result = session_.result();
  const auto picture = session_.picture();
  if (!result || !picture) {
    numbers_->setText(tr("Run the retraction; then the retractor can be moved by hand."));
    return;
  }
  auto made = std::make_shared<std::unique_ptr<session::LivePair>>();
  worker_.start(
      [made, result, picture,
       file = std::filesystem::path(session_.runFolder().toStdString()).parent_path() /
              "case.json"](const Progress& progress) {
        *made = std::make_unique<session::LivePair>(file, result->placed, *picture, result->landmarks_mm, progress);
      },
      [this, made](std::exception_ptr failure) {
        if (std::exchange(again_, false)) {
          build();
          return;
        }
        if (failure) {
          numbers_->setText(tr("The retractor cannot be moved live. %1").arg(session::reasonOf(failure)));
          return;
        }
        hand_ = std::make_unique<session::LiveHand>(std::move(*made));
        connect(hand_.get(), &session::LiveHand::moved, this, &LiveBar::show);
        connect(hand_.get(), &session::LiveHand::failed, this, [this](const QString& why) {
          setLive(false);
          numbers_->setText(tr("The retractor cannot be moved live. %1").arg(why));
        });
        // A run with a given travel compares at equal travel.
        comparison_->setCurrentIndex(hand_->pair().sceneTarget().force_N ? 0 : 1);
        live_->setEnabled(true);
        numbers_->setText(tr("Ready: \"Move live\" puts the retractor into your hand."));
        emit ready();
      });
}

void LiveBar::setLive(bool live) {
  live = live && hand_;
  const QSignalBlocker quiet(live_);
  live_->setChecked(live);
  for (QSlider* slider : slider_) slider->setEnabled(live);
  reset_->setEnabled(live);
  comparison_->setEnabled(live);
  scene_.setLive(live);
  if (live)
    reset();
  else
    for (QLabel* value : value_) value->clear();
  if (!live && hand_) numbers_->setText(tr("Ready: \"Move live\" puts the retractor into your hand."));
  emit liveChanged(live);
}

void LiveBar::reset() {
  if (!hand_) return;
  ask(hand_->pair().sceneTarget());
}

void LiveBar::take() {
  if (!isLive()) return;
  Eigen::Vector3d at;
  for (int a = 0; a < 3; ++a) at[a] = perStep_mm * slider_[static_cast<std::size_t>(a)]->value();
  ask({at, {}});
}

void LiveBar::moveTool(const Eigen::Vector3d& displacement_mm) {
  if (!isLive()) return;
  ask({displacement_mm.cwiseMax(-reach_mm).cwiseMin(reach_mm), {}});
}

void LiveBar::ask(const retraction::LiveTarget& target) {
  target_ = target;
  if (!hand_) return;
  if (!target.force_N) setSliders(target.tool_mm);
  hand_->ask(target, static_cast<session::LiveComparison>(comparison_->currentData().toInt()));
}

void LiveBar::setSliders(const Eigen::Vector3d& displacement_mm) {
  for (std::size_t a = 0; a < 3; ++a) {
    const QSignalBlocker quiet(slider_[a]);
    slider_[a]->setValue(qRound(displacement_mm[static_cast<Eigen::Index>(a)] / perStep_mm));
  }
}

void LiveBar::show() {
  frame_ = hand_->frame();
  if (!isLive() || !frame_) return;
  scene_.moveLive(frame_->mre_mm, frame_->atlas_mm, frame_->toolMre_mm, frame_->toolAtlas_mm);
  // Where the force leads the tool, the sliders follow it; else the hand is ahead of what is shown.
  if (target_.force_N) setSliders(frame_->toolMre_mm);
  for (std::size_t a = 0; a < 3; ++a)
    value_[a]->setText(tr("%1 mm").arg(tenths(frame_->toolMre_mm[static_cast<Eigen::Index>(a)])));
  numbers_->setText(numbers());
  tellSpeed();
}

QString LiveBar::numbers() const {
  const session::LivePair& pair = hand_->pair();
  const session::LiveFrame& f = *frame_;
  const bool equalForce = comparison_->currentData().toInt() == static_cast<int>(session::LiveComparison::EqualForce);
  // A rigid bar also keeps its place across the hoist; what is compared and asked for is the force along it.
  const bool contact = pair.kind() == retraction::LiveKind::Contact;
  const Eigen::Vector3d hoist = pair.sceneForce_N().normalized();
  const auto pull_N = [&](const Eigen::Vector3d& force_N) { return contact ? force_N.dot(hoist) : force_N.norm(); };
  const retraction::LiveTarget& run = pair.sceneTarget();
  QString text = (run.force_N ? tr("Tool %1 mm from rest with %2 N (the run: %3 N)")
                              : tr("Tool %1 mm from rest with %2 N (the run: %3 mm)"))
                     .arg(f.toolMre_mm.norm(), 0, 'f', 1)
                     .arg(std::abs(pull_N(f.force_N)), 0, 'f', 1)
                     .arg(run.force_N ? run.force_N->norm() : run.tool_mm.norm(), 0, 'f', 1);
  text += equalForce ? tr("; with atlas stiffness it goes %1 mm, %2 mm from there")
                           .arg(f.toolAtlas_mm.norm(), 0, 'f', 1)
                           .arg(f.atTool_mm, 0, 'f', 2)
                     : tr("; with atlas stiffness that takes %1 N").arg(std::abs(pull_N(f.forceAtlas_N)), 0, 'f', 1);
  const auto landmarks = f.mre_mm.cols() - pair.liverVertices() - pair.vesselVertices();
  if (landmarks > 0)
    text += tr("; vessels: mean %1, largest %2 mm, %3 of %4 landmarks at 5 mm or more")
                .arg(f.vesselMean_mm, 0, 'f', 2)
                .arg(f.vesselMax_mm, 0, 'f', 2)
                .arg(f.vesselsBeyond)
                .arg(static_cast<qlonglong>(landmarks));
  text += QLatin1Char('.');
  using retraction::LiveOutcome;
  if (f.mre == LiveOutcome::Slips)
    text += QLatin1Char(' ') + tr("The bar slips: the liver does not bear this force here.");
  else if (f.atlas == LiveOutcome::Slips)
    text += QLatin1Char(' ') + tr("With atlas stiffness the bar slips: that liver does not bear this force here.");
  if (f.mre == LiveOutcome::Cuts)
    text += QLatin1Char(' ') + tr("The bar cuts into the liver: what is shown is no answer.");
  else if (f.atlas == LiveOutcome::Cuts)
    text += QLatin1Char(' ') + tr("With atlas stiffness the bar cuts into the liver: what is shown is no answer.");
  if (!contact && f.force_N.norm() > 1.5 * pair.sceneForce_N().norm())
    text += QLatin1Char(' ') + tr("Linear theory, far beyond the force of the run: shapes are not to be trusted.");
  return text;
}

void LiveBar::tellSpeed() {
  const session::LiveFrame& f = *frame_;
  QString text = tr("Simulation %1 ms a frame (%2 frames/s possible)")
                     .arg(1e3 * f.seconds, 0, 'f', f.seconds < 1e-3 ? 2 : 0)
                     .arg(1.0 / std::max(f.seconds, 1e-9), 0, 'f', 0);
  if (between_ms_ > 0) text += tr("; on screen %1 pictures/s").arg(1e3 / static_cast<double>(between_ms_), 0, 'f', 0);
  if (hand_->pair().kind() == retraction::LiveKind::Contact)
    text += f.atRest ? tr("; at rest, on %1 degrees of freedom").arg(hand_->pair().dofs())
                     : tr("; up to %1 mm from rest, on %2 degrees of freedom")
                           .arg(f.remaining_mm, 0, 'f', 2)
                           .arg(hand_->pair().dofs());
  speed_->setText(text + QLatin1Char('.'));
}

void LiveBar::pictureDrawn() {
  if (!isLive() || !frame_) return;
  const qint64 since = picture_.isValid() ? picture_.elapsed() : pause_ms;
  picture_.start();
  between_ms_ = since <= 0 || since >= pause_ms ? 0 : since;
  if (between_ms_ > 0) tellSpeed();
}

}  // namespace glisson::panels
