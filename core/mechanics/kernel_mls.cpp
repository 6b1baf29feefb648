// SPDX-License-Identifier: GPL-3.0-or-later

// Moving least squares: the element-free Galerkin shape functions.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "mechanics/kernel.h"

namespace glisson::mechanics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A pivot or eigenvalue of the moment matrix below this share of its own size is rounding, not information.
constexpr double smallest = 1e-9;

/// Sites whose spread in one direction is below this share of their spread in another lie in a sheet or a row: no
/// polynomial of theirs can tell bending from shear.
constexpr double flatSpread = 0.15;
constexpr double flatNoted = 0.05;

/// Monomials behind the constant, linear ones first.
void monomials(const Vector3d& s, int terms, double* p) {
  p[0] = s.x(), p[1] = s.y(), p[2] = s.z();
  if (terms == 3) return;
  p[3] = s.x() * s.x(), p[4] = s.y() * s.y(), p[5] = s.z() * s.z();
  p[6] = s.x() * s.y(), p[7] = s.y() * s.z(), p[8] = s.z() * s.x();
}

/// Pseudo-inverse of a symmetric positive semi-definite matrix; size: that of a well-placed one. rank counts what is
/// kept.
MatrixXd pseudoInverse(const MatrixXd& A, double size, Eigen::Index& rank) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  VectorXd inverse = VectorXd::Zero(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    if (solver.eigenvalues()[i] > smallest * size) inverse[i] = 1.0 / solver.eigenvalues()[i], ++rank;
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

/// c with S c = b. Where S is singular: the linear terms by their own pseudo-inverse, then the quadratic ones by that
/// of what the linear terms leave, so that linear fields are kept as long as the sites show them. complete: S is
/// regular.
VectorXd coefficients(const MatrixXd& S, const VectorXd& b, bool& complete) {
  const Eigen::LLT<MatrixXd> factor(S);
  complete = factor.info() == Eigen::Success;
  for (Eigen::Index i = 0; complete && i < S.rows(); ++i) {
    const double pivot = factor.matrixLLT()(i, i);
    complete = pivot * pivot > smallest * S(i, i);
  }
  if (complete) return factor.solve(b);
  Eigen::Index rank = 0;
  const MatrixXd A = pseudoInverse(S.topLeftCorner(3, 3), S.topLeftCorner(3, 3).trace(), rank);
  if (S.rows() == 3) return A * b;
  const MatrixXd B = S.topRightCorner(3, 6), C = S.bottomRightCorner(6, 6);
  const MatrixXd schur = C - B.transpose() * A * B;
  const VectorXd quadratic =
      pseudoInverse(0.5 * (schur + schur.transpose()), C.trace(), rank) * (b.tail(6) - B.transpose() * A * b.head(3));
  VectorXd c(9);
  c << A * (b.head(3) - B * quadratic), quadratic;
  return c;
}

/// Whether weighted sites (monomials p about their mean, linear ones first) lie in a sheet or a row.
bool liesFlat(const MatrixXd& p, const VectorXd& w) {
  const Eigen::Matrix3d spread = p.topRows<3>() * w.asDiagonal() * p.topRows<3>().transpose();
  const Vector3d size = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return !(size[0] > flatSpread * flatSpread * size[2]);
}

/// Widens supports until every node lies within those of `least` sites (as the crow flies).
void reachEnoughSites(const VoxelMesh& mesh, const Sites& sites, int least, VectorXd& radius_m) {
  const auto wanted = static_cast<std::size_t>(std::min(least, sites.count()));
  const VectorXd before = radius_m;
  const auto nodes = static_cast<std::size_t>(mesh.nodeCount());
  constexpr std::size_t chunk = 512;
  std::vector<VectorXd> wider((nodes + chunk - 1) / chunk, before);
  parallelChunks(nodes, chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<std::pair<double, int>> byDistance(static_cast<std::size_t>(sites.count()));
    for (std::size_t n = begin; n < end; ++n) {
      const Vector3d x = mesh.position_m(static_cast<int>(n));
      std::size_t inside = 0;
      for (int f = 0; f < sites.count(); ++f)
        inside += 1.21 * (sites.position_m.col(f) - x).squaredNorm() < before[f] * before[f] ? 1 : 0;
      if (inside >= wanted) continue;
      for (int f = 0; f < sites.count(); ++f)
        byDistance[static_cast<std::size_t>(f)] = {(sites.position_m.col(f) - x).norm(), f};
      std::partial_sort(byDistance.begin(), byDistance.begin() + static_cast<std::ptrdiff_t>(wanted), byDistance.end());
      VectorXd& own = wider[begin / chunk];
      for (std::size_t i = 0; i < wanted; ++i)
        own[byDistance[i].second] = std::max(own[byDistance[i].second], 1.2 * byDistance[i].first);
    }
  });
  for (const VectorXd& w : wider) radius_m = radius_m.cwiseMax(w);
}

/// Weight of a site at a node.
struct Entry {
  int frame;
  double* value;
};

/// Turns the weights at a node x into moving least squares functions. Centred at the weighted mean, the constant is
/// exact whatever becomes of the rest:
/// ψᵢ = wᵢ (1 + c·(pᵢ − p̄)),  S c = −p̄,  S = Σ wᵢ (pᵢ − p̄)(pᵢ − p̄)ᵀ,  Σ wᵢ = 1, p = 0 at the node.
struct LeastSquares {
  const Sites& sites;
  int terms;
  MatrixXd p;
  VectorXd w;
  bool flat = false;      ///< the sites lie in a sheet or a row
  bool complete = false;  ///< all terms are kept

  void fit(const Vector3d& x, const std::vector<Entry>& near) {
    const auto count = static_cast<Eigen::Index>(near.size());
    p.resize(terms, count);
    w.resize(count);
    double square = 0.0, sum = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      w[i] = *near[static_cast<std::size_t>(i)].value;
      sum += w[i];
      square += w[i] * (sites.position_m.col(near[static_cast<std::size_t>(i)].frame) - x).squaredNorm();
    }
    w /= sum;
    const double length = square > 0.0 ? std::sqrt(square / sum) : 1.0;
    for (Eigen::Index i = 0; i < count; ++i)
      monomials((sites.position_m.col(near[static_cast<std::size_t>(i)].frame) - x) / length, terms, p.col(i).data());
    const VectorXd mean = p * w;
    p.colwise() -= mean;
    flat = liesFlat(p, w);
    const MatrixXd S = p * w.asDiagonal() * p.transpose();
    const VectorXd c = coefficients(S, -mean, complete);
    for (Eigen::Index i = 0; i < count; ++i) *near[static_cast<std::size_t>(i)].value = w[i] * (1.0 + c.dot(p.col(i)));
  }
};

}  // namespace

std::vector<FrameBasis::Column> FrameBasis::mls(const VoxelMesh& mesh, const Progress& progress) {
  VectorXd radius = radii(mesh);
  reachEnoughSites(mesh, sites_, options_.order == 1 ? 6 : 15, radius);
  std::vector<Column> columns = connectedBalls(mesh, radius, progress);

  std::vector<std::vector<Entry>> byNode(static_cast<std::size_t>(mesh.nodeCount()));
  for (int f = 0; f < frames(); ++f)
    for (auto& [node, phi] : columns[static_cast<std::size_t>(f)])
      byNode[static_cast<std::size_t>(node)].push_back({f, &phi});

  std::atomic<int> reduced{0}, flat{0};
  parallelChunks(byNode.size(), 64, [&](std::size_t begin, std::size_t end) {
    progress.check();
    LeastSquares least{sites_, options_.order == 1 ? 3 : 9, {}, {}};
    for (std::size_t n = begin; n < end; ++n) {
      least.fit(mesh.position_m(static_cast<int>(n)), byNode[n]);
      if (least.flat) ++flat;
      if (!least.complete) ++reduced;
    }
  });
  flatShare_ = static_cast<double>(flat) / mesh.nodeCount();
  if (flatShare_ > flatNoted)
    notes_.push_back("the sites around " + std::to_string(std::lround(100 * flatShare_)) +
                     " % of the voxel nodes lie in one sheet or row, because the body is thinner there than they are "
                     "apart: moving least squares cannot bend there and come out far too stiff. Use the kernel "
                     "\"wendland\" or \"voronoi\", finite elements, or so many frames that several lie across the "
                     "body everywhere");
  if (reduced > 0)
    notes_.push_back(std::to_string(reduced) + " of " + std::to_string(mesh.nodeCount()) +
                     " voxel nodes see too few mesh-free sites, or sites in one plane: the moving least squares fit "
                     "keeps fewer terms there. Use more frames" +
                     (options_.order == 2 ? ", or order 1" : ""));
  return columns;
}

}  // namespace glisson::mechanics
