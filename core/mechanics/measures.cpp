// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/measures.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "mechanics/hex_element.h"

namespace glisson::mechanics {
namespace {

constexpr std::size_t chunk = 2048;

void checkField(const VoxelMesh& mesh, const NodalField& u_m) {
  if (u_m.cols() != mesh.nodeCount())
    throw BadArgument("a displacement of " + std::to_string(u_m.cols()) + " nodes on a mesh of " +
                      std::to_string(mesh.nodeCount()));
  if (!u_m.allFinite()) throw BadInput("the displacement is not finite at some node");
}

/// Angle of the rotation nearest to F, degrees. An inverted F has no proper one: 180.
double rotationAngle_deg(const Eigen::Matrix3d& F) {
  // Away from inversion a few Newton steps R ← ½(R + R⁻ᵀ) give the polar factor [higham1986computing].
  if (!(F.determinant() > 0)) return 180.0;
  Eigen::Matrix3d R = F;
  for (int step = 0; step < 30; ++step) {
    const Eigen::Matrix3d next = 0.5 * (R + R.inverse().transpose());
    const double change = (next - R).norm();
    R = next;
    if (change < 1e-14) break;
  }
  // sin and cos of the angle together: acos alone loses small angles.
  const Eigen::Vector3d axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(0.5 * axis.norm(), 0.5 * (R.trace() - 1)) * 180 / std::numbers::pi;
}

/// √(FᵀF) − I for F = I + H, without cancellation for small H.
Eigen::Matrix3d biot(const Eigen::Matrix3d& H) {
  const Eigen::Matrix3d twiceGreen = H + H.transpose() + H.transpose() * H;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(twiceGreen);
  const Eigen::Array3d e = eigen.eigenvalues().array().max(-1.0);
  const Eigen::Vector3d stretch = e / (1 + (1 + e).sqrt());
  return eigen.eigenvectors() * stretch.asDiagonal() * eigen.eigenvectors().transpose();
}

/// Of values in ascending order with their volumes: the first up to which there is this volume.
double quantile(const std::vector<std::pair<double, double>>& values, double volume) {
  double sum = 0.0;
  for (const auto& [value, share] : values)
    if ((sum += share) >= volume * (1 - 1e-12)) return value;
  return values.back().first;
}

}  // namespace

CellMeasures measureCells(const VoxelMesh& mesh, const NodalField& u_m, StrainMeasure measure) {
  checkField(mesh, u_m);
  CellMeasures m;
  const int count = mesh.cellCount();
  m.strain.resize(6, count);
  m.principalStrain.resize(count);
  m.rotation_deg.resize(count);
  m.volumeRatio.resize(count);
  m.meanVolumeRatio.resize(count);
  std::array<Eigen::Matrix<double, 8, 3>, 9> gradients;
  std::array<Eigen::Matrix<double, 8, 3>, 8> atGauss;  // two per axis: exact, as det F is of second order along each
  gradients[0] = hexGradients(mesh.h_m(), Eigen::Vector3d::Zero());
  for (int a = 0; a < 8; ++a) {
    const Eigen::Vector3d corner(2 * (a & 1) - 1, 2 * (a >> 1 & 1) - 1, 2 * (a >> 2 & 1) - 1);
    gradients[static_cast<std::size_t>(a) + 1] = hexGradients(mesh.h_m(), corner);
    atGauss[static_cast<std::size_t>(a)] = hexGradients(mesh.h_m(), corner / std::numbers::sqrt3);
  }
  parallelChunks(static_cast<std::size_t>(count), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const auto e = static_cast<Eigen::Index>(cell);
      const std::array<int, 8> nodes = mesh.nodesOf(static_cast<int>(cell));
      Eigen::Matrix<double, 3, 8> u;
      for (int a = 0; a < 8; ++a) u.col(a) = u_m.col(nodes[static_cast<std::size_t>(a)]);
      const Eigen::Matrix3d H = u * gradients[0];
      const Eigen::Matrix3d strain =
          measure == StrainMeasure::Small ? Eigen::Matrix3d(0.5 * (H + H.transpose())) : biot(H);
      m.strain.col(e) << strain(0, 0), strain(1, 1), strain(2, 2), strain(0, 1), strain(1, 2), strain(2, 0);
      const Eigen::Vector3d principal =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(strain, Eigen::EigenvaluesOnly).eigenvalues();
      m.principalStrain[e] = principal.cwiseAbs().maxCoeff();
      m.rotation_deg[e] = rotationAngle_deg(Eigen::Matrix3d::Identity() + H);
      double smallest = std::numeric_limits<double>::infinity(), sum = 0.0;
      for (const auto& G : gradients)
        smallest = std::min(smallest, (Eigen::Matrix3d::Identity() + u * G).determinant());
      for (const auto& G : atGauss) sum += (Eigen::Matrix3d::Identity() + u * G).determinant();
      m.volumeRatio[e] = smallest;
      m.meanVolumeRatio[e] = sum / 8;
    }
  });
  return m;
}

DeformationSummary summarise(const CellMeasures& cells, const NodalField& u_m) {
  return summarise(cells, u_m, std::vector<float>(static_cast<std::size_t>(cells.principalStrain.size()), 1.0f));
}

DeformationSummary summarise(const CellMeasures& cells, const NodalField& u_m, const std::vector<float>& covered) {
  if (covered.size() != static_cast<std::size_t>(cells.principalStrain.size()))
    throw BadArgument("summarise: " + std::to_string(covered.size()) + " shares for " +
                      std::to_string(cells.principalStrain.size()) + " cells");
  DeformationSummary s;
  std::vector<std::pair<double, double>> strains;  // strain, volume
  double volume = 0.0, above10 = 0.0, crushed = 0.0;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const double share = static_cast<double>(covered[i]);
    if (share < leastCovered) {
      ++s.cellsLeftOut;
      continue;
    }
    const auto e = static_cast<Eigen::Index>(i);
    strains.emplace_back(cells.principalStrain[e], share);
    volume += share;
    if (cells.principalStrain[e] > 0.1) above10 += share;
    s.maxStrain = std::max(s.maxStrain, cells.principalStrain[e]);
    s.maxRotation_deg = std::max(s.maxRotation_deg, cells.rotation_deg[e]);
    if (cells.volumeRatio[e] <= 0) ++s.invertedCells;
    if (cells.meanVolumeRatio[e] < 0.5) crushed += share;
  }
  if (strains.empty()) return s;
  std::sort(strains.begin(), strains.end());
  s.p95Strain = quantile(strains, 0.95 * volume);
  s.p99Strain = quantile(strains, 0.99 * volume);
  s.fractionAbove10 = above10 / volume;
  s.fractionCrushed = crushed / volume;
  const Eigen::VectorXd length = u_m.colwise().norm();
  s.maxDisplacement_m = length.maxCoeff();
  s.meanDisplacement_m = length.mean();
  return s;
}

DeformationSummary summarise(const VoxelMesh& mesh, const NodalField& u_m, StrainMeasure measure) {
  return summarise(measureCells(mesh, u_m, measure), u_m);
}

Validity validity(const VoxelMesh& mesh, const DeformationSummary& summary) {
  constexpr double strainLimit = 0.10, rotationLimit_deg = 15, noticeable_deg = 8;
  Validity v;
  Eigen::Vector3i low = mesh.cellOf(0);
  Eigen::Vector3i high = low;
  for (int e = 0; e < mesh.cellCount(); ++e) {
    low = low.cwiseMin(mesh.cellOf(e));
    high = high.cwiseMax(mesh.cellOf(e));
  }
  const double size = (high - low + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(mesh.h_m()).norm();
  if (summary.maxDisplacement_m > size) {
    v.invalid = true;
    v.said.add(DiagnosticCode::DisplacementBeyondBody,
               {{"displacement_mm", 1e3 * summary.maxDisplacement_m}, {"body_mm", 1e3 * size}});
  }
  if (summary.invertedCells > 0) {
    v.invalid = true;
    v.said.add(DiagnosticCode::CellsInsideOut, {{"cells", static_cast<std::int64_t>(summary.invertedCells)}});
  }
  v.linearTrusted = !v.invalid && summary.p95Strain < strainLimit && summary.maxRotation_deg < rotationLimit_deg;
  if (summary.p95Strain >= strainLimit)
    v.said.add(DiagnosticCode::StrainBeyondLinear,
               {{"percent", 100 * summary.p95Strain}, {"limit_percent", 100 * strainLimit}});
  if (summary.maxRotation_deg >= rotationLimit_deg)
    v.said.add(DiagnosticCode::RotationBeyondLinear,
               {{"degrees", summary.maxRotation_deg}, {"limit_degrees", rotationLimit_deg}});
  else if (summary.maxRotation_deg > noticeable_deg)
    v.said.add(DiagnosticCode::RotationNoticeable, {{"degrees", summary.maxRotation_deg}});
  if (summary.fractionAbove10 > 0 && summary.p95Strain < strainLimit)
    v.said.add(DiagnosticCode::StrainLocallyLarge, {{"percent", 100 * summary.fractionAbove10}});
  v.warnings = v.said.texts();
  return v;
}

std::optional<Eigen::Vector3d> displacementAt(const VoxelMesh& mesh, const NodalField& u_m,
                                              const Eigen::Vector3d& p_m) {
  const Eigen::Vector3d p = p_m.cwiseQuotient(mesh.h_m());  // in cells
  if (!p.allFinite()) return std::nullopt;
  const Eigen::Vector3d limit = mesh.cells().cast<double>();
  if ((p.array() < -0.5).any() || (p.array() > limit.array() + 0.5).any()) return std::nullopt;
  double best = std::numeric_limits<double>::infinity();
  std::optional<Eigen::Vector3d> found;
  const Eigen::Vector3i here = p.array().floor().cast<int>();
  for (int d = 0; d < 27; ++d) {
    const Eigen::Vector3i cell = here + Eigen::Vector3i(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
    if ((cell.array() < 0).any() || (cell.array() >= mesh.cells().array()).any()) continue;
    Eigen::Matrix<double, 3, 8> u;
    bool filled = true;
    for (int a = 0; a < 8 && filled; ++a) {
      const int node = mesh.nodeAt(cell.x() + (a & 1), cell.y() + (a >> 1 & 1), cell.z() + (a >> 2 & 1));
      filled = node >= 0;
      if (filled) u.col(a) = u_m.col(node);
    }
    if (!filled || !mesh.isFilled(cell.x(), cell.y(), cell.z())) continue;
    const Eigen::Vector3d local = p - cell.cast<double>();
    const Eigen::Vector3d inside = local.cwiseMax(0.0).cwiseMin(1.0);
    const Eigen::Vector3d beyond = local - inside;
    if (beyond.cwiseAbs().maxCoeff() > 0.5) continue;
    const double distance = beyond.cwiseProduct(mesh.h_m()).norm();
    if (distance >= best) continue;
    best = distance;
    found = u * hexShape(2 * inside - Eigen::Vector3d::Ones());
  }
  return found;
}

}  // namespace glisson::mechanics
