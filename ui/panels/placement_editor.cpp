// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/placement_editor.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "panels/form.h"
#include "panels/theme.h"
#include "session/model_preview.h"
#include "session/session.h"
#include "tools/scene_camera.h"
#include "views/scene_view.h"
#include "views/slice_view.h"

namespace glisson::panels {

namespace {

constexpr double hoistArrow_mm = 60.0;
const QColor barColour(205, 211, 218);

QString place(const Eigen::Vector3d& p) {
  const auto one = [](double v, QChar more, QChar less) {
    return QStringLiteral("%1 %2").arg(v < 0 ? less : more).arg(std::abs(v), 0, 'f', 1);
  };
  return QStringLiteral("%1, %2, %3 mm")
      .arg(one(p.x(), QLatin1Char('L'), QLatin1Char('R')), one(p.y(), QLatin1Char('P'), QLatin1Char('A')),
           one(p.z(), QLatin1Char('S'), QLatin1Char('I')));
}

QString proposedBy(tools::BarProof proof) {
  switch (proof) {
    case tools::BarProof::ByTheRun:
      return PlacementEditor::tr(" (proposed from the liver's shape; the run proves that it bears)");
    case tools::BarProof::Proved: return PlacementEditor::tr(" (where the run has laid it)");
    case tools::BarProof::None: break;
  }
  return PlacementEditor::tr(" (as proposed)");
}

}  // namespace

PlacementEditor::PlacementEditor(session::Session& session, views::SceneView& scene, views::SliceView& slice,
                                 QWidget* parent)
    : QWidget(parent), session_(session), scene_(scene), slice_(slice) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 8, 14, 8);
  column->setSpacing(4);
  auto* row = new QHBoxLayout;
  add_ = button("addHold", tr("Hold here…"), {}, tr("Then click on the liver: a block that is held fixed"));
  add_->setCheckable(true);
  row->addWidget(add_);
  edge_ = quantity("holdEdge", 2, 120, 2, 0, QStringLiteral("mm"), tr("Edge of the block that is held"));
  edge_->setValue(20.0);
  row->addWidget(edge_);
  remove_ = button("removeHold", tr("Remove"), {}, tr("Takes the chosen block away (Delete)"));
  row->addWidget(remove_);
  row->addSpacing(18);
  automatic_ = button("automaticBar", tr("Bar as proposed"), {},
                      tr("Back under the inferior right lobe, across the patient, hoisted towards anterior"));
  row->addWidget(automatic_);
  row->addStretch();
  column->addLayout(row);
  numbers_ = labelled({}, "faint");
  numbers_->setObjectName(QStringLiteral("placementNumbers"));
  column->addWidget(numbers_);
  connect(add_, &QPushButton::toggled, this, [this](bool on) { scene_.setPlacing(on); });
  connect(remove_, &QPushButton::clicked, this, &PlacementEditor::removeHold);
  connect(automatic_, &QPushButton::clicked, this, &PlacementEditor::automatic);
  connect(edge_, &QDoubleSpinBox::valueChanged, this, &PlacementEditor::resizeHold);
  connect(&session_.preview(), &session::ModelPreview::changed, this, [this] {
    if (active_) show();
  });
  connect(&session_.preview(), &session::ModelPreview::progressed, this, [this] {
    if (active_) scene_.setHint(session_.preview().words());
  });
  connect(&session_, &session::Session::loaded, this, [this] { slicePlaced_ = false; });
  connect(&session_, &session::Session::parametersChanged, this, [this] {
    if (active_ && isVisible()) session_.preview().want(), refresh();
  });
  connect(&session_, &session::Session::contoursChanged, this, [this] {
    if (active_ && isVisible()) session_.preview().want();
  });
  connect(&scene_, &views::SceneView::markChosen, this, [this](int id) {
    if (!active_) return;
    chosen_ = id;
    for (const views::Mark& mark : scene_.marks())
      if (mark.id == id) slice_.showPoint(mark.at_lps);
    refresh();
  });
  connect(&scene_, &views::SceneView::markMoved, this, &PlacementEditor::move);
  connect(&scene_, &views::SceneView::surfaceClicked, this, &PlacementEditor::addHold);
  const auto seen = [this](const Eigen::Vector3d& p) { return slice_.seenAt(p); };
  connect(&slice_, &views::SliceView::toolPressed, this, [this, seen](const tools::Pointer& at) {
    if (!active_ || !slice_.hasVolume()) return;
    if (add_->isChecked()) {
      addHold(slice_.plane().toLps(at.px));
      return;
    }
    const views::Mark* mark = views::markAt(slice_.marks(), seen, {at.px.x(), at.px.y()});
    held_ = mark && mark->movable ? mark->id : 0;
    heldMoved_ = false;
    if (held_) chosen_ = held_, refresh();
  });
  connect(&slice_, &views::SliceView::toolMoved, this, [this](const tools::Pointer& at) {
    if (!held_ || !active_) return;
    heldMoved_ = true;
    move(held_, slice_.plane().toLps(at.px), false);
  });
  connect(&slice_, &views::SliceView::toolReleased, this, [this](const tools::Pointer& at) {
    const int held = std::exchange(held_, 0);
    if (held && active_ && heldMoved_) move(held, slice_.plane().toLps(at.px), true);
  });
  connect(&slice_, &views::SliceView::keyDown, this, [this](QKeyEvent* event) {
    if (active_ && event->key() == Qt::Key_Delete) removeHold();
  });
}

void PlacementEditor::setActive(bool active) {
  const bool same = active_ == active;
  active_ = active;
  setVisible(active);
  if (!active) {
    add_->setChecked(false);
    moving_.reset();
    scene_.setMarks({});
    return;
  }
  session_.preview().want();
  if (!same) show();
}

void PlacementEditor::show() {
  const session::ModelPreview& preview = session_.preview();
  const auto model = preview.picture();
  scene_.setHint(preview.words());
  if (!model)
    scene_.setModel(nullptr);
  else if (!moving_)
    scene_.setModel(model);
  // The slice begins where the bar lies.
  if (const auto b = bar(); b && !std::exchange(slicePlaced_, true)) slice_.showPoint(b->contact_lps);
  refresh();
}

std::optional<tools::BarPlace> PlacementEditor::bar() const {
  const auto model = session_.preview().picture();
  if (!model || !model->bar) return {};
  tools::BarPlace b = *model->bar;
  const session::Placement& p = moving_ ? *moving_ : session_.parameters().placement;
  b.length_mm = moving_ ? length_mm_ : session_.parameters().retractorLength_mm;
  if (p.barAt_lps) b.contact_lps = *p.barAt_lps;
  b.direction = p.hoistDirection.normalized();
  // Where nothing was laid, geometry says how the bar lies.
  const Eigen::Vector3d axis = p.barAt_lps || p.barAxis != session::Placement{}.barAxis ? p.barAxis : b.axis;
  b.axis = (axis - axis.dot(b.direction) * b.direction).normalized();
  return b;
}

void PlacementEditor::refresh() {
  if (!active_) return;
  using Shape = views::Mark::Shape;
  std::vector<views::Mark> marks;
  QStringList words;
  const session::Placement& p = moving_ ? *moving_ : session_.parameters().placement;
  for (std::size_t n = 0; n < p.holds.size(); ++n) {
    views::Mark m{.id = firstHold + static_cast<int>(n), .at_lps = p.holds[n].centre_lps, .shape = Shape::Square};
    m.colour = holdColour;
    m.text = tr("held %1").arg(n + 1);
    m.movable = m.onSurface = true;
    marks.push_back(m);
  }
  if (const auto b = bar()) {
    const Eigen::Vector3d half = 0.5 * b->length_mm * b->axis;
    views::Mark end{.id = barEndA, .at_lps = b->contact_lps - half, .shape = Shape::Dot, .colour = barColour};
    end.movable = true;
    end.from_lps = b->contact_lps + half;
    marks.push_back(end);
    end.id = barEndB;
    end.at_lps = b->contact_lps + half;
    end.from_lps.reset();
    end.text = tr("%1 mm").arg(b->length_mm, 0, 'f', 0);
    marks.push_back(end);
    views::Mark up{.id = hoist, .at_lps = b->contact_lps + hoistArrow_mm * b->direction, .shape = Shape::Dot};
    up.colour = hoistColour;
    up.text = tr("hoist");
    up.from_lps = b->contact_lps;
    up.arrow = up.movable = true;
    marks.push_back(up);
    views::Mark at{.id = contact, .at_lps = b->contact_lps, .shape = Shape::Diamond, .colour = barColour};
    at.text = tr("bar");
    at.movable = at.onSurface = true;
    at.against = b->direction;
    marks.push_back(at);
    words << tr("Bar at %1%2, ∅ %3 mm, length %4 mm; hoisted along (%5, %6, %7).")
                 .arg(place(b->contact_lps), p.barAt_lps ? QString() : proposedBy(b->proof))
                 .arg(b->diameter_mm, 0, 'f', 1)
                 .arg(b->length_mm, 0, 'f', 0)
                 .arg(b->direction.x(), 0, 'f', 2)
                 .arg(b->direction.y(), 0, 'f', 2)
                 .arg(b->direction.z(), 0, 'f', 2);
  }
  for (std::size_t n = 0; n < p.holds.size(); ++n)
    words << tr("Held %1: block of %2 mm at %3.")
                 .arg(n + 1)
                 .arg(p.holds[n].edge_mm, 0, 'f', 0)
                 .arg(place(p.holds[n].centre_lps));
  const auto model = session_.preview().picture();
  if (model && !moving_) {
    if (!model->barProblem.empty()) words << QString::fromStdString(model->barProblem);
    for (const auto& support : model->supports)
      if (!support.problem.empty()) words << QString::fromStdString(support.problem);
  }
  for (views::Mark& mark : marks) mark.current = mark.id == chosen_;
  numbers_->setText(words.isEmpty() ? tr("Drag the handles in 3-D or on the slice. Each drag can be undone.")
                                    : words.join(QLatin1Char(' ')));
  const auto hold = static_cast<std::size_t>(std::max(chosen_ - firstHold, 0));
  const bool isHold = chosen_ >= firstHold && hold < p.holds.size();
  remove_->setEnabled(isHold);
  add_->setEnabled(model != nullptr);
  automatic_->setEnabled(model != nullptr);
  if (isHold) {
    const QSignalBlocker quiet(edge_);
    edge_->setValue(p.holds[hold].edge_mm);
  }
  scene_.setMarks(marks);
  slice_.setMarks(marks);
}

void PlacementEditor::move(int handle, const Eigen::Vector3d& at, bool ended) {
  const auto b = bar();
  if (!active_) return;
  if (!moving_) {
    moving_ = session_.parameters().placement;
    if (b && handle < firstHold && !moving_->barAt_lps) moving_->barAxis = b->axis;  // it stays as it is seen
    length_mm_ = session_.parameters().retractorLength_mm;
  }
  const auto model = session_.preview().picture();
  Eigen::Vector3d p_lps = at;
  QString what = tr("move what is held");
  if (handle >= firstHold) {
    const auto n = static_cast<std::size_t>(handle - firstHold);
    if (n < moving_->holds.size()) moving_->holds[n].centre_lps = p_lps;
  } else if (b && handle == contact) {
    // On a slice the mouse leaves the surface: the nearest place on it is meant.
    if (model)
      if (const auto on = tools::nearestVertex(model->liver, p_lps, b->direction)) p_lps = *on;
    moving_->barAt_lps = p_lps;
    what = tr("move the bar");
  } else if (b && (handle == barEndA || handle == barEndB)) {
    // The contact stays: with the axis or the hoist alone given, another place would be proposed.
    moving_->barAt_lps = b->contact_lps;
    Eigen::Vector3d d = p_lps - b->contact_lps;
    d -= d.dot(b->direction) * b->direction;
    if (d.norm() > 1.0) {
      moving_->barAxis = (handle == barEndA ? -d : d).normalized();
      length_mm_ = std::clamp(std::round(2.0 * d.norm()), session::leastBar_mm, session::mostBar_mm);
    }
    what = tr("turn the bar");
  } else if (b && handle == hoist) {
    moving_->barAt_lps = b->contact_lps;
    const Eigen::Vector3d d = (p_lps - b->contact_lps).normalized();
    if (d.allFinite() && d.cross(moving_->barAxis).norm() >= session::leastCross) moving_->hoistDirection = d;
    what = tr("turn the hoist");
  }
  if (ended) {
    const session::Placement after = *std::exchange(moving_, std::nullopt);
    session_.place(after, length_mm_, what);
    if (handle == contact && after.barAt_lps) slice_.showPoint(*after.barAt_lps);
  }
  refresh();
}

void PlacementEditor::addHold(const Eigen::Vector3d& p_lps) {
  if (!active_ || !add_->isChecked()) return;
  add_->setChecked(false);
  session::Placement after = session_.parameters().placement;
  after.holds.push_back({p_lps, edge_->value()});
  chosen_ = firstHold + static_cast<int>(after.holds.size()) - 1;
  session_.place(after, session_.parameters().retractorLength_mm, tr("hold the liver"));
  refresh();
}

void PlacementEditor::removeHold() {
  session::Placement after = session_.parameters().placement;
  const int n = chosen_ - firstHold;
  if (n < 0 || n >= static_cast<int>(after.holds.size())) return;
  after.holds.erase(after.holds.begin() + n);
  chosen_ = contact;
  session_.place(after, session_.parameters().retractorLength_mm, tr("release the liver"));
  refresh();
}

void PlacementEditor::automatic() {
  session::Placement after;
  after.holds = session_.parameters().placement.holds;
  session_.place(after, session_.parameters().retractorLength_mm, tr("bar as proposed"));
  refresh();
}

void PlacementEditor::resizeHold(double edge_mm) {
  session::Placement after = session_.parameters().placement;
  const int n = chosen_ - firstHold;
  if (n < 0 || n >= static_cast<int>(after.holds.size())) return;
  after.holds[static_cast<std::size_t>(n)].edge_mm = edge_mm;
  session_.place(after, session_.parameters().retractorLength_mm, tr("size of what is held"));
}

}  // namespace glisson::panels
