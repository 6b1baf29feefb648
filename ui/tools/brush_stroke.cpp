// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/brush_stroke.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "roi/trace.h"

namespace glisson::tools {

namespace {

constexpr double cellsPerRadius = 6.0;
constexpr int finest = 8;               ///< cells per pixel
constexpr double step = 1.0 / 3.0;      ///< of the radius, between two discs
constexpr double corePart = 0.4;        ///< of the radius: what the tissue under the press looks like
constexpr double spread = 3.5;          ///< robust standard deviations of it that are alike
constexpr double leastContrast = 0.03;  ///< of the range of the slice: flatter tissue is as noisy as that
constexpr double follows = 0.2;         ///< of the mean that a disc brings
constexpr double fillHoles = 0.25;      ///< of the disc: smaller holes (vessels, noise) are filled
constexpr double leastPart = 0.02;      ///< vertices keep this far from the middles of cells
constexpr std::size_t samples = 20000;  ///< of the slice, for its range

template <typename V>
double quantile(V& values, double part) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

/// Intensities that differ by less are alike on this slice, however even the tissue.
double leastSpread(const image::ScalarVolume& image, int k) {
  const auto n = static_cast<std::size_t>(image.grid.size.x()) * static_cast<std::size_t>(image.grid.size.y());
  const float* values = &image.values[static_cast<std::size_t>(k) * n];
  std::vector<float> some;
  const std::size_t stride = std::max<std::size_t>(1, n / samples);
  for (std::size_t p = 0; p < n; p += stride)
    if (std::isfinite(values[p])) some.push_back(values[p]);
  if (some.empty()) return 0.0;
  const double low = quantile(some, 0.02), high = quantile(some, 0.98);
  return leastContrast * (high - low);
}

}  // namespace

BrushStroke::BrushStroke(const SlicePlane& plane, std::shared_ptr<const image::ScalarVolume> image,
                         const Eigen::Vector2d& at_mm, double radius_mm)
    : image_(std::move(image)), slice_(plane.slice), radius_mm_(radius_mm), last_mm_(at_mm) {
  const Eigen::Vector2d spacing = plane.grid.spacing_mm.head<2>();
  fine_ = std::clamp(static_cast<int>(std::ceil(cellsPerRadius * spacing.maxCoeff() / radius_mm)), 1, finest);
  nx_ = (plane.grid.size.x() - 1) * fine_ + 1;
  ny_ = (plane.grid.size.y() - 1) * fine_ + 1;
  cell_mm_ = spacing / fine_;
  inside_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), -1.0F);
  low_[0] = nx_, low_[1] = ny_, high_[0] = high_[1] = -1;
  if (!image_) return;
  median_.assign(static_cast<std::size_t>(plane.grid.size.x()) * static_cast<std::size_t>(plane.grid.size.y()),
                 std::numeric_limits<float>::quiet_NaN());
  learn(at_mm);
}

double BrushStroke::value(int i, int j) {
  const int mx = image_->grid.size.x(), my = image_->grid.size.y();
  i = std::clamp(i, 0, mx - 1);
  j = std::clamp(j, 0, my - 1);
  float& kept = median_[static_cast<std::size_t>(j) * static_cast<std::size_t>(mx) + static_cast<std::size_t>(i)];
  if (!std::isnan(kept)) return static_cast<double>(kept);
  std::array<float, 9> around{};
  for (int n = 0; n < 9; ++n) {
    const float v = image_->at(std::clamp(i + n % 3 - 1, 0, mx - 1), std::clamp(j + n / 3 - 1, 0, my - 1), slice_);
    around[static_cast<std::size_t>(n)] = std::isfinite(v) ? v : std::numeric_limits<float>::lowest();
  }
  std::nth_element(around.begin(), around.begin() + 4, around.end());
  kept = around[4];
  return static_cast<double>(kept);
}

/// At a cell, between pixels.
double BrushStroke::valueAt(double i, double j) {
  const int a = static_cast<int>(std::floor(i)), b = static_cast<int>(std::floor(j));
  const double u = i - a, v = j - b;
  if (u == 0.0 && v == 0.0) return value(a, b);
  return (1.0 - v) * ((1.0 - u) * value(a, b) + u * value(a + 1, b)) +
         v * ((1.0 - u) * value(a, b + 1) + u * value(a + 1, b + 1));
}

void BrushStroke::learn(const Eigen::Vector2d& at_mm) {
  const Eigen::Vector2d spacing = cell_mm_ * fine_;
  const double core_mm = std::max(corePart * radius_mm_, 1.5 * spacing.maxCoeff());
  const Eigen::Vector2d middle = at_mm.cwiseQuotient(spacing),
                        reach = Eigen::Vector2d::Constant(core_mm).cwiseQuotient(spacing);
  std::vector<double> values;
  for (int j = static_cast<int>(std::ceil(middle.y() - reach.y())); j <= middle.y() + reach.y(); ++j)
    for (int i = static_cast<int>(std::ceil(middle.x() - reach.x())); i <= middle.x() + reach.x(); ++i)
      if ((Eigen::Vector2d(i, j) - middle).cwiseProduct(spacing).norm() <= core_mm) values.push_back(value(i, j));
  if (values.empty()) values.push_back(value(static_cast<int>(middle.x()), static_cast<int>(middle.y())));
  mean_ = quantile(values, 0.5);
  for (double& v : values) v = std::abs(v - mean_);
  tolerance_ = std::max(spread * std::max(1.4826 * quantile(values, 0.5), leastSpread(*image_, slice_)), 1e-30);
}

void BrushStroke::dragTo(const Eigen::Vector2d& to_mm, bool plain) {
  const Eigen::Vector2d way = to_mm - last_mm_;
  const int n = std::max(1, static_cast<int>(std::ceil(way.norm() / (step * radius_mm_))));
  if (!std::exchange(started_, true)) dab(last_mm_, plain);
  if (way.norm() > 0.0)
    for (int s = 1; s <= n; ++s) dab(last_mm_ + way * (static_cast<double>(s) / n), plain);
  last_mm_ = to_mm;
}

void BrushStroke::dab(const Eigen::Vector2d& at_mm, bool plain) {
  const Eigen::Vector2d middle = at_mm.cwiseQuotient(cell_mm_);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_mm_).cwiseQuotient(cell_mm_).array() + 1.0;
  const int i0 = std::max(0, static_cast<int>(std::ceil(middle.x() - reach.x()))),
            i1 = std::min(nx_ - 1, static_cast<int>(std::floor(middle.x() + reach.x()))),
            j0 = std::max(0, static_cast<int>(std::ceil(middle.y() - reach.y()))),
            j1 = std::min(ny_ - 1, static_cast<int>(std::floor(middle.y() + reach.y())));
  if (i0 > i1 || j0 > j1) return;
  const bool adaptive = image_ && !plain;
  const int width = i1 - i0 + 1, height = j1 - j0 + 1;
  const auto at = [&](int i, int j) { return static_cast<std::size_t>((j - j0) * width + i - i0); };
  std::vector<float> part(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<int> open;
  std::vector<char> reached(part.size(), adaptive ? 0 : 1);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const Eigen::Vector2d off = (Eigen::Vector2d(i, j) - middle).cwiseProduct(cell_mm_);
      double in = (radius_mm_ - off.norm()) / cell_mm_.mean();
      if (adaptive && in > 0.0)
        in = std::min(in,
                      1.0 - std::abs(valueAt(static_cast<double>(i) / fine_, static_cast<double>(j) / fine_) - mean_) /
                                tolerance_);
      part[at(i, j)] = static_cast<float>(std::clamp(in, -1.0, 1.0));
      const bool seed = off.cwiseAbs().cwiseQuotient(cell_mm_).maxCoeff() <= 0.5 || inside_[cell(i, j)] > 0.0F;
      if (adaptive && part[at(i, j)] > 0.0F && seed) {
        reached[at(i, j)] = 1;
        open.push_back(j * nx_ + i);
      }
    }
  double sum = 0.0;
  std::size_t n = 0;
  while (!open.empty()) {
    const int i = open.back() % nx_, j = open.back() / nx_;
    open.pop_back();
    sum += valueAt(static_cast<double>(i) / fine_, static_cast<double>(j) / fine_);
    ++n;
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int a = i + di, b = j + dj;
      if (a < i0 || b < j0 || a > i1 || b > j1 || reached[at(a, b)] != 0 || part[at(a, b)] <= 0.0F) continue;
      reached[at(a, b)] = 1;
      open.push_back(b * nx_ + a);
    }
  }
  if (n > 0) mean_ += follows * (sum / static_cast<double>(n) - mean_);
  // Cells beside what is reached keep how far they are from it, so that the border runs between the two.
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const float in = part[at(i, j)];
      if (in > 0.0F && reached[at(i, j)] == 0) continue;
      inside_[cell(i, j)] = std::max(inside_[cell(i, j)], in);
    }
  low_[0] = std::min(low_[0], i0), low_[1] = std::min(low_[1], j0);
  high_[0] = std::max(high_[0], i1), high_[1] = std::max(high_[1], j1);
}

std::vector<Outline> BrushStroke::rings(double tolerance_mm) const {
  std::vector<Outline> result;
  if (high_[0] < low_[0]) return result;
  image::Grid grid;
  grid.size = {high_[0] - low_[0] + 1, high_[1] - low_[1] + 1, 1};
  image::Mask mask(grid);
  for (int j = 0; j < grid.size.y(); ++j)
    for (int i = 0; i < grid.size.x(); ++i) mask.at(i, j, 0) = inside_[cell(low_[0] + i, low_[1] + j)] > 0.0F ? 1 : 0;
  const auto level = [&](const roi::HalfPoint& p) -> Eigen::Vector2d {
    const Eigen::Vector2d middle(0.5 * p[0] + low_[0], 0.5 * p[1] + low_[1]);
    const int axis = p[0] % 2 != 0 ? 0 : 1;
    Eigen::Vector2d low = middle, high = middle;
    low[axis] -= 0.5;
    high[axis] += 0.5;
    if (low.minCoeff() < 0.0 || high.x() > nx_ - 1 || high.y() > ny_ - 1) return middle;  // the border of the image
    const double a = static_cast<double>(inside_[cell(static_cast<int>(low.x()), static_cast<int>(low.y()))]);
    const double b = static_cast<double>(inside_[cell(static_cast<int>(high.x()), static_cast<int>(high.y()))]);
    return low + std::clamp(a / (a - b), leastPart, 1.0 - leastPart) * (high - low);
  };
  const double disc_mm2 = std::numbers::pi * radius_mm_ * radius_mm_;
  for (const std::vector<roi::HalfPoint>& traced : roi::ringsOf(mask, 0)) {
    Outline ring(2, static_cast<Eigen::Index>(traced.size()) + 1);
    for (std::size_t v = 0; v <= traced.size(); ++v)
      ring.col(static_cast<Eigen::Index>(v)) = level(traced[v % traced.size()]).cwiseProduct(cell_mm_);
    // Anticlockwise around what is inside: the others are holes.
    const Outline whole = ring.leftCols(ring.cols() - 1);
    if (signedArea(whole) < 0.0 && -signedArea(whole) < fillHoles * disc_mm2) continue;
    std::vector<Eigen::Index> kept = simplify(ring, tolerance_mm);
    kept.pop_back();  // the first point again
    if (kept.size() < 3) continue;
    Outline simple = whole(Eigen::all, kept);
    result.push_back(crossesItself(simple, true) ? whole : std::move(simple));
  }
  return result;
}

}  // namespace glisson::tools
