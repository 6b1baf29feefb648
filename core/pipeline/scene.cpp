#include "pipeline/scene.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "pipeline/case_folder.h"
#include "pipeline/detail/json_reader.h"

namespace glisson::pipeline {
namespace {

using detail::JsonDocument;
using detail::JsonObject;
using retraction::Setup;

double positive(JsonObject& o, const std::string& key, double value) {
  if (!(value > 0.0)) o.fail(key, "is " + std::to_string(value) + "; it must be greater than 0");
  return value;
}

std::filesystem::path existing(JsonObject& o, const std::string& key, const std::filesystem::path& folder) {
  const std::filesystem::path p = o.text(key);
  const std::filesystem::path full = p.is_absolute() ? p : folder / p;
  std::error_code ec;
  if (!std::filesystem::exists(full, ec))
    o.fail(key, "names a file or folder that does not exist; paths are relative to the scene file");
  return full;
}

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
    m.quantity =
        o.word("quantity", {"youngs", "shear"}) == "youngs" ? StiffnessQuantity::Youngs : StiffnessQuantity::Shear;
    m.unit = o.text("unit");
  } else {
    m.kind = o.word("source", {"mre", "atlas"}) == "mre" ? MaterialSpec::Kind::Mre : MaterialSpec::Kind::Atlas;
  }
  readPoissonAndDensity(o, setup);
  o.finish();
  return m;
}

retraction::Region readRegion(JsonObject o, const std::filesystem::path& folder) {
  const int given =
      int{o.has("face")} + int{o.has("surface")} + int{o.has("box_mm")} + int{o.has("plane")} + int{o.has("mask")};
  if (given != 1) o.fail("give exactly one of face, surface, box_mm, plane, mask");
  retraction::Region region;
  if (o.has("face")) {
    region = retraction::FaceRegion{o.word("face", {"x-", "x+", "y-", "y+", "z-", "z+"})};
  } else if (o.has("surface")) {
    region = retraction::SurfaceRegion{
        o.word("surface", {"posterior", "anterior", "superior", "inferior", "left", "right", "outer", "inner", "all"})};
  } else if (o.has("box_mm")) {
    const std::vector<Eigen::Vector3d> corners = o.vectors3("box_mm");
    if (corners.size() != 2) o.fail("box_mm", "must be two corners [[x,y,z],[x,y,z]]");
    region = retraction::BoxRegion{corners[0].cwiseMin(corners[1]), corners[0].cwiseMax(corners[1])};
  } else if (o.has("plane")) {
    JsonObject p = o.object("plane");
    retraction::PlaneRegion plane;
    plane.point_mm = p.vector3("point_mm");
    plane.normal = p.vector3("normal");
    if (plane.normal.norm() < 1e-12) p.fail("normal", "must not be zero");
    plane.normal.normalize();
    plane.tolerance_mm = positive(p, "tolerance_mm", p.number("tolerance_mm", 0.1));
    p.finish();
    region = plane;
  } else {
    const std::filesystem::path file = existing(o, "mask", folder);
    const int label = o.integer("label", 0);
    region = retraction::MaskRegion{file, label};
  }
  o.finish();
  return region;
}

retraction::SupportSpec readSupport(JsonObject o, const std::filesystem::path& folder) {
  retraction::SupportSpec s;
  s.region = readRegion(o.object("region"), folder);
  if (o.word("kind", {"fixed", "spring"}) == "fixed") {
    s.kind = retraction::SupportSpec::Kind::Fixed;
    if (o.has("axes")) {
      s.axes = {false, false, false};
      const nlohmann::json& axes = o.raw("axes");
      if (!axes.is_array() || axes.empty()) o.fail("axes", "must be a list out of \"x\", \"y\", \"z\"");
      for (const nlohmann::json& a : axes) {
        if (a == "x" || a == "y" || a == "z")
          s.axes[static_cast<std::size_t>(a.get<std::string>()[0] - 'x')] = true;
        else
          o.fail("axes", "must be a list out of \"x\", \"y\", \"z\"");
      }
    }
    if (o.has("displacement_mm")) s.displacement_mm = o.vector3("displacement_mm");
  } else {
    s.kind = retraction::SupportSpec::Kind::Spring;
    s.stiffness_kPa_per_mm = o.number("stiffness_kPa_per_mm");
    if (s.stiffness_kPa_per_mm < 0) o.fail("stiffness_kPa_per_mm", "must not be negative");
    s.normalOnly = o.word("direction", {"isotropic", "normal"}, "isotropic") == "normal";
  }
  o.finish();
  return s;
}

Eigen::Vector3d direction(JsonObject& o, const std::string& key, const Eigen::Vector3d& fallback) {
  if (!o.has(key)) return fallback;
  if (o.raw(key).is_string()) {
    o.word(key, {"transverse", "anterior"});
    return fallback;
  }
  const Eigen::Vector3d d = o.vector3(key);
  if (d.norm() < 1e-12) o.fail(key, "must not be zero");
  return d.normalized();
}

retraction::LoadSpec readLoad(JsonObject o, const std::filesystem::path& folder) {
  const std::string kind = o.word("kind", {"body_force", "traction", "pressure", "retractor"});
  retraction::LoadSpec load;
  if (kind == "body_force") {
    load = retraction::BodyForce{o.vector3("N_per_m3")};
  } else if (kind == "traction") {
    load = retraction::Traction{readRegion(o.object("region"), folder), o.vector3("kPa")};
  } else if (kind == "pressure") {
    load = retraction::Pressure{readRegion(o.object("region"), folder), o.number("kPa")};
  } else {
    retraction::Retractor r;
    r.diameter_mm = positive(o, "diameter_mm", o.number("diameter_mm", defaults::retractorDiameter.mm()));
    r.length_mm = positive(o, "length_mm", o.number("length_mm", 80.0));
    r.spread_mm = o.number("spread_mm", r.spread_mm);
    if (r.spread_mm < 0) o.fail("spread_mm", "must not be negative");
    if (o.has("at")) {
      if (o.raw("at").is_string())
        o.word("at", {"inferior-right-lobe"});
      else
        r.at_mm = o.vector3("at");
    }
    if (o.has("force")) {
      if (o.raw("force").is_string())
        o.word("force", {"liver-weight"});
      else
        r.force_N = o.number("force");
    }
    r.direction = direction(o, "direction", Eigen::Vector3d(0, -1, 0));
    r.axis = direction(o, "axis", Eigen::Vector3d(1, 0, 0));
    if (r.axis.cross(r.direction).norm() < 0.1) o.fail("axis", "is (nearly) parallel to the direction of the hoist");
    load = r;
  }
  o.finish();
  return load;
}

retraction::ModelSpec readModel(JsonObject o) {
  retraction::ModelSpec m;
  const std::string kind = o.word("kind", {"fem-hex", "fem-tet", "meshfree"});
  if (kind == "meshfree") {
    m.kind = retraction::ModelKind::Meshfree;
    m.meshfree.frames = o.integer("frames", 200);
    if (m.meshfree.frames < 1) o.fail("frames", "must be at least 1");
    const std::string kernel = o.word("kernel", {"voronoi", "wendland", "mls"}, "wendland");
    m.meshfree.kernel = kernel == "voronoi" ? mechanics::Kernel::Voronoi
                        : kernel == "mls"   ? mechanics::Kernel::Mls
                                            : mechanics::Kernel::Wendland;
    m.meshfree.order = o.integer("order", 1);
    if (m.meshfree.order != 1 && m.meshfree.order != 2) o.fail("order", "must be 1 (affine) or 2 (quadratic)");
  } else if (kind == "fem-hex") {
    const std::string e = o.word("element", {"H8", "H8-Bbar", "H8-incompatible"}, "H8-incompatible");
    m.element = e == "H8"        ? mechanics::HexElement::H8
                : e == "H8-Bbar" ? mechanics::HexElement::BBar
                                 : mechanics::HexElement::Incompatible;
  } else {
    m.kind = retraction::ModelKind::FemTet;
    if (o.has("order")) {
      if (o.has("element")) o.fail("order", "says the same as \"element\"; keep one of the two");
      const int order = o.integer("order", 2);
      if (order != 1 && order != 2) o.fail("order", "must be 1 (four nodes) or 2 (ten)");
      m.quadraticTets = order == 2;
    } else {
      m.quadraticTets = o.word("element", {"T4", "T10"}, "T10") == "T10";
    }
    m.delaunay = o.word("mesh", {"voxels", "delaunay"}, "voxels") == "delaunay";
    if (m.delaunay) {
      m.cell_mm = positive(o, "cell_mm", o.number("cell_mm", m.cell_mm));
      m.toolCell_mm = positive(o, "tool_cell_mm", o.number("tool_cell_mm", std::min(m.cell_mm, m.toolCell_mm)));
      if (m.toolCell_mm > m.cell_mm) o.fail("tool_cell_mm", "must not be larger than cell_mm");
    }
  }
  o.finish();
  return m;
}

retraction::AnalysisSpec readAnalysis(JsonObject o) {
  retraction::AnalysisSpec a;
  a.dynamic = o.word("kind", {"static", "dynamic"}) == "dynamic";
  if (a.dynamic) {
    a.h_ms = positive(o, "h_ms", o.number("h_ms", a.h_ms));
    a.end_s = positive(o, "end_s", o.number("end_s", a.end_s));
    if (o.has("rayleigh")) {
      const std::vector<double> r = o.numbers("rayleigh", 2);
      if (r[0] < 0 || r[1] < 0) o.fail("rayleigh", "must be two numbers, alpha (1/s) and beta (s), not negative");
      a.rayleigh = {r[0], r[1]};
    }
    a.stopWhenSteady = o.number("stop_when_steady", a.stopWhenSteady);
    if (a.stopWhenSteady < 0) o.fail("stop_when_steady", "must not be negative");
    if (a.end_s / (1e-3 * a.h_ms) > 1e7) o.fail("h_ms", "makes more than ten million steps");
  }
  o.finish();
  return a;
}

mechanics::SolverOptions readSolver(JsonObject o) {
  mechanics::SolverOptions s;
  const std::string kind = o.word("kind", {"auto", "cg", "factorised", "multigrid", "condensed"});
  s.kind = kind == "cg"           ? mechanics::SolverKind::Cg
           : kind == "factorised" ? mechanics::SolverKind::Factorised
           : kind == "multigrid"  ? mechanics::SolverKind::Multigrid
                                  : mechanics::SolverKind::Auto;
  s.iterations = o.integer("iterations", 0);
  if (s.iterations < 0) o.fail("iterations", "must not be negative");
  s.tolerance = positive(o, "tolerance", o.number("tolerance", s.tolerance));
  if (s.tolerance >= 1.0) o.fail("tolerance", "is the relative residual to reach: it must be below 1, e.g. 1e-8");
  if (kind == "cg") {
    const std::string p = o.word("preconditioner", {"none", "jacobi", "block-jacobi"}, "jacobi");
    s.preconditioner = p == "none"     ? mechanics::Preconditioner::None
                       : p == "jacobi" ? mechanics::Preconditioner::Jacobi
                                       : mechanics::Preconditioner::BlockJacobi;
  }
  o.finish();
  return s;
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

}  // namespace

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
    for (JsonObject& item : o.objects("supports")) s.setup.supports.push_back(readSupport(item, folder));
  if (o.has("loads"))
    for (JsonObject& item : o.objects("loads")) s.setup.loads.push_back(readLoad(item, folder));
  if (o.has("model")) s.setup.model = readModel(o.object("model"));
  if (s.setup.model.delaunay && s.geometry.kind == GeometrySpec::Kind::Box)
    o.fail("model",
           "asks for Delaunay tetrahedra, which follow smooth organs and would round the edges of a box: use "
           "\"mesh\": \"voxels\"");
  const std::string kinematics = o.word("kinematics", {"linear", "corotational", "hyperelastic"}, "linear");
  s.setup.kinematics = kinematics == "linear"         ? retraction::Kinematics::Linear
                       : kinematics == "corotational" ? retraction::Kinematics::Corotational
                                                      : retraction::Kinematics::Hyperelastic;
  if (o.has("analysis")) s.setup.analysis = readAnalysis(o.object("analysis"));
  if (o.has("solver")) {
    s.setup.solver = readSolver(o.object("solver"));
    s.setup.condensed = document.root["solver"]["kind"] == "condensed";
  }
  if (o.has("compare")) s.compare = readCompare(o.object("compare"));
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
