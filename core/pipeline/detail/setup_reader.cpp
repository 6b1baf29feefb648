// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/setup_reader.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "pipeline/detail/scene_words.h"
#include "retraction/ligaments.h"

namespace glisson::pipeline::detail {

double positive(JsonObject& o, const std::string& key, double value) {
  if (!(value > 0.0)) o.fail(key, "is " + std::to_string(value) + "; it must be greater than 0");
  return value;
}

namespace {

/// The value, if it lies in the range.
double within(JsonObject& o, const std::string& key, double value, const retraction::Retractor::Range& range,
              const char* unit) {
  if (!(value >= range.least && value <= range.most)) {
    std::ostringstream text;
    text << "is " << value << " " << unit << "; it must lie between " << range.least << " and " << range.most << " "
         << unit;
    o.fail(key, text.str());
  }
  return value;
}

}  // namespace

std::filesystem::path existing(JsonObject& o, const std::string& key, const std::filesystem::path& folder) {
  const std::filesystem::path p = o.text(key);
  const std::filesystem::path full = p.is_absolute() ? p : folder / p;
  std::error_code ec;
  if (!std::filesystem::exists(full, ec))
    o.fail(key, "names a file or folder that does not exist; paths are relative to the scene file");
  return full;
}

namespace {

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

/// Force of a retractor, N; nothing for the liver's weight.
std::optional<double> forceOf(JsonObject& o) {
  if (!o.has("force")) return {};
  if (!o.raw("force").is_string()) {
    const double force_N = o.number("force");
    if (force_N < 0.0)
      o.fail("force", "must not be negative: give its size, and turn \"direction\" where the bar pulls the other way");
    within(o, "force", force_N, retraction::Retractor::forces_N, "N");
    return force_N;
  }
  o.word("force", {"liver-weight"});
  return {};
}

}  // namespace

namespace {

retraction::LigamentSpec readLigament(JsonObject& o) {
  using retraction::LigamentName;
  retraction::LigamentSpec l;
  const std::string name = o.word("name", {"falciform", "coronary", "left-triangular", "right-triangular", "other"});
  for (const LigamentName n : {LigamentName::Falciform, LigamentName::Coronary, LigamentName::LeftTriangular,
                               LigamentName::RightTriangular, LigamentName::Other})
    if (name == retraction::nameOf(n)) l.name = n;
  if (o.has("stiffness_N_per_mm"))
    l.stiffness_N_per_mm = positive(o, "stiffness_N_per_mm", o.number("stiffness_N_per_mm"));
  l.length_mm =
      positive(o, "length_mm",
               o.number("length_mm", l.name == LigamentName::Falciform ? l.falciformLength_mm : l.otherLength_mm));
  l.slack_mm = o.number("slack_mm", 0.0);
  if (l.slack_mm < 0) o.fail("slack_mm", "must not be negative: a ligament that pulls at rest has no place here");
  if (o.has("towards")) l.towards = direction(o, "towards", Eigen::Vector3d::Zero());
  l.twoSided = o.boolean("two_sided", false);
  return l;
}

}  // namespace

retraction::SupportSpec readSupport(JsonObject o, const std::filesystem::path& folder) {
  retraction::SupportSpec s;
  s.region = readRegion(o.object("region"), folder);
  const std::string kind = o.word("kind", {"fixed", "spring", "ligament"});
  if (kind == "ligament") {
    s.kind = retraction::SupportSpec::Kind::Ligament;
    s.ligament = readLigament(o);
  } else if (kind == "fixed") {
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
    s.unilateral = o.boolean("unilateral", false);
    s.tangential = o.number("tangential", 0.0);
    if (s.tangential < 0) o.fail("tangential", "must not be negative: it is a share of the spring's stiffness");
    if (s.tangential > 0 && !s.unilateral)
      o.fail("tangential",
             "is offered for springs that only press (\"unilateral\"); others hold across the surface "
             "as much as along it (\"direction\": \"isotropic\") or not at all (\"normal\")");
    s.normalOnly = o.word("direction", {"isotropic", "normal"}, "isotropic") == "normal";
  }
  o.finish();
  return s;
}

retraction::LoadSpec readLoad(JsonObject o, const std::filesystem::path& folder) {
  const std::string kind = o.word("kind", {"body_force", "traction", "pressure", "retractor"});
  retraction::LoadSpec load;
  if (kind == "body_force") {
    load = retraction::BodyForce{o.vector3("N_per_m3")};
  } else if (kind == "traction") {
    load = retraction::Traction{readRegion(o.object("region"), folder), o.vector3("kPa"), o.boolean("follows", false)};
  } else if (kind == "pressure") {
    load = retraction::Pressure{readRegion(o.object("region"), folder), o.number("kPa"), o.boolean("follows", false)};
  } else {
    retraction::Retractor r;
    using retraction::Retractor;
    r.diameter_mm = within(o, "diameter_mm", o.number("diameter_mm", defaults::retractorDiameter.mm()),
                           Retractor::diameters_mm, "mm");
    r.length_mm = within(o, "length_mm", o.number("length_mm", 80.0), Retractor::lengths_mm, "mm");
    r.spread_mm = within(o, "spread_mm", o.number("spread_mm", r.spread_mm), Retractor::spreads_mm, "mm");
    if (o.has("at")) {
      if (o.raw("at").is_string())
        o.word("at", {"inferior-right-lobe"});
      else
        r.at_mm = o.vector3("at");
    }
    if (o.has("drive")) {
      JsonObject drive = o.object("drive");
      if (o.has("force") || int{drive.has("force")} + int{drive.has("travel_mm")} != 1)
        o.fail("drive", "must hold either \"force\" or \"travel_mm\", and the retractor no \"force\" beside it");
      if (drive.has("travel_mm"))
        r.travel_mm = positive(drive, "travel_mm", drive.number("travel_mm"));
      else
        r.force_N = forceOf(drive);
      drive.finish();
    } else {
      r.force_N = forceOf(o);
    }
    r.contact.reset();
    if (o.has("contact"))
      r.contact = o.word("contact", {"rigid", "patch"}) == "rigid" ? retraction::ContactKind::Rigid
                                                                   : retraction::ContactKind::Patch;
    if (r.contact == retraction::ContactKind::Patch && r.travel_mm)
      o.fail("contact", "is \"patch\", a pressure, which has no travel: give a force, or \"contact\": \"rigid\"");
    r.shape = o.word("shape", {"straight", "hook"}, "straight") == "hook" ? retraction::BarShape::Hook
                                                                          : retraction::BarShape::Straight;
    r.direction = direction(o, "direction", Eigen::Vector3d(0, -1, 0));
    if (o.has("axis")) r.axis = direction(o, "axis", Eigen::Vector3d(1, 0, 0));
    if (r.patchAxis().cross(r.direction).norm() < 0.1)
      o.fail("axis", "is (nearly) parallel to the direction of the hoist");
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
    m.meshfree.kernel = o.named("kernel", kernelNames, mechanics::Kernel::Wendland);
    m.meshfree.order = o.integer("order", 1);
    if (m.meshfree.order != 1 && m.meshfree.order != 2) o.fail("order", "must be 1 (affine) or 2 (quadratic)");
  } else if (kind == "fem-hex") {
    m.element = o.named("element", hexElementNames, mechanics::HexElement::Incompatible);
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
    const std::string scheme = o.word("scheme", {"implicit-euler", "newmark", "generalised-alpha"}, "implicit-euler");
    for (const auto s : {mechanics::TimeScheme::Newmark, mechanics::TimeScheme::GeneralisedAlpha})
      if (scheme == mechanics::nameOf(s)) a.scheme = s;
    if (a.scheme == mechanics::TimeScheme::GeneralisedAlpha) {
      a.spectralRadius = o.number("spectral_radius", a.spectralRadius);
      if (a.spectralRadius < 0 || a.spectralRadius > 1) o.fail("spectral_radius", "must be 0 to 1");
    }
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
  std::vector<std::string> kinds = solverNames.words();
  kinds.emplace_back(condensedSolver);
  const std::string kind = o.word("kind", kinds);
  if (kind != condensedSolver) s.kind = solverNames.named(kind);
  s.iterations = o.integer("iterations", 0);
  if (s.iterations < 0) o.fail("iterations", "must not be negative");
  s.toleranceAsked = o.has("tolerance");
  s.tolerance = positive(o, "tolerance", o.number("tolerance", s.tolerance));
  if (s.tolerance >= 1.0) o.fail("tolerance", "is the relative residual to reach: it must be below 1, e.g. 1e-8");
  if (s.kind == mechanics::SolverKind::Cg)
    s.preconditioner = o.named("preconditioner", preconditionerNames, mechanics::Preconditioner::Jacobi);
  o.finish();
  return s;
}

}  // namespace glisson::pipeline::detail
