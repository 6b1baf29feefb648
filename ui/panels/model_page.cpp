// SPDX-License-Identifier: GPL-3.0-or-later
#include "panels/model_page.h"

#include <QAbstractItemView>
#include <QCheckBox>
#include <QComboBox>
#include <QHeaderView>
#include <QSpinBox>
#include <QSplitter>
#include <QStandardItemModel>
#include <QTreeWidget>

#include "panels/form.h"
#include "panels/model_stage.h"
#include "pipeline/plan.h"
#include "session/said.h"
#include "session/session.h"
#include "session/setup_of.h"

namespace glisson::panels {

namespace {

constexpr double leastCell_mm = 1.0;

QComboBox* choice(const char* objectName, const QString& tip) {
  auto* box = new QComboBox;
  box->setObjectName(QString::fromLatin1(objectName));
  box->setToolTip(tip);
  // Not as wide as the longest choice: what the choice is for must be read too.
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box->setMinimumContentsLength(12);
  box->view()->setTextElideMode(Qt::ElideNone);
  return box;
}

}  // namespace

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
  auto* both = new QSplitter(Qt::Vertical);
  both->setHandleWidth(3);
  both->setChildrenCollapsible(false);
  both->addWidget(new ModelStage(session_));
  both->addWidget(centre);
  both->setStretchFactor(0, 3);
  both->setStretchFactor(1, 2);
  row->addWidget(both, 1);
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
  auto* frame = new SidePanel;
  QVBoxLayout* side = frame->column();
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
  register_ = new QCheckBox(tr("Lay elastogram over MRI"));
  register_->setObjectName(QStringLiteral("registerRigidly"));
  register_->setToolTip(tr(
      "The elastogram is of another breath-hold: moved rigidly until the magnitude images agree, before it is read"));
  material->addRow(register_);
  side->addLayout(material);
  side->addSpacing(8);
  side->addWidget(section(tr("Discretisation")));
  mesh_ = new QFormLayout;
  method_ = choice("modelKind", tr("How the liver is divided; Compare shows error against run time of each"));
  const auto offer = [this](session::Method method, const QString& text, const QString& tip) {
    method_->addItem(text, QString::fromStdString(nameIn(session::methodNames, method)));
    method_->setItemData(method_->count() - 1, tip, Qt::ToolTipRole);
  };
  using session::Method;
  offer(Method::HexIncompatible, tr("Voxel FEM, incompatible modes"),
        tr("Hexahedra that bend without locking: the default"));
  offer(Method::HexBBar, tr("Voxel FEM, B-bar"), tr("Hexahedra that do not lock where nearly incompressible"));
  offer(Method::Hex, tr("Voxel FEM, trilinear"), tr("The plain hexahedron; too stiff in bending"));
  offer(Method::TetQuadratic, tr("Tetrahedra, quadratic"), tr("Six ten-node tetrahedra per voxel"));
  offer(Method::TetLinear, tr("Tetrahedra, linear"), tr("Six four-node tetrahedra per voxel; too stiff"));
  offer(Method::DelaunayQuadratic, tr("Delaunay, quadratic"), tr("Ten-node tetrahedra that follow the smooth surface"));
  offer(Method::DelaunayLinear, tr("Delaunay, linear"), tr("Four-node tetrahedra that follow the smooth surface"));
  offer(Method::WendlandAffine, tr("Mesh-free, Wendland"), tr("Frames with affine motion, Wendland kernel"));
  offer(Method::WendlandQuadratic, tr("Mesh-free, Wendland quadratic"), tr("Frames with quadratic motion"));
  offer(Method::Voronoi, tr("Mesh-free, Voronoi"), tr("Frames with affine motion, Voronoi kernel as published"));
  offer(Method::MovingLeastSquares, tr("Mesh-free, moving least squares"),
        tr("Element-free Galerkin: three degrees of freedom per site"));
  method_->setAccessibleName(tr("Method"));
  mesh_->addRow(method_);  // the whole width: names are long
  cell_ = quantity("cellSize", 0, 20, 0.5, 2, QStringLiteral("mm"),
                   tr("Edge of a voxel cell: smaller is more exact and slower. 0 = twice the pixel of the MRI"));
  cell_->setSpecialValueText(tr("automatic"));
  mesh_->addRow(tr("Cell"), cell_);
  frames_ = new QSpinBox;
  frames_->setObjectName(QStringLiteral("frames"));
  frames_->setButtonSymbols(QAbstractSpinBox::NoButtons);
  frames_->setRange(4, 5000);
  frames_->setToolTip(tr("Number of mesh-free sites"));
  mesh_->addRow(tr("Sites"), frames_);
  tetEdge_ = quantity("tetEdge", 2, 50, 1, 1, QStringLiteral("mm"), tr("Edge of the tetrahedra"));
  mesh_->addRow(tr("Edge"), tetEdge_);
  tetToolEdge_ = quantity("tetToolEdge", 1, 50, 0.5, 1, QStringLiteral("mm"),
                          tr("Edge of the tetrahedra near the retractor, at most that of the others"));
  mesh_->addRow(tr("At the tool"), tetToolEdge_);
  side->addLayout(mesh_);
  side->addSpacing(8);
  side->addWidget(section(tr("Equations")));
  solution_ = new QFormLayout;
  kinematics_ =
      choice("kinematics", tr("How strain follows from displacement; other than linear for voxel FEM at rest"));
  kinematics_->addItems({tr("Linear"), tr("Corotational"), tr("Hyperelastic"), tr("Automatic")});
  solution_->addRow(tr("Deformation"), kinematics_);
  motion_ = choice("analysis", tr("One solve for the new rest, or time steps towards it"));
  motion_->addItems({tr("At rest"), tr("Time steps")});
  solution_->addRow(tr("Analysis"), motion_);
  step_ = quantity("timeStep", 0.01, 1000, 0.5, 2, QStringLiteral("ms"), tr("Length of an implicit time step"));
  solution_->addRow(tr("Step"), step_);
  end_ = quantity("endTime", 0.01, 100, 0.5, 2, QStringLiteral("s"), tr("Stops before where nothing moves any more"));
  solution_->addRow(tr("Until"), end_);
  addSolver();
  side->addLayout(solution_);
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
  for (QDoubleSpinBox* box : {poisson_, density_, cell_, atlas_, tetEdge_, tetToolEdge_, step_, end_})
    connect(box, &QDoubleSpinBox::valueChanged, this, &ModelPage::take);
  connect(frames_, &QSpinBox::valueChanged, this, &ModelPage::take);
  for (QComboBox* box : {method_, kinematics_, motion_, solver_, stiffness_})
    connect(box, &QComboBox::currentIndexChanged, this, &ModelPage::take);
  for (QCheckBox* box : {register_, howSure_}) connect(box, &QCheckBox::toggled, this, &ModelPage::take);
  return frame;
}

void ModelPage::addSolver() {
  solver_ = choice("solver", tr("Who solves the equations; automatic takes the fastest for the size"));
  solver_->addItems({tr("Automatic"), tr("Conjugate gradients"), tr("Multigrid"), tr("Factorised"), tr("Condensed")});
  solution_->addRow(tr("Solver"), solver_);
  howSure_ = new QCheckBox(tr("Say how sure"));
  howSure_->setObjectName(QStringLiteral("howSure"));
  howSure_->setToolTip(
      tr("Intervals, the chance of 5 mm and what drives them, under a rigid bar; takes about four times as long"));
  solution_->addRow(QString(), howSure_);
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
  p.useMre = stiffness_->currentIndex() == 0;
  p.registerRigidly = register_->isChecked();
  p.howSure = howSure_->isChecked();
  p.method = session::named(session::methodNames, method_->currentData().toString().toStdString(), "model");
  p.tetEdge_mm = tetEdge_->value();
  p.tetToolEdge_mm = std::min(tetToolEdge_->value(), p.tetEdge_mm);
  p.kinematics = session::kinematicsNames[static_cast<std::size_t>(kinematics_->currentIndex())].first;
  p.dynamic = motion_->currentIndex() == 1;
  p.step_ms = step_->value();
  p.end_s = end_->value();
  p.solver = session::solverNames[static_cast<std::size_t>(solver_->currentIndex())].first;
  // What the method does not offer goes back to what it does: the controls show it.
  if (!session::isHex(p.method) && !session::mayBeLinear(p.kinematics)) p.kinematics = retraction::Kinematics::Auto;
  const bool linear = session::mayBeLinear(p.kinematics);
  if (!linear || (!session::isHex(p.method) && !session::isMeshfree(p.method))) p.dynamic = false;
  if (p.solver == session::Solver::Condensed && (!session::isHex(p.method) || !linear))
    p.solver = session::Solver::Auto;
  session_.setParameters(p);
  show_();
}

void ModelPage::show_() {
  filling_ = true;
  const session::Parameters& p = session_.parameters();
  poisson_->setValue(p.poisson);
  density_->setValue(p.density_kg_m3);
  cell_->setValue(p.cell_mm);
  atlas_->setValue(p.atlasShear_kPa);
  frames_->setValue(p.frames);
  tetEdge_->setValue(p.tetEdge_mm);
  tetToolEdge_->setValue(p.tetToolEdge_mm);
  step_->setValue(p.step_ms);
  end_->setValue(p.end_s);
  method_->setCurrentIndex(method_->findData(QString::fromStdString(nameIn(session::methodNames, p.method))));
  kinematics_->setCurrentIndex(static_cast<int>(p.kinematics));
  motion_->setCurrentIndex(p.dynamic ? 1 : 0);
  solver_->setCurrentIndex(static_cast<int>(p.solver));
  stiffness_->setCurrentIndex(p.useMre ? 0 : 1);
  register_->setChecked(p.registerRigidly);
  howSure_->setChecked(p.howSure);
  showWhatFits();
  filling_ = false;
}

void ModelPage::showWhatFits() {
  const session::Parameters& p = session_.parameters();
  const bool hex = session::isHex(p.method), frames = session::isMeshfree(p.method);
  const bool delaunay = session::isDelaunay(p.method), linear = session::mayBeLinear(p.kinematics);
  mesh_->setRowVisible(frames_, frames);
  mesh_->setRowVisible(tetEdge_, delaunay);
  mesh_->setRowVisible(tetToolEdge_, delaunay);
  solution_->setRowVisible(step_, p.dynamic);
  solution_->setRowVisible(end_, p.dynamic);
  kinematics_->setEnabled(hex);
  motion_->setEnabled(linear && (hex || frames));
  auto* offers = qobject_cast<QStandardItemModel*>(solver_->model());
  offers->item(static_cast<int>(session::Solver::Condensed))->setEnabled(hex && linear);
  register_->setEnabled(p.useMre);
  howSure_->setEnabled(p.contact == retraction::ContactKind::Rigid && !session::rigidRefusal(p));
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
    auto* item =
        new QTreeWidgetItem(plan_, {session::stepInWords(QString::fromStdString(s.step)),
                                    s.needed ? tr("yes") : tr("left out"), time, QString::fromStdString(s.why)});
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
