// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/delaunay_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "anatomy/tetrahedra.h"
#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/supports.h"
#include "mechanics/tet_element.h"
#include "mechanics/tet_solve.h"
#include "retraction/surface_points.h"

namespace glisson::retraction {
namespace {

constexpr double mToMm = 1e3;

image::Mask bodyMask(const Model& model) {
  image::Mask mask(model.youngs_kPa.grid);
  for (std::size_t i = 0; i < mask.values.size(); ++i) mask.values[i] = model.youngs_kPa.values[i] > 0 ? 1 : 0;
  return mask;
}

anatomy::TetrahedraOptions optionsFor(const Setup& setup, const MechanicsScene& scene) {
  anatomy::TetrahedraOptions o;
  o.cell_mm = setup.model.cell_mm;
  for (const LoadSpec& load : setup.loads)
    if (const auto* r = std::get_if<Retractor>(&load); r && scene.contact) {
      const Eigen::Vector3d hoist = r->direction.normalized();
      const Eigen::Vector3d half =
          0.5 * r->length_mm * (r->patchAxis() - r->patchAxis().dot(hoist) * hoist).normalized();
      o.tool = {{scene.contact->centre_mm - half, scene.contact->centre_mm + half}};
      o.toolCell_mm = std::min(o.cell_mm, setup.model.toolCell_mm);
      o.toolReach_mm = r->diameter_mm;
    }
  return o;
}

/// Calls visit(tet, lattice position, barycentric weights) for every position of a lattice (spacing h, from 0 to most)
/// in each tetrahedron, in the order of the tetrahedra. offset: of the lattice, m.
template <class Visit>
void forLatticeIn(const mechanics::TetMesh& mesh, const Eigen::Vector3d& h, const Eigen::Vector3d& offset,
                  const Eigen::Vector3i& most, Visit&& visit) {
  constexpr double slack = 1e-9;
  for (int t = 0; t < mesh.tetCount(); ++t) {
    Eigen::Matrix<double, 3, 4> x;
    for (int c = 0; c < 4; ++c) x.col(c) = (mesh.nodes_m.col(mesh.tets(c, t)) - offset).cwiseQuotient(h);
    const Eigen::Vector3i low = x.rowwise().minCoeff().array().ceil().cast<int>().max(0);
    const Eigen::Vector3i high = x.rowwise().maxCoeff().array().floor().cast<int>().min(most.array());
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c) edges.col(c) = x.col(c + 1) - x.col(0);
    const Eigen::Matrix3d inverse = edges.inverse();
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i) {
          const Eigen::Vector3d xi = inverse * (Eigen::Vector3d(i, j, k) - x.col(0));
          if (xi.minCoeff() >= -slack && xi.sum() <= 1.0 + slack) visit(t, Eigen::Vector3i(i, j, k), xi);
        }
  }
}

mechanics::TetMesh meshFor(const Body& body, const anatomy::TetrahedralMesh& made, bool quadratic) {
  mechanics::TetMesh mesh;
  mesh.nodes_m.resize(3, made.points_lps_mm.cols());
  for (Eigen::Index p = 0; p < mesh.nodes_m.cols(); ++p)
    mesh.nodes_m.col(p) = body.toLocal_m(made.points_lps_mm.col(p));
  mesh.tets = made.cells;
  if (body.vectorToLps(Eigen::Vector3d::UnitX())
          .cross(body.vectorToLps(Eigen::Vector3d::UnitY()))
          .dot(body.vectorToLps(Eigen::Vector3d::UnitZ())) < 0)
    mesh.tets.row(0).swap(mesh.tets.row(1));  // a mirrored grid turns every cell inside out

  const mechanics::VoxelBody& voxels = body.voxels();
  const auto E = [&](const Eigen::Vector3i& c) {
    return voxels.E_Pa[static_cast<std::size_t>(c.x()) +
                       static_cast<std::size_t>(voxels.cells.x()) *
                           (static_cast<std::size_t>(c.y()) +
                            static_cast<std::size_t>(voxels.cells.y()) * static_cast<std::size_t>(c.z()))];
  };
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.tetCount()), count = sum;
  forLatticeIn(mesh, voxels.h_m, 0.5 * voxels.h_m, voxels.cells - Eigen::Vector3i::Ones(),
               [&](int t, const Eigen::Vector3i& cell, const Eigen::Vector3d&) {
                 if (!(E(cell) > 0)) return;
                 sum[t] += E(cell);
                 count[t] += 1.0;
               });
  mesh.E_Pa.resize(mesh.tetCount());
  parallelChunks(static_cast<std::size_t>(mesh.tetCount()), 64, [&](std::size_t begin, std::size_t end) {
    for (auto t = static_cast<Eigen::Index>(begin); t < static_cast<Eigen::Index>(end); ++t) {
      if (count[t] > 0) {
        mesh.E_Pa[t] = sum[t] / count[t];
        continue;
      }
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (int c = 0; c < 4; ++c) middle += 0.25 * mesh.nodes_m.col(mesh.tets(c, t));
      double least = std::numeric_limits<double>::infinity();
      for (int cell = 0; cell < body.mesh().cellCount(); ++cell) {
        const Eigen::Vector3i at = body.mesh().cellOf(cell);
        const Eigen::Vector3d centre = (at.cast<double>().array() + 0.5).matrix().cwiseProduct(voxels.h_m);
        if ((centre - middle).squaredNorm() >= least) continue;
        least = (centre - middle).squaredNorm();
        mesh.E_Pa[t] = E(at);
      }
    }
  });
  return quadratic ? mechanics::withMiddles(mesh) : mesh;
}

/// Middles of the pieces of a voxel face, none longer than piece_m; grid axes.
std::vector<Eigen::Vector3d> piecesOf(const Body& body, const mechanics::Face& face, double piece_m) {
  const std::array<int, 4> n = mechanics::faceNodes(body.mesh(), face);
  const Eigen::Vector3d o = body.mesh().position_m(n[0]), u = body.mesh().position_m(n[1]) - o,
                        v = body.mesh().position_m(n[3]) - o;
  const int nu = std::max(1, static_cast<int>(std::ceil(u.norm() / piece_m))),
            nv = std::max(1, static_cast<int>(std::ceil(v.norm() / piece_m)));
  std::vector<Eigen::Vector3d> result;
  for (int a = 0; a < nu; ++a)
    for (int b = 0; b < nv; ++b) result.push_back(o + (a + 0.5) / nu * u + (b + 0.5) / nv * v);
  return result;
}

void addLoads(const Body& body, const MechanicsScene& scene, const Setup& setup, const SurfaceFinder& finder,
              double piece_m, mechanics::TetProblem& p) {
  double volume_m3 = 0.0;
  for (int t = 0; t < p.mesh.tetCount(); ++t)
    for (const mechanics::TetPoint& q : mechanics::tetPoints(p.mesh, t)) volume_m3 += q.volume_m3;
  const double keep = static_cast<double>(body.mesh().cellCount()) * body.mesh().h_m().prod() / volume_m3;
  std::vector<Eigen::Vector3d> places, force_N;
  for (std::size_t i = 0; i < setup.loads.size(); ++i) {
    if (const auto* load = std::get_if<BodyForce>(&setup.loads[i]))
      p.f_N += mechanics::bodyForce(p.mesh, keep * body.vectorToLocal(load->N_per_m3));
    for (const FaceTraction& t : scene.tractions[i]) {
      const std::vector<Eigen::Vector3d> pieces = piecesOf(body, t.face, piece_m);
      const Eigen::Vector3d each_N =
          t.traction_Pa * mechanics::faceArea_m2(body.mesh(), t.face.side) / static_cast<double>(pieces.size());
      places.insert(places.end(), pieces.begin(), pieces.end());
      force_N.insert(force_N.end(), pieces.size(), each_N);
    }
  }
  const std::vector<SurfacePoint> at = finder.nearest(places);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (const auto& [node, share] : finder.shares(at[i])) p.f_N.col(node) += share * force_N[i];
}

void addSprings(const Body& body, const Setup& setup, const SurfaceFinder& finder, double piece_m,
                mechanics::TetProblem& p) {
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Matrix3d> k_N_m;
  for (const SupportSpec& s : setup.supports) {
    if (s.kind != SupportSpec::Kind::Spring || !(s.stiffness_kPa_per_mm > 0)) continue;
    for (const SurfaceFace* f : body.faces(s.region)) {
      const std::vector<Eigen::Vector3d> pieces = piecesOf(body, f->face, piece_m);
      const Eigen::Vector3d n = mechanics::faceNormal(f->face.side);
      const Eigen::Matrix3d direction = s.normalOnly ? Eigen::Matrix3d(n * n.transpose()) : Eigen::Matrix3d::Identity();
      places.insert(places.end(), pieces.begin(), pieces.end());
      k_N_m.insert(k_N_m.end(), pieces.size(),
                   mechanics::N_m3_per_kPa_mm * s.stiffness_kPa_per_mm * f->area_m2 /
                       static_cast<double>(pieces.size()) * direction);
    }
  }
  std::map<int, Eigen::Matrix3d> sum;
  const std::vector<SurfacePoint> at = finder.nearest(places);
  for (std::size_t i = 0; i < at.size(); ++i)
    for (const auto& [node, share] : finder.shares(at[i]))
      sum.try_emplace(node, Eigen::Matrix3d::Zero()).first->second += share * k_N_m[i];
  for (const auto& [node, k] : sum) p.supports.springs.push_back({node, k});
}

void addFixations(const Body& body, const MechanicsScene& scene, mechanics::TetProblem& p) {
  if (scene.problem.supports.fixations.empty()) return;
  const auto held = [&] {
    std::vector<const mechanics::Fixation*> h(static_cast<std::size_t>(body.mesh().nodeCount()), nullptr);
    for (const mechanics::Fixation& f : scene.problem.supports.fixations) h[static_cast<std::size_t>(f.node)] = &f;
    return h;
  }();
  std::vector<char> outer(static_cast<std::size_t>(body.mesh().nodeCount()), 0);
  for (const SurfaceFace& f : body.surface())
    for (const int n : f.nodes) outer[static_cast<std::size_t>(n)] = 1;
  std::vector<int> outerNodes;
  for (int n = 0; n < body.mesh().nodeCount(); ++n)
    if (outer[static_cast<std::size_t>(n)]) outerNodes.push_back(n);
  std::vector<char> surface(static_cast<std::size_t>(p.mesh.nodeCount()), 0);
  for (const mechanics::TetFace& f : mechanics::exteriorFaces(p.mesh))
    for (const int n : mechanics::nodesOf(p.mesh, f)) surface[static_cast<std::size_t>(n)] = 1;

  std::vector<const mechanics::Fixation*> result(static_cast<std::size_t>(p.mesh.nodeCount()), nullptr);
  parallelChunks(result.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Eigen::Vector3d x = p.mesh.nodes_m.col(static_cast<Eigen::Index>(n));
      int nearest = -1;
      if (surface[n]) {
        double least = std::numeric_limits<double>::infinity();
        for (const int o : outerNodes) {
          const double away = (body.mesh().position_m(o) - x).squaredNorm();
          if (away < least) {
            least = away;
            nearest = o;
          }
        }
      } else {
        const Eigen::Vector3i at = x.cwiseQuotient(body.mesh().h_m()).array().round().cast<int>();
        nearest = body.mesh().nodeAt(at.x(), at.y(), at.z());
        if (nearest >= 0 && outer[static_cast<std::size_t>(nearest)]) nearest = -1;
      }
      if (nearest >= 0) result[n] = held[static_cast<std::size_t>(nearest)];
    }
  });
  for (std::size_t n = 0; n < result.size(); ++n)
    if (result[n]) p.supports.fixations.push_back({static_cast<int>(n), result[n]->axis, result[n]->value_m});
  if (p.supports.fixations.empty())
    throw BadInput(
        "no node of the tetrahedra lies in the region of a fixed support: enlarge it, or choose smaller cells");
}

/// Displacement at the voxel nodes.
mechanics::NodalField onVoxels(const Body& body, const mechanics::TetMesh& mesh, const SurfaceFinder& finder,
                               const mechanics::NodalField& u_m) {
  mechanics::NodalField result = mechanics::NodalField::Zero(3, body.mesh().nodeCount());
  std::vector<char> done(static_cast<std::size_t>(body.mesh().nodeCount()), 0);
  const auto at = [&](int t, const Eigen::Vector3d& xi) {
    const Eigen::VectorXd N = mechanics::tetShape(mesh.quadratic(), xi);
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    for (Eigen::Index c = 0; c < N.size(); ++c) u += N[c] * u_m.col(mesh.tets(c, t));
    return u;
  };
  forLatticeIn(mesh, body.mesh().h_m(), Eigen::Vector3d::Zero(), body.mesh().cells(),
               [&](int t, const Eigen::Vector3i& p, const Eigen::Vector3d& xi) {
                 const int node = body.mesh().nodeAt(p.x(), p.y(), p.z());
                 if (node < 0 || done[static_cast<std::size_t>(node)]) return;
                 done[static_cast<std::size_t>(node)] = 1;
                 result.col(node) = at(t, xi);
               });
  std::vector<int> outside;
  std::vector<Eigen::Vector3d> places;
  for (int node = 0; node < body.mesh().nodeCount(); ++node)
    if (!done[static_cast<std::size_t>(node)]) {
      outside.push_back(node);
      places.push_back(body.mesh().position_m(node));
    }
  const std::vector<SurfacePoint> nearest = finder.nearest(places);
  const double farthest_m = body.mesh().h_m().norm();
  for (std::size_t i = 0; i < outside.size(); ++i) {
    const SurfacePoint& s = nearest[i];
    Eigen::Vector4d weight = Eigen::Vector4d::Zero();
    const auto& corners = mechanics::tetFaces[static_cast<std::size_t>(s.face.face)];
    for (std::size_t c = 0; c < 3; ++c) weight[corners[c]] = s.weight[static_cast<Eigen::Index>(c)];
    const Eigen::Vector3d xi = weight.tail<3>();
    Eigen::Vector3d beyond = places[i] - s.p_m;
    if (beyond.norm() > farthest_m) beyond *= farthest_m / beyond.norm();
    const auto G = mechanics::tetGradients(mesh, s.face.tet, xi);
    Eigen::Vector3d u = at(s.face.tet, xi);
    for (Eigen::Index c = 0; c < G.rows(); ++c)
      u += G.row(c).dot(beyond.transpose()) * u_m.col(mesh.tets(c, s.face.tet));
    result.col(outside[i]) = u;
  }
  return result;
}

}  // namespace

DelaunayAnswer solveOnDelaunay(const Model& model, const Body& body, const MechanicsScene& scene, const Setup& setup,
                               const Progress& progress) {
  const anatomy::TetrahedraOptions options = optionsFor(setup, scene);
  const anatomy::TetrahedralMesh made = anatomy::tetrahedra(bodyMask(model), options, progress.part(0.0, 0.3));
  mechanics::TetProblem p;
  p.poisson = model.poisson;
  p.mesh = meshFor(body, made, setup.model.quadraticTets);
  p.f_N = mechanics::NodalField::Zero(3, p.mesh.nodeCount());
  const SurfaceFinder finder(p.mesh);
  const double piece_m = 0.5 * (options.tool ? options.toolCell_mm : options.cell_mm) / mToMm;
  addLoads(body, scene, setup, finder, piece_m, p);
  addSprings(body, setup, finder, piece_m, p);
  addFixations(body, scene, p);

  DelaunayAnswer answer;
  answer.solution = mechanics::solveTets(p, setup.solver, progress.part(0.3, 1.0));
  answer.dofs = 3 * p.mesh.nodeCount();
  answer.note = std::string(setup.model.quadraticTets ? "quadratic" : "linear") + " Delaunay tetrahedra: " + made.note;
  answer.solution.u_m = onVoxels(body, p.mesh, finder, answer.solution.u_m);
  return answer;
}

}  // namespace glisson::retraction
