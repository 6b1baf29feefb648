// SPDX-License-Identifier: GPL-3.0-or-later

// Rigid motions, the oscillator, steps of any size, and what dynamics must tend to.
#include <limits>
#include <memory>
#include <numbers>

#include "mechanics/dynamics.h"
#include "mechanics/measures.h"
#include "mechanics/meshfree.h"
#include "mechanics/static_solve.h"
#include "study/beam.h"
#include "study/detail/stability_cases.h"

namespace glisson::study {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
constexpr double g = 9.81;

Outcome freeFall(const Progress& progress) {
  mechanics::Problem p;
  p.body = solidBox({6, 5, 4}, {0.06, 0.05, 0.04}, 6e3, 0.45);
  const mechanics::VoxelMesh mesh(p.body);
  p.f_N = mechanics::bodyForce(mesh, {0, 0, -p.body.density_kg_m3 * g});
  mechanics::DynamicOptions d;
  d.h_s = 1e-3;
  d.end_s = 0.1;
  mechanics::SolverOptions s;
  s.tolerance = 1e-14;
  const mechanics::DynamicSolution r = mechanics::solveDynamic(p, d, s, progress);
  const int n = r.trajectory.steps;
  const double v = -g * d.h_s * n, x = -0.5 * g * d.h_s * d.h_s * n * (n + 1);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < r.solution.u_m.cols(); ++i) {
    const Vector3d u = r.solution.u_m.col(i), w = r.trajectory.last.v.segment<3>(3 * i);
    worst =
        std::max({worst, (u - Vector3d(0, 0, x)).norm() / std::abs(x), (w - Vector3d(0, 0, v)).norm() / std::abs(v)});
  }
  const double strain = mechanics::summarise(mesh, r.solution.u_m).maxStrain;
  Outcome o;
  o.add(r.solution.report);
  o.good = n == 100 && worst <= 1e-12 && strain <= 1e-12;
  o.detail = words("after ", n, " steps of 1 ms: x and v off by ", worst, " relative, strain ", strain);
  return o;
}

Outcome rotation(double degrees) {
  const mechanics::VoxelMesh mesh(solidBox({4, 4, 4}, {0.04, 0.04, 0.04}, 6e3, 0.45));
  const double a = degrees * std::numbers::pi / 180;
  Eigen::Matrix3d R;
  R << std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1;
  mechanics::NodalField u(3, mesh.nodeCount());
  for (int n = 0; n < mesh.nodeCount(); ++n) u.col(n) = R * mesh.position_m(n) - mesh.position_m(n);
  const mechanics::DeformationSummary s = mechanics::summarise(mesh, u);
  const mechanics::Validity v = mechanics::validity(mesh, s);
  const double spurious = 1 - std::cos(a);
  const bool flagged = !v.warnings.empty();
  Outcome o;
  o.good = std::abs(s.maxStrain - spurious) <= 1e-12 && std::abs(s.maxRotation_deg - degrees) <= 1e-6 &&
           flagged == (degrees > 8);
  o.detail = words("small strain reads ", s.maxStrain, " (1 - cos = ", spurious, "), rotation ", s.maxRotation_deg,
                   " deg, ", flagged ? "flagged" : "not flagged");
  return o;
}

mechanics::Trajectory oscillator(double k, double m, double f, double x0, double h, int steps) {
  Eigen::SparseMatrix<double> K(1, 1), M(1, 1);
  K.insert(0, 0) = k;
  M.insert(0, 0) = m;
  K.makeCompressed();
  M.makeCompressed();
  mechanics::MatrixSystem system(K, M);
  mechanics::DynamicOptions d;
  d.h_s = h;
  d.end_s = h * steps;
  return mechanics::integrate(system, VectorXd::Constant(1, f), VectorXd::Constant(1, x0), VectorXd::Zero(1), d);
}

Outcome massAndSpring(const Progress&) {
  // ω = 100 rad/s. The invariant of undamped backward Euler is ½ m v² + ½ k x².
  const double k = 1e4, m = 1.0, h = 1e-3, w = 100.0, f = 3.0;
  const mechanics::Trajectory settled = oscillator(k, m, f, 0.0, 0.01, 4000);
  const double rest = std::abs(settled.last.q[0] - f / k) / (f / k);
  double amplitude = 0.0;
  const int n = 50;
  const mechanics::Trajectory free = oscillator(k, m, 0.0, 1.0, h, n);
  const double x = free.last.q[0], v = free.last.v[0];
  amplitude = std::sqrt(x * x + v * v / (w * w)) / std::pow(1 + w * w * h * h, -0.5 * n) - 1;
  const mechanics::Trajectory stiff = oscillator(1e12, 1.0, 5.0, 0.0, 1.0, 1);
  const double once = stiff.last.q[0] / 5e-12 - 1;
  Outcome o;
  o.add(settled.worst);
  o.good = rest <= 1e-10 && std::abs(amplitude) <= 1e-10 && once <= 0 && once >= -1.1e-12;
  o.detail = words("settles at f/k to ", rest, "; amplitude after ", n, " steps off (1+w2h2)^(-n/2) by ", amplitude,
                   "; at wh = 1e6 one step reaches f/k within ", once, ", no overshoot");
  return o;
}

Outcome anyStep(const Progress& progress) {
  const mechanics::Problem p = beamProblem({}, {10, 2, 2}, Root::Clamped);
  mechanics::MeshfreeOptions mo;
  mo.frames = 3;
  const mechanics::MeshfreeModel model(p, mo);
  Outcome o;
  o.good = true;
  double growth = 0.0;
  for (int power = -9; power <= 3; ++power) {
    mechanics::DynamicOptions d;
    d.h_s = std::pow(10.0, power);
    d.end_s = 50 * d.h_s;
    const mechanics::DynamicSolution r = mechanics::solveDynamic(model, d, {}, progress);
    const double scale = std::abs(r.trajectory.energies.back().load_J) + 1e-300;
    double before = 0.0;
    for (const mechanics::StepEnergy& e : r.trajectory.energies) {
      if (!std::isfinite(e.total_J())) o.good = false;
      growth = std::max(growth, (e.total_J() - before) / scale);
      before = e.total_J();
    }
    if (!r.trajectory.last.q.allFinite()) o.good = false;
    o.add(r.solution.report);
  }
  o.good = o.good && growth <= 1e-12;
  // Order: the state at 20 ms with h, h/2, h/4.
  VectorXd q[3];
  for (int i = 0; i < 3; ++i) {
    mechanics::DynamicOptions d;
    d.h_s = 2e-4 / (1 << i);
    d.end_s = 0.02;
    q[i] = mechanics::solveDynamic(model, d, {}, progress).trajectory.last.q;
  }
  const double order = std::log2((q[0] - q[1]).norm() / (q[1] - q[2]).norm());
  o.good = o.good && order > 0.85 && order < 1.15;
  o.detail =
      words("h from 1e-9 to 1e3 s: finite, energy grows by at most ", growth, " of the work; observed order ", order);
  return o;
}

Outcome momentum(const Progress& progress, bool quick) {
  mechanics::Problem p;
  p.body = solidBox({2, 2, 2}, {0.02, 0.02, 0.02}, 6e3, 0.3);
  const auto voxels = std::make_shared<const mechanics::VoxelOperator>(p.body);
  mechanics::SolverOptions s;
  s.tolerance = 1e-14;
  mechanics::VoxelSystem system(voxels, s);
  const Eigen::Index n = system.size();
  VectorXd v0(n), q0 = VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i)
    v0[i] = 0.1 * std::sin(1.0 + 1.7 * static_cast<double>(i)) + (i % 3 == 0 ? 0.3 : 0.0);
  const auto impulse = [&](const VectorXd& v) {
    return Vector3d(voxels->applyMass(v.reshaped(3, n / 3)).rowwise().sum());
  };
  mechanics::DynamicOptions d;
  d.h_s = 1e-3;
  const int steps = quick ? 1000 : 10000;
  d.end_s = steps * d.h_s;
  const mechanics::Trajectory t = mechanics::integrate(system, VectorXd::Zero(n), q0, v0, d, progress);
  const Vector3d before = impulse(v0);
  const double drift = (impulse(t.last.v) - before).norm() / before.norm();
  Outcome o;
  o.add(t.worst);
  o.good = t.steps == steps && drift <= 1e-10;
  o.detail = words("momentum drifts by ", drift, " over ", t.steps, " steps");
  return o;
}

Outcome staticLimit(const Progress& progress) {
  const mechanics::Problem p = beamProblem({}, {15, 3, 3}, Root::Clamped);
  mechanics::SolverOptions s;
  s.tolerance = 1e-12;
  const mechanics::Solution rest = mechanics::solveStatic(p, s, progress);
  mechanics::DynamicOptions d;
  d.h_s = 0.5;
  d.end_s = 100;
  const mechanics::DynamicSolution moving = mechanics::solveDynamic(p, d, s, progress);
  const double off = relativeDifference(moving.solution.u_m, rest.u_m);
  Outcome o;
  o.add(moving.solution.report);
  o.good = off <= 1e-6;
  o.detail = words("dynamics come to rest ", off, " (relative) from the static answer");
  return o;
}

Outcome unsupportedFalls(const Progress& progress) {
  mechanics::Problem p = beamProblem({}, {10, 2, 2}, Root::Clamped);
  p.supports = {};
  mechanics::DynamicOptions d;
  d.end_s = 0.01;
  const mechanics::DynamicSolution r = mechanics::solveDynamic(p, d, {}, progress);
  Outcome o;
  o.add(r.solution.report);
  o.good = r.solution.u_m.allFinite() && r.solution.report.converged() && r.solution.u_m.row(2).maxCoeff() < 0;
  o.detail =
      words("runs: all of the body moves along the load, at least ", -1e3 * r.solution.u_m.row(2).maxCoeff(), " mm");
  return o;
}

}  // namespace

Scenes motionScenes(const StabilityOptions& options) {
  Scenes s;
  s.push_back({"free fall", "velocity grows by g h to 1e-12, no strain, x = -g h2 n(n+1)/2", freeFall});
  for (const double a : {7.9, 8.1, 30.0})
    s.push_back({words("rigid rotation by ", a, " degrees"),
                 "spurious strain cos - 1 is what it is; flagged when the rotation passes 8 degrees",
                 [a](const Progress&) { return rotation(a); }});
  s.push_back(
      {"mass and spring", "settles at f/k; amplitude (1+w2h2)^(-n/2); wh = 1e6 is static in one step", massAndSpring});
  s.push_back({"time steps 1e-9 to 1e3 s", "finite, energy never grows, first order", anyStep});
  s.push_back({"momentum of a free body", "drift at most 1e-10 over 10,000 steps",
               [q = options.quick](const Progress& p) { return momentum(p, q); }});
  s.push_back({"static limit of dynamics", "at most 1e-6 from the static answer", staticLimit});
  s.push_back({"no support, dynamic", "runs and falls", unsupportedFalls});
  return s;
}

}  // namespace glisson::study
