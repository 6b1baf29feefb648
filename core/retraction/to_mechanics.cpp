// The one crossing from mm, kPa and LPS to m, Pa and the grid's own axes, for supports and loads.
#include <cmath>
#include <map>

#include "anatomy/regions.h"
#include "base/error.h"
#include "mechanics/supports.h"
#include "retraction/body.h"

namespace glisson::retraction {
namespace {

constexpr double kPaToPa = 1e3;
constexpr double mmToM = 1e-3;

mechanics::NodalField zeroField(const Body& body) { return mechanics::NodalField::Zero(3, body.mesh().nodeCount()); }

void addFixed(const Body& body, const SupportSpec& spec, std::map<int, mechanics::Fixation>& fixations) {
  // Which grid axis each scene axis is; partial supports need them to coincide.
  std::array<bool, 3> axes = spec.axes;
  if (!(axes[0] && axes[1] && axes[2])) {
    std::array<bool, 3> local = {false, false, false};
    for (int a = 0; a < 3; ++a) {
      if (!axes[static_cast<std::size_t>(a)]) continue;
      const Eigen::Vector3d v = body.vectorToLocal(Eigen::Vector3d::Unit(a)).cwiseAbs();
      Eigen::Index along = 0;
      if (v.maxCoeff(&along) < 1.0 - 1e-6)
        throw BadInput("a support that holds single axes needs a grid along the patient's axes; this one is oblique: "
                       "hold all three axes, or resample the mask");
      local[static_cast<std::size_t>(along)] = true;
    }
    axes = local;
  }
  const Eigen::Vector3d value_m = body.vectorToLocal(mmToM * spec.displacement_mm);
  for (const int node : body.nodes(spec.region)) {
    auto [it, fresh] = fixations.try_emplace(node);
    mechanics::Fixation& f = it->second;
    if (fresh) {
      f.node = node;
      f.axis = {false, false, false};
    }
    for (std::size_t a = 0; a < 3; ++a) {
      if (!axes[a]) continue;
      const double v = value_m[static_cast<Eigen::Index>(a)];
      double& held = f.value_m[static_cast<Eigen::Index>(a)];
      if (f.axis[a] && std::abs(held - v) > 1e-12 * (1.0 + std::abs(v)))
        throw BadInput("two supports hold the same node at different displacements (" + Body::name(spec.region) +
                       "); separate their regions");
      f.axis[a] = true;
      held = v;
    }
  }
}

std::vector<mechanics::Face> meshFaces(const Body& body, const Region& region) {
  std::vector<mechanics::Face> faces;
  for (const SurfaceFace* f : body.faces(region)) faces.push_back(f->face);
  return faces;
}

image::Mask bodyMask(const Model& model) {
  image::Mask mask(model.youngs_kPa.grid);
  for (std::size_t i = 0; i < mask.values.size(); ++i) mask.values[i] = model.youngs_kPa.values[i] > 0 ? 1 : 0;
  return mask;
}

struct LoadBuilder {
  const Body& body;
  const Model& model;
  std::optional<Contact>& contact;

  mechanics::NodalField operator()(const BodyForce& load) const {
    return mechanics::bodyForce(body.mesh(), body.vectorToLocal(load.N_per_m3));
  }
  mechanics::NodalField operator()(const Traction& load) const {
    return mechanics::tractionForce(body.mesh(), meshFaces(body, load.region),
                                    Eigen::Vector3d(body.vectorToLocal(kPaToPa * load.kPa)));
  }
  mechanics::NodalField operator()(const Pressure& load) const {
    return mechanics::pressureForce(body.mesh(), meshFaces(body, load.region), kPaToPa * load.kPa);
  }
  mechanics::NodalField operator()(const Retractor& load) const {
    if (contact) throw BadInput("the scene has two retractors; keep one");
    const Eigen::Vector3d at_mm = load.at_mm ? *load.at_mm : findHoistPoint(body, load, anatomy::inferiorRightLobePoint(bodyMask(model)));
    contact = findContact(body, load, at_mm);
    const double force_N = load.force_N ? *load.force_N : model.mass_kg * defaults::gravity_m_s2;
    const Eigen::Vector3d local_N = body.vectorToLocal(force_N * load.direction.normalized());
    std::vector<mechanics::Face> faces;
    Eigen::Matrix3Xd traction_Pa(3, static_cast<Eigen::Index>(contact->faces.size()));
    for (std::size_t i = 0; i < contact->faces.size(); ++i) {
      faces.push_back(contact->faces[i]->face);
      traction_Pa.col(static_cast<Eigen::Index>(i)) = contact->share[i] / contact->faces[i]->area_m2 * local_N;
    }
    return mechanics::tractionForce(body.mesh(), faces, traction_Pa);
  }
};

}  // namespace

MechanicsScene toMechanics(const Body& body, const Model& model, const Setup& setup) {
  MechanicsScene scene;
  scene.problem.body = body.voxels();
  std::map<int, mechanics::Fixation> fixations;
  for (const SupportSpec& s : setup.supports) {
    if (s.kind == SupportSpec::Kind::Fixed)
      addFixed(body, s, fixations);
    else if (s.stiffness_kPa_per_mm > 0)
      for (const mechanics::Spring& spring : mechanics::faceSprings(
               body.mesh(), meshFaces(body, s.region), mechanics::N_m3_per_kPa_mm * s.stiffness_kPa_per_mm,
               s.normalOnly ? mechanics::SpringDirection::Normal : mechanics::SpringDirection::Every))
        scene.problem.supports.springs.push_back(spring);
  }
  for (const auto& [node, f] : fixations) scene.problem.supports.fixations.push_back(f);
  if (!setup.analysis.dynamic) mechanics::requireSupported(body.mesh(), scene.problem.supports);

  scene.problem.f_N = zeroField(body);
  for (const LoadSpec& load : setup.loads) {
    scene.loads_N.push_back(std::visit(LoadBuilder{body, model, scene.contact}, load));
    scene.problem.f_N += scene.loads_N.back();
  }
  return scene;
}

}  // namespace glisson::retraction
