// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/model_stage.h"

#include <QComboBox>
#include <QHBoxLayout>

#include "panels/form.h"
#include "panels/theme.h"
#include "session/model_preview.h"
#include "session/session.h"
#include "views/scene_view.h"

namespace glisson::panels {

namespace {

/// What the numerics call the place of a support, as a reader would.
QString placeInWords(const std::string& name) {
  if (name == "box_mm") return ModelStage::tr("a block");
  if (name == "surface \"posterior\"") return ModelStage::tr("posterior surface");
  if (name == "surface \"superior\"") return ModelStage::tr("superior surface");
  return QString::fromStdString(name);
}

}  // namespace

ModelStage::ModelStage(session::Session& session, QWidget* parent)
    : QWidget(parent), session_(session), scene_(new views::SceneView) {
  scene_->setObjectName(QStringLiteral("modelView"));
  scene_->setAccessibleName(tr("The model in 3-D"));
  scene_->setMinimumHeight(180);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(scene_, 1);
  auto* bar = new QWidget;
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(14, 8, 14, 8);
  const auto part = [this, row](const char* name, const QString& text, const QString& tip) {
    auto* b = button(name, text, {}, tip);
    b->setCheckable(true);
    b->setChecked(true);
    connect(b, &QPushButton::toggled, this, &ModelStage::takeParts);
    row->addWidget(b);
    return b;
  };
  surface_ = part("showSurface", tr("Surface"), tr("The liver's surface"));
  stiffness_ = part("showStiffness", tr("Stiffness"), tr("Shear modulus of the cells below the surface, by colour"));
  vessels_ = part("showVessels", tr("Vessels"), tr("Hepatic vessels found in the MRI"));
  sites_ = part("showSites", tr("Sites"), tr("Nodes of the cells, or mesh-free sites: where the model moves"));
  {
    const QSignalBlocker quiet(sites_);
    sites_->setChecked(false);  // thousands of dots hide what lies below them
  }
  supports_ = part("showSupports", tr("Supports"), tr("What holds the liver: springs and fixed blocks"));
  bar_ = part("showBar", tr("Retractor"), tr("The bar and the direction of its hoist"));
  row->addStretch();
  scale_ = new QComboBox;
  scale_->setObjectName(QStringLiteral("modelScale"));
  scale_->setAccessibleName(tr("Colour scale of the stiffness"));
  scale_->addItem(tr("0–8 kPa"), 8.0);
  scale_->addItem(tr("0–20 kPa"), 20.0);
  connect(scale_, &QComboBox::currentIndexChanged, this, &ModelStage::takeParts);
  row->addWidget(scale_);
  column->addWidget(bar);
  words_ = labelled({}, "faint");
  words_->setObjectName(QStringLiteral("modelWords"));
  words_->setContentsMargins(14, 0, 14, 8);
  column->addWidget(words_);
  connect(&session_.preview(), &session::ModelPreview::changed, this, &ModelStage::show_);
  connect(&session_.preview(), &session::ModelPreview::progressed, this,
          [this] { scene_->setHint(session_.preview().words()); });
  const auto again = [this] {
    if (isVisible()) session_.preview().want();
  };
  connect(&session_, &session::Session::parametersChanged, this, again);
  connect(&session_, &session::Session::contoursChanged, this, again);
  connect(&session_, &session::Session::loaded, this, again);
  show_();
}

void ModelStage::showEvent(QShowEvent*) {
  session_.preview().want();
  show_();
}

void ModelStage::takeParts() {
  views::ModelParts parts;
  parts.surface = surface_->isChecked();
  parts.stiffness = stiffness_->isChecked();
  parts.vessels = vessels_->isChecked();
  parts.sites = sites_->isChecked();
  parts.supports = supports_->isChecked();
  parts.bar = bar_->isChecked();
  parts.most_kPa = scale_->currentData().toDouble();
  stiffness_->setEnabled(parts.surface);
  scene_->setParts(parts);
  show_();
}

void ModelStage::show_() {
  const session::ModelPreview& preview = session_.preview();
  const auto model = preview.picture();
  scene_->setHint(preview.words());
  scene_->setModel(model);
  if (!model) {
    words_->clear();
    return;
  }
  std::vector<views::Mark> marks;
  if (model->bar && bar_->isChecked()) {
    views::Mark up{.id = 1, .at_lps = model->bar->contact_lps + 60.0 * model->bar->direction};
    up.colour = hoistColour;
    up.text = tr("hoist");
    up.from_lps = model->bar->contact_lps;
    up.arrow = true;
    marks.push_back(up);
  }
  int number = 0;
  for (const auto& support : model->supports) {
    if (!supports_->isChecked() || support.points_lps.cols() == 0) continue;
    if (!support.fixed) continue;
    views::Mark held{.id = 100 + number,
                     .at_lps = support.points_lps.rowwise().mean(),
                     .shape = views::Mark::Shape::Square,
                     .colour = holdColour};
    held.text = tr("held %1").arg(++number);
    marks.push_back(held);
  }
  scene_->setMarks(marks);
  QStringList words;
  words << tr("Shear modulus of the cells: mean %1, from %2 to %3 kPa.")
               .arg(model->mean_kPa, 0, 'f', 2)
               .arg(model->least_kPa, 0, 'f', 2)
               .arg(model->most_kPa, 0, 'f', 2);
  const auto shown = static_cast<qlonglong>(model->sites_lps.cols());
  const QString sites = model->meshfree ? tr("%1 mesh-free sites").arg(static_cast<qlonglong>(model->sites))
                                        : tr("%1 nodes of cells").arg(static_cast<qlonglong>(model->sites));
  if (!sites_->isChecked())
    words << sites + QLatin1Char('.');
  else
    words << (shown == model->sites ? sites + tr(", all shown.") : sites + tr(", %1 of them shown.").arg(shown));
  if (model->vessels.triangles.cols() == 0) words << tr("No vessels were found in the MRI.");
  QStringList fixed, springs, problems;
  for (const auto& support : model->supports)
    if (!support.problem.empty())
      problems << sentence(support.problem);
    else
      (support.fixed ? fixed : springs) << placeInWords(support.name);
  if (!fixed.isEmpty()) words << tr("Fixed (orange): %1.").arg(fixed.join(QStringLiteral(", ")));
  if (!springs.isEmpty()) words << tr("Springs (turquoise): %1.").arg(springs.join(QStringLiteral(", ")));
  words << problems;
  if (!model->barProblem.empty()) words << sentence(model->barProblem);
  words_->setText(words.join(QLatin1Char(' ')));
}

}  // namespace glisson::panels
