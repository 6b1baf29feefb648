// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "base/quantity_names.h"
#include "pipeline/detail/scene_words.h"
#include "pipeline/scene.h"
#include "retraction/ligaments.h"
#include "retraction/rigid_contact.h"

namespace glisson::pipeline {
namespace {

using detail::condensedSolver;
using detail::hexElementNames;
using detail::kernelNames;
using detail::preconditionerNames;
using detail::solverNames;
using Json = nlohmann::ordered_json;

Json toJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Relative to the scene's folder where the file lies below it, so that a case can be moved.
std::string pathText(const std::filesystem::path& p, const std::filesystem::path& folder) {
  std::error_code ec;
  const std::filesystem::path relative = std::filesystem::relative(p, folder, ec);
  if (!ec && !relative.empty() && *relative.begin() != "..") return relative.generic_string();
  return p.generic_string();
}

Json toJson(const GeometrySpec& g, const std::filesystem::path& folder) {
  Json j;
  switch (g.kind) {
    case GeometrySpec::Kind::Box:
      j["kind"] = "box";
      j["size_mm"] = toJson(g.size_mm);
      break;
    case GeometrySpec::Kind::Mask:
      j["kind"] = "mask";
      j["file"] = pathText(g.file, folder);
      if (g.label != 0) j["label"] = g.label;
      if (!g.background.empty()) j["mri"] = pathText(g.background, folder);
      break;
    case GeometrySpec::Kind::Patient:
      j["kind"] = "patient";
      j["mri"] = pathText(g.mri, folder);
      if (!g.mre.empty()) j["mre"] = pathText(g.mre, folder);
      j["roi"] = pathText(g.roi, folder);
      if (!g.roiName.empty()) j["roi_name"] = g.roiName;
      if (g.rigidRegistration) j["registration"] = "rigid";
      for (const auto& [which, role] : g.roles) j["roles"][which] = dicom::name(role);
      if (g.overrideChecks) j["override"] = true;
      if (g.mreQuantity) j["mre_quantity"] = stiffnessQuantityNames.nameOf(*g.mreQuantity);
      if (g.mreUnit) j["mre_unit"] = *g.mreUnit;
      if (g.mreConfidenceScale) j["mre_confidence_scale"] = *g.mreConfidenceScale;
      if (g.label != 0) j["label"] = g.label;
      break;
  }
  if (g.cell_mm.x() > 0) j["cell_mm"] = toJson(g.cell_mm);
  return j;
}

Json toJson(const MaterialSpec& m, const retraction::Setup& setup, const std::filesystem::path& folder) {
  Json j;
  const bool youngs = m.quantity == StiffnessQuantity::Youngs;
  switch (m.kind) {
    case MaterialSpec::Kind::Uniform: j[youngs ? "youngs_kPa" : "shear_kPa"] = m.value_kPa; break;
    case MaterialSpec::Kind::Map:
      j["map"] = pathText(m.map, folder);
      j["quantity"] = stiffnessQuantityNames.nameOf(m.quantity);
      j["unit"] = m.unit;
      break;
    case MaterialSpec::Kind::Mre: j["source"] = "mre"; break;
    case MaterialSpec::Kind::Atlas: j["source"] = "atlas"; break;
  }
  j["poisson"] = setup.poisson;
  j["density_kg_m3"] = setup.density.kgPerM3();
  if (setup.law)
    j["law"] = *setup.law == mechanics::SolidLaw::Polynomial ? "neo-hookean-polynomial" : "neo-hookean-log";
  return j;
}

struct RegionToJson {
  const std::filesystem::path& folder;
  Json operator()(const retraction::FaceRegion& r) const { return {{"face", r.face}}; }
  Json operator()(const retraction::SurfaceRegion& r) const { return {{"surface", r.surface}}; }
  Json operator()(const retraction::BoxRegion& r) const {
    return {{"box_mm", Json::array({toJson(r.low_mm), toJson(r.high_mm)})}};
  }
  Json operator()(const retraction::PlaneRegion& r) const {
    return {
        {"plane", {{"point_mm", toJson(r.point_mm)}, {"normal", toJson(r.normal)}, {"tolerance_mm", r.tolerance_mm}}}};
  }
  Json operator()(const retraction::MaskRegion& r) const {
    Json j = {{"mask", pathText(r.file, folder)}};
    if (r.label != 0) j["label"] = r.label;
    return j;
  }
};

Json toJson(const retraction::SupportSpec& s, const std::filesystem::path& folder) {
  Json j;
  j["region"] = std::visit(RegionToJson{folder}, s.region);
  if (s.kind == retraction::SupportSpec::Kind::Spring) {
    j["kind"] = "spring";
    j["stiffness_kPa_per_mm"] = s.stiffness_kPa_per_mm;
    j["direction"] = s.normalOnly ? "normal" : "isotropic";
    if (s.unilateral) j["unilateral"] = true;
    if (s.tangential > 0) j["tangential"] = s.tangential;
    return j;
  }
  if (s.kind == retraction::SupportSpec::Kind::Ligament) {
    const retraction::LigamentSpec& l = s.ligament;
    j["kind"] = "ligament";
    j["name"] = retraction::nameOf(l.name);
    if (l.stiffness_N_per_mm) j["stiffness_N_per_mm"] = *l.stiffness_N_per_mm;
    j["length_mm"] = l.length_mm;
    j["slack_mm"] = l.slack_mm;
    if (l.towards) j["towards"] = toJson(*l.towards);
    if (l.twoSided) j["two_sided"] = true;
    return j;
  }
  j["kind"] = "fixed";
  Json axes = Json::array();
  for (std::size_t a = 0; a < 3; ++a)
    if (s.axes[a]) axes.push_back(std::string(1, static_cast<char>('x' + a)));
  j["axes"] = axes;
  j["displacement_mm"] = toJson(s.displacement_mm);
  return j;
}

struct LoadToJson {
  const std::filesystem::path& folder;
  bool spread, shape;  ///< whether a bar's are to be written where they are defaults
  Json operator()(const retraction::BodyForce& l) const {
    return {{"kind", "body_force"}, {"N_per_m3", toJson(l.N_per_m3)}};
  }
  Json operator()(const retraction::Traction& l) const {
    Json j = {{"kind", "traction"}, {"region", std::visit(RegionToJson{folder}, l.region)}, {"kPa", toJson(l.kPa)}};
    if (l.follows) j["follows"] = true;
    return j;
  }
  Json operator()(const retraction::Pressure& l) const {
    Json j = {{"kind", "pressure"}, {"region", std::visit(RegionToJson{folder}, l.region)}, {"kPa", l.kPa}};
    if (l.follows) j["follows"] = true;
    return j;
  }
  Json operator()(const retraction::Retractor& l) const {
    Json j = {{"kind", "retractor"}, {"diameter_mm", l.diameter_mm}, {"length_mm", l.length_mm}};
    if (spread || l.spread_mm != retraction::Retractor{}.spread_mm) j["spread_mm"] = l.spread_mm;
    j["at"] = l.at_mm ? toJson(*l.at_mm) : Json("inferior-right-lobe");
    if (l.travel_mm)
      j["drive"] = {{"travel_mm", *l.travel_mm}};
    else
      j["force"] = l.force_N ? Json(*l.force_N) : Json("liver-weight");
    if (l.contact) j["contact"] = *l.contact == retraction::ContactKind::Rigid ? "rigid" : "patch";
    if (shape || l.shape == retraction::BarShape::Hook)
      j["shape"] = l.shape == retraction::BarShape::Hook ? "hook" : "straight";
    j["direction"] = toJson(l.direction);
    if (l.axis) j["axis"] = toJson(*l.axis);
    return j;
  }
};

/// element: whether that of hexahedra is to be written where it is the default.
Json toJson(const retraction::ModelSpec& m, bool element) {
  if (m.kind == retraction::ModelKind::Meshfree)
    return {{"kind", "meshfree"},
            {"frames", m.meshfree.frames},
            {"kernel", kernelNames.nameOf(m.meshfree.kernel)},
            {"order", m.meshfree.order}};
  if (m.kind == retraction::ModelKind::FemTet) {
    Json j = {{"kind", "fem-tet"}, {"element", m.quadraticTets ? "T10" : "T4"}};
    if (m.delaunay) {
      j["mesh"] = "delaunay";
      j["cell_mm"] = m.cell_mm;
      j["tool_cell_mm"] = m.toolCell_mm;
    }
    return j;
  }
  if (!element && m.element == mechanics::HexElement::Incompatible) return {{"kind", "fem-hex"}};
  return {{"kind", "fem-hex"}, {"element", hexElementNames.nameOf(m.element)}};
}

Json toJson(const retraction::AnalysisSpec& a) {
  if (!a.dynamic) return {{"kind", "static"}};
  Json j = {{"kind", "dynamic"},
            {"h_ms", a.h_ms},
            {"end_s", a.end_s},
            {"rayleigh", {a.rayleigh[0], a.rayleigh[1]}},
            {"stop_when_steady", a.stopWhenSteady}};
  if (a.scheme != mechanics::TimeScheme::ImplicitEuler) j["scheme"] = mechanics::nameOf(a.scheme);
  if (a.scheme == mechanics::TimeScheme::GeneralisedAlpha) j["spectral_radius"] = a.spectralRadius;
  return j;
}

Json toJson(const uncertainty::Options& u) {
  const uncertainty::Spreads& s = u.spreads;
  Json j = {{"repeatability_percent", 100 * s.repeatability},
            {"correlation_mm", s.correlation_mm},
            {"outline_mm", s.outline_mm},
            {"poisson", s.poisson},
            {"supports_percent", 100 * s.supports},
            {"capsule_percent", 100 * s.capsule},
            {"force_percent", 100 * s.force},
            {"density_percent", 100 * s.density},
            {"bar_mm", s.barPlace_mm},
            {"bar_deg", s.barTurn_deg},
            {"fields", u.fields},
            {"checks", u.checks}};
  if (s.noise >= 0) j["noise_percent"] = 100 * s.noise;
  return j;
}

/// used: whether the scene's solver takes them; else they are written where the scene names them. The tolerance of time
/// steps that nobody named is the program's to choose, and is still when the text is read again.
Json solverToJson(const Scene& scene, bool used) {
  const retraction::Setup& s = scene.setup;
  using mechanics::SolverKind;
  Json j;
  j["kind"] = s.condensed ? condensedSolver : solverNames.nameOf(s.solver.kind);
  const mechanics::SolverOptions usual;
  const bool chosen =
      s.analysis.dynamic && !s.condensed && s.solver.kind == SolverKind::Auto && !s.solver.keepsTolerance();
  if (used || scene.names("solver.iterations") || s.solver.iterations != usual.iterations)
    j["iterations"] = s.solver.iterations;
  if ((used && !chosen) || s.solver.keepsTolerance()) j["tolerance"] = s.solver.tolerance;
  if (s.solver.kind == SolverKind::Cg && (used || scene.names("solver.preconditioner")))
    j["preconditioner"] = preconditionerNames.nameOf(s.solver.preconditioner);
  return j;
}

}  // namespace

std::string toJson(const Scene& scene) {
  const retraction::Setup& s = scene.setup;
  Json j;
  j["schema"] = "glisson/scene/1";
  j["geometry"] = toJson(scene.geometry, scene.folder);
  j["material"] = toJson(scene.material, s, scene.folder);
  j["supports"] = Json::array();
  for (const auto& support : s.supports) j["supports"].push_back(toJson(support, scene.folder));
  j["loads"] = Json::array();
  // What this scene leaves without use is written where it is named, so that reading it again says the same of it.
  const bool bar = retraction::wantsRigidBar(s);
  const LoadToJson loadToJson{scene.folder, !bar || scene.names("spread_mm"), scene.names("shape")};
  for (const auto& load : s.loads) j["loads"].push_back(std::visit(loadToJson, load));
  j["model"] = toJson(s.model, !bar || scene.names("model.element"));
  j["kinematics"] = nameOf(s.kinematics);
  // Where nothing would use it, a capsule that nobody asked for stays a default.
  if (scene.capsuleAsked || bar)
    j["capsule"] = s.capsule
                       ? Json{{"tension_N_per_mm", s.capsule->tension_N_per_mm},
                              {"form", s.capsule->form == retraction::CapsuleForm::Membrane ? "membrane" : "cells"}}
                       : Json(false);
  j["analysis"] = toJson(s.analysis);
  j["solver"] = solverToJson(scene, !bar && s.kinematics != retraction::Kinematics::Hyperelastic);
  if (scene.compare)
    j["compare"] = {
        {"against", "atlas"},
        {scene.compare->quantity == StiffnessQuantity::Shear ? "shear_kPa" : "youngs_kPa", scene.compare->value_kPa}};
  if (scene.uncertainty) j["uncertainty"] = toJson(*scene.uncertainty);
  Json outputs = Json::array();
  if (!scene.outputs.probes_mm.empty()) {
    Json points = Json::array();
    for (const auto& p : scene.outputs.probes_mm) points.push_back(toJson(p));
    outputs.push_back({{"probe", points}});
  }
  if (scene.outputs.displacementField) outputs.push_back("displacement-field");
  if (scene.outputs.vessels) outputs.push_back("vessels");
  if (scene.outputs.overlay) outputs.push_back("overlay");
  if (scene.outputs.report) outputs.push_back("report");
  if (scene.outputs.sofa) outputs.push_back("sofa");
  j["outputs"] = outputs;
  j["seed"] = s.seed;
  return j.dump(2) + "\n";
}

}  // namespace glisson::pipeline
