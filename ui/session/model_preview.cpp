// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model_preview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "anatomy/regions.h"
#include "anatomy/surface.h"
#include "anatomy/vessels.h"
#include "base/error.h"
#include "base/quantity.h"
#include "image/io.h"
#include "mechanics/contact/rigid_bar.h"
#include "mechanics/kernel.h"
#include "mechanics/sites.h"
#include "pipeline/inputs.h"
#include "pipeline/models.h"
#include "retraction/body.h"
#include "retraction/rigid_contact.h"
#include "roi/contour_io.h"
#include "session/session.h"

namespace glisson::session {

namespace {

constexpr int delay_ms = 250;
constexpr Eigen::Index mostSites = 20000;  // that are shown

image::Mask cellsOf(const retraction::Model& model) {
  image::Mask cells(model.youngs_kPa.grid);
  for (std::size_t i = 0; i < cells.values.size(); ++i) cells.values[i] = model.youngs_kPa.values[i] > 0.0F ? 1 : 0;
  return cells;
}

/// The modulus of the cell at a point, or of the nearest one within two cells: the surface is smooth and leaves the
/// cells by a part of one.
float youngsAt(const image::ScalarVolume& E, const Eigen::Vector3d& p_lps) {
  const Eigen::Vector3d at = E.grid.lpsToIndex(p_lps);
  const Eigen::Vector3i c = at.array().round().cast<int>();
  float value = 0.0F;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = -2; k <= 2; ++k)
    for (int j = -2; j <= 2; ++j)
      for (int i = -2; i <= 2; ++i) {
        const Eigen::Vector3i n = c + Eigen::Vector3i(i, j, k);
        if (!E.grid.contains(n) || !(E.at(n) > 0.0F)) continue;
        const double d = (n.cast<double>() - at).cwiseProduct(E.grid.spacing_mm).squaredNorm();
        if (d < nearest) {
          nearest = d;
          value = E.at(n);
        }
      }
  return value;
}

/// Every n-th, so that at most `most` are left.
Eigen::Matrix3Xd thinned(const std::vector<Eigen::Vector3d>& points, Eigen::Index most) {
  const auto count = static_cast<Eigen::Index>(points.size());
  const Eigen::Index step = std::max<Eigen::Index>(1, (count + most - 1) / most);
  Eigen::Matrix3Xd kept(3, (count + step - 1) / step);
  for (Eigen::Index n = 0; n < kept.cols(); ++n) kept.col(n) = points[static_cast<std::size_t>(n * step)];
  return kept;
}

}  // namespace

/// What does not depend on how the liver is held and lifted.
struct ModelPreview::Body {
  std::string key;
  retraction::Model model;
  image::Mask cells;
  mechanics::TriangleSurface smooth;                   ///< of the model's smooth body
  std::shared_ptr<const tools::ModelPicture> picture;  ///< without supports and bar
};

ModelPreview::ModelPreview(Session& session) : QObject(&session), session_(session) {
  delay_.setSingleShot(true);
  delay_.setInterval(delay_ms);
  connect(&delay_, &QTimer::timeout, this, &ModelPreview::start);
  // A run tells where it has laid the bar.
  connect(&session_, &Session::runFinished, this, [this] { made_.reset(); });
  connect(&worker_, &Worker::progressed, this, [this](double fraction, const QString&, double secondsLeft) {
    progress_ = tr(" %1 %").arg(qRound(100.0 * fraction)) + timeLeft(secondsLeft);
    emit progressed();
  });
}

QString ModelPreview::words() const {
  return problem_.isEmpty() ? tr("Building the model…") + progress_ : problem_;
}

ModelPreview::~ModelPreview() = default;

void ModelPreview::want() {
  if (session_.revision() == made_ && (picture_ || !problem_.isEmpty())) return;
  if (!worker_.busy()) delay_.start();
}

namespace {

/// The scene with its images and outlines where they can be read.
pipeline::Scene readable(const CaseFiles& files, const std::filesystem::path& folder) {
  pipeline::Scene scene = files.scene;
  scene.geometry.mri = files.images.mriSource;
  if (scene.geometry.mri.empty()) {
    scene.geometry.mri = folder / "mri.nrrd";
    image::writeVolume(scene.geometry.mri, *files.images.mri);
  }
  if (files.images.stiffness) scene.geometry.mre = files.images.mreSource;
  if (scene.material.kind == pipeline::MaterialSpec::Kind::Mre && scene.geometry.mre.empty())
    scene.material.kind = pipeline::MaterialSpec::Kind::Atlas;
  roi::writeContours(folder / "contours.json", files.contours);
  return scene;
}

std::shared_ptr<const tools::ModelPicture> bodyPicture(const pipeline::Scene& scene, const retraction::Model& model,
                                                       const image::Mask& cells, const pipeline::Inputs& inputs,
                                                       const Progress& progress) {
  auto p = std::make_shared<tools::ModelPicture>();
  p->liver = anatomy::liverSurface(cells);
  p->fromMre = scene.material.kind == pipeline::MaterialSpec::Kind::Mre;
  const auto toShear = [&model](float E) {
    return static_cast<float>(glisson::toShear(YoungsModulus::fromKPa(static_cast<double>(E)), model.poisson).kPa());
  };
  p->shear_kPa.resize(p->liver.vertices_lps_mm.cols());
  for (Eigen::Index n = 0; n < p->shear_kPa.size(); ++n)
    p->shear_kPa[n] = toShear(youngsAt(model.youngs_kPa, p->liver.vertices_lps_mm.col(n)));
  p->least_kPa = std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const float E : model.youngs_kPa.values) {
    if (!(E > 0.0F)) continue;
    const auto shear = static_cast<double>(toShear(E));
    p->least_kPa = std::min(p->least_kPa, shear);
    p->most_kPa = std::max(p->most_kPa, shear);
    sum += shear;
  }
  p->mean_kPa = sum / static_cast<double>(model.cells);
  progress.report(0.4, "sites");
  const retraction::Body body(model);
  std::vector<Eigen::Vector3d> sites;
  p->meshfree = scene.setup.model.kind == retraction::ModelKind::Meshfree;
  if (p->meshfree) {
    const mechanics::MeshfreeOptions& m = scene.setup.model.meshfree;
    mechanics::SiteOptions options;
    options.count = m.frames;
    options.iterations = m.lloydIterations;
    options.seed = m.seed;
    options.minimumNodes = mechanics::leastNodesOf(m.kernel, m.order);
    const mechanics::Sites placed = mechanics::placeSites(body.mesh(), options);
    for (int n = 0; n < placed.count(); ++n) sites.push_back(body.toLps_mm(placed.position_m.col(n)));
  } else {
    for (int n = 0; n < body.mesh().nodeCount(); ++n) sites.push_back(body.nodePosition_mm(n));
  }
  p->sites = static_cast<long long>(sites.size());
  p->sites_lps = thinned(sites, mostSites);
  if (inputs.mri && inputs.liver)
    p->vessels = anatomy::findVessels(*inputs.mri, *inputs.liver, progress.part(0.5, 1.0)).surface;
  return p;
}

/// Where a rigid bar lies at first touch: as laid by hand, or the first place that geometry offers. Throws BadInput.
tools::BarPlace rigidPlace(const retraction::Retractor& bar, const retraction::Model& model,
                           const mechanics::TriangleSurface& smooth) {
  const retraction::Pose pose = bar.at_mm ? retraction::poseAt(smooth, bar, *bar.at_mm)
                                          : retraction::poseCandidates(*model.smooth, smooth, bar).front();
  tools::BarPlace at;
  at.direction = pose.hoist;
  at.axis = pose.axis;
  at.contact_lps = pose.centre_mm + 0.5 * bar.diameter_mm * pose.hoist;
  at.proof = bar.at_mm ? tools::BarProof::None : tools::BarProof::ByTheRun;
  return at;
}

/// Where the load of a patch lies. Throws BadInput.
tools::BarPlace patchPlace(const retraction::Retractor& bar, const retraction::Body& body, const image::Mask& cells) {
  tools::BarPlace at;
  at.direction = bar.direction.normalized();
  const Eigen::Vector3d axis = bar.patchAxis();
  at.axis = (axis - axis.dot(at.direction) * at.direction).normalized();
  at.contact_lps =
      bar.at_mm ? *bar.at_mm : retraction::findHoistPoint(body, bar, anatomy::inferiorRightLobePoint(cells));
  return at;
}

/// The centre line of a hook at first touch, as the run bends it: to the side that its grid's axes make of the hoist
/// and the bar's axis. mm throughout.
std::vector<Eigen::Vector3d> hookLine(const tools::BarPlace& at, const image::Grid& grid,
                                      const mechanics::TriangleSurface& liver) {
  constexpr double reach_mm = 30.0, near_mm = 0.05;  // it touches elsewhere than a straight bar, along the hoist
  const double side = grid.direction.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d centre = at.contact_lps - 0.5 * at.diameter_mm * at.direction;
  mechanics::RigidBar bar =
      mechanics::hook(centre, at.axis, side * at.direction.cross(at.axis), at.length_mm, 0.5 * std::numbers::pi);
  bar.radius_m = 0.5 * at.diameter_mm;
  bar.hoist = at.direction;
  const auto free = [&](double travel_mm) {
    return std::all_of(liver.vertices.begin(), liver.vertices.end(),
                       [&](const Eigen::Vector3d& p) { return mechanics::gapTo(bar, p, travel_mm).g_m >= 0.0; });
  };
  double low_mm = -reach_mm, high_mm = reach_mm;
  if (free(low_mm) && !free(high_mm)) {
    while (high_mm - low_mm > near_mm) {
      const double middle_mm = 0.5 * (low_mm + high_mm);
      (free(middle_mm) ? low_mm : high_mm) = middle_mm;
    }
    bar.shift(low_mm * at.direction);
  }
  return bar.centreline_m;
}

/// The bar of a scene; where it cannot lie at the point given it is shown there, with the reason.
void placeBar(const pipeline::Scene& scene, const retraction::Model& model, const mechanics::TriangleSurface& smooth,
              const retraction::Body& body, const image::Mask& cells,
              const std::optional<retraction::PlacedBar>& proved, tools::ModelPicture& picture) {
  for (const retraction::LoadSpec& load : scene.setup.loads) {
    const auto* bar = std::get_if<retraction::Retractor>(&load);
    if (!bar) continue;
    const bool rigid = retraction::rigidBarOf(scene.setup).has_value() && model.smooth;
    try {
      picture.bar = rigid ? rigidPlace(*bar, model, smooth) : patchPlace(*bar, body, cells);
      if (!rigid) retraction::findContact(body, *bar, picture.bar->contact_lps);
    } catch (const BadInput& e) {
      picture.barProblem = e.what();
      if (bar->at_mm) picture.bar = patchPlace(*bar, body, cells);
    }
    if (!picture.bar) continue;
    if (rigid && !bar->at_mm && proved && proved->pose) {
      picture.bar->axis = proved->pose->axis;
      picture.bar->contact_lps = proved->pose->centre_mm + 0.5 * bar->diameter_mm * proved->pose->hoist;
      picture.bar->proof = tools::BarProof::Proved;
    }
    picture.bar->diameter_mm = bar->diameter_mm;
    picture.bar->length_mm = bar->length_mm;
    picture.bar->rigid = rigid;
    if (rigid && bar->shape == retraction::BarShape::Hook)
      picture.bar->line_lps = hookLine(*picture.bar, model.youngs_kPa.grid, smooth);
  }
}

/// What holds the liver and where the bar lies on it.
void place(const pipeline::Scene& scene, const retraction::Model& model, const mechanics::TriangleSurface& smooth,
           const image::Mask& cells, const std::optional<retraction::PlacedBar>& proved, tools::ModelPicture& picture) {
  const retraction::Body body(model);
  for (const retraction::SupportSpec& spec : scene.setup.supports) {
    tools::ModelPicture::Support s;
    s.fixed = spec.kind == retraction::SupportSpec::Kind::Fixed;
    s.name = retraction::Body::name(spec.region);
    std::vector<Eigen::Vector3d> points;
    try {
      for (const int node : body.nodes(spec.region)) points.push_back(body.nodePosition_mm(node));
    } catch (const BadInput& e) {
      s.problem = e.what();
    }
    s.points_lps = thinned(points, mostSites);
    picture.supports.push_back(std::move(s));
  }
  placeBar(scene, model, smooth, body, cells, proved, picture);
}

/// All of a scene that the body depends on.
std::string bodyKey(pipeline::Scene scene) {
  scene.setup.loads.clear();
  scene.setup.supports.clear();
  scene.setup.capsule.reset();
  return pipeline::toJson(scene);
}

}  // namespace

void ModelPreview::start() {
  if (worker_.busy()) return;
  const std::uint64_t revision = session_.revision();
  if (!session_.images().mri || session_.acceptedCount() == 0) {
    picture_.reset();
    body_.reset();
    made_ = revision;
    problem_ = session_.images().mri ? tr("Outline the liver first (step Segment): the model appears here.")
                                     : tr("Open a patient first: the model appears here.");
    emit changed();
    return;
  }
  progress_.clear();
  if (!problem_.isEmpty()) {  // it may be mended: nobody should read it until that is known
    problem_.clear();
    emit changed();
  }
  const std::filesystem::path folder = (session_.runFolder() + QStringLiteral("/preview")).toStdString();
  struct Made {
    std::shared_ptr<const Body> body;
    std::shared_ptr<const tools::ModelPicture> picture;
  };
  auto made = std::make_shared<Made>();
  std::optional<retraction::PlacedBar> proved;
  if (session_.result() && !session_.resultIsStale()) proved = session_.result()->placed;
  worker_.start(
      [made, folder, proved, files = session_.caseFiles(folder), before = body_](const Progress& progress) {
        std::filesystem::create_directories(folder);
        const pipeline::Scene scene = readable(files, folder);
        const std::string key = bodyKey(scene) + roi::toJson(files.contours);
        made->body = before;
        if (!before || before->key != key) {
          auto body = std::make_shared<Body>();
          body->key = key;
          const pipeline::Inputs inputs = pipeline::loadInputs(scene, progress.part(0.0, 0.3));
          body->model = pipeline::buildModels(scene, false, progress.part(0.3, 0.5), &inputs).model;
          body->cells = cellsOf(body->model);
          if (body->model.smooth) body->smooth = body->model.smooth->surface();
          body->picture = bodyPicture(scene, body->model, body->cells, inputs, progress.part(0.5, 1.0));
          made->body = body;
        }
        auto picture = std::make_shared<tools::ModelPicture>(*made->body->picture);
        place(scene, made->body->model, made->body->smooth, made->body->cells, proved, *picture);
        made->picture = picture;
      },
      [this, made, revision](std::exception_ptr failure) {
        made_ = revision;
        problem_ = reasonOf(failure);
        if (failure) {
          picture_.reset();
        } else {
          body_ = made->body;
          picture_ = made->picture;
        }
        emit changed();
        if (session_.revision() != made_) delay_.start();
      });
}

}  // namespace glisson::session
