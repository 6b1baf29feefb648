// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/hyperelastic.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
namespace glisson::mechanics {
namespace {

/// det(I + H) − 1 without cancellation.
double dilatation(const Eigen::Matrix3d& H) {
  const double second = 0.5 * (H.trace() * H.trace() - (H * H).trace());
  return H.trace() + (second + H.determinant());
}

/// What the energy of an element depends on, J̄ and S of the header, with derivatives by the corner displacements.
struct ElementMeans {
  double meanJ1 = 0;                 // J̄ − 1
  double s = 0;                      // S/V − 3
  HexVector dJ = HexVector::Zero();  // ∂J̄/∂u
  HexVector dS = HexVector::Zero();  // ∂S/∂u
  HexMatrix ddJ, ddS;                // lower triangles, with a tangent only

  /// Adds a Gauss point of weight w (m³) with the gradients G; false where it is inside out.
  bool add(const Eigen::Matrix<double, 8, 3>& G, const HexCorners& u, double w, bool wantTangent) {
    const Eigen::Matrix3d H = u * G;
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + H;
    const double J1 = dilatation(H);
    if (!(J1 > -1)) return false;
    const double J = 1 + J1;
    const double scale = std::exp(-2.0 / 3.0 * std::log1p(J1));       // J^{−2/3}
    const Eigen::Matrix3d e = H + H.transpose() + H * H.transpose();  // b − I
    const double I1 = 3 + e.trace();
    meanJ1 += J1 / 8;
    s += (scale * e.trace() + 3 * std::expm1(-2.0 / 3.0 * std::log1p(J1))) / 8;
    const Eigen::Matrix<double, 3, 8> g = F.inverse().transpose() * G.transpose();
    const Eigen::Matrix3d deviator = e - e.trace() / 3 * Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 3, 8> p = 2 * scale * (deviator * g);
    dJ += (J / 8 * g).reshaped();
    dS += (w * p).reshaped();
    if (!wantTangent) return true;
    const Eigen::Matrix<double, 3, 8> FG = F * G.transpose();
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b <= a; ++b) {
        const Eigen::Matrix3d gg = g.col(a) * g.col(b).transpose();
        Eigen::Matrix3d block = 2 * w * scale *
                                (G.row(a).dot(G.row(b)) * Eigen::Matrix3d::Identity() -
                                 2.0 / 3.0 * (g.col(a) * FG.col(b).transpose() + FG.col(a) * g.col(b).transpose()) +
                                 2.0 / 9.0 * I1 * gg + I1 / 3.0 * gg.transpose());
        ddS.block<3, 3>(3 * a, 3 * b) += block;
        ddJ.block<3, 3>(3 * a, 3 * b) += J / 8 * (gg - gg.transpose());
      }
    return true;
  }
};

/// The nearest matrix without negative eigenvalues.
void makePositive(HexMatrix& T) {
  const Eigen::SelfAdjointEigenSolver<HexMatrix> eigen(T);
  const HexMatrix& Q = eigen.eigenvectors();
  T = Q * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * Q.transpose();
  T = 0.5 * (T + T.transpose()).eval();
}

}  // namespace

NeoHookeanHex::NeoHookeanHex(double poisson, const Eigen::Vector3d& h_m)
    : mu_(lameMu(poisson)), lambda_(lameLambda(poisson)), volume_m3_(h_m.prod()) {
  const double point = 1 / std::sqrt(3.0);
  for (int g = 0; g < 8; ++g)
    G_[static_cast<std::size_t>(g)] =
        hexGradients(h_m, point * Eigen::Vector3d(2 * (g & 1) - 1, 2 * (g >> 1 & 1) - 1, 2 * (g >> 2 & 1) - 1));
}

bool NeoHookeanHex::evaluate(double E_Pa, const HexCorners& u_m, Tangent tangent, HexResponse& response) const {
  const double mu = E_Pa * mu_;
  const double lambda = E_Pa * lambda_;
  const double V = volume_m3_;
  const HexCorners u = u_m.colwise() - u_m.rowwise().mean();
  const bool wantTangent = tangent != Tangent::None;
  ElementMeans m;
  if (wantTangent) {
    m.ddJ.setZero();
    m.ddS.setZero();
  }
  for (const Eigen::Matrix<double, 8, 3>& G : G_)
    if (!m.add(G, u, V / 8, wantTangent)) return false;

  const double J = 1 + m.meanJ1;
  const double L = std::log1p(m.meanJ1);
  const double J23 = std::exp(2.0 / 3.0 * L);
  const double y = 2.0 / 3.0 * L;
  const double growth = std::abs(y) < 1e-3 ? y * y / 2 * (1 + y / 3 * (1 + y / 4 * (1 + y / 5))) : std::expm1(y) - y;
  response.energy_J = V * (1.5 * mu * growth + 0.5 * mu * J23 * m.s + 0.5 * lambda * L * L);
  const double bySt = 0.5 * mu * J23;                                              // ∂W/∂S
  const double byJ = V / J * (mu * (std::expm1(y) + J23 * m.s / 3) + lambda * L);  // ∂W/∂J̄
  response.force_N = bySt * m.dS + byJ * m.dJ;
  if (!wantTangent) return true;

  const double bySJ = mu / 3 * J23 / J;
  const double byJJ = V / (J * J) * (mu * (1 - J23 * (3 + m.s) / 9) + lambda * (1 - L));
  HexMatrix& T = response.tangent_N_m;
  T.triangularView<Eigen::Lower>() = bySt * m.ddS + byJ * m.ddJ;
  T.triangularView<Eigen::StrictlyUpper>() = T.transpose();
  T += bySJ * (m.dS * m.dJ.transpose() + m.dJ * m.dS.transpose()) + byJJ * m.dJ * m.dJ.transpose();
  if (tangent == Tangent::Positive) makePositive(T);
  return true;
}

}  // namespace glisson::mechanics
