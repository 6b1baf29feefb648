// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/corotational.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace glisson::mechanics {
namespace {

/// cross(v) w = v × w.
Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

using Matrix3x24 = Eigen::Matrix<double, 3, 24>;

}  // namespace

std::optional<Eigen::Matrix3d> rotationLessIdentity(const Eigen::Matrix3d& H) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  if (!((I + H).determinant() > 0)) return std::nullopt;
  // R ← ½(R + R⁻ᵀ), and (I + Z)⁻ᵀ − I = −(I + Z)⁻ᵀ Zᵀ has no cancellation.
  Eigen::Matrix3d Z = H;
  for (int step = 0; step < 60; ++step) {
    const Eigen::Matrix3d next = 0.5 * (Z - (I + Z).inverse().transpose() * Z.transpose());
    const double change = (next - Z).norm();
    Z = next;
    if (!(change > 1e-16 * Z.norm())) break;
  }
  return Z;
}

CorotationalHex::CorotationalHex(const HexMatrix& K0, const Eigen::Vector3d& h_m)
    : K0_(K0), G_(hexGradients(h_m, Eigen::Vector3d::Zero())) {
  for (int a = 0; a < 8; ++a)
    X_.col(a) = (Eigen::Vector3d(a & 1, a >> 1 & 1, a >> 2 & 1) - Eigen::Vector3d::Constant(0.5)).cwiseProduct(h_m);
}

// The displacement in the turned frame is d = Rᵀ u + (R − I)ᵀ X. A change δx turns the frame by ω, with
// (tr U I − U) ω = Σ g_a × δx̃_a, δx̃ = Rᵀ δx: ω = Γ δx̃. Then δd = (I + [x̃]× Γ) δx̃ = P δx̃, and the energy's gradient
// is Pᵀ k = k − Γᵀ m with k = E K₀ d and the moment m = Σ d_a × k_a, in the turned frame.
bool CorotationalHex::evaluate(double E_Pa, const HexCorners& u_m, Tangent tangent, HexResponse& response) const {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d mean = u_m.rowwise().mean();
  const HexCorners u = u_m.colwise() - mean;
  const Eigen::Matrix3d H = u * G_;
  const std::optional<Eigen::Matrix3d> Z = rotationLessIdentity(H);
  if (!Z) return false;
  const Eigen::Matrix3d R = I + *Z;
  const HexCorners d = R.transpose() * u + Z->transpose() * X_;
  const HexVector dv = d.reshaped();
  const HexVector k = E_Pa * (K0_ * dv);
  response.energy_J = 0.5 * dv.dot(k);

  const Eigen::Matrix3d U = R.transpose() * (I + H);
  const Eigen::Matrix3d Yinverse = (U.trace() * I - U).inverse();
  Eigen::Vector3d m = Eigen::Vector3d::Zero();
  Matrix3x24 Gamma;
  for (int a = 0; a < 8; ++a) {
    m += d.col(a).cross(Eigen::Vector3d(k.segment<3>(3 * a)));
    Gamma.block<3, 3>(0, 3 * a) = Yinverse * cross(G_.row(a).transpose());
  }
  const HexVector f = k - Gamma.transpose() * m;
  for (int a = 0; a < 8; ++a) response.force_N.segment<3>(3 * a) = R * f.segment<3>(3 * a);
  if (tangent == Tangent::None) return true;

  Eigen::Matrix<double, 24, 3> S;  // δd = δx̃ + S ω
  for (int a = 0; a < 8; ++a) S.block<3, 3>(3 * a, 0) = cross(d.col(a) + X_.col(a));
  const Eigen::Matrix<double, 24, 3> KS = E_Pa * (K0_ * S);
  HexMatrix T =
      E_Pa * K0_ + KS * Gamma + Gamma.transpose() * KS.transpose() + Gamma.transpose() * (S.transpose() * KS) * Gamma;
  if (tangent == Tangent::Exact) {
    // kᵀ δ²d: the frame turns the force (Q), turns twice (C), and its own rate of turning changes (n).
    const Eigen::Vector3d n = Yinverse * m;
    Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
    Matrix3x24 B;
    HexVector t;
    for (int a = 0; a < 8; ++a) {
      const Eigen::Vector3d ka = k.segment<3>(3 * a);
      const Eigen::Vector3d g = G_.row(a).transpose();
      C += ka * (d.col(a) + X_.col(a)).transpose();
      B.block<3, 3>(0, 3 * a) = cross(ka) - g * n.transpose();
      t.segment<3>(3 * a) = g;
    }
    B += n * t.transpose();
    const Eigen::Matrix3d M = C - C.trace() * I - cross(n) * U;
    const HexMatrix GB = Gamma.transpose() * B;
    T += GB + GB.transpose() + Gamma.transpose() * (0.5 * (M + M.transpose())) * Gamma;
  }
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b <= a; ++b) {
      const Eigen::Matrix3d block = R * T.block<3, 3>(3 * a, 3 * b) * R.transpose();
      response.tangent_N_m.block<3, 3>(3 * a, 3 * b) = block;
      response.tangent_N_m.block<3, 3>(3 * b, 3 * a) = block.transpose();
    }
  return true;
}

}  // namespace glisson::mechanics
