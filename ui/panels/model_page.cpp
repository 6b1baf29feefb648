#include "panels/model_page.h"

#include <QComboBox>
#include <QHeaderView>
#include <QSpinBox>
#include <QTreeWidget>

#include "panels/form.h"
#include "pipeline/plan.h"
#include "session/session.h"

namespace glisson::panels {

namespace {
constexpr double leastCell_mm = 1.0;
}

ModelPage::ModelPage(session::Session& session, QWidget* parent) : QWidget(parent), session_(session) {
  auto* centre = new QWidget;
  auto* layout = new QVBoxLayout(centre);
  layout->setContentsMargins(24, 20, 24, 20);
  layout->setSpacing(10);
  layout->addWidget(labelled(tr("Plan"), "heading"));
  layout->addWidget(
      labelled(tr("What this case needs, what it leaves out, and why. Times are predicted before a run and "
                  "measured after it."),
               "faint"));
  plan_ = new QTreeWidget;
  plan_->setObjectName(QStringLiteral("planTable"));
  plan_->setHeaderLabels({tr("Step"), tr("Needed"), tr("Time"), tr("Why")});
  plan_->setRootIsDecorated(false);
  plan_->setAlternatingRowColors(true);
  plan_->setSelectionMode(QAbstractItemView::NoSelection);
  for (int c = 0; c < 3; ++c) plan_->header()->setSectionResizeMode(c, QHeaderView::ResizeToContents);
  layout->addWidget(plan_, 1);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  row->addWidget(centre, 1);
  row->addWidget(makeSide());
  connect(&session_, &session::Session::parametersChanged, this, [this] {
    show_();
    showPlan();
  });
  connect(&session_, &session::Session::loaded, this, [this] {
    if (!session_.images().mri) return;
    const Eigen::Vector3d& s = session_.images().mri->grid.spacing_mm;
    cell_->setSpecialValueText(tr("automatic (%1 mm)").arg(2.0 * std::min(s.x(), s.y()), 0, 'f', 2));
  });
  connect(&session_, &session::Session::contoursChanged, this, [this] {
    if (isVisible()) showPlan();
  });
  connect(&session_, &session::Session::runFinished, this, [this] {
    showPlan();
    showNumbers();
  });
  connect(&session_, &session::Session::statusChanged, this, &ModelPage::showNumbers);
  show_();
}

QWidget* ModelPage::makeSide() {
  QVBoxLayout* side = nullptr;
  QFrame* frame = sidePanel(side);
  side->addWidget(labelled(tr("Model"), "heading"));
  side->addWidget(section(tr("Material")));
  auto* material = new QFormLayout;
  stiffness_ = new QComboBox;
  stiffness_->setObjectName(QStringLiteral("stiffnessSource"));
  stiffness_->addItems({tr("MR elastogram"), tr("Atlas")});
  material->addRow(tr("Stiffness"), stiffness_);
  atlas_ = quantity("atlasShear", 0.1, 50, 0.1, 2, tr("kPa (µ)"),
                    tr("Shear modulus of the atlas model; healthy donors: 2.1 kPa"));
  material->addRow(tr("Atlas"), atlas_);
  poisson_ = quantity("poisson", -0.99, 0.4999, 0.01, 4, {}, tr("Poisson's ratio ν; 0.5 would be incompressible"));
  material->addRow(tr("Poisson's ratio ν"), poisson_);
  density_ = quantity("density", 1, 20000, 10, 0, QStringLiteral("kg/m³"), tr("Mass density of the liver"));
  material->addRow(tr("Density"), density_);
  side->addLayout(material);
  side->addSpacing(8);
  side->addWidget(section(tr("Discretisation")));
  auto* mesh = new QFormLayout;
  kind_ = new QComboBox;
  kind_->setObjectName(QStringLiteral("modelKind"));
  kind_->addItem(tr("Voxel FEM (hexahedra)"), static_cast<int>(retraction::ModelKind::FemHex));
  kind_->addItem(tr("Mesh-free (Voronoi sites)"), static_cast<int>(retraction::ModelKind::Meshfree));
  mesh->addRow(tr("Method"), kind_);
  cell_ = quantity("cellSize", 0, 20, 0.5, 2, QStringLiteral("mm"),
                   tr("Edge of a voxel cell: smaller is more exact and slower. 0 = twice the pixel of the MRI"));
  cell_->setSpecialValueText(tr("automatic"));
  mesh->addRow(tr("Cell"), cell_);
  frames_ = new QSpinBox;
  frames_->setObjectName(QStringLiteral("frames"));
  frames_->setButtonSymbols(QAbstractSpinBox::NoButtons);
  frames_->setRange(4, 5000);
  frames_->setToolTip(tr("Number of mesh-free sites"));
  mesh->addRow(tr("Sites"), frames_);
  side->addLayout(mesh);
  side->addSpacing(8);
  side->addWidget(section(tr("Liver")));
  numbers_ = labelled({}, "faint");
  numbers_->setObjectName(QStringLiteral("modelNumbers"));
  side->addWidget(numbers_);
  side->addStretch();
  auto* run = button("modelRunButton", tr("Run"), QStringLiteral("run"), tr("Build, retract and compare (Ctrl+R)"));
  run->setProperty("primary", true);
  side->addWidget(run);
  connect(run, &QPushButton::clicked, this, &ModelPage::runWanted);
  for (QDoubleSpinBox* box : {poisson_, density_, cell_, atlas_})
    connect(box, &QDoubleSpinBox::valueChanged, this, &ModelPage::take);
  connect(frames_, &QSpinBox::valueChanged, this, &ModelPage::take);
  connect(kind_, &QComboBox::currentIndexChanged, this, &ModelPage::take);
  connect(stiffness_, &QComboBox::currentIndexChanged, this, &ModelPage::take);
  return frame;
}

void ModelPage::take() {
  if (filling_) return;
  session::Parameters p = session_.parameters();
  p.poisson = poisson_->value();
  p.density_kg_m3 = density_->value();
  // Below a millimetre there is nothing but "automatic".
  p.cell_mm = cell_->value() >= leastCell_mm ? cell_->value()
              : p.cell_mm >= leastCell_mm    ? 0.0
              : cell_->value() > 0.0         ? leastCell_mm
                                             : 0.0;
  p.atlasShear_kPa = atlas_->value();
  p.frames = frames_->value();
  p.model = static_cast<retraction::ModelKind>(kind_->currentData().toInt());
  p.useMre = stiffness_->currentIndex() == 0;
  session_.setParameters(p);
}

void ModelPage::show_() {
  filling_ = true;
  const session::Parameters& p = session_.parameters();
  poisson_->setValue(p.poisson);
  density_->setValue(p.density_kg_m3);
  cell_->setValue(p.cell_mm);
  atlas_->setValue(p.atlasShear_kPa);
  frames_->setValue(p.frames);
  frames_->setEnabled(p.model == retraction::ModelKind::Meshfree);
  kind_->setCurrentIndex(kind_->findData(static_cast<int>(p.model)));
  stiffness_->setCurrentIndex(p.useMre ? 0 : 1);
  filling_ = false;
}

void ModelPage::showEvent(QShowEvent*) {
  showPlan();
  showNumbers();
}

void ModelPage::showPlan() {
  plan_->clear();
  if (!session_.images().mri) return;
  const auto result = session_.result();
  const bool measured = result && !session_.resultIsStale();
  std::vector<pipeline::PlanStep> steps;
  try {
    steps = measured ? result->plan : pipeline::plan(session_.scene(session_.runFolder().toStdString()));
  } catch (const std::exception& e) {
    new QTreeWidgetItem(plan_, {tr("no plan"), {}, {}, QString::fromUtf8(e.what())});
    return;
  }
  for (const pipeline::PlanStep& s : steps) {
    const QString time = !s.needed ? QString()
                                   : tr("%1%2 s")
                                         .arg(measured ? QString() : QStringLiteral("≈ "))
                                         .arg(s.seconds, 0, 'f', s.seconds < 1 ? 2 : 1);
    auto* item = new QTreeWidgetItem(plan_, {QString::fromStdString(s.step), s.needed ? tr("yes") : tr("left out"),
                                             time, QString::fromStdString(s.why)});
    item->setToolTip(3, item->text(3));
    if (!s.needed)
      for (int c = 0; c < 4; ++c) item->setForeground(c, palette().color(QPalette::PlaceholderText));
  }
}

void ModelPage::showNumbers() {
  if (const auto result = session_.result()) {
    const retraction::Model& m = result->model;
    QString text = tr("%1 cells, %2 mL, %3 kg")
                       .arg(static_cast<qulonglong>(m.cells))
                       .arg(m.volume_mL, 0, 'f', 0)
                       .arg(m.mass_kg, 0, 'f', 2);
    if (session_.resultIsStale()) text += tr("\n(of the last run; something has changed since)");
    numbers_->setText(text);
  } else {
    numbers_->setText(session_.acceptedCount() == 0 ? tr("Outline the liver first (step Segment).")
                                                    : tr("Known after the first run."));
  }
}

}  // namespace glisson::panels
