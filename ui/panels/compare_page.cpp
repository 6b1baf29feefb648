#include "panels/compare_page.h"

#include <QComboBox>
#include <QSlider>
#include <QSplitter>

#include "panels/form.h"
#include "session/session.h"
#include "views/picture_view.h"
#include "views/scene_view.h"

namespace glisson::panels {

namespace {

QString mm(double value) {
  return QString::number(value, 'f', 2) + QStringLiteral(" mm");
}

}  // namespace

ComparePage::ComparePage(session::Session& session, QWidget* parent)
    : QWidget(parent), session_(session), overlay_(new views::PictureView), scene_(new views::SceneView) {
  overlay_->setObjectName(QStringLiteral("overlayView"));
  overlay_->setHint(tr("Run the retraction to compare MRE with the atlas."));
  scene_->setObjectName(QStringLiteral("compareScene"));
  scene_->setHint(tr("The vessels in 3-D appear here."));
  auto* left = new QWidget;
  auto* column = new QVBoxLayout(left);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(overlay_, 1);
  auto* bar = new QHBoxLayout;
  bar->setContentsMargins(14, 8, 14, 8);
  slice_ = new QSlider(Qt::Horizontal);
  slice_->setObjectName(QStringLiteral("overlaySlice"));
  slice_->setEnabled(false);
  sliceText_ = new QLabel;
  sliceText_->setMinimumWidth(110);
  sliceText_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  bar->addWidget(slice_, 1);
  bar->addWidget(sliceText_);
  column->addLayout(bar);
  auto* splitter = new QSplitter;
  splitter->setHandleWidth(3);
  splitter->setChildrenCollapsible(false);
  splitter->addWidget(left);
  splitter->addWidget(scene_);
  splitter->setSizes({1000, 1000});
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  row->addWidget(splitter, 1);
  row->addWidget(makeSide());
  connect(slice_, &QSlider::valueChanged, this, [this] {
    chosen_ = true;
    drawSlice();
  });
  connect(overlay_, &views::PictureView::sliceWanted, this,
          [this](int step) { slice_->setValue(slice_->value() + step); });
  connect(&session_, &session::Session::runFinished, this, &ComparePage::showResult);
  connect(&session_, &session::Session::loaded, this, &ComparePage::showResult);
  connect(&session_, &session::Session::statusChanged, this, &ComparePage::showNumbers);
  showNumbers();
}

QWidget* ComparePage::makeSide() {
  QVBoxLayout* side = nullptr;
  QFrame* frame = sidePanel(side);
  side->addWidget(labelled(tr("MRE against atlas"), "heading"));
  side->addWidget(section(tr("Difference at the retractor")));
  retractor_ = labelled({}, "number");
  retractor_->setObjectName(QStringLiteral("differenceAtRetractor"));
  side->addWidget(retractor_);
  side->addWidget(section(tr("Over the whole liver")));
  numbers_ = labelled({}, "faint");
  numbers_->setObjectName(QStringLiteral("differenceNumbers"));
  side->addWidget(numbers_);
  side->addWidget(section(tr("Hepatic vessels")));
  vessels_ = labelled({}, "faint");
  vessels_->setObjectName(QStringLiteral("vesselNumbers"));
  side->addWidget(vessels_);
  side->addWidget(section(tr("How far to trust it")));
  validity_ = labelled({}, "faint");
  validity_->setObjectName(QStringLiteral("validityText"));
  side->addWidget(validity_);
  side->addStretch();
  side->addWidget(section(tr("Display")));
  auto* form = new QFormLayout;
  colours_ = new QComboBox;
  colours_->setObjectName(QStringLiteral("paletteChoice"));
  colours_->addItems({tr("Red / blue"), tr("Orange / blue (colour-blind)")});
  form->addRow(tr("Colours"), colours_);
  view_ = new QComboBox;
  view_->setObjectName(QStringLiteral("cameraChoice"));
  view_->addItem(tr("Oblique"), static_cast<int>(render::View3D::Oblique));
  view_->addItem(tr("From the front"), static_cast<int>(render::View3D::Anterior));
  view_->addItem(tr("From below"), static_cast<int>(render::View3D::Inferior));
  form->addRow(tr("Camera"), view_);
  side->addLayout(form);
  connect(colours_, &QComboBox::currentIndexChanged, this, [this] {
    scene_->setPalette3D(palette_());
    drawSlice();
  });
  connect(view_, &QComboBox::activated, this,
          [this] { scene_->setView(static_cast<render::View3D>(view_->currentData().toInt())); });
  return frame;
}

render::Palette ComparePage::palette_() const {
  return colours_->currentIndex() == 1 ? render::Palette::ColourBlind : render::Palette::RedBlue;
}

void ComparePage::showResult() {
  const auto picture = session_.picture();
  scene_->setScene(picture);
  slice_->setEnabled(picture != nullptr);
  if (!picture) {
    overlay_->clear();
    sliceText_->clear();
    showNumbers();
    return;
  }
  const QSignalBlocker quiet(slice_);
  slice_->setRange(0, picture->mri.grid.size.z() - 1);
  chosen_ = false;
  drawSlice();
  showNumbers();
}

void ComparePage::drawSlice() {
  const auto picture = session_.picture();
  if (!picture) return;
  if (chosen_) sliceText_->setText(tr("slice %1 / %2").arg(slice_->value() + 1).arg(slice_->maximum() + 1));
  if (painter_.busy()) {
    wanted_ = true;
    return;
  }
  render::SliceOverlayOptions options;
  options.slice = chosen_ ? slice_->value() : -1;
  options.palette = palette_();
  options.margin_mm = 40.0;
  struct Drawn {
    render::Picture picture;
    int slice = 0;
  };
  auto drawn = std::make_shared<Drawn>();
  painter_.start(
      [picture, options, drawn](const Progress&) mutable {
        // The first picture is of the slice where MRE and atlas differ most.
        if (options.slice < 0) options.slice = render::sliceOfLargestDifference(*picture);
        drawn->slice = options.slice;
        drawn->picture = render::sliceOverlay(*picture, options);
      },
      [this, picture, drawn](std::exception_ptr failure) {
        const int shown = drawn->slice;
        if (failure) {
          overlay_->setHint(session::reasonOf(failure));
        } else if (picture == session_.picture()) {
          overlay_->setPicture(drawn->picture);
          if (!std::exchange(chosen_, true)) {
            const QSignalBlocker quiet(slice_);
            slice_->setValue(shown);
            sliceText_->setText(tr("slice %1 / %2").arg(shown + 1).arg(slice_->maximum() + 1));
          }
        }
        if (std::exchange(wanted_, false))
          drawSlice();
        else if (!failure)
          emit overlayShown(shown);
      });
}

void ComparePage::showNumbers() {
  const auto result = session_.result();
  if (!result || !result->difference) {
    retractor_->setText(QStringLiteral("–"));
    numbers_->setText(tr("Not run yet."));
    vessels_->setText(QStringLiteral("–"));
    validity_->setText(QStringLiteral("–"));
    return;
  }
  const comparison::Difference& d = *result->difference;
  retractor_->setText(mm(d.at_retractor_mm));
  numbers_->setText(tr("mean %1, 95th percentile %2, largest %3\n%4")
                        .arg(mm(d.mean_mm), mm(d.p95_mm), mm(d.max_mm),
                             d.clinically_significant ? tr("At or above the 5 mm that matter clinically.")
                                                      : tr("Below the 5 mm that matter clinically.")));
  vessels_->setText(d.vessel_mm.empty()
                        ? tr("No vessel landmarks were found.")
                        : tr("%1 landmarks: mean %2, 95th percentile %3, largest %4; %5 % at 5 mm or more")
                              .arg(static_cast<qulonglong>(d.vessel_mm.size()))
                              .arg(mm(d.vesselMean_mm), mm(d.vesselP95_mm), mm(d.vesselMax_mm))
                              .arg(100.0 * d.vesselFractionBeyond, 0, 'f', 0));
  QStringList words;
  if (session_.resultIsStale()) words << tr("Something has changed since this run: run again.");
  for (const std::string& w : result->primary.validity) words << QString::fromStdString(w);
  for (const std::string& w : result->warnings) words << QString::fromStdString(w);
  words.removeDuplicates();
  validity_->setText(words.isEmpty() ? tr("No warning: strains and rotations are within linear theory.")
                                     : words.join(QStringLiteral("\n")));
}

}  // namespace glisson::panels
