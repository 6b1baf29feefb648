// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/resample.h"

namespace glisson::elastography {
namespace {

constexpr int bins = 32;
constexpr double leastOverlap = 0.3;       // of the samples
constexpr int fewestSlices = 6;            // for a motion in space
using Parameters = std::array<double, 6>;  // mm along the moving image's axes, then mm of arc at arm_mm
constexpr double arm_mm = 60.0;

struct Sample {
  Eigen::Vector3d p_lps;
  double value = 0.0;
};

/// Intensities to bins, by 1 % and 99 % quantiles: outliers share the outer bins.
class Binning {
 public:
  explicit Binning(std::vector<float> values) {
    std::sort(values.begin(), values.end());
    low_ = static_cast<double>(values[values.size() / 100]);
    high_ = static_cast<double>(values[values.size() - 1 - values.size() / 100]);
  }
  bool constant() const { return !(high_ > low_); }
  /// Continuous bin position, 0 ... bins − 1.
  double operator()(double value) const { return std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) * (bins - 1); }

 private:
  double low_ = 0.0, high_ = 0.0;
};

class Similarity {
 public:
  Similarity(const image::ScalarVolume& fixed, const image::ScalarVolume& moving, const RegistrationOptions& options)
      : fixed_(fixed), grid_(moving.grid), fixedBins_(finite(fixed)), movingBins_(finite(moving)) {
    if (fixedBins_.constant() || movingBins_.constant())
      throw BadInput("an image is constant: there is nothing to lay over each other");
    middle_lps_ = grid_.indexToLps(0.5 * (grid_.size.cast<double>() - Eigen::Vector3d::Ones()));
    // Points between the pixels, but on the slices: lattices that coincide would favour whole-pixel shifts.
    Random random(options.seed);
    for (int s = 0; s < options.samples; ++s) {
      const Eigen::Vector3d index(random.uniform(0.0, grid_.size.x() - 1.0), random.uniform(0.0, grid_.size.y() - 1.0),
                                  static_cast<double>(random.below(static_cast<std::uint64_t>(grid_.size.z()))));
      const Eigen::Vector3d p = grid_.indexToLps(index);
      const auto value = static_cast<double>(image::sampleLinear(moving, p, 0.0F));
      if (std::isfinite(value)) samples_.push_back({p, movingBins_(value)});
    }
  }

  Eigen::Isometry3d motion(const Parameters& x) const {
    const Eigen::Vector3d turn = grid_.direction * Eigen::Vector3d(x[3], x[4], x[5]) / arm_mm;
    const double angle = turn.norm();
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translate(middle_lps_ + grid_.direction * Eigen::Vector3d(x[0], x[1], x[2]));
    if (angle > 0.0) X.rotate(Eigen::AngleAxisd(angle, turn / angle));
    X.translate(-middle_lps_);
    return X;
  }
  const Eigen::Vector3d& middle_lps() const { return middle_lps_; }

  /// Normalised mutual information; 0 where too few samples meet the fixed image.
  double operator()(const Parameters& x) const {
    const Eigen::Isometry3d X = motion(x);
    constexpr std::size_t chunk = 1024;
    const std::size_t chunks = (samples_.size() + chunk - 1) / chunk;
    std::vector<std::vector<double>> part(chunks);
    parallelChunks(samples_.size(), chunk, [&](std::size_t begin, std::size_t end) {
      std::vector<double>& joint = part[begin / chunk];
      joint.assign(bins * bins, 0.0);
      for (std::size_t s = begin; s < end; ++s) {
        const float value = image::sampleLinear(fixed_, X * samples_[s].p_lps, outside);
        if (value == outside || !std::isfinite(value)) continue;
        add(joint, fixedBins_(static_cast<double>(value)), samples_[s].value);
      }
    });
    std::vector<double> joint(bins * bins, 0.0);
    for (const std::vector<double>& p : part)
      for (std::size_t b = 0; b < joint.size(); ++b) joint[b] += p[b];
    return normalised(joint);
  }

 private:
  static constexpr float outside = -3e38F;

  static std::vector<float> finite(const image::ScalarVolume& volume) {
    std::vector<float> values;
    for (const float v : volume.values)
      if (std::isfinite(v)) values.push_back(v);
    if (values.empty()) throw BadInput("an image holds no finite value");
    return values;
  }

  /// Shared among the four nearest bins, so that the histogram changes smoothly.
  static void add(std::vector<double>& joint, double fixed, double moving) {
    const int f = std::min(static_cast<int>(fixed), bins - 2), m = std::min(static_cast<int>(moving), bins - 2);
    const double tf = fixed - f, tm = moving - m;
    for (const int df : {0, 1})
      for (const int dm : {0, 1})
        joint[static_cast<std::size_t>((f + df) * bins + m + dm)] += (df ? tf : 1.0 - tf) * (dm ? tm : 1.0 - tm);
  }

  double normalised(const std::vector<double>& joint) const {
    double total = 0.0;
    std::array<double, bins> fixed{}, moving{};
    for (std::size_t b = 0; b < joint.size(); ++b) {
      total += joint[b];
      fixed[b / bins] += joint[b];
      moving[b % bins] += joint[b];
    }
    if (total < leastOverlap * static_cast<double>(samples_.size())) return 0.0;
    const auto entropy = [&](const auto& weights) {
      double sum = 0.0;
      for (const double w : weights)
        if (w > 0.0) sum -= w / total * std::log(w / total);
      return sum;
    };
    const double both = entropy(joint);
    return both > 0.0 ? (entropy(fixed) + entropy(moving)) / both : 0.0;
  }

  const image::ScalarVolume& fixed_;
  image::Grid grid_;
  Binning fixedBins_, movingBins_;
  Eigen::Vector3d middle_lps_;
  std::vector<Sample> samples_;
};

bool allowed(const Parameters& x, const RegistrationOptions& options) {
  const double turn_mm = options.largest_deg * std::numbers::pi / 180.0 * arm_mm;
  return Eigen::Vector3d(x[0], x[1], x[2]).norm() <= options.largest_mm &&
         Eigen::Vector3d(x[3], x[4], x[5]).norm() <= turn_mm;
}

/// Tries every parameter both ways; true where something got better.
bool explore(const Similarity& similarity, const RegistrationOptions& options, std::size_t count, double step,
             Parameters& at, double& best) {
  bool better = false;
  for (std::size_t a = 0; a < count; ++a)
    for (const double way : {step, -step}) {
      Parameters next = at;
      next[a] += way;
      if (!allowed(next, options)) continue;
      const double value = similarity(next);
      if (value <= best) continue;
      best = value;
      at = next;
      better = true;
      break;
    }
  return better;
}

}  // namespace

Registration registerRigid(const image::ScalarVolume& fixed, const image::ScalarVolume& moving,
                           const RegistrationOptions& options, const Progress& progress) {
  fixed.grid.check();
  moving.grid.check();
  const Similarity similarity(fixed, moving, options);
  Registration result;
  result.motion = options.motion != Motion::Auto        ? options.motion
                  : moving.grid.size.z() < fewestSlices ? Motion::InPlane
                                                        : Motion::Rigid;
  const std::size_t count = result.motion == Motion::InPlane ? 2 : 6;
  Parameters at{};
  result.similarityBefore = similarity(at);
  if (!(result.similarityBefore > 0.0))
    throw BadInput("less than a third of the elastogram lies inside the MRI: they cannot be laid over each other");
  double best = result.similarityBefore;
  const std::array<double, 8> steps{8.0, 4.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05};
  for (std::size_t s = 0; s < steps.size(); ++s) {
    progress.report(static_cast<double>(s) / static_cast<double>(steps.size()), "laying the elastogram over the MRI");
    for (int round = 0; round < 50; ++round) {
      progress.check();
      const Parameters before = at;
      if (!explore(similarity, options, count, steps[s], at, best)) break;
      // On along what was gained, as long as it gains.
      Parameters further = at;
      for (std::size_t a = 0; a < count; ++a) further[a] += at[a] - before[a];
      if (!allowed(further, options)) continue;
      const double value = similarity(further);
      if (value > best) {
        best = value;
        at = further;
      }
    }
  }
  result.similarityAfter = best;
  result.improved = best > result.similarityBefore;
  if (result.improved) result.X_fixed_moving = similarity.motion(at);
  result.shift_mm = (result.X_fixed_moving * similarity.middle_lps() - similarity.middle_lps()).norm();
  result.rotation_deg = Eigen::AngleAxisd(result.X_fixed_moving.rotation()).angle() * 180.0 / std::numbers::pi;
  progress.report(1.0, "laid over each other");
  return result;
}

image::Grid moved(const image::Grid& grid, const Eigen::Isometry3d& X) {
  image::Grid result = grid;
  result.origin_lps_mm = X * grid.origin_lps_mm;
  result.direction = X.linear() * grid.direction;
  return result;
}

std::string describe(const Registration& registration) {
  std::ostringstream text;
  text.precision(3);
  if (!registration.improved) {
    text << "registration: no motion makes the elastogram fit the MRI better (similarity "
         << registration.similarityBefore << "); left where it was";
    return text.str();
  }
  text << "registration: the elastogram was moved by " << registration.shift_mm << " mm and turned by "
       << registration.rotation_deg << " degrees"
       << (registration.motion == Motion::InPlane ? " (within its slices only)" : "") << ", similarity to the MRI "
       << registration.similarityBefore << " before, " << registration.similarityAfter << " after";
  return text.str();
}

}  // namespace glisson::elastography
