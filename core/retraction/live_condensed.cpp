// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/live_condensed.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "mechanics/condensed.h"
#include "mechanics/static_solve.h"
#include "retraction/body.h"

namespace glisson::retraction {
namespace {

constexpr double mmPerM = 1e3;

/// The point itself, or the nearest node where it lies outside the body.
mechanics::Landmark landmarkNear(const Body& body, const Eigen::Vector3d& p_mm) {
  const Eigen::Vector3d p_m = body.toLocal_m(p_mm);
  const mechanics::VoxelMesh& mesh = body.mesh();
  const Eigen::Vector3i cell = p_m.cwiseQuotient(mesh.h_m()).array().floor().cast<int>();
  if (mesh.isFilled(cell.x(), cell.y(), cell.z())) return mechanics::landmarkAt(mesh, p_m);
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < mesh.nodeCount(); ++n) {
    const double d = (mesh.position_m(n) - p_m).squaredNorm();
    if (d < least) {
      least = d;
      nearest = n;
    }
  }
  return {{nearest}, {1.0}};
}

/// Share of the tool's force that each node takes; adds up to 1.
Eigen::RowVectorXd toolWeights(const MechanicsScene& scene, const Setup& setup, mechanics::NodalField& others_N,
                               Eigen::Vector3d& force_N) {
  Eigen::RowVectorXd weights;
  for (std::size_t i = 0; i < setup.loads.size(); ++i) {
    if (!std::holds_alternative<Retractor>(setup.loads[i])) {
      others_N += scene.loads_N[i];
      continue;
    }
    // The contact pulls everywhere in one direction, so that a nodal force is a share of the whole.
    force_N = scene.loads_N[i].rowwise().sum();
    weights = force_N.transpose() * scene.loads_N[i] / force_N.squaredNorm();
  }
  if (weights.size() == 0) throw BadInput("a retraction that follows the tool needs a load of kind \"retractor\"");
  if (!weights.allFinite()) throw BadInput("the retractor pulls with no force; give it one, or \"liver-weight\"");
  return weights;
}

}  // namespace

CondensedRetraction::CondensedRetraction(const Model& model, const Setup& setup,
                                         const std::vector<Eigen::Vector3d>& points_mm, bool everyNode,
                                         const Progress& progress) {
  const Body body(model);
  Setup still = withPatch(setup);
  still.analysis.dynamic = false;
  const MechanicsScene scene = toMechanics(body, model, still);
  const Eigen::Index nodes = body.mesh().nodeCount();
  mechanics::NodalField others_N = mechanics::NodalField::Zero(3, nodes);
  Eigen::Vector3d force_N;
  const Eigen::RowVectorXd weights = toolWeights(scene, setup, others_N, force_N);
  toolPoint_mm_ = scene.contact->centre_mm;
  sceneForce_N_ = body.vectorToLps(force_N);

  // Unit forces along L, P and S in the grid's own axes, then everything else at once.
  std::vector<mechanics::NodalField> inputs;
  for (int a = 0; a < 3; ++a) inputs.emplace_back(body.vectorToLocal(Eigen::Vector3d::Unit(a)) * weights);
  const bool constant = !others_N.isZero(0.0);
  if (constant) inputs.push_back(others_N);

  // The contact itself is watched too: its mean displacement, weighted as it pulls.
  std::vector<mechanics::Landmark> watched;
  for (const Eigen::Vector3d& p : points_mm) watched.push_back(landmarkNear(body, p));
  points_ = static_cast<int>(points_mm.size());
  dofs_ = static_cast<int>(3 * nodes);
  if (everyNode) {
    for (const mechanics::Landmark& l : mechanics::everyNode(body.mesh())) watched.push_back(l);
    for (int n = 0; n < body.mesh().nodeCount(); ++n) nodes_mm_.push_back(body.nodePosition_mm(n));
  }
  mechanics::Landmark tool;
  for (Eigen::Index n = 0; n < nodes; ++n)
    if (weights[n] != 0.0) {
      tool.nodes.push_back(static_cast<int>(n));
      tool.weights.push_back(weights[n]);
    }
  watched.push_back(tool);

  mechanics::SolverOptions options = setup.solver;
  options.element = setup.model.element;
  mechanics::StaticSolver solver(body.voxels(), scene.problem.supports, options, progress.part(0.0, 0.2));
  const mechanics::CondensedModel condensed(solver, inputs, watched, progress.part(0.2, 1.0));

  Eigen::Matrix3d toLps;
  for (int a = 0; a < 3; ++a) toLps.col(a) = body.vectorToLps(Eigen::Vector3d::Unit(a));
  Eigen::MatrixXd C = mmPerM * condensed.response();
  for (Eigen::Index row = 0; row < C.rows(); row += 3) C.middleRows<3>(row) = toLps * C.middleRows<3>(row).eval();
  const Eigen::Index rows = C.rows() - 3;
  response_mm_N_ = C.topLeftCorner(rows, 3);
  compliance_mm_N_ = C.bottomLeftCorner<3, 3>();
  constant_mm_ = constant ? Eigen::VectorXd(C.col(3).head(rows)) : Eigen::VectorXd::Zero(rows);
  if (constant) toolConstant_mm_ = C.col(3).tail<3>();
  cell_mm_ = mmPerM * body.voxels().h_m.maxCoeff();
  // A travel takes the force along the hoist that leads there.
  for (const LoadSpec& load : setup.loads)
    if (const auto* r = std::get_if<Retractor>(&load); r != nullptr && r->travel_mm) {
      const Eigen::Vector3d hoist = sceneForce_N_.normalized();
      sceneForce_N_ = (*r->travel_mm - hoist.dot(toolConstant_mm_)) / hoist.dot(compliance_mm_N_ * hoist) * hoist;
    }
  sceneTarget_.force_N = sceneForce_N_;
}

Eigen::Vector3d CondensedRetraction::forceFor(const Eigen::Vector3d& toolDisplacement_mm) const {
  return compliance_mm_N_.inverse() * (toolDisplacement_mm - toolConstant_mm_);
}

Eigen::Vector3d CondensedRetraction::toolDisplacement_mm(const Eigen::Vector3d& force_N) const {
  return compliance_mm_N_ * force_N + toolConstant_mm_;
}

LiveAnswer CondensedRetraction::follow(const LiveTarget& target) {
  force_N_ = target.force_N ? *target.force_N : forceFor(target.tool_mm);
  LiveAnswer answer;
  answer.tool_mm = toolDisplacement_mm(force_N_);
  answer.force_N = force_N_;
  return answer;
}

void CondensedRetraction::evaluate(const Eigen::Vector3d& force_N, Eigen::Matrix3Xd& u_mm) const {
  u_mm.resize(3, response_mm_N_.rows() / 3);
  Eigen::Map<Eigen::VectorXd> flat(u_mm.data(), u_mm.size());
  flat.noalias() = response_mm_N_ * force_N;
  flat += constant_mm_;
}

}  // namespace glisson::retraction
