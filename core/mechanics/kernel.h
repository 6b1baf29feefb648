// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "base/progress.h"
#include "mechanics/problem.h"
#include "mechanics/sites.h"

namespace glisson::mechanics {

/// Wendland  φ = (1−r)₊⁴ (4r+1), r = |x − xᵢ| / (α hᵢ), C² [wendland1995piecewise]; a frame acts on the part of its
/// ball
///           that is connected with its site inside the ball, so that folded lobes stay apart.
/// Voronoi   the ratio of distances to the site and to the border of its Voronoi cell, distances along paths through
///           voxels: 1 at the site, ½ at the border, 0 from the neighbouring sites on [faure2011sparse].
/// Mls       moving least squares of a polynomial through values at the sites, Wendland weights on connected balls
///           [lancaster1981surfaces]: the shape functions of the element-free Galerkin method [belytschko1994element].
///           A site carries one function (3 degrees of freedom), not a polynomial.
enum class Kernel { Wendland, Voronoi, Mls };

/// Scalar functions that a frame carries; its degrees of freedom are three times as many.
constexpr int functionsOf(Kernel kernel, int order) {
  return kernel == Kernel::Mls ? 1 : order == 1 ? 4 : 10;
}
/// Voxel nodes that a frame's Voronoi cell must hold, so that the voxels can tell its functions from the others.
constexpr int leastNodesOf(Kernel kernel, int order) {
  return kernel == Kernel::Mls ? 8 : order == 1 ? 27 : 64;
}

/// Kernel, order and reach of the shape functions of frames.
struct KernelOptions {
  Kernel kernel = Kernel::Wendland;
  int order = 1;  ///< 1: affine frames, 4 functions (12 degrees of freedom); 2: quadratic, 10 (30); Mls: of the basis
  double alpha = 0.0;  ///< support radius over spacing, not Voronoi; 0 = 2.2 affine, 1.8 quadratic; Mls 1.8 and 2.6
};

/// Scalar shape functions wᵢ(x) P_b((x − xᵢ)/hᵢ) at the voxel nodes; wᵢ = φᵢ/Σφ is a partition of unity (1e-12) and
/// P = 1, x, y, z (, x², y², z², xy, yz, zx), so every polynomial of degree `order` is reproduced exactly.
/// Mls: wᵢ(x) are the moving least squares functions (some negative), P = 1; the same holds with the polynomial's
/// values at the sites. Where the sites near a node are too few or lie in a plane, the polynomial loses the terms that
/// they cannot tell apart, quadratic ones first, and never the constant; notes() count such nodes.
class FrameBasis {
 public:
  /// Throws BadInput where order is neither 1 nor 2 or alpha is not in [1, 6] (or 0).
  FrameBasis(const VoxelMesh& mesh, Sites sites, const KernelOptions& options, const Progress& progress = {});

  int frames() const { return sites_.count(); }
  int functions() const { return functionsOf(options_.kernel, options_.order); }
  const Sites& sites() const { return sites_; }
  const KernelOptions& options() const { return options_; }
  /// nodeCount × frames, unitless, rows sum to 1; by frame and by node.
  const Eigen::SparseMatrix<double>& weights() const { return byFrame_; }
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& weightsByNode() const { return byNode_; }
  /// P_b at a point, functions() values.
  void polynomials(int frame, const Eigen::Vector3d& p_m, double* P) const {
    P[0] = 1.0;
    if (functions() == 1) return;
    const Eigen::Vector3d s = (p_m - sites_.position_m.col(frame)) / sites_.spacing_m[frame];
    P[1] = s.x(), P[2] = s.y(), P[3] = s.z();
    if (options_.order == 1) return;
    P[4] = s.x() * s.x(), P[5] = s.y() * s.y(), P[6] = s.z() * s.z();
    P[7] = s.x() * s.y(), P[8] = s.y() * s.z(), P[9] = s.z() * s.x();
  }
  const std::vector<std::string>& notes() const { return notes_; }
  /// Mls: share of the nodes that see sites in one sheet or row only, as on a body thinner than its sites are apart:
  /// what they carry cannot bend there (140 times too stiff on a plate of two cells). Other kernels: 0.
  double flatShare() const { return flatShare_; }

 private:
  using Column = std::vector<std::pair<int, double>>;  ///< {node, φ}, ascending nodes
  std::vector<Column> wendland(const VoxelMesh& mesh, const Progress& progress);
  std::vector<Column> voronoi(const VoxelMesh& mesh, const Progress& progress);
  std::vector<Column> mls(const VoxelMesh& mesh, const Progress& progress);
  /// Support radii, m: alpha times the spacing, more where a site's own nodes lie further out.
  Eigen::VectorXd radii(const VoxelMesh& mesh) const;
  /// The Wendland kernel on the part of each site's ball that is connected with the site.
  std::vector<Column> connectedBalls(const VoxelMesh& mesh, const Eigen::VectorXd& radius_m, const Progress& progress);
  Column ball(const VoxelMesh& mesh, int frame, double radius_m) const;

  Sites sites_;
  KernelOptions options_;
  Eigen::SparseMatrix<double> byFrame_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> byNode_;
  std::vector<std::string> notes_;
  double flatShare_ = 0.0;
};

}  // namespace glisson::mechanics
