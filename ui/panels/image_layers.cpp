// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/image_layers.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <algorithm>
#include <cmath>

#include "panels/form.h"
#include "panels/grey_window.h"
#include "session/session.h"
#include "views/slice_view.h"

namespace glisson::panels {

namespace {
constexpr int phaseEvery_ms = 110;
}

ImageLayers::~ImageLayers() = default;

ImageLayers::ImageLayers(views::SliceView* view, QWidget* parent)
    : QWidget(parent), view_(view), images_(std::make_unique<session::OpenImages>()) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(6, 4, 6, 4);
  row->setSpacing(2);
  auto* group = new QButtonGroup(this);
  const std::array<std::pair<const char*, QString>, 4> names = {{{"layerStiffness", tr("Stiffness")},
                                                                 {"layerMagnitude", tr("Magnitude")},
                                                                 {"layerWave", tr("Wave")},
                                                                 {"layerConfidence", tr("Confidence")}}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    buttons_[i] = button(names[i].first, names[i].second, {}, tr("Show the %1 image").arg(names[i].second));
    buttons_[i]->setCheckable(true);
    buttons_[i]->setProperty("flat", true);
    group->addButton(buttons_[i]);
    row->addWidget(buttons_[i]);
    connect(buttons_[i], &QPushButton::clicked, this, [this, i] { show(static_cast<Layer>(i)); });
  }
  buttons_[0]->setChecked(true);
  row->addStretch();
  phaseText_ = labelled({}, "faint");
  phaseText_->setWordWrap(false);
  row->addWidget(phaseText_);
  play_ = button("playWave", {}, QStringLiteral("play"), tr("Play the wave (V)"));
  play_->setProperty("flat", true);
  row->addWidget(play_);
  connect(play_, &QPushButton::clicked, this, &ImageLayers::togglePlay);
  clock_.setInterval(phaseEvery_ms);
  connect(view_, &views::SliceView::windowChanged, this, [this](double, double high) {
    if (layer_ == Layer::Wave) waveRange_ = high;
  });
  connect(&clock_, &QTimer::timeout, this, [this] {
    if (images_->wave.empty()) return;
    phase_ = (phase_ + 1) % static_cast<int>(images_->wave.size());
    showWave();
  });
}

void ImageLayers::setImages(const session::OpenImages& images) {
  setPlaying(false);
  *images_ = images;
  phase_ = 0;
  waveRange_ = 1.0;
  if (!images.wave.empty()) {
    const auto [low, high] = windowOf(*images.wave.front());
    waveRange_ = std::max({std::abs(low), std::abs(high), 1e-6});
  }
  buttons_[0]->setEnabled(images.stiffness != nullptr);
  buttons_[1]->setEnabled(images.magnitude != nullptr);
  buttons_[2]->setEnabled(!images.wave.empty());
  buttons_[3]->setEnabled(images.stiffness && images.stiffness->confidence);
  show(Layer::Stiffness);
}

void ImageLayers::setStiffnessScale(double high_kPa) {
  high_kPa_ = high_kPa;
  if (layer_ == Layer::Stiffness) view_->setWindow(0.0, high_kPa);
}

void ImageLayers::show(Layer layer) {
  if (!buttons_[static_cast<std::size_t>(layer)]->isEnabled() && layer != Layer::Stiffness) return;
  layer_ = layer;
  buttons_[static_cast<std::size_t>(layer)]->setChecked(true);
  const bool wave = layer == Layer::Wave;
  play_->setEnabled(wave && images_->wave.size() > 1);
  if (!wave) setPlaying(false);
  phaseText_->clear();
  const Eigen::Vector3d here = view_->hasVolume() ? view_->centre_lps() : Eigen::Vector3d::Zero();
  const bool had = view_->hasVolume();
  views::ShownVolume shown;
  if (wave) {
    showWave();
    return;
  }
  if (layer == Layer::Magnitude) {
    shown.values = images_->magnitude;
    std::tie(shown.low, shown.high) = windowOf(*images_->magnitude);
    shown.title = tr("MRE magnitude");
  } else if (images_->stiffness) {
    // Shared with the map that is measured: what is seen is what counts.
    const auto& map = images_->stiffness;
    if (map->confidence) shown.confidence = std::shared_ptr<const image::ScalarVolume>(map, &*map->confidence);
    if (layer == Layer::Stiffness) {
      shown.values = std::shared_ptr<const image::ScalarVolume>(map, &map->values_kPa);
      shown.confidenceThreshold = defaults::confidenceThreshold;
      shown.stiffness = true;
      shown.low = 0.0;
      shown.high = high_kPa_;
      shown.title = tr("MRE stiffness (µ)");
      shown.unit = QStringLiteral("kPa");
    } else {
      shown.values = std::exchange(shown.confidence, nullptr);
      shown.title = tr("MRE confidence");
    }
  }
  view_->setVolume(shown);
  if (had && view_->hasVolume()) view_->showPoint(here);
}

void ImageLayers::showWave() {
  if (images_->wave.empty()) return;
  views::ShownVolume shown;
  shown.values = images_->wave[static_cast<std::size_t>(phase_)];
  shown.low = -waveRange_;
  shown.high = waveRange_;
  shown.wave = true;
  shown.title = tr("MRE wave");
  view_->setVolume(shown);
  const QString step = QStringLiteral("%1/%2").arg(phase_ + 1).arg(images_->wave.size());
  phaseText_->setText(images_->wave.size() > 1 ? step : QString());
  phaseText_->setToolTip(images_->wave.size() > 1 ? tr("Time step of the wave") : tr("one time step"));
}

void ImageLayers::togglePlay() {
  if (images_->wave.size() < 2) return;
  if (layer_ != Layer::Wave) show(Layer::Wave);
  setPlaying(!clock_.isActive());
}

void ImageLayers::setPlaying(bool on) {
  on ? clock_.start() : clock_.stop();
  const QString shown = on ? QStringLiteral("pause") : QStringLiteral("play");
  if (play_->property("iconName") == shown) return;
  play_->setProperty("iconName", shown);
  play_->setIcon(icon(shown));
}

}  // namespace glisson::panels
