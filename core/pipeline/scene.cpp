// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/scene.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/quantity_names.h"
#include "pipeline/case_folder.h"
#include "pipeline/detail/json_reader.h"
#include "pipeline/detail/scene_words.h"
#include "pipeline/detail/setup_reader.h"
#include "retraction/rigid_contact.h"

namespace glisson::pipeline {
namespace {

using detail::existing;
using detail::JsonDocument;
using detail::JsonObject;
using detail::positive;
using retraction::Setup;

/// "roles": { "<series UID or number>": "stiffness", ... }
dicom::RoleOverrides readRoles(JsonObject& o) {
  dicom::RoleOverrides roles;
  const auto& list = o.raw("roles");
  if (!list.is_object()) o.fail("roles", "must be an object: series UID or number -> role");
  for (const auto& [which, role] : list.items()) {
    if (!role.is_string()) o.fail("roles", "must name a role in words, e.g. \"stiffness\"");
    try {
      roles[which] = dicom::roleNamed(role.template get<std::string>());
    } catch (const BadInput& e) {
      o.fail("roles", e.what());
    }
  }
  return roles;
}

GeometrySpec readGeometry(JsonObject o, const std::filesystem::path& folder) {
  GeometrySpec g;
  const std::string kind = o.word("kind", {"box", "mask", "patient"});
  if (o.has("cell_mm")) {
    if (o.raw("cell_mm").is_array())
      g.cell_mm = o.vector3("cell_mm");
    else
      g.cell_mm.setConstant(o.number("cell_mm"));
    if ((g.cell_mm.array() <= 0).any()) o.fail("cell_mm", "must be greater than 0");
  }
  if (kind == "box") {
    g.kind = GeometrySpec::Kind::Box;
    g.size_mm = o.vector3("size_mm");
    if ((g.size_mm.array() <= 0).any()) o.fail("size_mm", "must be three lengths greater than 0");
    if (!o.has("cell_mm")) g.cell_mm.setConstant(g.size_mm.minCoeff() / 6.0);
    const Eigen::Vector3d n = g.size_mm.cwiseQuotient(g.cell_mm);
    if ((n.array() < 0.5).any()) o.fail("cell_mm", "is larger than the box");
    if (n.prod() > 2e8) o.fail("cell_mm", "makes more than 200 million cells; choose larger cells");
  } else if (kind == "mask") {
    g.kind = GeometrySpec::Kind::Mask;
    g.file = existing(o, "file", folder);
    g.label = o.integer("label", 0);
    if (o.has("mri")) g.background = existing(o, "mri", folder);
  } else {
    g.kind = GeometrySpec::Kind::Patient;
    g.mri = existing(o, "mri", folder);
    if (o.has("mre")) g.mre = existing(o, "mre", folder);
    g.roi = existing(o, "roi", folder);
    g.roiName = o.text("roi_name", "");
    g.rigidRegistration = o.word("registration", {"none", "rigid"}, "none") == "rigid";
    if (o.has("roles")) g.roles = readRoles(o);
    g.overrideChecks = o.boolean("override", false);
    if (o.has("mre_quantity")) g.mreQuantity = o.named("mre_quantity", stiffnessQuantityNames);
    if (o.has("mre_unit")) g.mreUnit = o.text("mre_unit");
    if (o.has("mre_confidence_scale")) {
      g.mreConfidenceScale = o.number("mre_confidence_scale");
      if (!(*g.mreConfidenceScale > 0.0)) o.fail("mre_confidence_scale", "must be a positive number");
    }
    g.label = o.integer("label", 0);
  }
  o.finish();
  return g;
}

void readPoissonAndDensity(JsonObject& o, Setup& setup) {
  setup.poisson = o.number("poisson", defaults::poisson);
  if (!(setup.poisson > -1.0 && setup.poisson < 0.5))
    o.fail("poisson", "is " + std::to_string(setup.poisson) +
                          "; Poisson's ratio must lie between -1 and 0.5 (0.5 itself is incompressible; 0.499 is as "
                          "close as makes sense)");
  setup.density =
      Density::fromKgPerM3(positive(o, "density_kg_m3", o.number("density_kg_m3", defaults::liverDensity.kgPerM3())));
}

MaterialSpec readMaterial(JsonObject& scene, Setup& setup, const std::filesystem::path& folder) {
  MaterialSpec m;
  if (scene.raw("material").is_string()) {
    const std::string w = scene.word("material", {"mre", "atlas"});
    m.kind = w == "mre" ? MaterialSpec::Kind::Mre : MaterialSpec::Kind::Atlas;
    return m;
  }
  JsonObject o = scene.object("material");
  const int given = int{o.has("youngs_kPa")} + int{o.has("shear_kPa")} + int{o.has("map")} + int{o.has("source")};
  if (given != 1) o.fail("give exactly one of youngs_kPa, shear_kPa, map, source (\"mre\" or \"atlas\")");
  if (o.has("youngs_kPa") || o.has("shear_kPa")) {
    const bool youngs = o.has("youngs_kPa");
    const std::string key = youngs ? "youngs_kPa" : "shear_kPa";
    m.kind = MaterialSpec::Kind::Uniform;
    m.quantity = youngs ? StiffnessQuantity::Youngs : StiffnessQuantity::Shear;
    m.value_kPa = positive(o, key, o.number(key));
    if (m.value_kPa > 1e12) o.fail(key, "is stiffer than any material (1e12 kPa)");
  } else if (o.has("map")) {
    m.kind = MaterialSpec::Kind::Map;
    m.map = existing(o, "map", folder);
    m.quantity = o.named("quantity", stiffnessQuantityNames);
    m.unit = o.text("unit");
  } else {
    m.kind = o.word("source", {"mre", "atlas"}) == "mre" ? MaterialSpec::Kind::Mre : MaterialSpec::Kind::Atlas;
  }
  readPoissonAndDensity(o, setup);
  if (o.has("law"))
    setup.law = o.word("law", {"neo-hookean-log", "neo-hookean-polynomial"}) == "neo-hookean-log"
                    ? mechanics::SolidLaw::Logarithmic
                    : mechanics::SolidLaw::Polynomial;
  o.finish();
  return m;
}

/// Glisson's capsule: default, false, or its tension.
std::optional<retraction::Capsule> readCapsule(JsonObject& scene, bool byDefault) {
  retraction::Capsule capsule;
  if (!scene.has("capsule")) return byDefault ? std::optional(capsule) : std::nullopt;
  if (scene.raw("capsule").is_boolean()) return scene.boolean("capsule", false) ? std::optional(capsule) : std::nullopt;
  JsonObject o = scene.object("capsule");
  capsule.tension_N_per_mm = positive(o, "tension_N_per_mm", o.number("tension_N_per_mm", capsule.tension_N_per_mm));
  if (o.word("form", {"cells", "membrane"}, "cells") == "membrane") capsule.form = retraction::CapsuleForm::Membrane;
  o.finish();
  return capsule;
}

CompareSpec readCompare(JsonObject o) {
  CompareSpec c;
  o.word("against", {"atlas"});
  if (o.has("shear_kPa") && o.has("youngs_kPa")) o.fail("give shear_kPa or youngs_kPa, not both");
  if (o.has("youngs_kPa")) {
    c.quantity = StiffnessQuantity::Youngs;
    c.value_kPa = positive(o, "youngs_kPa", o.number("youngs_kPa"));
  } else {
    c.value_kPa = positive(o, "shear_kPa", o.number("shear_kPa", c.value_kPa));
  }
  o.finish();
  return c;
}

/// How sure: true, or what differs from the defaults.
std::optional<uncertainty::Options> readUncertainty(JsonObject& scene) {
  uncertainty::Options u;
  if (!scene.has("uncertainty")) return {};
  if (scene.raw("uncertainty").is_boolean())
    return scene.boolean("uncertainty", false) ? std::optional(u) : std::nullopt;
  JsonObject o = scene.object("uncertainty");
  uncertainty::Spreads& s = u.spreads;
  const auto spread = [&](const char* key, double& value, double unit, double most) {
    if (!o.has(key)) return;
    const double given = o.number(key);
    if (!(given >= 0.0 && given <= most)) o.fail(key, "must lie between 0 and " + std::to_string(most));
    value = given * unit;
  };
  spread("repeatability_percent", s.repeatability, 0.01, 100);
  spread("noise_percent", s.noise, 0.01, 100);
  spread("correlation_mm", s.correlation_mm, 1.0, 200);
  spread("outline_mm", s.outline_mm, 1.0, 10);
  spread("poisson", s.poisson, 1.0, 0.2);
  spread("supports_percent", s.supports, 0.01, 100);
  spread("capsule_percent", s.capsule, 0.01, 100);
  spread("force_percent", s.force, 0.01, 100);
  spread("density_percent", s.density, 0.01, 100);
  spread("bar_mm", s.barPlace_mm, 1.0, 50);
  spread("bar_deg", s.barTurn_deg, 1.0, 45);
  u.fields = o.integer("fields", u.fields);
  if (u.fields < 4 || u.fields > 1000) o.fail("fields", "must lie between 4 and 1000");
  u.checks = o.integer("checks", u.checks);
  if (u.checks < 0 || u.checks > 100) o.fail("checks", "must lie between 0 and 100");
  o.finish();
  return u;
}

OutputSpec readOutputs(JsonObject& scene) {
  OutputSpec out;
  if (!scene.has("outputs")) return out;
  const nlohmann::json& list = scene.raw("outputs");
  if (!list.is_array()) scene.fail("outputs", "must be a list");
  for (const nlohmann::json& item : list) {
    if (item.is_string()) {
      if (item == "displacement-field")
        out.displacementField = true;
      else if (item == "vessels")
        out.vessels = true;
      else if (item == "overlay")
        out.overlay = true;
      else if (item == "report")
        out.report = true;
      else if (item == "sofa")
        out.sofa = true;
      else
        scene.fail("outputs",
                   "holds \"" + item.get<std::string>() +
                       "\"; known are displacement-field, vessels, overlay, report, sofa and {\"probe\": [[x,y,z]]}");
    }
  }
  // Objects in the list: probes.
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].is_string()) continue;
    if (!list[i].is_object() || list[i].size() != 1 || !list[i].contains("probe"))
      scene.fail("outputs", "holds something that is neither a word nor {\"probe\": [[x,y,z]]}");
    const nlohmann::json& points = list[i]["probe"];
    if (!points.is_array()) scene.fail("outputs", "\"probe\" must be a list of points [x, y, z]");
    for (const nlohmann::json& p : points) {
      if (!p.is_array() || p.size() != 3 || !p[0].is_number() || !p[1].is_number() || !p[2].is_number())
        scene.fail("outputs", "\"probe\" must be a list of points [x, y, z]");
      out.probes_mm.emplace_back(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
    }
  }
  return out;
}

/// Scene::named.
std::vector<std::string> namedIn(const nlohmann::json& root) {
  std::vector<std::string> named;
  for (const auto& load : root.value("loads", nlohmann::json::array()))
    for (const char* key : {"spread_mm", "shape"})
      if (load.contains(key)) named.emplace_back(key);
  if (root.contains("model") && root["model"].contains("element")) named.emplace_back("model.element");
  if (root.contains("solver"))
    for (const char* key : {"iterations", "tolerance", "preconditioner"})
      if (root["solver"].contains(key)) named.push_back(std::string("solver.") + key);
  return named;
}

}  // namespace

namespace {
constexpr std::pair<const char*, retraction::Kinematics> kinematicsWords[] = {
    {"auto", retraction::Kinematics::Auto},
    {"linear", retraction::Kinematics::Linear},
    {"corotational", retraction::Kinematics::Corotational},
    {"hyperelastic", retraction::Kinematics::Hyperelastic}};
}  // namespace

retraction::Kinematics kinematicsOf(const std::string& word) {
  for (const auto& [name, kinematics] : kinematicsWords)
    if (word == name) return kinematics;
  throw BadArgument("kinematics \"" + word + "\" are not known");
}

std::string nameOf(retraction::Kinematics kinematics) {
  for (const auto& [name, k] : kinematicsWords)
    if (k == kinematics) return name;
  throw BadArgument("kinematics without a name");
}

Scene parseScene(const std::string& text, const std::filesystem::path& folder, const std::string& name) {
  const JsonDocument document = JsonDocument::parse(text, name);
  JsonObject o(document, "", document.root);
  Scene s;
  s.folder = folder;
  if (const std::string schema = o.text("schema"); schema != "glisson/scene/1")
    o.fail("schema", "is \"" + schema + "\"; this version reads \"glisson/scene/1\"");
  s.geometry = readGeometry(o.object("geometry"), folder);
  s.material = readMaterial(o, s.setup, folder);
  if (o.has("supports"))
    for (JsonObject& item : o.objects("supports")) s.setup.supports.push_back(detail::readSupport(item, folder));
  if (o.has("loads"))
    for (JsonObject& item : o.objects("loads")) s.setup.loads.push_back(detail::readLoad(item, folder));
  if (o.has("model")) s.setup.model = detail::readModel(o.object("model"));
  if (s.setup.model.delaunay && s.geometry.kind == GeometrySpec::Kind::Box)
    o.fail("model",
           "asks for Delaunay tetrahedra, which follow smooth organs and would round the edges of a box: use "
           "\"mesh\": \"voxels\"");
  const bool retractor = std::any_of(s.setup.loads.begin(), s.setup.loads.end(), [](const retraction::LoadSpec& l) {
    return std::holds_alternative<retraction::Retractor>(l);
  });
  s.setup.kinematics = kinematicsOf(
      o.word("kinematics", {"auto", "linear", "corotational", "hyperelastic"}, retractor ? "auto" : "linear"));
  // A liver: a patient's, or a mask on which the place of the bar is found by anatomy.
  const bool found = std::any_of(s.setup.loads.begin(), s.setup.loads.end(), [](const retraction::LoadSpec& l) {
    const auto* bar = std::get_if<retraction::Retractor>(&l);
    return bar != nullptr && !bar->at_mm;
  });
  if (o.has("analysis")) s.setup.analysis = detail::readAnalysis(o.object("analysis"));
  if (o.has("solver")) {
    s.setup.solver = detail::readSolver(o.object("solver"));
    s.setup.condensed = document.root["solver"]["kind"] == detail::condensedSolver;
  }
  s.named = namedIn(document.root);
  s.capsuleAsked = o.has("capsule");
  s.setup.capsule = readCapsule(o, s.geometry.kind == GeometrySpec::Kind::Patient
                                       ? retractor
                                       : s.geometry.kind == GeometrySpec::Kind::Mask && found);
  if (!s.capsuleAsked && !retraction::wantsRigidBar(s.setup)) s.setup.capsule.reset();
  if (o.has("compare")) s.compare = readCompare(o.object("compare"));
  s.uncertainty = readUncertainty(o);
  s.outputs = readOutputs(o);
  const double seed = o.number("seed", 1);
  if (seed < 0 || seed != std::floor(seed) || seed > 9e15)
    o.fail("seed", "must be a whole number that is not negative");
  s.setup.seed = static_cast<std::uint64_t>(seed);
  s.setup.model.meshfree.seed = s.setup.seed;
  s.setup.solver.element = s.setup.model.element;
  o.finish();

  if (s.material.kind == MaterialSpec::Kind::Mre &&
      (s.geometry.kind != GeometrySpec::Kind::Patient || s.geometry.mre.empty()))
    o.fail("material", "is \"mre\", but the geometry names no \"mre\"; give a patient geometry with mre, or a map");
  return s;
}

Scene readScene(const std::filesystem::path& file) {
  if (isCase(file)) return sceneOfCase(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw BadInput("cannot read the scene '" + file.filename().string() + "'; check that it exists");
  std::ostringstream text;
  text << in.rdbuf();
  const std::filesystem::path folder = file.parent_path();
  return parseScene(text.str(), folder.empty() ? "." : folder, file.filename().string());
}

}  // namespace glisson::pipeline
