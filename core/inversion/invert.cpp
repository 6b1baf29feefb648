// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/invert.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/quantity.h"
#include "image/morphology.h"
#include "inversion/detail/background.h"
#include "inversion/detail/window.h"

namespace glisson::inversion {
namespace {

using Complex = std::complex<double>;
using detail::Fitted;
using detail::FittedDirection;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double leastRoom = 0.125;  // of the neighbours that are pooled: at a straight border a seventh of them count
constexpr double meaningfulChange = 0.19;  // repeatability coefficient of the stiffness of a liver [qiba2022mre]
constexpr double stiffest = 8.0;           // times the textbook modulus: what the background's fit takes for a wave
constexpr double unresolved = 1.0;         // textbook wavelengths: finer than that no wave tells stiffness from noise

double textbookWavelength_mm(const InversionOptions& o) {
  return 1e3 * std::sqrt(defaults::atlasShear.kPa() * 1e3 / o.density_kg_m3) / o.frequency_Hz;
}

InversionOptions completed(const InversionOptions& given, const image::Grid& grid) {
  if (!(given.frequency_Hz > 0.0 && given.frequency_Hz < 1e5))
    throw BadInput("a vibration frequency of " + std::to_string(given.frequency_Hz) +
                   " Hz; give the one the patient was vibrated with");
  if (!(given.density_kg_m3 > 0.0 && std::isfinite(given.density_kg_m3)))
    throw BadInput("a density of " + std::to_string(given.density_kg_m3) + " kg/m3; it must be positive");
  if (given.dimensions != 0 && given.dimensions != 2 && given.dimensions != 3)
    throw BadArgument("an inversion is made in 2 or 3 dimensions");
  InversionOptions o = given;
  const double wavelength_mm = textbookWavelength_mm(o), pixel_mm = grid.spacing_mm.head<2>().maxCoeff();
  if (o.dimensions == 0) {
    const double inSpace_mm = o.window_mm > 0.0 ? o.window_mm : std::max(wavelength_mm / 4.0, 2.0 * pixel_mm);
    const bool dense = grid.spacing_mm.z() <= inSpace_mm / 2.0;
    const bool many = (grid.size.z() - 1) * grid.spacing_mm.z() >= 3.0 * inSpace_mm;
    o.dimensions = dense && many ? 3 : 2;
  }
  // In space two voxels along every axis where they are dense enough for a window of a quarter wavelength.
  const double spacing_mm =
      o.dimensions == 3 ? std::max(pixel_mm, std::min(grid.spacing_mm.z(), wavelength_mm / 8.0)) : pixel_mm;
  if (o.window_mm <= 0.0)
    o.window_mm = std::max({wavelength_mm / 5.0, 2.0 * spacing_mm, std::min(3.0 * pixel_mm, wavelength_mm / 4.0)});
  if (o.averaging_mm <= 0.0) o.averaging_mm = wavelength_mm / 4.0;
  if (o.cutoff_mm <= 0.0) o.cutoff_mm = 2.5 * wavelength_mm;
  if (o.filter == BulkFilter::Auto) o.filter = BulkFilter::HighPass;
  return o;
}

/// Maps without a value, and how a squared wavenumber goes into them.
class Maps {
 public:
  Maps(Inversion& out, const image::Grid& grid) : out_(out) {
    const image::ScalarVolume nothing(grid, nan);
    out.magnitude_kPa = out.storage_kPa = out.loss_kPa = out.shear_kPa = out.spread_kPa = nothing;
    out.confidence = image::ScalarVolume(grid);
    const double omega = 2.0 * std::numbers::pi * out.used.frequency_Hz;
    // ρω²/q: kg/m³ · 1/s² · mm² = 1e-6 Pa = 1e-9 kPa.
    inertia_ = out.used.density_kg_m3 * omega * omega * 1e-9;
  }

  void put(std::size_t v, Complex q_mm2, double confidence) {
    const Complex modulus_kPa = inertia_ / q_mm2;
    const double realWavenumber = std::sqrt(q_mm2).real();
    out_.magnitude_kPa.values[v] = static_cast<float>(std::abs(modulus_kPa));
    out_.storage_kPa.values[v] = static_cast<float>(modulus_kPa.real());
    out_.loss_kPa.values[v] = static_cast<float>(modulus_kPa.imag());
    out_.shear_kPa.values[v] = static_cast<float>(inertia_ / (realWavenumber * realWavenumber));
    out_.confidence.values[v] = static_cast<float>(std::clamp(confidence, 0.0, 1.0));
  }

 private:
  Inversion& out_;
  double inertia_ = 0.0;
};

Fitted fit(const ComplexVolume& u, const Stencil& stencil, const detail::Window& window, const image::Mask& inner,
           const Progress& progress) {
  Fitted out{std::vector<std::complex<float>>(u.values.size()), std::vector<std::complex<float>>(u.values.size())};
  detail::forEachVoxel(inner, progress, [&](std::size_t v) {
    Complex value = 0.0, laplacian = 0.0;
    for (std::size_t t = 0; t < window.size(); ++t) {
      const Complex x(u.values[window.neighbour(v, t)]);
      value += stencil.taps()[t].value * x;
      laplacian += stencil.taps()[t].laplacian * x;
    }
    out.value[v] = std::complex<float>(value);
    out.laplacian[v] = std::complex<float>(laplacian);
  });
  return out;
}

/// The voxels that are pooled for one estimate.
std::vector<Eigen::Vector3i> neighbourhood(const image::Grid& grid, double radius_mm, int dimensions) {
  std::vector<Eigen::Vector3i> result;
  Eigen::Vector3i reach = (radius_mm / grid.spacing_mm.array() + 1e-9).floor().cast<int>();
  if (dimensions == 2) reach.z() = 0;
  for (int k = -reach.z(); k <= reach.z(); ++k)
    for (int j = -reach.y(); j <= reach.y(); ++j)
      for (int i = -reach.x(); i <= reach.x(); ++i)
        if (grid.spacing_mm.cwiseProduct(Eigen::Vector3d(i, j, k)).norm() <= radius_mm * (1.0 + 1e-9))
          result.emplace_back(i, j, k);
  return result;
}

struct Estimate {
  Complex ratio;  ///< r, 1/mm²
  double confidence = 0.0;
};

Complex product(const std::complex<float>& a, const std::complex<float>& b) {
  return std::conj(Complex(a)) * Complex(b);
}

/// So many pooled voxels count as one for what the fit leaves over, e = ∇²u + ru with u and ∇²u of one window, in white
/// noise beside a wave of squared wavenumber q along an axis: E|Σ exp(−ik·x) e|² over n E|e|², the mean of two axes.
double correlatedVoxels(const Stencil& stencil, const std::vector<Eigen::Vector3i>& around,
                        const Eigen::Vector3d& spacing_mm, double q_mm2) {
  const double r = stencil.response(q_mm2).real();
  Eigen::Vector3i reach = Eigen::Vector3i::Zero();
  double alone = 0.0;
  for (const Stencil::Tap& t : stencil.taps()) {
    reach = reach.cwiseMax(t.offset.cwiseAbs());
    alone += std::pow(t.laplacian + r * t.value, 2);
  }
  Eigen::Vector3i pooled = Eigen::Vector3i::Zero();
  for (const Eigen::Vector3i& p : around) pooled = pooled.cwiseMax(p.cwiseAbs());
  image::Grid box;
  box.size = 2 * (reach + pooled) + Eigen::Vector3i::Ones();
  double sum = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<Complex> response(box.voxelCount());
    for (const Eigen::Vector3i& p : around) {
      const Complex phase = std::polar(1.0, -std::sqrt(q_mm2) * p[axis] * spacing_mm[axis]);
      for (const Stencil::Tap& t : stencil.taps())
        response[box.linear(p + t.offset + reach + pooled)] += phase * (t.laplacian + r * t.value);
    }
    for (const Complex& c : response) sum += 0.5 * std::norm(c);
  }
  return sum / (alone * static_cast<double>(around.size()));
}

/// Of a normal error with a relative standard deviation.
double probabilityWithin(double part, double deviation) {
  return deviation > 0.0 ? std::erf(part / (std::numbers::sqrt2 * deviation)) : 1.0;
}

/// Pools over directions and the given voxels.
Estimate pool(const std::vector<FittedDirection>& directions, const std::vector<std::size_t>& voxels,
              double correlated) {
  Complex ul = 0.0, nl = 0.0;
  double uu = 0.0, ll = 0.0, nn = 0.0;
  const std::size_t noises = directions.front().noise.size();
  for (const FittedDirection& d : directions)
    for (const std::size_t v : voxels) {
      ul += product(d.wave.value[v], d.wave.laplacian[v]);
      uu += static_cast<double>(std::norm(d.wave.value[v]));
      ll += static_cast<double>(std::norm(d.wave.laplacian[v]));
      for (const Fitted& n : d.noise) {
        nl += product(n.value[v], n.laplacian[v]) / static_cast<double>(noises);
        nn += static_cast<double>(std::norm(n.value[v])) / static_cast<double>(noises);
      }
    }
  Estimate e;
  if (!(uu > 0.0) || !(ll > 0.0)) return e;
  const double wave = uu - nn;
  if (!(wave > 0.1 * uu)) return e;  // mostly noise
  e.ratio = -(ul - nl) / wave;
  // Least squares: |δr|² = correlated E|e|² Σ|u|² / wave²; errors have no preferred phase, so that |r| has half of it.
  const double left = std::max(0.0, ll + 2.0 * (std::conj(e.ratio) * ul).real() + std::norm(e.ratio) * uu);
  const double samples = static_cast<double>(voxels.size() * directions.size());
  const double variance = 0.5 * correlated * left / samples * uu / (wave * wave * std::norm(e.ratio));
  e.confidence = probabilityWithin(meaningfulChange, std::sqrt(variance));
  return e;
}

/// Squared wavenumber at every voxel of the mask, 1/mm², 0 where there is none, and its confidence.
struct Estimates {
  std::vector<Complex> q_mm2;
  std::vector<float> confidence;
};

Eigen::Vector3i placeOf(const image::Grid& grid, std::size_t v) {
  const auto nx = static_cast<std::size_t>(grid.size.x()), ny = static_cast<std::size_t>(grid.size.y());
  return {static_cast<int>(v % nx), static_cast<int>(v / nx % ny), static_cast<int>(v / (nx * ny))};
}

Estimates estimate(const std::vector<FittedDirection>& fitted, const Stencil& stencil, const image::Mask& inner,
                   const image::Mask& mask, double averaging_mm, double q0_mm2, const Progress& progress) {
  const image::Grid& grid = mask.grid;
  const std::vector<Eigen::Vector3i> around = neighbourhood(grid, averaging_mm, stencil.dimensions());
  const double correlated = correlatedVoxels(stencil, around, grid.spacing_mm, q0_mm2);
  Estimates out{std::vector<Complex>(mask.values.size()), std::vector<float>(mask.values.size())};
  detail::forEachVoxel(mask, progress, [&](std::size_t v) {
    const Eigen::Vector3i at = placeOf(grid, v);
    std::vector<std::size_t> voxels;
    for (const Eigen::Vector3i& offset : around)
      if (grid.contains(at + offset) && inner.at(at + offset) != 0) voxels.push_back(grid.linear(at + offset));
    if (voxels.empty() || static_cast<double>(voxels.size()) < leastRoom * static_cast<double>(around.size())) return;
    const Estimate e = pool(fitted, voxels, correlated);
    const auto q = stencil.squaredWavenumber(e.ratio);
    if (!q || e.ratio == 0.0) return;
    out.q_mm2[v] = *q;
    out.confidence[v] = static_cast<float>(e.confidence);
  });
  return out;
}

/// Mean square of f(voxel, neighbour) over the neighbours, in the slice, that have both; not-a-number without any.
template <typename F>
double meanSquare(const image::Grid& grid, std::size_t v, const std::vector<Eigen::Vector3i>& around, const F& f) {
  const Eigen::Vector3i at = placeOf(grid, v);
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Vector3i& offset : around) {
    if (!grid.contains(at + offset)) continue;
    const double x = f(grid.linear(at + offset));
    if (!std::isfinite(x)) continue;
    sum += x * x;
    ++count;
  }
  return count > 1 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// What the answer owes to where and how it was asked: how far the estimates within a wavelength lie from it, and how
/// far it moves with another background.
void putSpread(Inversion& out, const Estimates& all, const Estimates* other, const Progress& progress) {
  const image::Grid& grid = out.mask.grid;
  const auto logarithms = [](const Estimates& e) {
    std::vector<double> result;
    for (const Complex& q : e.q_mm2)
      result.push_back(q != 0.0 ? std::log(std::abs(q)) : std::numeric_limits<double>::quiet_NaN());
    return result;
  };
  const std::vector<double> here = logarithms(all), there = other != nullptr ? logarithms(*other) : here;
  const auto near = neighbourhood(grid, out.used.averaging_mm, 2);
  const auto wide = neighbourhood(grid, unresolved * textbookWavelength_mm(out.used), 2);
  detail::forEachVoxel(out.mask, progress, [&](std::size_t v) {
    if (!std::isfinite(here[v])) return;
    double square = meanSquare(grid, v, wide, [&](std::size_t n) { return here[n] - here[v]; });
    if (other != nullptr) square += meanSquare(grid, v, near, [&](std::size_t n) { return there[n] - here[n]; });
    out.spread_kPa.values[v] = out.magnitude_kPa.values[v] * static_cast<float>(std::sqrt(square));
  });
}

/// Whether some direction has more noise than rounding to 12 bits leaves beside a wave.
bool noiseIn(const Waves& waves) {
  constexpr double rounding = 3e-3;
  return std::any_of(waves.directions.begin(), waves.directions.end(), [&](const Waves::Direction& d) {
    double power = 0.0;
    for (std::size_t v = 0; v < waves.mask.values.size(); ++v)
      if (waves.mask.values[v] != 0) power += static_cast<double>(std::norm(d.wave.values[v]));
    return d.noise_rad * d.noise_rad * static_cast<double>(image::count(waves.mask)) > rounding * rounding * power;
  });
}

void warn(Inversion& out, int directions, bool noiseSeen) {
  // Part of the modulus: a body without loss has values around 0, which say nothing about the order in time.
  constexpr float clearlyNegative = -0.1F;
  std::vector<float> loss;
  for (std::size_t v = 0; v < out.loss_kPa.values.size(); ++v)
    if (out.confidence.values[v] >= 0.9F && std::isfinite(out.loss_kPa.values[v]))
      loss.push_back(out.loss_kPa.values[v] / out.magnitude_kPa.values[v]);
  if (loss.size() > 20 && middleValue(loss) < clearlyNegative)
    out.warnings.push_back(
        "the loss modulus is negative at most confident voxels: are the phase offsets in order of time?");
  if (out.used.dimensions == 2)
    out.warnings.push_back(
        "inverted slice by slice: a wave that crosses the slices at an angle looks longer than it is, and stiffer");
  if (!noiseSeen)
    out.warnings.push_back(
        "the series holds no noise beside the wave (three offsets, or harmonics taken off before it was stored): "
        "smooth "
        "noise then passes for a wave, with a confidence; the spread shows it");
  if (directions == 1)
    out.warnings.push_back("one motion-encoding direction: where this component vanishes there is no stiffness");
}

/// u and ∇²u from the same local polynomial.
std::vector<FittedDirection> fitAll(const Waves& waves, const Stencil& stencil, const detail::Window& window,
                                    const image::Mask& inner, const Progress& progress) {
  std::vector<FittedDirection> fitted;
  for (std::size_t d = 0; d < waves.directions.size(); ++d) {
    progress.report(static_cast<double>(d) / static_cast<double>(waves.directions.size()), "local polynomials");
    FittedDirection f{fit(waves.directions[d].wave, stencil, window, inner, progress), {}};
    for (const ComplexVolume& n : waves.directions[d].noise)
      f.noise.push_back(fit(n, stencil, window, inner, progress));
    fitted.push_back(std::move(f));
  }
  return fitted;
}

void byLaplacian(Waves& waves, Inversion& out, const Progress& progress) {
  const Stencil stencil(waves.grid.spacing_mm, out.used.window_mm, out.used.dimensions);
  const detail::Window window(waves.grid, stencil);
  const image::Mask inner = window.complete(waves.mask);
  if (image::count(inner) == 0)
    throw BadInput("nowhere in the mask is there room for a window of radius " + std::to_string(out.used.window_mm) +
                   " mm; take a smaller window or a larger mask");
  const double q0_mm2 = std::pow(2.0 * std::numbers::pi / textbookWavelength_mm(out.used), 2);
  std::vector<FittedDirection> fitted = fitAll(waves, stencil, window, inner, progress.part(0.0, 0.3));
  const auto answer = [&](const std::vector<FittedDirection>& from, double begin, double end) {
    return estimate(from, stencil, inner, waves.mask, out.used.averaging_mm, q0_mm2, progress.part(begin, end));
  };
  std::optional<Estimates> other;
  if (out.used.filter == BulkFilter::HighPass) {
    const double sigma_mm = out.used.cutoff_mm * std::sqrt(2.0 * std::numbers::ln2) / (2.0 * std::numbers::pi);
    std::vector<FittedDirection> shorter = fitted;
    takeBackgroundOff(shorter, inner, waves.mask, sigma_mm / std::numbers::sqrt2, q0_mm2 / stiffest,
                      progress.part(0.3, 0.4));
    other = answer(shorter, 0.4, 0.6);
    const auto background =
        takeBackgroundOff(fitted, inner, waves.mask, sigma_mm, q0_mm2 / stiffest, progress.part(0.6, 0.7));
    for (std::size_t d = 0; d < background.size(); ++d)
      for (std::size_t v = 0; v < background[d].size(); ++v) {
        std::complex<float>& u = waves.directions[d].wave.values[v];
        u = waves.mask.values[v] != 0 ? u - background[d][v] : 0.0F;
      }
  }
  const Estimates all = answer(fitted, 0.7, 0.9);
  Maps maps(out, waves.grid);
  for (std::size_t v = 0; v < all.q_mm2.size(); ++v)
    if (all.q_mm2[v] != 0.0) maps.put(v, all.q_mm2[v], static_cast<double>(all.confidence[v]));
  putSpread(out, all, other ? &*other : nullptr, progress.part(0.9, 1.0));
}

}  // namespace

Inversion invert(Waves waves, const InversionOptions& options, const Progress& progress) {
  if (waves.directions.empty()) throw BadArgument("invert: there is no wave");
  Inversion out;
  out.warnings = waves.warnings;
  out.used = completed(options, waves.grid);
  const int given = static_cast<int>(waves.directions.size());
  const bool noiseSeen = noiseIn(waves);
  out.mask = waves.mask;
  if (out.used.filter == BulkFilter::Curl)
    curl(waves, out.used.window_mm / 2.0, out.used.dimensions, progress.part(0.0, 0.3));
  progress.report(0.3, "inverting");
  byLaplacian(waves, out, progress.part(0.3, 1.0));
  out.resolved =
      static_cast<std::size_t>(std::count_if(out.magnitude_kPa.values.begin(), out.magnitude_kPa.values.end(),
                                             [](float value) { return std::isfinite(value); }));
  for (Waves::Direction& d : waves.directions) out.waves.push_back(std::move(d.wave));
  warn(out, given, noiseSeen);
  progress.report(1.0, "inverted");
  return out;
}

elastography::StiffnessMap stiffnessMap(const Inversion& inversion, ShearMeasure measure) {
  elastography::StiffnessMap map;
  map.values_kPa = measure == ShearMeasure::Magnitude ? inversion.magnitude_kPa : inversion.shear_kPa;
  map.quantity = StiffnessQuantity::Shear;
  map.confidence = inversion.confidence;
  return map;
}

}  // namespace glisson::inversion
