#include "pipeline/plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "image/io.h"
#include "mechanics/sites.h"
#include "pipeline/detail/needs.h"
#include "pipeline/region_file.h"
#include "retraction/offered.h"
#include "retraction/rigid_contact.h"

namespace glisson::pipeline {

namespace detail {

Needs::Needs(const Scene& s) {
  patient = s.geometry.kind == GeometrySpec::Kind::Patient;
  mre = s.material.kind == MaterialSpec::Kind::Mre;
  map = s.material.kind == MaterialSpec::Kind::Map;
  pictures = s.outputs.overlay || s.outputs.report;
  report = s.outputs.report;
  sofa = s.outputs.sofa;
  // Vessels are found in the contrast-enhanced image; pictures show them where there is such an image.
  vessels = patient && (s.outputs.vessels || pictures || sofa);
  mriValues = (patient && vessels) || pictures;
  liverSurface = pictures;
  meshfree = s.setup.model.kind == retraction::ModelKind::Meshfree;
  timeSteps = s.setup.analysis.dynamic;
  mass = timeSteps;
  damping = timeSteps && (s.setup.analysis.rayleigh[0] > 0 || s.setup.analysis.rayleigh[1] > 0);
  rigidBar = retraction::rigidBarOf(s.setup).has_value();
  const retraction::Kinematics k = s.setup.kinematics;
  newton = k != retraction::Kinematics::Linear && (k != retraction::Kinematics::Auto || rigidBar);
  uncertainty = s.uncertainty.has_value() && rigidBar;
  condensed = s.setup.condensed;
  linearBeside = newton && !timeSteps;
  discretisation = !timeSteps;
  compare = s.compare.has_value();
  cellField = pictures || compare || s.outputs.displacementField;
  for (const retraction::LoadSpec& load : s.setup.loads) {
    retractor = retractor || std::holds_alternative<retraction::Retractor>(load);
    const auto* pressure = std::get_if<retraction::Pressure>(&load);
    const auto* traction = std::get_if<retraction::Traction>(&load);
    followingLoads = followingLoads || (pressure && pressure->follows) || (traction && traction->follows);
  }
  for (const retraction::SupportSpec& support : s.setup.supports)
    ligaments = ligaments || support.kind == retraction::SupportSpec::Kind::Ligament;
}

}  // namespace detail

namespace {

struct BodySize {
  double voxels = 0.0;
  double volume_mm3 = 0.0;
  double surface_mm2 = 0.0;
};

/// Of the smooth body: staircases are 3/2 as large as a surface that faces all directions alike.
double smoothSurface_mm2(const image::Mask& mask) {
  const image::Grid& g = mask.grid;
  double stairs_mm2 = 0.0;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        if (mask.at(i, j, k) == 0) continue;
        for (int a = 0; a < 3; ++a)
          for (const int side : {-1, 1}) {
            Eigen::Vector3i beside(i, j, k);
            beside[a] += side;
            if (!g.contains(beside) || mask.at(beside) == 0) stairs_mm2 += g.voxelVolume_mm3() / g.spacing_mm[a];
          }
      }
  return stairs_mm2 / 1.5;
}

/// Exactly for a box, from the mask for a mask, for an ordinary liver of 1.5 L otherwise.
BodySize predictBody(const Scene& s) {
  const GeometrySpec& g = s.geometry;
  if (g.kind == GeometrySpec::Kind::Box)
    return {g.size_mm.cwiseQuotient(g.cell_mm).array().round().prod(), g.size_mm.prod(),
            2.0 * g.size_mm.prod() * g.size_mm.cwiseInverse().sum()};
  if (g.kind == GeometrySpec::Kind::Mask) {
    std::vector<std::string> ignored;
    const image::Mask mask = readRegion(g.file, g.label, surfaceCell_mm(g), ignored);
    double filled = 0;
    for (const std::uint8_t v : mask.values) filled += v;
    const double volume_mm3 = filled * mask.grid.voxelVolume_mm3();
    return {g.cell_mm.x() > 0 ? volume_mm3 / g.cell_mm.prod() : filled, volume_mm3, smoothSurface_mm2(mask)};
  }
  constexpr double ordinaryLiver_mm3 = 1.5e6, ordinaryLiver_mm2 = 8e4;
  const double cell_mm3 = g.cell_mm.x() > 0 ? g.cell_mm.prod() : std::pow(2.0 * defaults::mriVoxel.mm(), 3);
  return {ordinaryLiver_mm3 / cell_mm3, ordinaryLiver_mm3, ordinaryLiver_mm2};
}

/// Number of nodes, exactly for a box.
double predictNodes(const Scene& s, double cells) {
  if (s.geometry.kind == GeometrySpec::Kind::Box) {
    const Eigen::Array3d n = s.geometry.size_mm.cwiseQuotient(s.geometry.cell_mm).array().round().max(1.0);
    return (n + 1.0).prod();
  }
  return 1.1 * cells;
}

/// Frames that the voxels have room for, and what they are, in words.
struct Frames {
  int count = 0;
  double dofs = 0.0;
  std::string why;
};

Frames predictFrames(const mechanics::MeshfreeOptions& o, double nodes, double cells) {
  const int least = mechanics::leastNodesOf(o.kernel, o.order);
  Frames f;
  f.count = std::min(o.frames, mechanics::mostSites(nodes, cells, least));
  f.dofs = 3.0 * mechanics::functionsOf(o.kernel, o.order) * f.count;
  std::ostringstream t;
  if (f.count < o.frames)
    t << "at most " << f.count << " of the " << o.frames << " frames asked for";
  else
    t << f.count << " frames";
  t << (o.kernel == mechanics::Kernel::Mls       ? ", moving least squares"
        : o.kernel == mechanics::Kernel::Voronoi ? ", Voronoi kernel"
                                                 : ", Wendland kernel")
    << (o.order == 1 ? ", order 1" : ", order 2") << ": each needs at least " << least << " of about "
    << static_cast<long long>(nodes) << " voxel nodes";
  f.why = t.str();
  return f;
}

struct DelaunaySize {
  double cells = 0.0;
  double dofs = 0.0;
};

/// Delaunay tetrahedra, to 25 % from 8 to 20 mm. Inside, their number goes with volume / size³; along the surface, with
/// area / size². Both factors of both are fitted to livers, a ball and a flat ellipsoid.
DelaunaySize predictDelaunay(const Scene& s, const BodySize& body) {
  const retraction::ModelSpec& m = s.setup.model;
  double inside = body.volume_mm3 / std::pow(m.cell_mm, 3), along = body.surface_mm2 / std::pow(m.cell_mm, 2);
  for (const retraction::LoadSpec& load : s.setup.loads)
    if (const auto* bar = std::get_if<retraction::Retractor>(&load)) {
      // The bar lies on the surface: half of what is within a distance of its axis is inside the body. The size grows
      // from the bar's reach on (anatomy/tetrahedra.h).
      constexpr double growth = 0.3, step_mm = 0.5;
      for (double r = 0.5 * step_mm;; r += step_mm) {
        const double size_mm = std::min(m.cell_mm, m.toolCell_mm) + growth * std::max(0.0, r - bar->diameter_mm);
        if (size_mm >= m.cell_mm) break;
        const double area_mm2 = 2.0 * (bar->length_mm + std::numbers::pi * r) * step_mm;
        inside += 0.5 * std::numbers::pi * (2.0 * r * bar->length_mm + 4.0 * r * r) * step_mm *
                  (std::pow(size_mm, -3) - std::pow(m.cell_mm, -3));
        along += area_mm2 * (std::pow(size_mm, -2) - std::pow(m.cell_mm, -2));
      }
    }
  DelaunaySize d;
  d.cells = 10.1 * inside + 6.1 * along;
  d.dofs = 3.0 * (m.quadraticTets ? 10.2 * inside + 18.0 * along : 1.16 * inside + 3.1 * along);
  return d;
}

/// Why the retractor is no rigid bar.
std::string patchInWords(const retraction::Setup& setup) {
  const auto refusal = retraction::patchTakenFor(setup);
  return "the retractor is a patch of pressure" +
         (refusal ? ": a rigid bar is not offered for " + retraction::inWords(*refusal, setup) : std::string());
}

/// What "auto" does without a rigid bar.
std::string autoInWords(const retraction::Setup& setup) {
  const auto refusal = retraction::largeDeformationRefusal(setup);
  return refusal ? "it is not offered for " + retraction::inWords(*refusal, setup)
                 : "only if linear theory misses 0.2 mm or more, or strains leave it: then the scene is solved again";
}

/// The equations of the one solve.
std::string solveInWords(const Scene& s, const detail::Needs& n) {
  if (n.rigidBar) {
    const bool travel = std::any_of(s.setup.loads.begin(), s.setup.loads.end(), [](const retraction::LoadSpec& load) {
      const auto* bar = std::get_if<retraction::Retractor>(&load);
      return bar != nullptr && bar->travel_mm;
    });
    return std::string("contact of bar and body: the bar is moved in steps on coarse cells until it has ") +
           (travel ? "its travel" : "its force") +
           ", then balance is found on the body's own cells, each time by Newton's method" +
           (s.setup.kinematics == retraction::Kinematics::Linear ? " (the body is linear, contact is not)" : "");
  }
  if (n.newton) return "balance in the deformed shape, by Newton's method";
  return "K u = f once";
}

}  // namespace

std::vector<PlanStep> plan(const Scene& s) {
  const detail::Needs n(s);
  const BodySize body = predictBody(s);
  const bool tets = s.setup.model.kind == retraction::ModelKind::FemTet;
  const bool delaunay = tets && s.setup.model.delaunay;
  const DelaunaySize tetrahedra = delaunay ? predictDelaunay(s, body) : DelaunaySize{};
  const double cells = delaunay ? tetrahedra.cells : body.voxels;
  const double nodes = predictNodes(s, body.voxels);
  const Frames frames = predictFrames(s.setup.model.meshfree, nodes, body.voxels);
  // A T10 mesh has a node in the middle of each of the seven edges that a voxel adds.
  const double dofs = n.meshfree                            ? frames.dofs
                      : delaunay                            ? tetrahedra.dofs
                      : tets && s.setup.model.quadraticTets ? 24.0 * nodes
                                                            : 3.0 * nodes;
  // Bytes per degree of freedom of the multigrid solve (vectors, hierarchy), and seconds per degree of freedom, one
  // solve.
  const double solve_MB = 250e-6 * 3.3 * body.voxels;
  const double solve_s = 4e-6 * 3.3 * body.voxels;
  std::vector<PlanStep> steps;
  auto add = [&](std::string step, bool needed, std::string why, double seconds = 0.0, double peak_MB = 0.0) {
    steps.push_back({std::move(step), needed, std::move(why), needed ? seconds : 0.0, needed ? peak_MB : 0.0});
  };

  add("read-mri", n.patient || n.mriValues,
      n.patient
          ? (n.mriValues ? "the contours lie on it; vessels and overlays show it" : "the contours lie on its grid")
          : (n.mriValues ? "the overlays need something to warp"
                         : "the body does not come from an image, and no picture is asked for"),
      n.patient ? 1.0 : 0.1, 100);
  add("read-roi", n.patient || s.geometry.kind == GeometrySpec::Kind::Mask,
      s.geometry.kind == GeometrySpec::Kind::Box ? "the body is a box" : "it outlines the body", 0.1, 20);
  add("read-mre", n.mre, n.mre ? "the stiffness comes from it" : "the material is not \"mre\"", 0.5, 20);
  add("measure-stiffness", n.mre,
      n.mre ? "statistics of the region of interest go into the record" : "no elastogram is used", 0.05);
  add("read-map", n.map, n.map ? "the modulus of each voxel comes from it" : "the material is not a map", 0.1);
  add("vessels", n.vessels,
      n.vessels   ? "they are the landmarks that are compared"
      : n.patient ? "neither vessels nor pictures are asked for"
                  : "there is no contrast-enhanced image to find them in",
      6.0, 300);
  add("liver-surface", n.liverSurface, n.liverSurface ? "the 3-D picture shows it" : "no picture is asked for", 1.0,
      50);
  add("mesh", true,
      "about " + std::to_string(static_cast<long long>(cells)) + " cells, " +
          std::to_string(static_cast<long long>(dofs)) + " degrees of freedom",
      0.1, 40e-6 * cells);
  const bool assembled = tets || (n.newton && !n.rigidBar) || s.setup.solver.kind == mechanics::SolverKind::Factorised;
  add("place-bar", n.rigidBar,
      n.rigidBar ? "the first place on the lower right lobe that both stiffnesses bear, or the one that the scene gives"
      : n.retractor ? patchInWords(s.setup)
                    : "there is no retractor",
      2 * solve_s, 0.2 * solve_MB);
  add("capsule", n.rigidBar && s.setup.capsule.has_value(),
      !n.rigidBar        ? "there is no rigid bar that would fold the surface"
      : s.setup.capsule && s.setup.capsule->form == retraction::CapsuleForm::Cells
          ? "Glisson's capsule stiffens a layer of 3 mm below the surface, in all directions"
      : s.setup.capsule ? "Glisson's capsule carries tension along the surface"
                        : "the scene leaves it out, or the body is no liver");
  add("ligaments", n.ligaments,
      n.ligaments ? "the scene says where they are attached: fibres that pull and turn"
      : n.patient ? "the scene names none: images show neither where they are attached nor where they spring from"
                  : "the scene names none");
  add("loads-that-follow", n.followingLoads && n.newton,
      !n.followingLoads ? "no load follows its faces (\"follows\")"
      : n.newton        ? "their direction and area are those of the deformed faces, in every iteration"
                        : "in linear theory faces neither turn nor grow");
  add("assembled-stiffness-matrix", assembled,
      tets        ? "tetrahedra have no common shape: their matrix is put together"
      : n.newton  ? "the tangent changes with every iteration: it is put together anew"
      : assembled ? "the scene asks for a factorisation"
                  : "one modulus per voxel is enough: K is applied, not stored");
  add("mesh-free-frames", n.meshfree,
      n.meshfree ? frames.why
      : tets     ? "the model is tetrahedra"
                 : "the model is voxel finite elements",
      2.0, 100);
  add("mass-matrix", n.mass, n.mass ? "the analysis is dynamic" : "the analysis is static: inertia plays no part", 0.1);
  add("damping", n.damping,
      n.damping     ? "Rayleigh damping is given"
      : n.timeSteps ? "both Rayleigh coefficients are 0"
                    : "the analysis is static");
  add("solve", !n.timeSteps, n.timeSteps ? "the time steps lead to the answer" : solveInWords(s, n), solve_s, solve_MB);
  add("time-steps", n.timeSteps,
      n.timeSteps ? mechanics::nameOf(s.setup.analysis.scheme) + (" to " + std::to_string(s.setup.analysis.end_s)) + " s"
                  : "only the steady state is asked for",
      solve_s * s.setup.analysis.end_s * 1e3 / s.setup.analysis.h_ms, solve_MB);
  const bool automatic = s.setup.kinematics == retraction::Kinematics::Auto;
  add("large-deformation", n.newton,
      n.newton && automatic
          ? "a rigid bar is followed in large deformation: what linear theory would miss is known only once "
            "that answer is there, so \"auto\" does not fall back to it"
      : n.newton  ? "the kinematics are not linear"
      : automatic ? autoInWords(s.setup)
                  : "the kinematics are linear",
      10 * solve_s, 2 * solve_MB);
  add("linear-solve", n.linearBeside,
      n.linearBeside ? (n.report ? "the report shows beside the answer what linear theory would have said"
                                 : "what linear theory misses is said of every answer")
      : n.newton     ? "the analysis is dynamic"
                     : "the answer is the linear one",
      (n.compare ? 2.0 : 1.0) * solve_s, solve_MB);
  add("condensed-response", n.condensed,
      n.condensed ? "the solver is \"condensed\"" : "one load case: a response matrix would not pay");
  add("atlas-solve", n.compare,
      n.compare ? "the same load on the textbook stiffness; left out where the answer follows from the first"
                : "no comparison is asked for",
      solve_s, solve_MB);
  add("discretisation-error", n.discretisation,
      n.discretisation
          ? (n.compare
                 ? "the answers and their difference say how far their cells let them be believed: both again on cells "
                   "of twice the edge"
                 : "the answer says how far its cells let it be believed: a second solve on cells of twice the "
                   "edge")
          : "estimated for static answers only",
      (n.compare ? 2.0 : 1.0) *
          (n.meshfree ? 1.2
           : n.newton ? 1.5
                      : 0.15) *
          solve_s,
      solve_MB / 8);
  add("difference", n.compare, n.compare ? "how far apart the two place the same tissue" : "no comparison is asked for",
      0.01);
  add("uncertainty", n.uncertainty,
      n.uncertainty     ? "asked for: every source through the tangent of both answers, and some draws in full"
      : s.uncertainty   ? "asked for, and offered for a rigid bar only"
                        : "not asked for (\"uncertainty\")",
      s.uncertainty ? (n.compare ? 2.0 : 1.0) * (0.1 * (s.uncertainty->fields + 12) + s.uncertainty->checks) * solve_s : 0.0,
      2.0 * solve_MB);
  // On cells so large that the tangent, 0.7 kB for each degree of freedom, stays below 42 MB.
  add("linear-gap", !n.newton,
      n.newton     ? "the kinematics are not linear: \"linear-solve\" says what they add"
      : n.rigidBar ? "the same bar in large deformation says what linear theory misses"
                   : "one corotational correction says what linear theory misses",
      (n.compare ? 2.0 : 1.0) * (n.rigidBar ? 10.0 : 0.4) * solve_s,
      n.rigidBar ? 2 * solve_MB : std::min(60.0, 0.7e-3 * 3.3 * body.voxels));
  add("strain", n.strain, "every result says whether linear theory can be trusted", 1e-7 * cells);
  add("cell-displacements", n.cellField,
      n.cellField ? "overlays, comparison or the field itself need them" : "only probes and sums are asked for",
      1e-8 * cells);
  add("write-displacement-field", s.outputs.displacementField,
      s.outputs.displacementField ? "asked for" : "not asked for", 0.1);
  add("picture-data", n.pictures,
      n.pictures ? "what the pictures show is kept, so that \"render\" can draw it again" : "no picture is asked for",
      0.1);
  add("slice-overlay", n.pictures, n.pictures ? "asked for" : "no picture is asked for", 1.0, 50);
  add("3d-overlay", n.pictures, n.pictures ? "asked for" : "no picture is asked for: no OpenGL is started", 4.0, 200);
  add("report", n.report, n.report ? "asked for" : "not asked for", 0.2);
  add("sofa", n.sofa, n.sofa ? "asked for: the patient's node as a scene for SOFA" : "not asked for");
  return steps;
}

}  // namespace glisson::pipeline
