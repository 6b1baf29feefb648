// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/contact/membrane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace glisson::mechanics {
namespace {

struct PlaneStress {
  double energy = 0;                                 ///< per area, N/m
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();  ///< 11 22 12, N/m
  Eigen::Matrix3d moduli = Eigen::Matrix3d::Zero();  ///< for strains 11 22 2·12
};

/// In-plane stress of a skin of Green's strain e (11 22 12).
PlaneStress respond(const Skin& skin, const Eigen::Vector3d& e) {
  const double nu = skin.poisson, stiff = skin.stiffness_N_m, plane = stiff / (1 - nu * nu);
  const double middle = 0.5 * (e[0] + e[1]), half = 0.5 * (e[0] - e[1]), radius = std::hypot(half, e[2]);
  const double largest = middle + radius, smallest = middle - radius;
  PlaneStress out;
  if (!skin.tensionOnly || smallest + nu * largest >= 0) {
    out.moduli << plane, plane * nu, 0, plane * nu, plane, 0, 0, 0, plane * (1 - nu) / 2;
    out.stress = out.moduli * Eigen::Vector3d(e[0], e[1], 2 * e[2]);
    out.energy = 0.5 * out.stress.dot(Eigen::Vector3d(e[0], e[1], 2 * e[2]));
    return out;
  }
  if (largest <= 0) return out;
  // Wrinkled: uniaxial tension along the direction of the largest strain.
  const double angle = 0.5 * std::atan2(e[2], half), c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector3d along(c * c, s * s, c * s), across(-2 * c * s, 2 * c * s, c * c - s * s);
  out.energy = 0.5 * stiff * largest * largest;
  out.stress = stiff * largest * along;
  // The direction turns with the strain; across: components of n⊗m + m⊗n, m across the folds' tension n.
  out.moduli = stiff * (along * along.transpose() + 0.5 * largest / (largest - smallest) * across * across.transpose());
  return out;
}

std::array<float, 8> slopesAlong(const Eigen::Vector3d& xi, const Eigen::Vector3d& h_m, const Eigen::Vector3d& t) {
  std::array<float, 8> out{};
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t i = 0; i < 2; ++i) {
      const std::array<bool, 3> upper = {i == 1, (r & 1) != 0, (r >> 1) != 0};
      double sum = 0;
      for (int axis = 0; axis < 3; ++axis) {
        double w = (upper[static_cast<std::size_t>(axis)] ? 1 : -1) / h_m[axis];
        for (int other = 0; other < 3; ++other)
          if (other != axis) w *= upper[static_cast<std::size_t>(other)] ? xi[other] : 1 - xi[other];
        sum += w * t[axis];
      }
      out[2 * r + i] = static_cast<float>(sum);
    }
  return out;
}

}  // namespace

Membrane::Membrane(const RowLattice& lattice, const Eigen::Vector3d& h_m, const std::vector<SkinSample>& samples,
                   const Skin& skin)
    : skin_(skin) {
  struct Sum {
    Eigen::Vector3d p = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double area = 0;
  };
  std::map<std::tuple<int, int, int, int>, Sum> groups;
  for (const SkinSample& s : samples) {
    int axis = 0;
    s.normal.cwiseAbs().maxCoeff(&axis);
    Sum& sum = groups[{s.cell.z(), s.cell.y(), s.cell.x(), 2 * axis + (s.normal[axis] > 0 ? 1 : 0)}];
    sum.p += s.area_m2 * s.p_m;
    sum.normal += s.area_m2 * s.normal;
    sum.area += s.area_m2;
  }
  for (const auto& [key, sum] : groups) {
    if (!(sum.area > 0) || !(sum.normal.norm() > 0)) continue;
    const Eigen::Vector3i cell(std::get<2>(key), std::get<1>(key), std::get<0>(key));
    const Eigen::Vector3d xi =
        ((sum.p / sum.area).cwiseQuotient(h_m) - cell.cast<double>()).cwiseMax(0.0).cwiseMin(1.0);
    Patch patch;
    const Eigen::Vector3d n = sum.normal.normalized();
    patch.tangent.col(0) = n.unitOrthogonal();
    patch.tangent.col(1) = n.cross(patch.tangent.col(0));
    patch.area_m2 = sum.area;
    for (int r = 0; r < 4; ++r)
      patch.slot[static_cast<std::size_t>(r)] =
          static_cast<std::uint32_t>(lattice.slot(cell.x(), cell.y() + (r & 1), cell.z() + (r >> 1)));
    for (int t = 0; t < 2; ++t) patch.slope[static_cast<std::size_t>(t)] = slopesAlong(xi, h_m, patch.tangent.col(t));
    patches_.push_back(patch);
  }
}

Eigen::Matrix<double, 3, 2> Membrane::deformed(const Patch& patch, const double* u, std::size_t nodes) const {
  Eigen::Matrix<double, 3, 2> a = patch.tangent;
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t i = 0; i < 2; ++i) {
      const double* at = u + patch.slot[r] + i;
      const Eigen::Vector3d v(at[0], at[nodes], at[2 * nodes]);
      a.col(0) += static_cast<double>(patch.slope[0][2 * r + i]) * v;
      a.col(1) += static_cast<double>(patch.slope[1][2 * r + i]) * v;
    }
  return a;
}

namespace {

Eigen::Vector3d greenStrain(const Eigen::Matrix<double, 3, 2>& a) {
  return {0.5 * (a.col(0).squaredNorm() - 1), 0.5 * (a.col(1).squaredNorm() - 1), 0.5 * a.col(0).dot(a.col(1))};
}

}  // namespace

double Membrane::addForces(const double* u, std::size_t nodes, double* gradient) const {
  double energy = 0;
  for (const Patch& patch : patches_) {
    const Eigen::Matrix<double, 3, 2> a = deformed(patch, u, nodes);
    const PlaneStress s = respond(skin_, greenStrain(a));
    energy += patch.area_m2 * s.energy;
    const Eigen::Vector3d first = patch.area_m2 * (s.stress[0] * a.col(0) + s.stress[2] * a.col(1));
    const Eigen::Vector3d second = patch.area_m2 * (s.stress[2] * a.col(0) + s.stress[1] * a.col(1));
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t i = 0; i < 2; ++i) {
        const Eigen::Vector3d f = static_cast<double>(patch.slope[0][2 * r + i]) * first +
                                  static_cast<double>(patch.slope[1][2 * r + i]) * second;
        double* at = gradient + patch.slot[r] + i;
        at[0] += f.x();
        at[nodes] += f.y();
        at[2 * nodes] += f.z();
      }
  }
  return energy;
}

void Membrane::linearise(const double* u, std::size_t nodes) {
  state_.resize(patches_.size());
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const Eigen::Matrix<double, 3, 2> a = deformed(patches_[p], u, nodes);
    const PlaneStress s = respond(skin_, greenStrain(a));
    state_[p].first = a.col(0).cast<float>();
    state_[p].second = a.col(1).cast<float>();
    state_[p].stress = (patches_[p].area_m2 * s.stress).cast<float>();
    state_[p].moduli = (patches_[p].area_m2 * s.moduli).cast<float>();
  }
}

void Membrane::addTangent(const float* in, std::size_t nodes, float* out) const {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const Patch& patch = patches_[p];
    const State& s = state_[p];
    Eigen::Vector3f first = Eigen::Vector3f::Zero(), second = Eigen::Vector3f::Zero();
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t i = 0; i < 2; ++i) {
        const float* at = in + patch.slot[r] + i;
        const Eigen::Vector3f v(at[0], at[nodes], at[2 * nodes]);
        first += patch.slope[0][2 * r + i] * v;
        second += patch.slope[1][2 * r + i] * v;
      }
    const Eigen::Vector3f strain(s.first.dot(first), s.second.dot(second), s.first.dot(second) + s.second.dot(first));
    const Eigen::Vector3f stress = s.moduli * strain;
    const Eigen::Vector3f f = s.stress[0] * first + s.stress[2] * second + stress[0] * s.first + stress[2] * s.second;
    const Eigen::Vector3f g = s.stress[2] * first + s.stress[1] * second + stress[2] * s.first + stress[1] * s.second;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t i = 0; i < 2; ++i) {
        const Eigen::Vector3f v = patch.slope[0][2 * r + i] * f + patch.slope[1][2 * r + i] * g;
        float* at = out + patch.slot[r] + i;
        at[0] += v.x();
        at[nodes] += v.y();
        at[2 * nodes] += v.z();
      }
  }
}

void Membrane::addDiagonal(std::size_t nodes, float* blocks) const {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const State& s = state_[p];
    for (std::size_t node = 0; node < 8; ++node) {
      const float b = patches_[p].slope[0][node], c = patches_[p].slope[1][node];
      Eigen::Matrix3f G;
      G << b * s.first, c * s.second, c * s.first + b * s.second;
      const float initial = b * b * s.stress[0] + 2 * b * c * s.stress[2] + c * c * s.stress[1];
      const Eigen::Matrix3f K = G * s.moduli * G.transpose() + std::max(0.0F, initial) * Eigen::Matrix3f::Identity();
      float* at = blocks + patches_[p].slot[node / 2] + node % 2;
      std::size_t entry = 0;
      for (int k = 0; k < 3; ++k)
        for (int l = k; l < 3; ++l) at[(entry++) * nodes] += K(k, l);
    }
  }
}

}  // namespace glisson::mechanics
