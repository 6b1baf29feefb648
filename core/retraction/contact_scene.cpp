// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <unordered_map>

#include "mechanics/contact/contact_setup.h"
#include "mechanics/contact/follower_loads.h"
#include "mechanics/supports.h"
#include "retraction/detail/contact_scene.h"
#include "retraction/ligaments.h"
#include "retraction/rigid_contact.h"
#include "retraction/smooth_body.h"

namespace glisson::retraction {
namespace {

constexpr double mmToM = 1e-3;
constexpr double leastFraction = 0.1;   ///< of a cell, for it to be one
constexpr double sample_mm = 1.5;       ///< largest spacing of the samples of the surface
constexpr double sampleOfRadius = 0.3;  ///< the same, of the bar's: none slips between them
constexpr double rind_mm = 3.0;         ///< depth of the layer that stands for the capsule

struct Samples {
  std::vector<Eigen::Vector3d> p_mm, normal;  ///< LPS
  std::vector<double> area_mm2;
  std::vector<const SurfaceFace*> face;  ///< of a model without smooth body
};

/// Largest spacing of the samples for a bar, mm.
double spacingFor(const Retractor& bar) {
  return std::min(sample_mm, sampleOfRadius * bar.diameter_mm / 2);
}

/// The triangles of the smooth surface, gathered in cubes of edge `spacing_mm`.
Samples samplesOf(const SmoothBody& smooth, double spacing_mm) {
  const mechanics::TriangleSurface& surface = smooth.surface();
  Samples s;
  std::unordered_map<std::int64_t, std::size_t> at;
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d &a = surface.vertices[static_cast<std::size_t>(t[0])],
                          &b = surface.vertices[static_cast<std::size_t>(t[1])],
                          &c = surface.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = 0.5 * (b - a).cross(c - a), middle = (a + b + c) / 3;
    const Eigen::Vector3i cube = (middle / spacing_mm).array().floor().cast<int>();
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

/// The outer faces of the cells, each in squares of at most `spacing_mm` and half an edge.
Samples samplesOf(const Body& body, double spacing_mm) {
  Samples s;
  const Eigen::Vector3d h = 1e3 * body.mesh().h_m();
  for (const SurfaceFace& f : body.surface()) {
    const int axis = f.face.side / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    const auto parts = [&](int a) { return std::max(2, static_cast<int>(std::ceil(h[a] / spacing_mm))); };
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
      for (mechanics::Spring spring : mechanics::faceSprings(
               body.mesh(), faces, k_N_m3,
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
      const auto angle = [&](const Eigen::Vector3d& v) {
        return std::atan2((v - middle).dot(second), (v - middle).dot(first));
      };
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
          p.bed.push_back(
              {mesh.position_m(node) + shift_m, mechanics::faceNormal(f->face.side), k_N_m, s.tangential * k_N_m});
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
  const Eigen::Vector3d centre = body.toLocal_m(at_mm - barBehind_mm * hoist) + shift_m;
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

}  // namespace

/// The node at a place of the lattice, or one within three cells of it; −1 where there is none.
int detail::nodeNear(const mechanics::VoxelMesh& mesh, const Eigen::Vector3i& at) {
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

mechanics::ContactProblem withoutBar(const Body& body, const Setup& setup, const MechanicsScene& scene) {
  mechanics::ContactProblem p;
  p.problem = scene.problem;
  p.law = setup.law.value_or(mechanics::SolidLaw::Logarithmic);
  addFollowing(body, setup, Eigen::Vector3d::Zero(), p);
  return p;
}

ContactScene contactScene(const Body& body, const Model& model, const Setup& setup, const MechanicsScene& scene,
                          const Retractor& bar) {
  ContactScene out;
  mechanics::ContactProblem& p = out.problem;
  p.problem.body = cutCells(body, model, out.layers);
  const Eigen::Vector3d shift_m = out.layers.cast<double>().cwiseProduct(body.voxels().h_m);
  Samples samples = model.smooth ? samplesOf(*model.smooth, spacingFor(bar)) : samplesOf(body, spacingFor(bar));
  for (std::size_t i = 0; i < samples.p_mm.size(); ++i)
    p.surface.push_back(
        {body.toLocal_m(samples.p_mm[i]) + shift_m, body.vectorToLocal(samples.normal[i]), 1e-6 * samples.area_mm2[i]});
  addSupports(body, model, setup, scene, samples, out);
  const mechanics::VoxelMesh mesh(p.problem.body);
  p.problem.f_N = mechanics::NodalField::Zero(3, mesh.nodeCount());
  for (int node = 0; node < body.mesh().nodeCount(); ++node) {
    if (scene.problem.f_N.col(node).isZero(0)) continue;
    if (const int to = detail::nodeNear(mesh, body.mesh().latticeOf(node) + out.layers); to >= 0)
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

}  // namespace glisson::retraction
