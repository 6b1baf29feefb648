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
  const double w = volume_m3_ / 8;
  const HexCorners u = u_m.colwise() - u_m.rowwise().mean();
  const bool wantTangent = tangent != Tangent::None;

  double meanJ1 = 0;                 // J̄ − 1
  double s = 0;                      // S/V − 3
  HexVector dJ = HexVector::Zero();  // ∂J̄/∂u
  HexVector dS = HexVector::Zero();  // ∂S/∂u
  HexMatrix ddJ, ddS;
  if (wantTangent) {
    ddJ.setZero();
    ddS.setZero();
  }
  for (const Eigen::Matrix<double, 8, 3>& G : G_) {
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
    if (!wantTangent) continue;
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
  }

  const double V = volume_m3_;
  const double J = 1 + meanJ1;
  const double L = std::log1p(meanJ1);
  const double J23 = std::exp(2.0 / 3.0 * L);
  const double y = 2.0 / 3.0 * L;
  const double growth = std::abs(y) < 1e-3 ? y * y / 2 * (1 + y / 3 * (1 + y / 4 * (1 + y / 5))) : std::expm1(y) - y;
  response.energy_J = V * (1.5 * mu * growth + 0.5 * mu * J23 * s + 0.5 * lambda * L * L);
  const double bySt = 0.5 * mu * J23;                                            // ∂W/∂S
  const double byJ = V / J * (mu * (std::expm1(y) + J23 * s / 3) + lambda * L);  // ∂W/∂J̄
  response.force_N = bySt * dS + byJ * dJ;
  if (!wantTangent) return true;

  const double bySJ = mu / 3 * J23 / J;
  const double byJJ = V / (J * J) * (mu * (1 - J23 * (3 + s) / 9) + lambda * (1 - L));
  HexMatrix& T = response.tangent_N_m;
  T.triangularView<Eigen::Lower>() = bySt * ddS + byJ * ddJ;
  T.triangularView<Eigen::StrictlyUpper>() = T.transpose();
  T += bySJ * (dS * dJ.transpose() + dJ * dS.transpose()) + byJJ * dJ * dJ.transpose();
  if (tangent == Tangent::Positive) {
    const Eigen::SelfAdjointEigenSolver<HexMatrix> eigen(T);
    const HexMatrix& Q = eigen.eigenvectors();
    T = Q * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * Q.transpose();
    T = 0.5 * (T + T.transpose()).eval();
  }
  return true;
}

}  // namespace glisson::mechanics
