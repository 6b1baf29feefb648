// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mechanics/row_lattice.h"

namespace glisson::mechanics {

/// A thin skin that is bound to the body's surface and bears in its own plane only: plane stress, linear between the
/// second Piola-Kirchhoff stress and Green's strain. tensionOnly: it wrinkles instead of bearing compression (the
/// relaxed energy of Pipkin 1986, convex in the places of the nodes).
struct Skin {
  double stiffness_N_m = 0;  ///< Young's modulus times thickness
  double poisson = 0.3;
  bool tensionOnly = true;
};

/// A part of the surface at rest: place and outward normal (grid axes, m) and its area; the cell that carries it.
struct SkinSample {
  Eigen::Vector3i cell;
  Eigen::Vector3d p_m, normal;
  double area_m2 = 0;
};

/// The skin on the cells of one level. The samples of a cell that look the same way are one patch, strained as the
/// cell's trilinear displacement strains its tangent plane at their mean place.
class Membrane {
 public:
  Membrane() = default;
  /// Samples outside their cell count at the nearest place inside.
  Membrane(const RowLattice& lattice, const Eigen::Vector3d& h_m, const std::vector<SkinSample>& samples,
           const Skin& skin);

  /// Energy (J) at displacements u (three arrays of `nodes` values, m); the forces (N) are added to gradient.
  double addForces(const double* u, std::size_t nodes, double* gradient) const;
  void linearise(const double* u, std::size_t nodes);
  /// out += tangent · in, of the last linearisation; positive semidefinite where the skin bears tension only.
  void addTangent(const float* in, std::size_t nodes, float* out) const;
  /// Adds the 3 × 3 diagonal blocks of the tangent to six arrays (xx xy xz yy yz zz) of `nodes` values each.
  void addDiagonal(std::size_t nodes, float* blocks) const;

 private:
  struct Patch {
    std::array<std::uint32_t, 4> slot{};          ///< first of two nodes along x, as CarriedPoint has them
    std::array<std::array<float, 8>, 2> slope{};  ///< derivative of each node's share along the tangents, 1/m
    Eigen::Matrix<double, 3, 2> tangent;          ///< at rest, orthonormal
    double area_m2 = 0;
  };
  /// Times the patch's area: stress (11 22 12) and moduli (symmetric, of 11 22 12 and strains 11 22 2·12), N m.
  struct State {
    Eigen::Vector3f first, second;  ///< tangents, deformed
    Eigen::Vector3f stress;
    Eigen::Matrix3f moduli;
  };
  Eigen::Matrix<double, 3, 2> deformed(const Patch& patch, const double* u, std::size_t nodes) const;

  Skin skin_;
  std::vector<Patch> patches_;
  std::vector<State> state_;
};

}  // namespace glisson::mechanics
