// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <cmath>

#include "mechanics/hex_element.h"

/// A law that stiffens with stretch, psi = mu/2a (e^{a (tr F'F - 3)} - 1) - mu ln J + lambda/2 (ln J)^2. Energy density
/// psi (Pa), first Piola-Kirchhoff stress P = dpsi/dF (Pa) and its derivative in a direction dF. Precondition: det F >
/// 0.
struct StiffeningLaw {
  double mu, lambda;  ///< Lame's constants for small strain, Pa (a adds nothing to them)
  double a;           ///< stiffening; 0 is neo-Hookean
  double e(const Eigen::Matrix3d& F) const { return std::exp(a * (F.squaredNorm() - 3)); }
  double psi(const Eigen::Matrix3d& F) const {
    const double lnJ = std::log(F.determinant());
    return (a > 0 ? mu / (2 * a) * (e(F) - 1) : mu / 2 * (F.squaredNorm() - 3)) - mu * lnJ + lambda / 2 * lnJ * lnJ;
  }
  Eigen::Matrix3d P(const Eigen::Matrix3d& F) const {
    return mu * e(F) * F + (lambda * std::log(F.determinant()) - mu) * F.inverse().transpose();
  }
  Eigen::Matrix3d dP(const Eigen::Matrix3d& F, const Eigen::Matrix3d& dF) const {
    const Eigen::Matrix3d inv = F.inverse().transpose();
    return mu * e(F) * (dF + 2 * a * F.cwiseProduct(dF).sum() * F) + lambda * inv.cwiseProduct(dF).sum() * inv -
           (lambda * std::log(F.determinant()) - mu) * inv * dF.transpose() * inv;
  }
};

/// Energy (J) of a box of edges h with corner displacements u (m), its gradient (N) and second derivative (N/m).
inline double element(const StiffeningLaw& law, const Eigen::Vector3d& h_m, const Eigen::Matrix<double, 3, 8>& u,
                      Eigen::MatrixXd& f, glisson::mechanics::HexMatrix& K) {
  double energy_J = 0;
  f.setZero(3, 8), K.setZero();
  for (int q = 0; q < 8; ++q) {  // 2 x 2 x 2 Gauss points
    const Eigen::Vector3d xi =
        (2 * Eigen::Vector3d(q & 1, q >> 1 & 1, q >> 2) - Eigen::Vector3d::Ones()) / std::sqrt(3.0);
    const Eigen::Matrix<double, 8, 3> G = glisson::mechanics::hexGradients(h_m, xi);
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + u * G;
    const double w_m3 = h_m.prod() / 8;
    energy_J += w_m3 * law.psi(F);
    f += w_m3 * law.P(F) * G.transpose();
    for (int column = 0; column < 24; ++column) {
      const Eigen::Matrix<double, 3, 8> dP_G =
          law.dP(F, Eigen::Vector3d::Unit(column % 3) * G.row(column / 3)) * G.transpose();
      K.col(column) += w_m3 * dP_G.reshaped();
    }
  }
  return energy_J;
}
