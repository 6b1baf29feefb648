// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/waves.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "image/morphology.h"
#include "inversion/detail/clipping.h"

namespace glisson::inversion {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double signalNoise_rad = 0.6;
constexpr double mostJumping = 0.002;  // of the masked voxels, before steps are unwrapped in space
using Complex = std::complex<double>;

double wrapped(double phase_rad) {
  return phase_rad - 2.0 * pi * std::round(phase_rad / (2.0 * pi));
}

void check(const std::vector<PhaseOffsets>& directions) {
  if (directions.empty() || directions.front().offsets_rad.empty()) throw BadInput("there is no phase image to invert");
  const std::size_t n = directions.front().offsets_rad.size();
  const image::Grid& grid = directions.front().offsets_rad.front().grid;
  if (n < 3)
    throw BadInput("a wave needs at least 3 phase offsets over its period; there are " + std::to_string(n) +
                   " in each direction");
  for (std::size_t d = 0; d < directions.size(); ++d) {
    if (directions[d].offsets_rad.size() != n)
      throw BadInput("direction " + std::to_string(d + 1) + " has " + std::to_string(directions[d].offsets_rad.size()) +
                     " phase offsets, the first one " + std::to_string(n) + "; all need the same number");
    for (std::size_t t = 0; t < n; ++t) {
      const image::ScalarVolume& volume = directions[d].offsets_rad[t];
      const std::string where = "offset " + std::to_string(t + 1) + " of direction " + std::to_string(d + 1);
      if (!volume.grid.sameGeometry(grid)) throw BadInput(where + " lies on another grid than the first phase image");
      for (const float v : volume.values)
        if (!std::isfinite(v)) throw BadInput(where + " holds a value that is not finite");
    }
  }
}

/// Wrapped steps from every offset to the next one, the last to the first.
std::vector<image::ScalarVolume> stepsOf(const std::vector<image::ScalarVolume>& offsets) {
  std::vector<image::ScalarVolume> steps;
  for (std::size_t t = 0; t < offsets.size(); ++t) {
    const image::ScalarVolume &from = offsets[t], &to = offsets[(t + 1) % offsets.size()];
    image::ScalarVolume step(from.grid);
    for (std::size_t v = 0; v < step.values.size(); ++v)
      step.values[v] =
          static_cast<float>(wrapped(static_cast<double>(to.values[v]) - static_cast<double>(from.values[v])));
    steps.push_back(std::move(step));
  }
  return steps;
}

ComplexVolume harmonic(const std::vector<image::ScalarVolume>& steps, int m) {
  const auto n = static_cast<double>(steps.size());
  std::vector<Complex> factor;
  const Complex scale = 2.0 / (n * (std::polar(1.0, 2.0 * pi * m / n) - 1.0));
  for (std::size_t t = 0; t < steps.size(); ++t)
    factor.push_back(scale * std::polar(1.0, -2.0 * pi * m * static_cast<double>(t) / n));
  ComplexVolume result(steps.front().grid);
  parallelChunks(result.values.size(), 65536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Complex sum = 0.0;
      for (std::size_t t = 0; t < steps.size(); ++t) sum += factor[t] * static_cast<double>(steps[t].values[v]);
      result.values[v] = std::complex<float>(sum);
    }
  });
  return result;
}

/// A step that wrapped differs by nearly 2π from its neighbour's.
double jumping(const std::vector<image::ScalarVolume>& steps, const image::Mask& mask) {
  std::size_t jumps = 0, all = 0;
  const Eigen::Vector3i n = mask.grid.size;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j + 1 < n.y(); ++j)
      for (int i = 0; i + 1 < n.x(); ++i) {
        if (mask.at(i, j, k) == 0 || mask.at(i + 1, j, k) == 0 || mask.at(i, j + 1, k) == 0) continue;
        ++all;
        const auto jumpsAt = [&](const image::ScalarVolume& step) {
          const auto here = static_cast<double>(step.at(i, j, k));
          return std::abs(static_cast<double>(step.at(i + 1, j, k)) - here) > pi ||
                 std::abs(static_cast<double>(step.at(i, j + 1, k)) - here) > pi;
        };
        if (std::any_of(steps.begin(), steps.end(), jumpsAt)) ++jumps;
      }
  return all == 0 ? 0.0 : static_cast<double>(jumps) / static_cast<double>(all);
}

/// Power of the phase noise at every voxel, rad², of one direction: E|n|² = 4σ²/N.
void addNoise(image::ScalarVolume& power, const Waves::Direction& direction, std::size_t offsets) {
  const double perHarmonic = static_cast<double>(offsets) / 4.0 / static_cast<double>(direction.noise.size());
  for (const ComplexVolume& n : direction.noise)
    for (std::size_t v = 0; v < power.values.size(); ++v)
      power.values[v] += static_cast<float>(perHarmonic * static_cast<double>(std::norm(n.values[v])));
}

/// Mean over 3 × 3 pixels of each slice.
image::ScalarVolume smoothed(const image::ScalarVolume& in) {
  image::ScalarVolume out(in.grid);
  const Eigen::Vector3i n = in.grid.size;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        double sum = 0.0;
        int count = 0;
        for (int b = std::max(0, j - 1); b <= std::min(n.y() - 1, j + 1); ++b)
          for (int a = std::max(0, i - 1); a <= std::min(n.x() - 1, i + 1); ++a, ++count)
            sum += static_cast<double>(in.at(a, b, k));
        out.at(i, j, k) = static_cast<float>(sum / count);
      }
  return out;
}

void fillHarmonics(Waves::Direction& d, const std::vector<image::ScalarVolume>& steps) {
  d.wave = harmonic(steps, 1);
  d.noise.clear();
  for (int m = 2; m <= static_cast<int>(steps.size()) / 2 && m <= 3; ++m) d.noise.push_back(harmonic(steps, m));
}

/// Where steps agree between neighbours: the mean over all of them of |mean of exp(i step) over 3 x 3 pixels|. A step
/// that wrapped is the same step there, and a wave changes little over so few pixels; noise of sigma in each phase
/// leaves exp(-sigma^2), phase without signal a third.
image::Mask signalMask(const std::vector<std::vector<image::ScalarVolume>>& steps, const image::Grid& grid) {
  image::Mask mask(grid, 1);
  if (steps.front().size() < 4) return mask;
  image::ScalarVolume agreement(grid);
  double count = 0.0;
  for (const auto& direction : steps)
    for (const image::ScalarVolume& step : direction) {
      image::ScalarVolume real(grid), imaginary(grid);
      for (std::size_t v = 0; v < step.values.size(); ++v) {
        real.values[v] = std::cos(step.values[v]);
        imaginary.values[v] = std::sin(step.values[v]);
      }
      real = smoothed(real);
      imaginary = smoothed(imaginary);
      for (std::size_t v = 0; v < step.values.size(); ++v)
        agreement.values[v] += std::hypot(real.values[v], imaginary.values[v]);
      count += 1.0;
    }
  const double least = std::exp(-signalNoise_rad * signalNoise_rad) * count;
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    mask.values[v] = static_cast<double>(agreement.values[v]) > least ? 1 : 0;
  return mask;
}

double noiseInside(const Waves::Direction& d, const image::Mask& mask, std::size_t offsets) {
  if (d.noise.empty()) return 0.0;
  image::ScalarVolume power(mask.grid);
  addNoise(power, d, offsets);
  double sum = 0.0;
  for (std::size_t v = 0; v < mask.values.size(); ++v)
    if (mask.values[v] != 0) sum += static_cast<double>(power.values[v]);
  return std::sqrt(sum / static_cast<double>(image::count(mask)));
}

}  // namespace

PhaseScale phaseScale(const std::vector<image::ScalarVolume>& phases) {
  double low = 1e300, high = -1e300;
  for (const auto& volume : phases)
    for (const float v : volume.values) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, static_cast<double>(v));
      high = std::max(high, static_cast<double>(v));
    }
  const double largest = std::max(std::abs(low), std::abs(high));
  const auto near = [&](double full) { return std::abs(largest / full - 1.0) < 0.02; };
  if (largest <= pi * 1.001) return {1.0, 0.0, "values within ± pi: radians"};
  if (low < 0.0 && near(1000.0 * pi)) return {1e-3, 0.0, "values within ± 3142: milliradians"};
  if (low < 0.0 && near(4096.0)) return {pi / 4096.0, 0.0, "values within ± 4096: pi is 4096"};
  if (low >= 0.0 && near(4095.0)) return {pi / 2048.0, 2048.0, "values within 0 to 4095: 2048 is 0, a turn is 4096"};
  std::ostringstream why;
  why << "the phase images hold values from " << low << " to " << high
      << ", which is neither radians, milliradians nor 12 bits; say how many radians one unit is";
  throw BadInput(why.str());
}

void toRadians(image::ScalarVolume& phase, const PhaseScale& scale) {
  for (float& v : phase.values) v = static_cast<float>(scale.slope_rad * (static_cast<double>(v) - scale.zero));
}

Waves firstHarmonic(const std::vector<PhaseOffsets>& directions, const WaveOptions& options, const Progress& progress) {
  check(directions);
  const std::size_t offsets = directions.front().offsets_rad.size();
  Waves waves;
  waves.grid = directions.front().offsets_rad.front().grid;
  if (options.mask && !options.mask->grid.sameGeometry(waves.grid))
    throw BadInput("the mask lies on another grid than the phase images");
  std::vector<std::vector<image::ScalarVolume>> steps;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    progress.report(0.6 * static_cast<double>(d) / static_cast<double>(directions.size()), "steps between offsets");
    steps.push_back(stepsOf(directions[d].offsets_rad));
    Waves::Direction out;
    const double length = directions[d].encoding_lps.norm();
    if (length > 0.0) out.encoding_lps = directions[d].encoding_lps / length;
    fillHarmonics(out, steps.back());
    waves.directions.push_back(std::move(out));
  }
  waves.mask = options.mask ? *options.mask : signalMask(steps, waves.grid);
  if (image::count(waves.mask) == 0)
    throw BadInput(options.mask ? "the mask holds no voxel of the phase images"
                                : "no voxel of the phase images has signal: the phase is noise everywhere");
  for (std::size_t d = 0; d < directions.size(); ++d) {
    progress.report(0.6 + 0.4 * static_cast<double>(d) / static_cast<double>(directions.size()), "unwrapping");
    Waves::Direction& out = waves.directions[d];
    const image::Mask clipped = detail::clippedVoxels(directions[d]);
    image::Mask whole = waves.mask;
    for (std::size_t v = 0; v < clipped.values.size(); ++v)
      if (clipped.values[v] != 0) whole.values[v] = 0;
    out.jumping = jumping(steps[d], whole);
    out.spatiallyUnwrapped = options.unwrapping == Unwrapping::Quality ||
                             (options.unwrapping == Unwrapping::Auto && out.jumping > mostJumping);
    if (out.spatiallyUnwrapped) {
      for (image::ScalarVolume& step : steps[d]) {
        progress.check();
        unwrapSlices(step, waves.mask);
      }
      fillHarmonics(out, steps[d]);
    }
    if (!clipped.values.empty()) {
      const std::size_t before = image::count(waves.mask);
      detail::fitUnclipped(directions[d], clipped, out, waves.mask);
      waves.warnings.push_back("direction " + std::to_string(d + 1) +
                               ": phases were cut off at the ends of the scale; " +
                               std::to_string(before - image::count(waves.mask)) +
                               " voxels with fewer than four whole offsets were left out");
      if (image::count(waves.mask) == 0) throw BadInput("phases are cut off at the ends of the scale everywhere");
    }
    out.noise_rad = noiseInside(out, waves.mask, offsets);
    if (out.jumping > mostJumping) {
      std::ostringstream text;
      text << "direction " << d + 1 << ": at " << std::round(1000.0 * out.jumping) / 10.0
           << " % of the voxels the wave jumps by a turn: it moves by more than pi between offsets"
           << (out.spatiallyUnwrapped ? "; its steps were unwrapped in space" : "; its stiffness is not right there");
      waves.warnings.push_back(text.str());
    }
  }
  progress.report(1.0, "waves");
  return waves;
}

}  // namespace glisson::inversion
