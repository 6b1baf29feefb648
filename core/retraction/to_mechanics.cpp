// SPDX-License-Identifier: GPL-3.0-or-later

// The one crossing from mm, kPa and LPS to m, Pa and the grid's own axes, for supports and loads.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "anatomy/regions.h"
#include "base/error.h"
#include "mechanics/supports.h"
#include "retraction/body.h"
#include "retraction/rigid_contact.h"

namespace glisson::retraction {
namespace {

constexpr double kPaToPa = 1e3;
constexpr double mmToM = 1e-3;

mechanics::NodalField zeroField(const Body& body) {
  return mechanics::NodalField::Zero(3, body.mesh().nodeCount());
}

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
        throw BadInput(
            "a support that holds single axes needs a grid along the patient's axes; this one is oblique: "
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

/// Consistent nodal forces of tractions on voxel faces.
mechanics::NodalField nodalForces(const Body& body, const std::vector<FaceTraction>& tractions) {
  std::vector<mechanics::Face> faces;
  Eigen::Matrix3Xd traction_Pa(3, static_cast<Eigen::Index>(tractions.size()));
  for (const FaceTraction& t : tractions) {
    traction_Pa.col(static_cast<Eigen::Index>(faces.size())) = t.traction_Pa;
    faces.push_back(t.face);
  }
  return mechanics::tractionForce(body.mesh(), faces, traction_Pa);
}

/// Refuses a bar that no instrument is, and a force that pushes it the other way.
void requireSensible(const Retractor& bar) {
  const auto within = [](const char* key, double value, const Retractor::Range& range, const char* unit) {
    if (value >= range.least && value <= range.most) return;
    std::ostringstream text;
    text << "the retractor's \"" << key << "\" is " << value << " " << unit << "; it must lie between " << range.least
         << " and " << range.most << " " << unit;
    throw BadInput(text.str());
  };
  within("diameter_mm", bar.diameter_mm, Retractor::diameters_mm, "mm");
  within("length_mm", bar.length_mm, Retractor::lengths_mm, "mm");
  within("spread_mm", bar.spread_mm, Retractor::spreads_mm, "mm");
  if (bar.force_N && *bar.force_N < 0.0)
    throw BadInput(
        "the retractor's \"force\" is negative; give its size, and turn \"direction\" where the bar pulls the "
        "other way");
  if (bar.force_N) within("force", *bar.force_N, Retractor::forces_N, "N");
}

/// Surface loads become tractions on faces; body forces have none.
struct LoadBuilder {
  const Body& body;
  const Model& model;
  std::optional<Contact>& contact;
  bool rigid;
  bool large;  ///< solved in large deformation: what follows is no dead load
  bool corotational;

  std::vector<FaceTraction> operator()(const BodyForce&) const { return {}; }
  /// True where the contact solver lets a load follow its faces.
  bool following(bool follows) const {
    if (follows && corotational)
      throw BadInput(
          "a load that follows its faces is offered for kinematics \"hyperelastic\": choose these, or leave "
          "\"follows\" out");
    return follows && large;
  }
  std::vector<FaceTraction> operator()(const Traction& load) const {
    if (following(load.follows)) return {};
    std::vector<FaceTraction> out;
    for (const SurfaceFace* f : body.faces(load.region))
      out.push_back({f->face, body.vectorToLocal(kPaToPa * load.kPa)});
    return out;
  }
  std::vector<FaceTraction> operator()(const Pressure& load) const {
    if (following(load.follows)) return {};
    std::vector<FaceTraction> out;
    for (const SurfaceFace* f : body.faces(load.region))
      out.push_back({f->face, -kPaToPa * load.kPa * mechanics::faceNormal(f->face.side)});
    return out;
  }
  std::vector<FaceTraction> operator()(const Retractor& load) const {
    requireSensible(load);
    if (rigid) return {};  // the bar is no load: the contact solver moves it
    const Eigen::Vector3d at_mm = load.at_mm ? *load.at_mm : defaultHoistPoint(body, model, load);
    contact = findContact(body, load, at_mm);
    const double force_N = load.force_N ? *load.force_N : model.mass_kg * defaults::gravity_m_s2;
    const Eigen::Vector3d local_N = body.vectorToLocal(force_N * load.direction.normalized());
    std::vector<FaceTraction> out;
    for (std::size_t i = 0; i < contact->faces.size(); ++i)
      out.push_back({contact->faces[i]->face, contact->share[i] / contact->faces[i]->area_m2 * local_N});
    return out;
  }
};

/// Refuses a static scene with a piece that nothing holds, in the patient's own millimetres.
void requireSupported(const Body& body, const mechanics::Supports& supports) {
  const std::vector<mechanics::FreeComponent> loose = mechanics::findUnsupported(body.mesh(), supports);
  if (loose.empty()) return;
  std::ostringstream text;
  text.precision(4);
  for (std::size_t i = 0; i < loose.size() && i < 3; ++i) {
    const mechanics::FreeComponent& c = loose[i];
    text << (i ? "; " : "") << "a piece of " << c.cells << " cells (" << 1e6 * c.volume_m3 << " mL) around ("
         << body.toLps_mm(c.centre_m).transpose() << ") mm has " << c.freeModes << " free rigid mode"
         << (c.freeModes == 1 ? "" : "s") << (c.hinged ? ", hanging on the rest by an edge or corner only" : "");
  }
  if (loose.size() > 3) text << "; and " << loose.size() - 3 << " more pieces";
  text << ": hold it with a support, or leave it out of the mask (a static solve needs every piece held)";
  throw BadInput(text.str());
}

}  // namespace

Eigen::Vector3d defaultHoistPoint(const Body& body, const Model& model, const Retractor& retractor) {
  return findHoistPoint(body, retractor, anatomy::inferiorRightLobePoint(bodyMask(model)));
}

Setup withPatch(Setup setup) {
  for (LoadSpec& load : setup.loads)
    if (auto* bar = std::get_if<Retractor>(&load)) {
      bar->contact = ContactKind::Patch;
      bar->travel_mm.reset();
      bar->shape = BarShape::Straight;
    }
  if (setup.kinematics == Kinematics::Auto)
    setup.kinematics = inLargeDeformation(setup) ? Kinematics::Hyperelastic : Kinematics::Linear;
  return setup;
}

namespace {

bool followsFaces(const LoadSpec& load) {
  const auto* pressure = std::get_if<Pressure>(&load);
  const auto* traction = std::get_if<Traction>(&load);
  return (pressure != nullptr && pressure->follows) || (traction != nullptr && traction->follows);
}

}  // namespace

Setup exportable(Setup setup) {
  setup = withPatch(std::move(setup));
  setup.supports.erase(std::remove_if(setup.supports.begin(), setup.supports.end(),
                                      [](const SupportSpec& s) { return s.kind == SupportSpec::Kind::Ligament; }),
                       setup.supports.end());
  for (SupportSpec& s : setup.supports) {
    s.normalOnly = s.normalOnly || s.unilateral;
    s.unilateral = false;
  }
  for (LoadSpec& load : setup.loads) {
    if (auto* pressure = std::get_if<Pressure>(&load)) pressure->follows = false;
    if (auto* traction = std::get_if<Traction>(&load)) traction->follows = false;
  }
  return setup;
}

Diagnostics notExportable(const Setup& setup) {
  Diagnostics said;
  if (rigidBarOf(setup)) said.add(DiagnosticCode::ContactNotExported);
  std::int64_t ligaments = 0, beds = 0;
  for (const SupportSpec& s : setup.supports)
    if (isOneSided(s)) ++(s.kind == SupportSpec::Kind::Ligament ? ligaments : beds);
  if (ligaments + beds > 0)
    said.add(DiagnosticCode::HoldingNotExported,
             {{"count", ligaments + beds},
              {"what", std::string(beds == 0        ? "ligaments"
                                   : ligaments == 0 ? "springs that only press"
                                                    : "ligaments and springs that only press")}});
  const auto following = std::count_if(setup.loads.begin(), setup.loads.end(), followsFaces);
  if (following > 0) said.add(DiagnosticCode::FollowingNotExported, {{"count", static_cast<std::int64_t>(following)}});
  return said;
}

MechanicsScene toMechanics(const Body& body, const Model& model, const Setup& setup) {
  MechanicsScene scene;
  scene.problem.body = body.voxels();
  std::map<int, mechanics::Fixation> fixations;
  std::vector<mechanics::Spring> pressing;  // hold the body as well, but are no springs of the linear problem
  for (const SupportSpec& s : setup.supports) {
    if (isOneSided(s) && !inLargeDeformation(setup))
      throw BadInput(
          s.kind == SupportSpec::Kind::Ligament
              ? "a ligament, which goes slack and turns, is offered for kinematics \"hyperelastic\" or a rigid "
                "retractor: change that, or take a spring instead"
              : "a spring that only presses (\"unilateral\") is offered for kinematics \"hyperelastic\" or a "
                "rigid retractor: change that, or let it pull as well");
    if (s.kind == SupportSpec::Kind::Ligament) {
      // Where it is attached it holds the body; how, the solver of large deformation says.
      for (const int node : mechanics::nodesOfFaces(body.mesh(), meshFaces(body, s.region)))
        pressing.push_back({node, Eigen::Matrix3d::Identity()});
      continue;
    }
    std::vector<mechanics::Foundation> own;
    if (s.kind == SupportSpec::Kind::Fixed)
      addFixed(body, s, fixations);
    else if (s.kind == SupportSpec::Kind::Spring && s.stiffness_kPa_per_mm > 0)
      for (const mechanics::Foundation& f : mechanics::foundations(
               meshFaces(body, s.region), mechanics::N_m3_per_kPa_mm * s.stiffness_kPa_per_mm,
               s.normalOnly || (s.unilateral && !(s.tangential > 0)) ? mechanics::SpringDirection::Normal
                                                                     : mechanics::SpringDirection::Every))
        own.push_back(f);
    // What only presses holds along its normal, and across it by its tangential share: that some is there is enough
    // here.
    for (const mechanics::Spring& spring : mechanics::faceSprings(body.mesh(), own))
      (s.unilateral ? pressing : scene.problem.supports.springs).push_back(spring);
    if (s.unilateral) continue;
    scene.foundations.insert(scene.foundations.end(), own.begin(), own.end());
  }
  for (const auto& [node, f] : fixations) scene.problem.supports.fixations.push_back(f);
  if (!setup.analysis.dynamic) {
    mechanics::Supports all = scene.problem.supports;
    all.springs.insert(all.springs.end(), pressing.begin(), pressing.end());
    requireSupported(body, all);
  }

  if (std::count_if(setup.loads.begin(), setup.loads.end(),
                    [](const LoadSpec& load) { return std::holds_alternative<Retractor>(load); }) > 1)
    throw BadInput("the scene has two retractors; keep one");
  const bool rigid = rigidBarOf(setup).has_value();
  scene.problem.f_N = zeroField(body);
  for (const LoadSpec& load : setup.loads) {
    scene.tractions.push_back(
        std::visit(LoadBuilder{body, model, scene.contact, rigid,
                               inLargeDeformation(setup) && setup.kinematics != Kinematics::Linear,
                               setup.kinematics == Kinematics::Corotational},
                   load));
    const auto* weight = std::get_if<BodyForce>(&load);
    scene.loads_N.push_back(weight ? mechanics::bodyForce(body.mesh(), body.vectorToLocal(weight->N_per_m3))
                                   : nodalForces(body, scene.tractions.back()));
    scene.problem.f_N += scene.loads_N.back();
  }
  return scene;
}

}  // namespace glisson::retraction
