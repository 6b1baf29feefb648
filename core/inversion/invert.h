// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "elastography/stiffness_map.h"
#include "inversion/filters.h"
#include "inversion/waves.h"

namespace glisson::inversion {

/// How waves become stiffness. Lengths of 0 are chosen from the frequency: λ₀ = √(2.1 kPa / density) / frequency is the
/// wavelength in a healthy liver.
struct InversionOptions {
  double frequency_Hz = 0.0;      ///< of the vibration; must be given
  double density_kg_m3 = 1000.0;  ///< of soft tissue; 1000 is the convention of MR elastography
  int dimensions = 0;             ///< 2: slice by slice, 3: in space, 0: 3 where slices are dense and many enough
  BulkFilter filter = BulkFilter::Auto;
  double window_mm =
      0.0;  ///< radius of the window of u and ∇²u; 0: λ₀/5, or what three pixels (λ₀/4 at most) or two voxels need
  double averaging_mm = 0.0;  ///< radius over which windows are pooled; 0: λ₀/4
  double cutoff_mm = 0.0;     ///< wavelength that the high-pass filter halves; 0: 2.5 λ₀
};

/// Complex shear modulus of an isotropic, incompressible, locally homogeneous body, voxel by voxel; kPa. Not-a-number
/// where there is none: window outside the mask, or a wave that the window cannot resolve.
struct Inversion {
  image::ScalarVolume magnitude_kPa;  ///< |G*|
  image::ScalarVolume storage_kPa;    ///< µ' = Re G*
  image::ScalarVolume loss_kPa;       ///< µ'' = Im G*
  image::ScalarVolume shear_kPa;  ///< shear stiffness ρ c², c = ω / Re k the wave speed: what vendors call stiffness
  image::ScalarVolume confidence;    ///< that noise moves |G*| by less than 19 %; 0 where there is no modulus
  image::ScalarVolume spread_kPa;    ///< standard deviation of |G*|
  std::vector<ComplexVolume> waves;  ///< filtered, as inverted, one for each direction or curl component
  image::Mask mask;                  ///< voxels with signal, as used
  InversionOptions used;             ///< with every 0 replaced
  std::size_t resolved = 0;          ///< voxels that have a modulus
  std::vector<std::string> warnings;
};

/// Algebraic inversion of ρω²u + G ∇²u = 0 [oliphant2001], u and ∇²u from the same local polynomial:
///   r = −(Σ ū ∇²u − Σ n̄ ∇²n) / (Σ |u|² − Σ |n|²), sums over directions and neighbours, n the noise harmonics:
/// so noise does not pull the stiffness down; then the response of the finite window is undone, q = f⁻¹(r)
/// (stencil.h), and G* = ρω²/q.
/// Confidence: the probability that noise leaves |G*| within 19 % of its mean, the least change of a liver's stiffness
/// that counts as one [qiba2022mre]: erf(.19/(√2 d)), d the relative deviation of r by least squares in white noise of
/// the power that the fit leaves over; no noise harmonics are needed.
/// Spread of ln|G*|: root of the mean square distance to the estimates within λ₀ in the slice, and, with the
/// high-pass filter, to those with its cutoff divided by √2. It says what noise, unresolved structure and background
/// leave open. Not-a-number where neighbours lack.
/// Throws BadInput: no frequency, density not positive, window without room, curl without three directions.
Inversion invert(Waves waves, const InversionOptions& options, const Progress& progress = {});

/// What is taken as shear stiffness: |G*|, or ρ c² by the speed c of the wave.
enum class ShearMeasure { Magnitude, WaveSpeed };

/// As a stiffness map with its confidence, for statistics and simulation. Voxels without a modulus are not finite.
elastography::StiffnessMap stiffnessMap(const Inversion& inversion, ShearMeasure measure = ShearMeasure::Magnitude);

}  // namespace glisson::inversion
