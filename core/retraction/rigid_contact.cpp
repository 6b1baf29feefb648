#include "retraction/rigid_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <unordered_map>

#include "base/error.h"
#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/follower_loads.h"
#include "mechanics/supports.h"
#include "retraction/ligaments.h"
#include "retraction/smooth_body.h"

namespace glisson::retraction {
namespace {

constexpr double mmToM = 1e-3;
constexpr double leastFraction = 0.1;  ///< of a cell, for it to be one
constexpr double sample_mm = 1.5;      ///< largest spacing of the samples of the surface
constexpr double rind_mm = 3.0;        ///< depth of the layer that stands for the capsule
constexpr double behind_mm = 400.0;    ///< from where the bar comes

struct Samples {
  std::vector<Eigen::Vector3d> p_mm, normal;  ///< LPS
  std::vector<double> area_mm2;
  std::vector<const SurfaceFace*> face;  ///< of a model without smooth body
};

/// The triangles of the smooth surface, gathered cube by cube.
Samples samplesOf(const SmoothBody& smooth) {
  const mechanics::TriangleSurface surface = smooth.surface();
  Samples s;
  std::unordered_map<std::int64_t, std::size_t> at;
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d &a = surface.vertices[static_cast<std::size_t>(t[0])],
                          &b = surface.vertices[static_cast<std::size_t>(t[1])],
                          &c = surface.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = 0.5 * (b - a).cross(c - a), middle = (a + b + c) / 3;
    const Eigen::Vector3i cube = (middle / sample_mm).array().floor().cast<int>();
    const std::int64_t key =
        (static_cast<std::int64_t>(cube.x() + 4096) << 32) | ((cube.y() + 4096) << 14) | (cube.z() + 4096);
    const auto [entry, fresh] = at.try_emplace(key, s.p_mm.size());
    if (fresh) {
      s.p_mm.emplace_back(Eigen::Vector3d::Zero());
      s.normal.emplace_back(Eigen::Vector3d::Zero());
      s.area_mm2.push_back(0.0);
    }
    const std::size_t i = entry->second;
    s.p_mm[i] += normal.norm() * middle;
    s.normal[i] += normal;
    s.area_mm2[i] += normal.norm();
  }
  for (std::size_t i = 0; i < s.p_mm.size(); ++i) {
    s.p_mm[i] /= s.area_mm2[i];
    s.normal[i].normalize();
  }
  return s;
}

/// The outer faces of the cells, each in squares of at most 1.5 mm and half an edge.
Samples samplesOf(const Body& body) {
  Samples s;
  const Eigen::Vector3d h = 1e3 * body.mesh().h_m();
  for (const SurfaceFace& f : body.surface()) {
    const int axis = f.face.side / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    const auto parts = [&](int a) { return std::max(2, static_cast<int>(std::ceil(h[a] / sample_mm))); };
    const int m = parts(first), n = parts(second);
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < n; ++j) {
        Eigen::Vector3d off = Eigen::Vector3d::Zero();
        off[first] = h[first] * ((i + 0.5) / m - 0.5);
        off[second] = h[second] * ((j + 0.5) / n - 0.5);
        s.p_mm.push_back(f.centre_mm + body.vectorToLps(off));
        s.normal.push_back(f.normal);
        s.area_mm2.push_back(1e6 * f.area_m2 / (m * n));
        s.face.push_back(&f);
      }
  }
  return s;
}

/// Modulus of each cell of a larger grid: that of the nearest filled cell, by faces.
std::vector<double> spreadModuli(const mechanics::VoxelBody& from, const Eigen::Vector3i& cells,
                                 const Eigen::Vector3i& layers, const std::vector<float>& fraction) {
  mechanics::VoxelBody to;
  to.cells = cells;
  std::vector<double> E(fraction.size(), 0.0);
  std::queue<Eigen::Vector3i> todo;
  for (int k = 0; k < from.cells.z(); ++k)
    for (int j = 0; j < from.cells.y(); ++j)
      for (int i = 0; i < from.cells.x(); ++i)
        if (const double e = from.E_Pa[from.cell(i, j, k)]; e > 0) {
          E[to.cell(i + layers.x(), j + layers.y(), k + layers.z())] = e;
          todo.push(Eigen::Vector3i(i, j, k) + layers);
        }
  while (!todo.empty()) {
    const Eigen::Vector3i c = todo.front();
    todo.pop();
    for (int side = 0; side < 6; ++side) {
      Eigen::Vector3i next = c;
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if ((next.array() < 0).any() || (next.array() >= cells.array()).any()) continue;
      const std::size_t at = to.cell(next.x(), next.y(), next.z());
      if (E[at] > 0 || static_cast<double>(fraction[at]) < leastFraction) continue;
      E[at] = E[to.cell(c.x(), c.y(), c.z())];
      todo.push(next);
    }
  }
  return E;
}

/// The largest piece of a body, by faces.
void keepLargest(mechanics::VoxelBody& body) {
  const mechanics::VoxelMesh mesh(body);
  const mechanics::Components pieces = mechanics::findComponents(mesh);
  for (int c = 0; c < mesh.cellCount(); ++c)
    if (pieces.ofCell[static_cast<std::size_t>(c)] != 0) {
      const Eigen::Vector3i at = mesh.cellOf(c);
      body.E_Pa[body.cell(at.x(), at.y(), at.z())] = 0.0;
    }
}

mechanics::VoxelBody cutCells(const Body& body, const Model& model, Eigen::Vector3i& layers) {
  mechanics::VoxelBody out = body.voxels();
  layers.setZero();
  if (!model.smooth) return out;
  const image::ScalarVolume fraction = model.smooth->fractions(model.youngs_kPa.grid);
  layers = (fraction.grid.size - out.cells) / 2;
  out.cells = fraction.grid.size;
  out.E_Pa = spreadModuli(body.voxels(), out.cells, layers, fraction.values);
  for (std::size_t i = 0; i < out.E_Pa.size(); ++i) {
    const double f = static_cast<double>(fraction.values[i]);
    out.E_Pa[i] *= f < leastFraction ? 0.0 : f;
  }
  keepLargest(out);
  return out;
}

/// Outward direction of a surface that is named by where it looks; nothing for other regions.
std::optional<Eigen::Vector3d> lookOf(const Region& region) {
  const auto* s = std::get_if<SurfaceRegion>(&region);
  if (s == nullptr) return {};
  if (s->surface == "left") return Eigen::Vector3d(1, 0, 0);
  if (s->surface == "right") return Eigen::Vector3d(-1, 0, 0);
  if (s->surface == "posterior") return Eigen::Vector3d(0, 1, 0);
  if (s->surface == "anterior") return Eigen::Vector3d(0, -1, 0);
  if (s->surface == "superior") return Eigen::Vector3d(0, 0, 1);
  if (s->surface == "inferior") return Eigen::Vector3d(0, 0, -1);
  return {};
}

void addSupports(const Body& body, const Model& model, const Setup& setup, const MechanicsScene& scene,
                 const Samples& samples, ContactScene& out) {
  const mechanics::VoxelMesh mesh(out.problem.problem.body);
  mechanics::Supports& supports = out.problem.problem.supports;
  const auto nodeOf = [&](int node) {
    const Eigen::Vector3i at = body.mesh().latticeOf(node) + out.layers;
    return mesh.nodeAt(at.x(), at.y(), at.z());
  };
  for (mechanics::Fixation f : scene.problem.supports.fixations) {
    f.node = nodeOf(f.node);
    if (f.node >= 0) supports.fixations.push_back(f);
  }
  for (const SupportSpec& s : setup.supports) {
    if (s.kind != SupportSpec::Kind::Spring || s.unilateral || !(s.stiffness_kPa_per_mm > 0)) continue;
    const double k_N_m3 = mechanics::N_m3_per_kPa_mm * s.stiffness_kPa_per_mm;
    const std::optional<Eigen::Vector3d> look = model.smooth ? lookOf(s.region) : std::nullopt;
    if (!look) {
      std::vector<mechanics::Face> faces;
      for (const SurfaceFace* f : body.faces(s.region)) faces.push_back(f->face);
      for (mechanics::Spring spring :
           mechanics::faceSprings(body.mesh(), faces, k_N_m3,
                                  s.normalOnly ? mechanics::SpringDirection::Normal : mechanics::SpringDirection::Every)) {
        spring.node = nodeOf(spring.node);
        if (spring.node >= 0) supports.springs.push_back(spring);
      }
      continue;
    }
    const Eigen::Vector3d n = body.vectorToLocal(*look);
    const Eigen::Matrix3d along = s.normalOnly ? Eigen::Matrix3d(n * n.transpose()) : Eigen::Matrix3d::Identity();
    for (std::size_t p = 0; p < samples.p_mm.size(); ++p) {
      const double seen_m2 = 1e-6 * samples.area_mm2[p] * std::max(0.0, samples.normal[p].dot(*look));
      if (seen_m2 == 0.0) continue;
      for (const auto& [node, share] : mechanics::sharesOf(mesh, out.problem.surface[p].p_m))
        supports.springs.push_back({node, share * k_N_m3 * seen_m2 * along});
    }
  }
}

/// The node at a place of the lattice, or one within three cells of it; −1 where there is none.
int nodeNear(const mechanics::VoxelMesh& mesh, const Eigen::Vector3i& at) {
  int best = mesh.nodeAt(at.x(), at.y(), at.z());
  for (int reach = 1; best < 0 && reach <= 3; ++reach)
    for (int k = -reach; k <= reach && best < 0; ++k)
      for (int j = -reach; j <= reach && best < 0; ++j)
        for (int i = -reach; i <= reach && best < 0; ++i) {
          const Eigen::Vector3i near = at + Eigen::Vector3i(i, j, k);
          if ((near.array() >= 0).all() && (near.array() <= mesh.cells().array()).all())
            best = mesh.nodeAt(near.x(), near.y(), near.z());
        }
  return best;
}

/// What only large deformation has: loads that follow their faces, springs that press only, and ligaments.
void addFollowing(const Body& body, const Setup& setup, const Eigen::Vector3d& shift_m, mechanics::ContactProblem& p) {
  const mechanics::VoxelMesh& mesh = body.mesh();
  const auto corners = [&](const SurfaceFace& f) {
    std::array<Eigen::Vector3d, 4> c;
    for (std::size_t i = 0; i < 4; ++i) c[i] = mesh.position_m(f.nodes[i]) + shift_m;
    // In turn round the face, anticlockwise seen from outside.
    const Eigen::Vector3d middle = 0.25 * (c[0] + c[1] + c[2] + c[3]), normal = mechanics::faceNormal(f.face.side);
    const Eigen::Vector3d first = c[0] - middle, second = normal.cross(first);
    std::sort(c.begin(), c.end(), [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      const auto angle = [&](const Eigen::Vector3d& v) { return std::atan2((v - middle).dot(second), (v - middle).dot(first)); };
      return angle(a) < angle(b);
    });
    return c;
  };
  for (const LoadSpec& load : setup.loads) {
    if (setup.kinematics == Kinematics::Linear) break;  // faces neither turn nor grow: their loads are dead ones
    const auto* pressure = std::get_if<Pressure>(&load);
    if (pressure != nullptr && pressure->follows)
      for (const SurfaceFace* f : body.faces(pressure->region))
        p.pressures.push_back({corners(*f), 1e3 * pressure->kPa});
    const auto* traction = std::get_if<Traction>(&load);
    if (traction == nullptr || !traction->follows) continue;
    const Eigen::Vector3d t_Pa = 1e3 * body.vectorToLocal(traction->kPa);
    for (const SurfaceFace* f : body.faces(traction->region)) {
      const Eigen::Vector3d n = mechanics::faceNormal(f->face.side);
      p.pressures.push_back({corners(*f), -t_Pa.dot(n), t_Pa - t_Pa.dot(n) * n});
    }
  }
  for (const SupportSpec& s : setup.supports)
    if (s.kind == SupportSpec::Kind::Spring && s.unilateral && s.stiffness_kPa_per_mm > 0)
      for (const SurfaceFace* f : body.faces(s.region))
        for (const int node : f->nodes) {
          const double k_N_m = 0.25 * mechanics::N_m3_per_kPa_mm * s.stiffness_kPa_per_mm * f->area_m2;
          p.bed.push_back({mesh.position_m(node) + shift_m, mechanics::faceNormal(f->face.side), k_N_m,
                           s.tangential * k_N_m});
        }
  for (const LigamentFibres& ligament : ligamentsOf(body, setup))
    for (mechanics::Tether t : ligament.fibres) {
      t.p_m += shift_m;
      t.anchor_m += shift_m;
      p.tethers.push_back(t);
    }
}

mechanics::RigidBar barOf(const Body& body, const Retractor& r, const Eigen::Vector3d& at_mm,
                          const Eigen::Vector3d& shift_m) {
  const Eigen::Vector3d hoist = r.direction.normalized();
  const Eigen::Vector3d axis = (r.patchAxis() - r.patchAxis().dot(hoist) * hoist).normalized();
  const Eigen::Vector3d along = body.vectorToLocal(axis), back = body.vectorToLocal(hoist);
  const Eigen::Vector3d centre = body.toLocal_m(at_mm - behind_mm * hoist) + shift_m;
  const double half = mmToM * r.length_mm / 2;
  mechanics::RigidBar bar;
  if (r.shape == BarShape::Hook)
    bar = mechanics::hook(centre, along, back.cross(along), 2 * half, std::numbers::pi / 2);
  else
    bar.centreline_m = {centre - half * along, centre + half * along};
  bar.radius_m = mmToM * r.diameter_mm / 2;
  bar.hoist = back;
  return bar;
}

/// What is offered in place of what refuses.
const char* offeredFor(RigidRefusal refusal) {
  switch (refusal) {
    case RigidRefusal::Model:
      return "the model \"fem-hex\"";
    case RigidRefusal::TimeSteps:
      return "the static analysis";
    case RigidRefusal::Condensed:
      return "solvers other than \"condensed\"";
    case RigidRefusal::Corotational:
      break;
  }
  return "kinematics \"hyperelastic\", \"linear\" or \"auto\"";
}

}  // namespace

std::optional<RigidRefusal> rigidRefusal(const Setup& setup) {
  if (setup.model.kind != ModelKind::FemHex) return RigidRefusal::Model;
  if (setup.analysis.dynamic) return RigidRefusal::TimeSteps;
  if (setup.condensed) return RigidRefusal::Condensed;
  if (setup.kinematics == Kinematics::Corotational) return RigidRefusal::Corotational;
  return {};
}

std::optional<Retractor> rigidBarOf(const Setup& setup) {
  const std::optional<RigidRefusal> refusal = rigidRefusal(setup);
  for (const LoadSpec& load : setup.loads) {
    const auto* r = std::get_if<Retractor>(&load);
    if (r == nullptr || r->contact == ContactKind::Patch) continue;
    if (!refusal) return *r;
    if (r->contact == ContactKind::Rigid || r->travel_mm || r->shape == BarShape::Hook)
      throw BadInput(std::string("a rigid retractor is offered for ") + offeredFor(*refusal) +
                     " only: change that, or ask for \"contact\": \"patch\" with a force");
  }
  return {};
}

bool wantsRigidBar(const Setup& setup) {
  try {
    return rigidBarOf(setup).has_value();
  } catch (const BadInput&) {
    return true;
  }
}

bool inLargeDeformation(const Setup& setup) {
  return setup.kinematics == Kinematics::Hyperelastic || rigidBarOf(setup).has_value();
}

mechanics::ContactProblem withoutBar(const Body& body, const Setup& setup, const MechanicsScene& scene) {
  mechanics::ContactProblem p;
  p.problem = scene.problem;
  p.law = setup.law.value_or(mechanics::SolidLaw::Logarithmic);
  addFollowing(body, setup, Eigen::Vector3d::Zero(), p);
  return p;
}

LargeDeformationAnswer solveWithoutBar(const Body& body, const Setup& setup, const MechanicsScene& scene,
                                       double tolerance, const Progress& progress) {
  mechanics::ContactOptions options;
  options.tolerance = tolerance;
  mechanics::ContactSolution s = mechanics::solveContact(withoutBar(body, setup, scene), options, progress);
  LargeDeformationAnswer answer;
  answer.following_N = body.vectorToLps(s.following_N);
  const std::vector<LigamentFibres> ligaments = ligamentsOf(body, setup);
  answer.ligaments = pullsOf(body, ligaments, s.tether_N);
  answer.diagnostics = estimatesOf(ligaments);
  answer.solution = std::move(s.solution);
  return answer;
}

ContactScene contactScene(const Body& body, const Model& model, const Setup& setup, const MechanicsScene& scene,
                          const Retractor& bar) {
  ContactScene out;
  mechanics::ContactProblem& p = out.problem;
  p.problem.body = cutCells(body, model, out.layers);
  const Eigen::Vector3d shift_m = out.layers.cast<double>().cwiseProduct(body.voxels().h_m);
  Samples samples = model.smooth ? samplesOf(*model.smooth) : samplesOf(body);
  for (std::size_t i = 0; i < samples.p_mm.size(); ++i)
    p.surface.push_back({body.toLocal_m(samples.p_mm[i]) + shift_m, body.vectorToLocal(samples.normal[i]),
                         1e-6 * samples.area_mm2[i]});
  addSupports(body, model, setup, scene, samples, out);
  const mechanics::VoxelMesh mesh(p.problem.body);
  p.problem.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  for (int node = 0; node < body.mesh().nodeCount(); ++node) {
    if (scene.problem.f_N.col(node).isZero(0)) continue;
    if (const int to = nodeNear(mesh, body.mesh().latticeOf(node) + out.layers); to >= 0)
      p.problem.f_N.col(to) += scene.problem.f_N.col(node);
  }
  addFollowing(body, setup, shift_m, p);
  p.law = setup.kinematics == Kinematics::Linear ? mechanics::SolidLaw::Linear
                                                  : setup.law.value_or(mechanics::SolidLaw::Polynomial);
  if (setup.capsule && setup.capsule->form == CapsuleForm::Membrane)
    p.skin = mechanics::Skin{1e3 * setup.capsule->tension_N_per_mm};
  else if (setup.capsule)
    p.rind_Pa = mechanics::rindOf(p.problem.body, p.surface, 1e3 * setup.capsule->tension_N_per_mm, mmToM * rind_mm);
  p.bar = barOf(body, bar, *bar.at_mm, shift_m);
  if (bar.travel_mm)
    p.travel_m = mmToM * *bar.travel_mm;
  else
    p.force_N = bar.force_N ? *bar.force_N : model.mass_kg * defaults::gravity_m_s2;
  out.sample_mm = std::move(samples.p_mm);
  return out;
}

mechanics::NodalField onModelNodes(const Body& body, const ContactScene& scene, const mechanics::NodalField& u_m) {
  const mechanics::VoxelMesh mesh(scene.problem.problem.body);
  const int count = body.mesh().nodeCount();
  mechanics::NodalField u = mechanics::NodalField::Zero(3, count);
  for (int node = 0; node < count; ++node)
    if (const int best = nodeNear(mesh, body.mesh().latticeOf(node) + scene.layers); best >= 0) u.col(node) = u_m.col(best);
  return u;
}

namespace {

RigidContact toRetraction(const Body& body, const ContactScene& scene, const mechanics::ContactSolution& s) {
  const auto vector = [&](const Eigen::Vector3d& v) { return body.vectorToLps(v); };
  const Eigen::Vector3d shift_m = scene.layers.cast<double>().cwiseProduct(body.voxels().h_m);
  RigidContact c;
  c.travel_mm = 1e3 * s.travel_m;
  c.capacity_N = s.capacity_N;
  c.capacityExceeded = s.capacityExceeded;
  c.slipped = s.outcome == mechanics::ContactOutcome::Slips;
  c.asked_N = scene.problem.force_N.value_or(0.0);
  c.force_N = vector(s.force_N);
  c.moment_Nm = vector(s.moment_Nm);
  c.area_mm2 = 1e6 * s.area_m2;
  c.footprint_mm2 = 1e6 * s.footprint_m2;
  c.pressureMax_kPa = 1e-3 * s.pressureMax_Pa;
  c.penetrationMax_mm = 1e3 * s.penetrationMax_m;
  c.smallestJ = s.smallestJ;
  for (const Eigen::Vector3d& p : s.bar.centreline_m) c.bar_mm.push_back(body.toLps_mm(p - shift_m));
  c.barRadius_mm = 1e3 * s.bar.radius_m;
  c.hoist = vector(s.bar.hoist);
  for (const mechanics::PathStep& step : s.path) c.path.push_back({1e3 * step.travel_m, step.force_N});
  c.sample_mm = scene.sample_mm;
  c.cut_u_m = s.solution.u_m;
  for (std::size_t i = 0; i < scene.problem.surface.size(); ++i) {
    c.sample_u_mm.push_back(1e3 * vector(s.surface_u_m.col(static_cast<Eigen::Index>(i))));
    c.sample_mm2.push_back(1e6 * scene.problem.surface[i].area_m2);
    c.pressure_kPa.push_back(1e-3 * s.pressure_Pa[i]);
  }
  return c;
}

/// The answer on the nodes of the model's own cells.
void toModelNodes(const Body& body, const ContactScene& scene, mechanics::Solution& s) {
  const mechanics::VoxelMesh mesh(scene.problem.problem.body);
  mechanics::NodalField u = onModelNodes(body, scene, s.u_m);
  mechanics::NodalField reaction = mechanics::NodalField::Zero(3, body.mesh().nodeCount());
  // Reactions keep their sum: what acts on nodes of cut cells only is added to the first node of the model.
  for (int node = 0; node < mesh.nodeCount(); ++node) {
    const Eigen::Vector3i at = mesh.latticeOf(node) - scene.layers;
    const bool inside = (at.array() >= 0).all() && (at.array() <= body.mesh().cells().array()).all();
    const int own = inside ? body.mesh().nodeAt(at.x(), at.y(), at.z()) : -1;
    reaction.col(std::max(own, 0)) += s.reaction_N.col(node);
  }
  s.u_m = std::move(u);
  s.reaction_N = std::move(reaction);
}

}  // namespace

RigidContactAnswer solveRigidContact(const Body& body, const Model& model, const Setup& setup,
                                     const MechanicsScene& scene, const Retractor& bar, const Progress& progress) {
  const ContactScene contact = contactScene(body, model, setup, scene, bar);
  mechanics::ContactOptions options;
  options.tolerance = std::max(1e-6, setup.solver.tolerance);
  mechanics::ContactSolution s = mechanics::solveContact(contact.problem, options, progress);
  RigidContactAnswer answer;
  answer.dofs = static_cast<int>(3 * s.solution.u_m.cols());
  answer.contact = toRetraction(body, contact, s);
  answer.following_N = body.vectorToLps(s.following_N);
  const std::vector<LigamentFibres> ligaments = ligamentsOf(body, setup);
  answer.ligaments = pullsOf(body, ligaments, s.tether_N);
  answer.diagnostics = estimatesOf(ligaments);
  answer.solution = std::move(s.solution);
  toModelNodes(body, contact, answer.solution);
  return answer;
}

}  // namespace glisson::retraction
