#include "panels/segment_page.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QShortcut>
#include <QSplitter>
#include <QTreeWidget>
#include <algorithm>
#include <cmath>

#include "panels/form.h"
#include "session/session.h"
#include "views/slice_view.h"

namespace glisson::panels {

namespace {

/// Grey window that holds the middle 99 % of the voxels that are not black.
std::pair<double, double> windowOf(const image::ScalarVolume& volume) {
  std::vector<float> sample;
  const std::size_t step = std::max<std::size_t>(1, volume.values.size() / 200000);
  for (std::size_t i = 0; i < volume.values.size(); i += step)
    if (std::isfinite(volume.values[i]) && volume.values[i] != 0.0F) sample.push_back(volume.values[i]);
  if (sample.size() < 10) return {0.0, 1.0};
  const auto at = [&sample](double q) {
    const auto n = static_cast<std::ptrdiff_t>(q * static_cast<double>(sample.size() - 1));
    std::nth_element(sample.begin(), sample.begin() + n, sample.end());
    return static_cast<double>(sample[static_cast<std::size_t>(n)]);
  };
  const double low = at(0.005), high = at(0.995);
  return {low, high > low ? high : low + 1.0};
}

QString kPa(double value) {
  return std::isfinite(value) ? QString::number(value, 'f', 2) : QStringLiteral("–");
}

}  // namespace

SegmentPage::SegmentPage(session::Session& session, QWidget* parent)
    : QWidget(parent), session_(session), mri_(new views::SliceView), mre_(new views::SliceView) {
  mri_->setObjectName(QStringLiteral("mriView"));
  mre_->setObjectName(QStringLiteral("mreView"));
  mri_->setHint(tr("Open images first (step Load)."));
  mre_->setHint(tr("No elastogram is open."));
  auto* splitter = new QSplitter;
  splitter->addWidget(mri_);
  splitter->addWidget(mre_);
  splitter->setChildrenCollapsible(false);
  splitter->setHandleWidth(3);
  splitter->setSizes({1000, 1000});
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(splitter, 1);
  layout->addWidget(makeSide());
  mri_->setContours(&session_.contours(), &session_.tool());
  mre_->setContours(&session_.contours(), nullptr);
  connectTool();
  connectCursor();
  connect(&session_, &session::Session::loaded, this, &SegmentPage::showImages);
  connect(&session_, &session::Session::statisticsChanged, this, &SegmentPage::showStatistics);
  connect(&session_, &session::Session::contoursChanged, this, &SegmentPage::showOutlines);
  connect(&session_, &session::Session::toolChanged, this, &SegmentPage::showTool);
  connect(&session_, &session::Session::statusChanged, this, &SegmentPage::showActions);
  connect(&session_, &session::Session::pointWanted, mri_, &views::SliceView::showPoint);
  showTool();
}

QWidget* SegmentPage::makeSide() {
  QVBoxLayout* side = nullptr;
  QFrame* frame = sidePanel(side);
  side->addWidget(labelled(tr("Outline the liver"), "heading"));
  stateText_ = labelled({}, "faint");
  stateText_->setObjectName(QStringLiteral("toolState"));
  stateText_->setMinimumHeight(50);
  stateText_->setAlignment(Qt::AlignTop);
  side->addWidget(stateText_);

  auto* row = new QHBoxLayout;
  undo_ = button("undoButton", {}, QStringLiteral("undo"), tr("Undo (Ctrl+Z)"));
  redo_ = button("redoButton", {}, QStringLiteral("redo"), tr("Redo (Ctrl+Shift+Z)"));
  delete_ =
      button("deleteButton", {}, QStringLiteral("delete"), tr("Delete the selected vertices or outline (Delete)"));
  accept_ = button("acceptButton", tr("Accept"), QStringLiteral("accept"),
                   tr("Close or accept the outline (Enter; both at once: Ctrl+Enter)"));
  accept_->setProperty("primary", true);
  for (QPushButton* b : {undo_, redo_, delete_}) row->addWidget(b);
  side->addWidget(accept_);
  side->addLayout(row);
  const auto key = [this](tools::ToolKey k) { session_.apply(session_.tool().key(k, mri_->plane())); };
  connect(undo_, &QPushButton::clicked, &session_, &session::Session::undo);
  connect(redo_, &QPushButton::clicked, &session_, &session::Session::redo);
  connect(delete_, &QPushButton::clicked, this, [key] { key(tools::ToolKey::Delete); });
  connect(accept_, &QPushButton::clicked, this, [key] { key(tools::ToolKey::Enter); });

  side->addSpacing(8);
  side->addWidget(section(tr("Stiffness under the outline")));
  readout_ = labelled({}, "number");
  readout_->setObjectName(QStringLiteral("liveMean"));
  side->addWidget(readout_);
  pooled_ = labelled({}, "faint");
  pooled_->setObjectName(QStringLiteral("liveReadout"));
  pooled_->setMinimumHeight(76);
  pooled_->setAlignment(Qt::AlignTop);
  side->addWidget(pooled_);
  cursor_ = labelled({}, "faint");
  cursor_->setObjectName(QStringLiteral("cursorReadout"));
  side->addWidget(cursor_);

  side->addWidget(section(tr("Colour scale")));
  auto* scales = new QHBoxLayout;
  auto* group = new QButtonGroup(this);
  for (const double high : {8.0, 20.0}) {
    auto* scale = button(high < 10 ? "scale8" : "scale20", tr("0 – %1 kPa").arg(high), {}, tr("Switch with K"));
    scale->setCheckable(true);
    scale->setChecked(high < 10);
    group->addButton(scale);
    scales->addWidget(scale);
    connect(scale, &QPushButton::clicked, this, [this, high] { setStiffnessScale(high); });
  }
  side->addLayout(scales);
  auto* switchScale = new QShortcut(QKeySequence(Qt::Key_K), this);
  connect(switchScale, &QShortcut::activated, this, [group] {
    for (QAbstractButton* b : group->buttons())
      if (!b->isChecked()) {
        b->click();
        return;
      }
  });

  side->addSpacing(8);
  side->addWidget(section(tr("Outlines")));
  outlines_ = new QTreeWidget;
  outlines_->setObjectName(QStringLiteral("outlineList"));
  outlines_->setHeaderLabels({tr("Slice"), tr("Vertices"), tr("State")});
  outlines_->setRootIsDecorated(false);
  outlines_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  outlines_->header()->setSectionResizeMode(QHeaderView::Stretch);
  side->addWidget(outlines_, 1);
  connect(outlines_, &QTreeWidget::itemClicked, this,
          [this](QTreeWidgetItem* item) { mri_->setSlice(item->data(0, Qt::UserRole).toInt()); });
  coverage_ = labelled({}, "faint");
  coverage_->setObjectName(QStringLiteral("outlineCoverage"));
  side->addWidget(coverage_);
  auto* fill = new QHBoxLayout;
  interpolate_ = button("interpolateButton", tr("Interpolate"), QStringLiteral("interpolate"),
                        tr("Interpolate between slices: fill empty slices between outlines by shape (B)"));
  acceptAll_ = button("acceptAllButton", tr("Accept all"), QStringLiteral("accept"),
                      tr("Accept all interpolated outlines (Shift+B)"));
  for (QPushButton* b : {interpolate_, acceptAll_}) fill->addWidget(b, 1);
  side->addLayout(fill);
  connect(interpolate_, &QPushButton::clicked, &session_, &session::Session::interpolateOutlines);
  connect(acceptAll_, &QPushButton::clicked, &session_, &session::Session::acceptInterpolated);
  import_ = button("importButton", tr("Import outlines…"), QStringLiteral("import"),
                   tr("RT Structure Set, contour file or mask (Ctrl+I)"));
  side->addWidget(import_);
  connect(import_, &QPushButton::clicked, this, &SegmentPage::importWanted);
  return frame;
}

void SegmentPage::connectTool() {
  using views::SliceView;
  const auto pass = [this](auto signal, auto gesture) {
    connect(mri_, signal, this, [this, gesture](const tools::Pointer& at) {
      session_.apply((session_.tool().*gesture)(at, mri_->plane()));
    });
  };
  pass(&SliceView::toolPressed, &tools::PolygonTool::press);
  pass(&SliceView::toolMoved, &tools::PolygonTool::move);
  pass(&SliceView::toolReleased, &tools::PolygonTool::release);
  pass(&SliceView::toolDoubleClicked, &tools::PolygonTool::doubleClick);
  pass(&SliceView::toolRightClicked, &tools::PolygonTool::rightClick);
  connect(mri_, &SliceView::toolKey, this,
          [this](tools::ToolKey key) { session_.apply(session_.tool().key(key, mri_->plane())); });
  connect(mri_, &SliceView::sliceAboutToChange, this,
          [this] { session_.apply(session_.tool().leaveSlice(mri_->plane())); });
}

void SegmentPage::connectCursor() {
  using views::SliceView;
  connect(mri_, &SliceView::sliceChanged, this, [this] {
    const tools::SlicePlane plane = mri_->plane();
    const Eigen::Vector3d middle =
        plane.grid.indexToLps({plane.grid.size.x() / 2.0, plane.grid.size.y() / 2.0, 1.0 * plane.slice});
    if (!mre_->underMouse()) mre_->showPoint(middle);
    session_.setShownPlane(plane);
    outlines_->clearSelection();
    showOutlines();
  });
  connect(mre_, &SliceView::sliceChanged, this, [this] {
    if (!mre_->underMouse()) return;
    const tools::SlicePlane plane = mre_->plane();
    mri_->showPoint(plane.grid.indexToLps({plane.grid.size.x() / 2.0, plane.grid.size.y() / 2.0, 1.0 * plane.slice}));
  });
  const auto both = [this](const std::optional<Eigen::Vector3d>& p) {
    mri_->setCursor(p);
    mre_->setCursor(p);
    QString text;
    if (p) {
      if (const auto value = mre_->valueAt(*p)) text = tr("Under the cursor: %1 kPa (µ)").arg(*value, 0, 'f', 2);
    }
    cursor_->setText(text);
  };
  for (SliceView* view : {mri_, mre_}) {
    connect(view, &SliceView::cursorMoved, this, [both](const Eigen::Vector3d& p) { both(p); });
    connect(view, &SliceView::cursorLeft, this, [both] { both(std::nullopt); });
  }
}

void SegmentPage::showImages() {
  const session::OpenImages& images = session_.images();
  if (!images.mri) {
    mri_->clear();
    mre_->clear();
    return;
  }
  views::ShownVolume mri;
  mri.values = images.mri;
  std::tie(mri.low, mri.high) = windowOf(*images.mri);
  mri.title = tr("MRI");
  mri.sopInstanceUids = session_.scan().series[static_cast<std::size_t>(images.mriSeries)].sopInstanceUids;
  mri_->setVolume(mri);
  if (!images.stiffness) {
    mre_->clear();
    return;
  }
  views::ShownVolume mre;
  // Shared with the map that is measured: what is seen is what counts.
  mre.values = std::shared_ptr<const image::ScalarVolume>(images.stiffness, &images.stiffness->values_kPa);
  if (images.stiffness->confidence)
    mre.confidence = std::shared_ptr<const image::ScalarVolume>(images.stiffness, &*images.stiffness->confidence);
  mre.confidenceThreshold = defaults::confidenceThreshold;
  mre.stiffness = true;
  mre.low = 0.0;
  mre.high = 8.0;
  mre.title = tr("MRE stiffness (µ)");
  mre.unit = QStringLiteral("kPa");
  mre_->setVolume(mre);
  session_.setShownPlane(mri_->plane());
}

void SegmentPage::setStiffnessScale(double high_kPa) {
  mre_->setWindow(0.0, high_kPa);
}

void SegmentPage::showStatistics() {
  const session::LiveStatistics& live = session_.statistics();
  if (!live.pooled) {
    readout_->setText(QStringLiteral("–"));
    pooled_->setText(live.reason);
    return;
  }
  const auto line = [](const elastography::Statistics& s) {
    return tr("%1 px → %2 after mask, %3 cm², %4 ± %5 kPa (µ)")
        .arg(static_cast<qulonglong>(s.n_before_mask))
        .arg(static_cast<qulonglong>(s.n))
        .arg(s.area_mm2 / 100.0, 0, 'f', 1)
        .arg(kPa(s.mean_kPa), kPa(s.sd_kPa));
  };
  const elastography::Statistics& all = live.pooled->pooled;
  readout_->setText(tr("%1 ± %2 kPa").arg(kPa(all.mean_kPa), kPa(all.sd_kPa)));
  QString text = tr("All slices: ") + line(all);
  if (live.slice) text += QStringLiteral("\n") + tr("This slice: ") + line(*live.slice);
  pooled_->setText(text);
}

void SegmentPage::showOutlines() {
  outlines_->clear();
  if (!mri_->hasVolume()) return;
  const image::Grid& grid = mri_->volume().values->grid;
  struct Row {
    int slice;
    QString vertices, state;
    bool drawn;
  };
  std::vector<Row> rows;
  for (const roi::Polygon& p : session_.contours().polygons) {
    if (p.points_lps_mm.cols() == 0) continue;
    const QString state = p.exclude                                    ? tr("left out")
                          : p.state == roi::PolygonState::Accepted     ? tr("drawn")
                          : p.state == roi::PolygonState::Interpolated ? tr("interpolated")
                                                                       : tr("draft");
    rows.push_back({tools::sliceOf(p, grid), QString::number(p.points_lps_mm.cols()), state,
                    p.state == roi::PolygonState::Accepted});
  }
  const session::OutlineCoverage covered = session_.coverage();
  for (const int k : covered.empty) rows.push_back({k, QStringLiteral("–"), tr("empty"), false});
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.slice > b.slice; });
  for (const Row& r : rows) {
    auto* item = new QTreeWidgetItem(outlines_, {QString::number(r.slice + 1), r.vertices, r.state});
    item->setData(0, Qt::UserRole, r.slice);
    if (r.slice == mri_->slice()) {
      QFont bold = item->font(0);
      bold.setBold(true);
      for (int c = 0; c < 3; ++c) item->setFont(c, bold);
    } else if (!r.drawn) {
      for (int c = 0; c < 3; ++c) item->setForeground(c, palette().color(QPalette::PlaceholderText));
    }
  }
  QString text;
  if (!covered.drawn.empty()) {
    text = tr("%1 drawn, %2 interpolated, %3 empty between them.")
               .arg(covered.drawn.size())
               .arg(covered.interpolated.size())
               .arg(covered.empty.size());
    if (!covered.empty.empty()) text += QLatin1Char(' ') + tr("A run fills these by shape.");
  }
  coverage_->setText(text);
  showActions();
}

void SegmentPage::showActions() {
  const session::OutlineCoverage covered = session_.coverage();
  interpolate_->setEnabled(covered.drawn.size() > 1 && covered.empty.size() + covered.interpolated.size() > 0 &&
                           !session_.busy());
  acceptAll_->setEnabled(!covered.interpolated.empty());
}

void SegmentPage::showTool() {
  const tools::ToolState state = session_.tool().state();
  const bool drawing = state == tools::ToolState::Drawing, editing = state == tools::ToolState::Editing;
  undo_->setEnabled(session_.canUndo());
  redo_->setEnabled(session_.canRedo());
  undo_->setToolTip(tr("Undo %1 (Ctrl+Z)").arg(session_.undoText()));
  redo_->setToolTip(tr("Redo %1 (Ctrl+Shift+Z)").arg(session_.redoText()));
  accept_->setEnabled(drawing || editing);
  accept_->setText(drawing ? tr("Close") : tr("Accept"));
  delete_->setEnabled(session_.tool().selected().has_value());
  showActions();
  switch (state) {
    case tools::ToolState::Idle:
      stateText_->setText(tr("Click vertices on the MRI, or drag to draw freehand. Click an outline to edit it."));
      break;
    case tools::ToolState::Drawing:
      stateText_->setText(
          tr("Close on the first vertex, with a right click, a double click or Enter. Backspace takes "
             "the last vertex back, Esc parks a draft."));
      break;
    case tools::ToolState::Editing:
      stateText_->setText(session_.tool().interpolated()
                              ? tr("Interpolated between drawn slices. Enter accepts it, correcting it accepts it too; "
                                   "an outline drawn "
                                   "on this slice replaces it.")
                              : tr("Drag vertices to adjust; Ctrl+click adds or deletes one. Enter accepts."));
      break;
    case tools::ToolState::Accepted:
      stateText_->setText(tr("Accepted. It can still be edited; click beside it to draw the next."));
      break;
  }
  mri_->update();
  mre_->update();
}

}  // namespace glisson::panels
