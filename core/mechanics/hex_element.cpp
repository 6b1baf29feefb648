// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/hex_element.h"

#include <Eigen/Cholesky>
#include <bit>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace glisson::mechanics {
namespace {

using Vector8 = Eigen::Matrix<double, 8, 1>;

/// Sign of corner a's coordinate along an axis.
double side(int a, int axis) {
  return (a >> axis & 1) != 0 ? 1.0 : -1.0;
}

/// Strain of a displacement g_c e_c with gradient g: fills column col of B.
template <class Matrix>
void strainColumn(Matrix& B, int col, int c, const Eigen::Vector3d& g) {
  if (c == 0) B.col(col) << g.x(), 0, 0, g.y(), 0, g.z();
  if (c == 1) B.col(col) << 0, g.y(), 0, g.x(), g.z(), 0;
  if (c == 2) B.col(col) << 0, 0, g.z(), 0, g.y(), g.x();
}

double walshSign(int a, int m) {
  return (std::popcount(static_cast<unsigned>(a & m)) & 1) != 0 ? -1.0 : 1.0;
}

}  // namespace

Eigen::Matrix<double, 6, 6> elasticity(double poisson) {
  const double lambda = poisson / ((1 + poisson) * (1 - 2 * poisson));
  const double mu = 0.5 / (1 + poisson);
  Eigen::Matrix<double, 6, 6> D = Eigen::Matrix<double, 6, 6>::Zero();
  D.topLeftCorner<3, 3>().setConstant(lambda);
  for (int c = 0; c < 3; ++c) {
    D(c, c) += 2 * mu;
    D(c + 3, c + 3) = mu;
  }
  return D;
}

Vector8 hexShape(const Eigen::Vector3d& xi) {
  Vector8 N;
  for (int a = 0; a < 8; ++a)
    N[a] = 0.125 * (1 + side(a, 0) * xi.x()) * (1 + side(a, 1) * xi.y()) * (1 + side(a, 2) * xi.z());
  return N;
}

Eigen::Matrix<double, 8, 3> hexGradients(const Eigen::Vector3d& h_m, const Eigen::Vector3d& xi) {
  Eigen::Matrix<double, 8, 3> G;
  for (int a = 0; a < 8; ++a)
    for (int d = 0; d < 3; ++d) {
      const int e = (d + 1) % 3;
      const int f = (d + 2) % 3;
      G(a, d) = 0.25 * side(a, d) * (1 + side(a, e) * xi[e]) * (1 + side(a, f) * xi[f]) / h_m[d];
    }
  return G;
}

Eigen::Matrix<double, 6, 24> hexStrain(const Eigen::Vector3d& h_m, const Eigen::Vector3d& xi) {
  const Eigen::Matrix<double, 8, 3> G = hexGradients(h_m, xi);
  Eigen::Matrix<double, 6, 24> B;
  for (int a = 0; a < 8; ++a)
    for (int c = 0; c < 3; ++c) strainColumn(B, 3 * a + c, c, G.row(a).transpose());
  return B;
}

HexMatrix hexStiffness(HexElement element, double poisson, const Eigen::Vector3d& h_m) {
  if (!h_m.allFinite() || (h_m.array() <= 0).any() || !(poisson > -1 && poisson < 0.5)) {
    std::ostringstream what;
    what << "hexStiffness: edges " << h_m.transpose() << " m, Poisson's ratio " << poisson
         << "; edges must be positive and the ratio between -1 and 0.5";
    throw BadArgument(what.str());
  }
  const Eigen::Matrix<double, 6, 6> D = elasticity(poisson);
  const Eigen::Matrix<double, 6, 24> B0 = hexStrain(h_m, Eigen::Vector3d::Zero());
  const double weight = h_m.prod() / 8;
  const double point = 1 / std::sqrt(3.0);
  HexMatrix K = HexMatrix::Zero();
  Eigen::Matrix<double, 24, 9> Kua = Eigen::Matrix<double, 24, 9>::Zero();
  Eigen::Matrix<double, 9, 9> Kaa = Eigen::Matrix<double, 9, 9>::Zero();
  for (int g = 0; g < 8; ++g) {
    const Eigen::Vector3d xi = point * Eigen::Vector3d(side(g, 0), side(g, 1), side(g, 2));
    Eigen::Matrix<double, 6, 24> B = hexStrain(h_m, xi);
    if (element == HexElement::BBar) {
      // The mean of the dilatation over a box is its value at the centre.
      const Eigen::Matrix<double, 1, 24> change = (B0.topRows<3>() - B.topRows<3>()).colwise().sum() / 3;
      for (int r = 0; r < 3; ++r) B.row(r) += change;
    }
    K += weight * B.transpose() * D * B;
    if (element == HexElement::Incompatible) {
      Eigen::Matrix<double, 6, 9> G;
      for (int d = 0; d < 3; ++d)
        for (int c = 0; c < 3; ++c) strainColumn(G, 3 * d + c, c, -4 * xi[d] / h_m[d] * Eigen::Vector3d::Unit(d));
      Kua += weight * B.transpose() * D * G;
      Kaa += weight * G.transpose() * D * G;
    }
  }
  if (element == HexElement::Incompatible) K -= Kua * Kaa.llt().solve(Kua.transpose());
  return 0.5 * (K + K.transpose());
}

Eigen::Matrix<double, 8, 8> hexMass(const Eigen::Vector3d& h_m) {
  Eigen::Matrix<double, 8, 8> M;
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b)
      M(a, b) = h_m.prod() / 27.0 / static_cast<double>(1 << std::popcount(static_cast<unsigned>(a ^ b)));
  return M;
}

std::array<double, 8> walshValues(const Eigen::Matrix<double, 8, 8>& M0) {
  std::array<double, 8> values{};
  for (int m = 0; m < 8; ++m) {
    double sum = 0;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) sum += walshSign(a, m) * walshSign(b, m) * M0(a, b);
    values[static_cast<std::size_t>(m)] = sum / 64;
  }
  return values;
}

std::array<Eigen::Matrix3d, 8> walshBlocks(const HexMatrix& K0) {
  std::array<Eigen::Matrix3d, 8> blocks;
  double outside = 0;
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d)
      for (int m = 0; m < 8; ++m)
        for (int n = 0; n < 8; ++n) {
          double sum = 0;
          for (int a = 0; a < 8; ++a)
            for (int b = 0; b < 8; ++b) sum += walshSign(a, m) * walshSign(b, n) * K0(3 * a + c, 3 * b + d);
          const int p = m ^ (1 << c);
          if (p == (n ^ (1 << d)))
            blocks[static_cast<std::size_t>(p)](c, d) = sum / 64;
          else
            outside = std::max(outside, std::abs(sum) / 64);
        }
  if (outside > 1e-12 * K0.cwiseAbs().maxCoeff())
    throw BadArgument("walshBlocks: the element stiffness lacks the mirror symmetry of a box");
  for (Eigen::Matrix3d& B : blocks) B = 0.5 * (B + B.transpose().eval());
  // Translation of component c is its mode m_c = 0, in block p = 2^c. Exact zeros there mean that a stiff part moving
  // with a soft one makes no force of its own by rounding, whatever the contrast.
  for (int c = 0; c < 3; ++c) {
    blocks[std::size_t{1} << c].row(c).setZero();
    blocks[std::size_t{1} << c].col(c).setZero();
  }
  return blocks;
}

}  // namespace glisson::mechanics
