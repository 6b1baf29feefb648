#include "inversion/invert.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/error.h"
#include "base/quantity.h"
#include "image/morphology.h"
#include "inversion/detail/local_waves.h"
#include "inversion/detail/window.h"

namespace glisson::inversion {
namespace {

using Complex = std::complex<double>;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double leastRoom = 0.5;  // of the neighbours that are pooled
constexpr double meaningfulChange = 0.19;  // repeatability coefficient of the stiffness of a liver [qiba2022mre]

/// Of a normal error with a relative standard deviation.
double probabilityWithin(double part, double deviation) {
  return deviation > 0.0 ? std::erf(part / (std::numbers::sqrt2 * deviation)) : 1.0;
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
  const double wavelength_mm = 1e3 * std::sqrt(defaults::atlasShear.kPa() * 1e3 / o.density_kg_m3) / o.frequency_Hz;
  const double pixel_mm = grid.spacing_mm.head<2>().maxCoeff();
  const double inSpace_mm = o.window_mm > 0.0 ? o.window_mm : std::max(wavelength_mm / 4.0, 2.0 * pixel_mm);
  if (o.dimensions == 0) {
    const bool dense = grid.spacing_mm.z() <= inSpace_mm / 2.0;
    const bool many = (grid.size.z() - 1) * grid.spacing_mm.z() >= 3.0 * inSpace_mm;
    o.dimensions = dense && many ? 3 : 2;
  }
  if (o.method == Method::Auto) o.method = Method::Laplacian;
  const bool slices = o.method == Method::LocalWaves;
  if (slices && o.dimensions != 2)
    throw BadInput("local waves are fitted slice by slice only; take 2 dimensions, or the Laplacian");
  if (o.window_mm <= 0.0) o.window_mm = slices ? std::max(wavelength_mm / 2.0, 4.0 * pixel_mm) : inSpace_mm;
  if (o.averaging_mm <= 0.0) o.averaging_mm = slices ? o.window_mm / 2.0 : wavelength_mm / 6.0;
  if (o.cutoff_mm <= 0.0) o.cutoff_mm = 3.0 * wavelength_mm;
  if (o.filter == BulkFilter::Auto) o.filter = slices ? BulkFilter::Local : BulkFilter::HighPass;
  if (o.filter == BulkFilter::Local && !slices)
    throw BadInput("motion that is affine across a window is fitted beside local waves only; with the Laplacian take the "
                   "high-pass filter or the curl");
  return o;
}

/// Radius of the window that curl is taken in.
double curlRadius_mm(const InversionOptions& o, const image::Grid& grid) {
  return o.method == Method::LocalWaves ? std::max(o.window_mm / 4.0, grid.spacing_mm.head<2>().maxCoeff()) : o.window_mm / 2.0;
}

/// Maps without a value, and how a squared wavenumber goes into them.
class Maps {
 public:
  Maps(Inversion& out, const image::Grid& grid, bool spread) : out_(out) {
    const image::ScalarVolume nothing(grid, nan);
    out.magnitude_kPa = out.storage_kPa = out.loss_kPa = out.shear_kPa = nothing;
    if (spread) out.spread_kPa = nothing;
    out.confidence = image::ScalarVolume(grid);
    const double omega = 2.0 * std::numbers::pi * out.used.frequency_Hz;
    // ρω²/q: kg/m³ · 1/s² · mm² = 1e-6 Pa = 1e-9 kPa.
    inertia_ = out.used.density_kg_m3 * omega * omega * 1e-9;
  }

  void put(std::size_t v, Complex q_mm2, double confidence, double relativeVariance) {
    const Complex modulus_kPa = inertia_ / q_mm2;
    const double realWavenumber = std::sqrt(q_mm2).real();
    out_.magnitude_kPa.values[v] = static_cast<float>(std::abs(modulus_kPa));
    out_.storage_kPa.values[v] = static_cast<float>(modulus_kPa.real());
    out_.loss_kPa.values[v] = static_cast<float>(modulus_kPa.imag());
    out_.shear_kPa.values[v] = static_cast<float>(inertia_ / (realWavenumber * realWavenumber));
    out_.confidence.values[v] = static_cast<float>(std::clamp(confidence, 0.0, 1.0));
    // |δ|q||² is half of |δq|²: errors have no preferred phase.
    if (!out_.spread_kPa.values.empty())
      out_.spread_kPa.values[v] = static_cast<float>(std::abs(modulus_kPa) * std::sqrt(0.5 * relativeVariance));
  }

 private:
  Inversion& out_;
  double inertia_ = 0.0;
};

/// A wave or noise field and its Laplacian after the local fit.
struct Fitted {
  std::vector<std::complex<float>> value, laplacian;
};

Fitted fit(const ComplexVolume& u, const Stencil& stencil, const detail::Window& window, const image::Mask& inner,
           const Progress& progress) {
  Fitted out{std::vector<std::complex<float>>(u.values.size()), std::vector<std::complex<float>>(u.values.size())};
  window.forEach(inner, progress, [&](std::size_t v) {
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

struct FittedDirection {
  Fitted wave;
  std::vector<Fitted> noise;
};

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
  double relativeVariance = 0.0;  ///< of r, |δr|²/|r|²
};

Complex product(const std::complex<float>& a, const std::complex<float>& b) {
  return std::conj(Complex(a)) * Complex(b);
}

/// Pools over directions and the given voxels.
Estimate pool(const std::vector<FittedDirection>& directions, const std::vector<std::size_t>& voxels) {
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
  e.confidence = std::norm(ul) / (uu * ll);
  const double wave = uu - nn;
  if (!(wave > 0.1 * uu)) return e;  // mostly noise
  e.ratio = -(ul - nl) / wave;
  // First-order change of r by another portion of the same noise, over its unknown phase.
  for (std::size_t m = 0; m < noises; ++m) {
    Complex a = 0.0, b = 0.0;
    for (const FittedDirection& d : directions)
      for (const std::size_t v : voxels) {
        const Complex u(d.wave.value[v]), lu(d.wave.laplacian[v]);
        const Complex n(d.noise[m].value[v]), ln(d.noise[m].laplacian[v]);
        a += std::conj(u) * (ln + e.ratio * n);
        b += std::conj(n) * (lu + e.ratio * u);
      }
    e.relativeVariance +=
        (std::norm(a) + std::norm(b)) / (wave * wave * std::norm(e.ratio) * static_cast<double>(noises));
  }
  return e;
}

/// Root of the mean square over the neighbourhood: a single portion of noise says little about its own size.
void smoothSpread(Inversion& out, const std::vector<Eigen::Vector3i>& around, const detail::Window& window,
                  const image::Mask& inner, const Progress& progress) {
  const image::Grid& grid = out.spread_kPa.grid;
  const image::ScalarVolume raw = out.spread_kPa;
  const auto nx = static_cast<std::size_t>(grid.size.x()), ny = static_cast<std::size_t>(grid.size.y());
  window.forEach(inner, progress, [&](std::size_t v) {
    if (!std::isfinite(raw.values[v])) return;
    const Eigen::Vector3i at(static_cast<int>(v % nx), static_cast<int>(v / nx % ny), static_cast<int>(v / (nx * ny)));
    double sum = 0.0;
    int count = 0;
    for (const Eigen::Vector3i& offset : around) {
      if (!grid.contains(at + offset) || !std::isfinite(raw.at(at + offset))) continue;
      const auto relative = static_cast<double>(raw.at(at + offset) / out.magnitude_kPa.at(at + offset));
      sum += relative * relative;
      ++count;
    }
    out.spread_kPa.values[v] =
        static_cast<float>(static_cast<double>(out.magnitude_kPa.values[v]) * std::sqrt(sum / count));
  });
}

void warn(Inversion& out, int directions) {
  // Part of the modulus: a body without loss has values around 0, which say nothing about the order in time.
  constexpr float clearlyNegative = -0.1F;
  std::vector<float> loss;
  for (std::size_t v = 0; v < out.loss_kPa.values.size(); ++v)
    if (out.confidence.values[v] >= 0.9F && std::isfinite(out.loss_kPa.values[v]))
      loss.push_back(out.loss_kPa.values[v] / out.magnitude_kPa.values[v]);
  if (loss.size() > 20) {
    const auto middle = loss.begin() + static_cast<std::ptrdiff_t>(loss.size() / 2);
    std::nth_element(loss.begin(), middle, loss.end());
    if (*middle < clearlyNegative)
      out.warnings.push_back(
          "the loss modulus is negative at most confident voxels: are the phase offsets in order of time?");
  }
  if (out.used.dimensions == 2)
    out.warnings.push_back(
        "inverted slice by slice: a wave that crosses the slices at an angle looks longer than it is, and stiffer");
  if (directions == 1)
    out.warnings.push_back("one motion-encoding direction: where this component vanishes there is no stiffness");
}

/// u and ∇²u from the same local polynomial.
void byLaplacian(const Waves& waves, Inversion& out, const Progress& progress) {
  const image::Grid& grid = waves.grid;
  const Stencil stencil(grid.spacing_mm, out.used.window_mm, out.used.dimensions);
  const detail::Window window(grid, stencil);
  const image::Mask inner = window.complete(waves.mask);
  if (image::count(inner) == 0)
    throw BadInput("nowhere in the mask is there room for a window of radius " + std::to_string(out.used.window_mm) +
                   " mm; take a smaller window or a larger mask");
  std::vector<FittedDirection> fitted;
  for (std::size_t d = 0; d < waves.directions.size(); ++d) {
    progress.report(0.6 * static_cast<double>(d) / static_cast<double>(waves.directions.size()), "local polynomials");
    FittedDirection f{fit(waves.directions[d].wave, stencil, window, inner, progress), {}};
    for (const ComplexVolume& n : waves.directions[d].noise)
      f.noise.push_back(fit(n, stencil, window, inner, progress));
    fitted.push_back(std::move(f));
  }
  const bool noise = !fitted.front().noise.empty();
  Maps maps(out, grid, noise);
  const std::vector<Eigen::Vector3i> around = neighbourhood(grid, out.used.averaging_mm, out.used.dimensions);
  const auto nx = static_cast<std::size_t>(grid.size.x()), ny = static_cast<std::size_t>(grid.size.y());
  window.forEach(inner, progress, [&](std::size_t v) {
    const Eigen::Vector3i at(static_cast<int>(v % nx), static_cast<int>(v / nx % ny), static_cast<int>(v / (nx * ny)));
    std::vector<std::size_t> voxels;
    for (const Eigen::Vector3i& offset : around)
      if (grid.contains(at + offset) && inner.at(at + offset) != 0) voxels.push_back(grid.linear(at + offset));
    if (static_cast<double>(voxels.size()) < leastRoom * static_cast<double>(around.size())) return;
    const Estimate e = pool(fitted, voxels);
    const auto q = stencil.squaredWavenumber(e.ratio);
    if (!q || e.ratio == 0.0) return;
    maps.put(v, *q, e.confidence, e.relativeVariance);
  });
  if (noise) smoothSpread(out, around, window, inner, progress);
}

/// Waves of one wavenumber fitted to each window.
void byLocalWaves(const Waves& waves, Inversion& out, const Progress& progress) {
  const double omega = 2.0 * std::numbers::pi * out.used.frequency_Hz;
  detail::LocalWaveOptions o;
  o.radius_mm = out.used.window_mm;
  o.averaging_mm = out.used.averaging_mm;
  o.q0_mm2 = out.used.density_kg_m3 * omega * omega * 1e-9 / defaults::atlasShear.kPa();
  o.affine = out.used.filter == BulkFilter::Local;
  const detail::LocalWaves fitted = detail::fitLocalWaves(waves, o, progress);
  Maps maps(out, waves.grid, !waves.directions.front().noise.empty());
  for (std::size_t v = 0; v < fitted.q_mm2.size(); ++v)
    if (fitted.q_mm2[v] != 0.0)
      maps.put(v, fitted.q_mm2[v], probabilityWithin(meaningfulChange, std::sqrt(0.5 * fitted.relativeVariance[v])),
               fitted.relativeVariance[v]);
  out.correlatedVoxels = fitted.correlatedVoxels;
  out.confidenceMeans = ConfidenceMeaning::ProbabilityWithin;
  out.warnings.push_back(
      "local waves are a trial: on one of five public livers they were 60 % too soft where their confidence was high; take "
      "the figures from the laplacian");
}

}  // namespace

Inversion invert(Waves waves, const InversionOptions& options, const Progress& progress) {
  if (waves.directions.empty()) throw BadArgument("invert: there is no wave");
  Inversion out;
  out.warnings = waves.warnings;
  out.used = completed(options, waves.grid);
  const int given = static_cast<int>(waves.directions.size());
  out.mask = waves.mask;
  if (out.used.filter == BulkFilter::HighPass) highPass(waves, out.used.cutoff_mm, progress.part(0.0, 0.3));
  if (out.used.filter == BulkFilter::Curl)
    curl(waves, curlRadius_mm(out.used, waves.grid), out.used.dimensions, progress.part(0.0, 0.3));
  progress.report(0.3, "inverting");
  if (out.used.method == Method::LocalWaves)
    byLocalWaves(waves, out, progress.part(0.3, 1.0));
  else
    byLaplacian(waves, out, progress.part(0.3, 1.0));
  out.resolved =
      static_cast<std::size_t>(std::count_if(out.magnitude_kPa.values.begin(), out.magnitude_kPa.values.end(),
                                             [](float value) { return std::isfinite(value); }));
  for (Waves::Direction& d : waves.directions) out.waves.push_back(std::move(d.wave));
  warn(out, given);
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
