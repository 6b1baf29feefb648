// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/plane_views.h"

#include <QHBoxLayout>
#include <QSplitter>
#include <cmath>

#include "image/reorient.h"
#include "tools/patient_planes.h"

namespace glisson::panels {

using tools::PatientPlane;
using views::SliceView;

namespace {

QString nameOf(PatientPlane plane) {
  switch (plane) {
    case PatientPlane::Axial: return PlaneViews::tr("Axial");
    case PatientPlane::Coronal: return PlaneViews::tr("Coronal");
    case PatientPlane::Sagittal: break;
  }
  return PlaneViews::tr("Sagittal");
}

}  // namespace

PlaneViews::PlaneViews(QWidget* parent) : QWidget(parent), views_{new SliceView, new SliceView} {
  setObjectName(QStringLiteral("planeViews"));
  auto* splitter = new QSplitter;
  splitter->setChildrenCollapsible(false);
  splitter->setHandleWidth(3);
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(splitter);
  for (std::size_t v = 0; v < views_.size(); ++v) {
    SliceView* view = views_[v];
    view->setObjectName(v == 0 ? QStringLiteral("firstPlane") : QStringLiteral("secondPlane"));
    view->setMinimumSize(160, 140);
    view->setHint(tr("Open images first (step Load)."));
    splitter->addWidget(view);
    connect(view, &SliceView::toolPressed, this, [this, view](const tools::Pointer& at) {
      dragging_ = true;
      emit crosshairMoved(view->plane().toLps(at.px));
    });
    connect(view, &SliceView::toolMoved, this, [this, view](const tools::Pointer& at) {
      if (dragging_) emit crosshairMoved(view->plane().toLps(at.px));
    });
    connect(view, &SliceView::toolReleased, this, [this] { dragging_ = false; });
    connect(view, &SliceView::sliceChanged, this, [this, view] { follow(view); });
  }
  splitter->setSizes({1000, 1000});
}

// By the wheel over it: the crosshair goes to the slice that is shown now.
void PlaneViews::follow(SliceView* view) {
  if (!crosshair_ || dragging_ || !view->underMouse()) return;
  const image::Grid& grid = view->volume().values->grid;
  Eigen::Vector3d index = grid.lpsToIndex(*crosshair_);
  if (std::lround(index.z()) == view->slice()) return;
  index.z() = view->slice();
  emit crosshairMoved(grid.indexToLps(index));
}

void PlaneViews::setImage(std::shared_ptr<const image::ScalarVolume> image, double low, double high) {
  if (image != image_) {
    image_ = std::move(image);
    stale_ = true;
    crosshair_.reset();
    for (SliceView* view : views_) {
      view->clear();
      view->setHint(image_ ? tr("This plane is being made.") : tr("Open images first (step Load)."));
    }
  }
  low_ = low;
  high_ = high;
  if (isVisible()) reformat();
}

void PlaneViews::showEvent(QShowEvent*) {
  reformat();
}

void PlaneViews::reformat() {
  if (!stale_ || !image_ || worker_.busy()) return;
  using Volumes = std::array<std::shared_ptr<const image::ScalarVolume>, 2>;
  auto made = std::make_shared<Volumes>();
  worker_.start(
      [made, image = image_](const Progress&) {
        const auto planes = tools::planesAcross(image->grid);
        for (std::size_t v = 0; v < planes.size(); ++v)
          (*made)[v] =
              std::make_shared<image::ScalarVolume>(image::permuted(*image, tools::axesOf(planes[v], image->grid)));
      },
      [this, made, image = image_](std::exception_ptr failure) {
        if (image != image_) {  // another one was opened meanwhile
          reformat();
          return;
        }
        stale_ = false;
        if (failure) return;
        const auto planes = tools::planesAcross(image->grid);
        for (std::size_t v = 0; v < views_.size(); ++v) {
          views::ShownVolume shown;
          shown.values = (*made)[v];
          shown.low = low_;
          shown.high = high_;
          shown.title = nameOf(planes[v]);
          views_[v]->setVolume(std::move(shown));
        }
        if (crosshair_) setCrosshair(*crosshair_);
        emit reformatted();
      });
}

void PlaneViews::setWindow(double low, double high) {
  low_ = low;
  high_ = high;
  for (SliceView* view : views_)
    if (view->hasVolume()) view->setWindow(low, high);
}

void PlaneViews::setFusion(const views::Fusion& fusion) {
  for (SliceView* view : views_) view->setFusion(fusion);
}

void PlaneViews::setRegion(const std::shared_ptr<const image::Mask>& region) {
  for (SliceView* view : views_) view->setRegion(region);
}

void PlaneViews::setCrosshair(const Eigen::Vector3d& p_lps) {
  crosshair_ = p_lps;
  for (SliceView* view : views_) {
    view->showPoint(p_lps);
    view->setCursor(p_lps);
  }
}

void PlaneViews::setCursor(const std::optional<Eigen::Vector3d>& p_lps) {
  for (SliceView* view : views_) view->setCursor(p_lps ? p_lps : crosshair_);
}

}  // namespace glisson::panels
