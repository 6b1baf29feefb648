#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "elastography/stiffness_map.h"
#include "inversion/filters.h"
#include "inversion/waves.h"

namespace glisson::inversion {

enum class Method {
  Auto,       ///< Laplacian
  LocalWaves, ///< waves of one wavenumber fitted to each window; slice by slice only
  Laplacian   ///< u and its Laplacian from local polynomials
};

/// How waves become stiffness. Lengths of 0 are chosen from the frequency: λ₀ = √(2.1 kPa / density) / frequency is the
/// wavelength in a healthy liver.
struct InversionOptions {
  double frequency_Hz = 0.0;      ///< of the vibration; must be given
  double density_kg_m3 = 1000.0;  ///< of soft tissue; 1000 is the convention of MR elastography
  int dimensions = 0;             ///< 2: slice by slice, 3: in space, 0: 3 where slices are dense and many enough
  Method method = Method::Auto;
  BulkFilter filter = BulkFilter::Auto;
  double window_mm = 0.0;     ///< radius of the window; 0: λ₀/2 for local waves, λ₀/4 for the Laplacian
  double averaging_mm = 0.0;  ///< radius over which windows are pooled; 0: half the window for local waves, λ₀/6 for the Laplacian
  double cutoff_mm = 0.0;     ///< wavelength that the high-pass filter halves; 0: 3 λ₀
};

/// What a confidence says.
enum class ConfidenceMeaning {
  Explained,         ///< part of ∇²u that the wave equation explains (Laplacian)
  ProbabilityWithin  ///< that |G*| lies within 19 % of the truth, the least change of a liver's stiffness that counts as
                     ///< one [qiba2022mre]: erf(.19 / (√2 spread / |G*|)), so .95 where the spread is 9.7 % (local waves)
};

/// Complex shear modulus of an isotropic, incompressible, locally homogeneous body, voxel by voxel; kPa. Not-a-number
/// where there is none: window outside the mask, or a wave that the window cannot resolve.
struct Inversion {
  image::ScalarVolume magnitude_kPa;  ///< |G*|
  image::ScalarVolume storage_kPa;    ///< µ' = Re G*
  image::ScalarVolume loss_kPa;       ///< µ'' = Im G*
  image::ScalarVolume shear_kPa;  ///< shear stiffness ρ c², c = ω / Re k the wave speed: what vendors call stiffness
  image::ScalarVolume confidence;    ///< 0 ... 1, 0 where there is no modulus
  ConfidenceMeaning confidenceMeans = ConfidenceMeaning::Explained;
  image::ScalarVolume spread_kPa;    ///< standard deviation of |G*|; empty for three offsets
  std::vector<ComplexVolume> waves;  ///< filtered, as inverted, one for each direction or curl component
  image::Mask mask;                  ///< voxels with signal, as used
  InversionOptions used;             ///< with every 0 replaced
  std::size_t resolved = 0;          ///< voxels that have a modulus
  double correlatedVoxels = 1.0;     ///< slice by slice: so many voxels of what the fit leaves over count as one
  std::vector<std::string> warnings;
};

/// Local waves: waves of one wavenumber, from wherever they come, fitted to each window by least squares
/// (detail/local_waves.h); G* = ρω²/q. Confidence and spread come from what the fit leaves over and from the noise.
/// Laplacian: algebraic inversion of ρω²u + G ∇²u = 0 [oliphant2001], u and ∇²u from the same local polynomial.
///   r = −(Σ ū ∇²u − Σ n̄ ∇²n) / (Σ |u|² − Σ |n|²), sums over directions and neighbours, n the noise harmonics:
/// so noise does not pull the stiffness down; then the response of the finite window is undone, q = f⁻¹(r)
/// (stencil.h), and G* = ρω²/q. Confidence is |Σ ū ∇²u|² / (Σ |u|² Σ |∇²u|²), spread from the noise alone.
/// Throws BadInput: no frequency, density not positive, window without room, curl without three directions, local
/// waves in space, the local filter without them.
Inversion invert(Waves waves, const InversionOptions& options, const Progress& progress = {});

enum class ShearMeasure { Magnitude, WaveSpeed };

/// As a stiffness map with its confidence, for statistics and simulation. Voxels without a modulus are not finite.
elastography::StiffnessMap stiffnessMap(const Inversion& inversion, ShearMeasure measure = ShearMeasure::Magnitude);

}  // namespace glisson::inversion
