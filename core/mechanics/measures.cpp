#include "mechanics/measures.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

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

double quantile(std::vector<double>& values, double q) {
  const auto place = static_cast<std::ptrdiff_t>(
      std::min(static_cast<double>(values.size() - 1), std::ceil(q * static_cast<double>(values.size())) - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
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
  std::array<Eigen::Matrix<double, 8, 3>, 9> gradients;
  gradients[0] = hexGradients(mesh.h_m(), Eigen::Vector3d::Zero());
  for (int a = 0; a < 8; ++a)
    gradients[static_cast<std::size_t>(a) + 1] =
        hexGradients(mesh.h_m(), Eigen::Vector3d(2 * (a & 1) - 1, 2 * (a >> 1 & 1) - 1, 2 * (a >> 2 & 1) - 1));
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
      double smallest = std::numeric_limits<double>::infinity();
      for (const auto& G : gradients)
        smallest = std::min(smallest, (Eigen::Matrix3d::Identity() + u * G).determinant());
      m.volumeRatio[e] = smallest;
    }
  });
  return m;
}

DeformationSummary summarise(const CellMeasures& cells, const NodalField& u_m) {
  DeformationSummary s;
  std::vector<double> strain(cells.principalStrain.begin(), cells.principalStrain.end());
  if (strain.empty()) return s;
  s.maxStrain = cells.principalStrain.maxCoeff();
  s.p95Strain = quantile(strain, 0.95);
  s.p99Strain = quantile(strain, 0.99);
  s.maxRotation_deg = cells.rotation_deg.maxCoeff();
  s.fractionAbove10 =
      static_cast<double>((cells.principalStrain.array() > 0.1).count()) / static_cast<double>(strain.size());
  s.invertedCells = static_cast<std::size_t>((cells.volumeRatio.array() <= 0).count());
  const Eigen::VectorXd length = u_m.colwise().norm();
  s.maxDisplacement_m = length.maxCoeff();
  s.meanDisplacement_m = length.mean();
  return s;
}

DeformationSummary summarise(const VoxelMesh& mesh, const NodalField& u_m, StrainMeasure measure) {
  return summarise(measureCells(mesh, u_m, measure), u_m);
}

Validity validity(const VoxelMesh& mesh, const DeformationSummary& summary) {
  Validity v;
  const auto warn = [&](const auto&... parts) {
    std::ostringstream text;
    text.precision(3);
    (text << ... << parts);
    v.warnings.push_back(text.str());
  };
  Eigen::Vector3i low = mesh.cellOf(0);
  Eigen::Vector3i high = low;
  for (int e = 0; e < mesh.cellCount(); ++e) {
    low = low.cwiseMin(mesh.cellOf(e));
    high = high.cwiseMax(mesh.cellOf(e));
  }
  const double size = (high - low + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(mesh.h_m()).norm();
  if (summary.maxDisplacement_m > size) {
    v.invalid = true;
    warn("the largest displacement (", 1e3 * summary.maxDisplacement_m, " mm) exceeds the body (", 1e3 * size,
         " mm): not a deformation");
  }
  if (summary.invertedCells > 0) {
    v.invalid = true;
    warn(summary.invertedCells, summary.invertedCells == 1 ? " cell is" : " cells are", " turned inside out");
  }
  v.linearTrusted = !v.invalid && summary.p95Strain < 0.10 && summary.maxRotation_deg < 15;
  if (summary.p95Strain >= 0.10)
    warn("outside linear elasticity: 5 % of the volume strains by more than ", 100 * summary.p95Strain,
         " % (limit 10 %)");
  if (summary.maxRotation_deg >= 15)
    warn("outside linear elasticity: material turns by up to ", summary.maxRotation_deg, " degrees (limit 15)");
  else if (summary.maxRotation_deg > 8)
    warn("material turns by up to ", summary.maxRotation_deg,
         " degrees: small-strain theory adds a spurious strain of about 1 % from 8 degrees on");
  if (summary.fractionAbove10 > 0 && summary.p95Strain < 0.10)
    warn(100 * summary.fractionAbove10, " % of the volume strains by more than 10 %");
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
