// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/smooth_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "anatomy/surface_field.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/components.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "retraction/marching_tetrahedra.h"

namespace glisson::retraction {
namespace {

constexpr double reach = 4.5;  // standard deviations; 7e-6 of a Gaussian lies beyond

/// A hat of half width s (linear interpolation between samples s apart) smoothed by a Gaussian: the hat is the second
/// difference of a ramp, so its smoothed form is that of the smoothed ramp, in closed form.
double smoothedHat(double x, double s, double sigma) {
  auto ramp = [sigma](double t) {
    const double u = t / sigma;
    return t * 0.5 * std::erfc(-u / std::numbers::sqrt2) +
           sigma * std::exp(-0.5 * u * u) / std::sqrt(2.0 * std::numbers::pi);
  };
  return (ramp(x + s) - 2.0 * ramp(x) + ramp(x - s)) / s;
}

/// One axis of the smoothed field: which samples of the mask each corner of a cube sums, with their weights.
struct AxisWeights {
  struct Row {
    int first = 0;
    std::vector<float> weights;
  };
  std::vector<Row> rows;
  double start_mm = 0.0;  ///< of the first cube corner, from the mask's first sample

  AxisWeights(int samples, double spacing_mm) {
    const double margin_mm = spacing_mm + reach * SmoothBody::sigma_mm, length_mm = (samples - 1) * spacing_mm;
    const int corners = static_cast<int>(std::ceil((length_mm + 2.0 * margin_mm) / SmoothBody::cube_mm)) + 1;
    start_mm = 0.5 * (length_mm - (corners - 1) * SmoothBody::cube_mm);
    rows.resize(static_cast<std::size_t>(corners));
    for (int o = 0; o < corners; ++o) {
      const double x = start_mm + o * SmoothBody::cube_mm;
      Row& row = rows[static_cast<std::size_t>(o)];
      row.first = std::clamp(static_cast<int>(std::ceil((x - margin_mm) / spacing_mm)), 0, samples);
      const int last = std::clamp(static_cast<int>(std::floor((x + margin_mm) / spacing_mm)), -1, samples - 1);
      for (int i = row.first; i <= last; ++i)
        row.weights.push_back(static_cast<float>(smoothedHat(x - i * spacing_mm, spacing_mm, SmoothBody::sigma_mm)));
    }
  }
};

/// Sums along one axis of an array of outer × samples × inner values, inner fastest.
std::vector<float> along(const std::vector<float>& in, std::size_t outer, std::size_t inner, std::size_t samples,
                         const AxisWeights& axis) {
  const std::size_t corners = axis.rows.size();
  std::vector<float> out(outer * corners * inner, 0.0f);
  parallelChunks(outer * corners, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task) {
      const AxisWeights::Row& row = axis.rows[task % corners];
      float* to = &out[task * inner];
      const float* from = in.data() + ((task / corners) * samples + static_cast<std::size_t>(row.first)) * inner;
      for (const float w : row.weights) {
        for (std::size_t i = 0; i < inner; ++i) to[i] += w * from[i];
        from += inner;
      }
    }
  });
  return out;
}

/// How much of the mask's body each point of a lattice along its axes stands for, 0 to 1: the mask's own voxels. Thick
/// slices (more than 1.5 × the spacing within them) are interpolated by shape first, as for anatomy's surface: linear
/// interpolation of the mask would leave terraces.
image::ScalarVolume covered(const image::Mask& mask) {
  const auto extent = image::extentOf(mask);
  if (!extent) throw BadInput("the region of interest holds no voxel; check the mask and its label");
  const Eigen::Vector3d& spacing_mm = mask.grid.spacing_mm;
  if (spacing_mm.z() > 1.5 * spacing_mm.head<2>().maxCoeff()) {
    anatomy::SurfaceField shape = anatomy::surfaceField(mask, SmoothBody::cube_mm);
    const double edge_mm = shape.values_mm.grid.spacing_mm.mean();
    for (float& v : shape.values_mm.values)
      v = static_cast<float>(std::clamp(0.5 + (static_cast<double>(v) - shape.level_mm) / edge_mm, 0.0, 1.0));
    return std::move(shape.values_mm);
  }
  image::Grid grid = mask.grid;
  grid.size = extent->high - extent->low + Eigen::Vector3i::Ones();
  grid.origin_lps_mm = mask.grid.indexToLps(extent->low.cast<double>());
  image::ScalarVolume result(grid);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        result.at(i, j, k) = mask.at(extent->low + Eigen::Vector3i(i, j, k)) != 0 ? 1.0f : 0.0f;
  return result;
}

image::ScalarVolume smoothed(image::ScalarVolume body) {
  image::ScalarVolume field;
  field.grid.direction = body.grid.direction;
  field.grid.spacing_mm.setConstant(SmoothBody::cube_mm);
  Eigen::Vector3d start_mm;
  std::size_t inner = 1;
  for (int a = 0; a < 3; ++a) {
    const AxisWeights axis(body.grid.size[a], body.grid.spacing_mm[a]);
    const auto samples = static_cast<std::size_t>(body.grid.size[a]);
    body.values = along(body.values, body.values.size() / (inner * samples), inner, samples, axis);
    field.grid.size[a] = static_cast<int>(axis.rows.size());
    start_mm[a] = axis.start_mm;
    inner *= axis.rows.size();
  }
  field.grid.origin_lps_mm = body.grid.origin_lps_mm + body.grid.direction * start_mm;
  field.values = std::move(body.values);
  return field;
}

/// The eight values of a cube, and the trilinear function between them.
struct Cube {
  std::array<float, 8> f;
  Cube(const image::ScalarVolume& field, int i, int j, int k) {
    const std::size_t at = field.grid.linear(i, j, k), y = field.grid.linear(0, 1, 0), z = field.grid.linear(0, 0, 1);
    const float* v = field.values.data() + at;
    f = {v[0], v[1], v[y], v[y + 1], v[z], v[z + 1], v[z + y], v[z + y + 1]};
  }
  float operator()(float x, float y, float z) const {
    const float a = f[0] + x * (f[1] - f[0]), b = f[2] + x * (f[3] - f[2]);
    const float c = f[4] + x * (f[5] - f[4]), d = f[6] + x * (f[7] - f[6]);
    const float ab = a + y * (b - a), cd = c + y * (d - c);
    return ab + z * (cd - ab);
  }
};

/// How many of 4 x 4 x 4 points in every cube have which value, for all levels at once.
class Histogram {
 public:
  explicit Histogram(const image::ScalarVolume& field) : counts_(bins, 0) {
    const Eigen::Vector3i n = field.grid.size;
    const auto layers = static_cast<std::size_t>(n.z() - 1);
    std::vector<std::vector<std::int64_t>> each(layers);
    parallelChunks(layers, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        each[k].assign(bins, 0);
        for (int j = 0; j + 1 < n.y(); ++j)
          for (int i = 0; i + 1 < n.x(); ++i) add(Cube(field, i, j, static_cast<int>(k)), each[k]);
      }
    });
    for (const auto& layer : each)
      for (std::size_t b = 0; b < bins; ++b) counts_[b] += layer[b];
    sample_mm3_ = field.grid.voxelVolume_mm3() / 64.0;
  }

  /// Level above which the field holds the volume.
  double levelFor(double volume_mm3) const {
    const double wanted = volume_mm3 / sample_mm3_;
    double above = 0.0;
    for (std::size_t b = bins; b-- > 1;) {
      const auto here = static_cast<double>(counts_[b]);
      if (above + here >= wanted) return (static_cast<double>(b + 1) - (wanted - above) / here) / bins;
      above += here;
    }
    return 1.0 / bins;
  }

 private:
  static constexpr std::size_t bins = 4096;
  static std::size_t bin(float v) {
    return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0f, v) * static_cast<float>(bins)));
  }
  static void add(const Cube& cube, std::vector<std::int64_t>& counts) {
    const auto [low, high] = std::minmax_element(cube.f.begin(), cube.f.end());
    if (bin(*low) == bin(*high)) {
      counts[bin(*low)] += 64;
      return;
    }
    for (int s = 0; s < 64; ++s) {
      auto at = [s](int shift) { return 0.125f + 0.25f * static_cast<float>(s >> shift & 3); };
      ++counts[bin(cube(at(0), at(2), at(4)))];
    }
  }

  std::vector<std::int64_t> counts_;
  double sample_mm3_ = 0.0;
};

image::Mask above(const image::ScalarVolume& field, double level) {
  image::Mask result(field.grid);
  for (std::size_t i = 0; i < field.values.size(); ++i)
    result.values[i] = static_cast<double>(field.values[i]) > level ? 1 : 0;
  return result;
}

/// Leaves the largest piece above the level; returns the share of the points above it that stay.
double keepLargest(image::ScalarVolume& field, double level) {
  const image::Components parts = image::components(above(field, level));
  if (parts.voxels.empty())
    throw BadInput("the body is too small to have a smooth surface: smoothed by 2 mm nothing of it is left");
  if (parts.voxels.size() == 1) return 1.0;
  std::size_t all = 0;
  for (const std::size_t part : parts.voxels) all += part;
  for (std::size_t i = 0; i < field.values.size(); ++i)
    if (parts.labels.values[i] > 1) field.values[i] = 0.0f;
  return static_cast<double>(parts.voxels.front()) / static_cast<double>(all);
}

/// Index range, in the frame of `cells`, of the body: of the crossings of its surface with the field's own lattice
/// lines.
Eigen::AlignedBox3d extentIn(const image::Grid& cells, const image::ScalarVolume& field, double level) {
  Eigen::AlignedBox3d box;
  const Eigen::Vector3i n = field.grid.size;
  for (int k = 1; k + 1 < n.z(); ++k)
    for (int j = 1; j + 1 < n.y(); ++j)
      for (int i = 1; i + 1 < n.x(); ++i) {
        const double f = static_cast<double>(field.at(i, j, k));
        if (f <= level) continue;
        for (int a = 0; a < 3; ++a)
          for (const int side : {-1, 1}) {
            const Eigen::Vector3i p = Eigen::Vector3i(i, j, k), q = p + side * Eigen::Vector3i::Unit(a);
            const double g = static_cast<double>(field.at(q));
            if (g > level) continue;
            const Eigen::Vector3d at = p.cast<double>() + (f - level) / (f - g) * (q - p).cast<double>();
            box.extend(cells.lpsToIndex(field.grid.indexToLps(at)));
          }
      }
  return box;
}

/// Covered fractions of the cells of a grid, by 4 x 4 x 4 points in each.
class CellCover {
 public:
  CellCover(const image::ScalarVolume& field, double level, const image::Grid& cells)
      : field_(field),
        level_(static_cast<float>(level)),
        columns_(field.grid.spacing_mm.cwiseInverse().asDiagonal() * field.grid.direction.transpose() *
                 cells.direction * cells.spacing_mm.asDiagonal()),
        offset_(field.grid.lpsToIndex(cells.origin_lps_mm)),
        half_(0.375 * columns_.cwiseAbs().rowwise().sum()),
        last_(field.grid.size - Eigen::Vector3i::Constant(2)) {
    for (int s = 0; s < 64; ++s) {
      const Eigen::Vector3d in = 0.25 * Eigen::Vector3d(s & 3, s >> 2 & 3, s >> 4) - Eigen::Vector3d::Constant(0.375);
      samples_[static_cast<std::size_t>(s)] = (columns_ * in).cast<float>();
    }
  }

  float of(const Eigen::Vector3d& cell) const {
    const Eigen::Vector3d centre = columns_ * cell + offset_;
    switch (around(centre)) {
      case Around::Outside: return 0.0f;
      case Around::Inside: return 1.0f;
      case Around::Both: break;
    }
    int inside = 0;
    for (const Eigen::Vector3f& sample : samples_) {
      const Eigen::Vector3f p = centre.cast<float>() + sample;
      if ((p.array() < 0.0f).any()) continue;
      const Eigen::Vector3i low = p.cast<int>();
      if ((low.array() > last_.array()).any()) continue;
      const Eigen::Vector3f t = p - low.cast<float>();
      inside += Cube(field_, low.x(), low.y(), low.z())(t.x(), t.y(), t.z()) > level_ ? 1 : 0;
    }
    return static_cast<float>(inside) / 64.0f;
  }

 private:
  enum class Around { Outside, Inside, Both };
  /// Where the field's points are that the cell's values come from.
  Around around(const Eigen::Vector3d& centre) const {
    const Eigen::Vector3d floor = (centre - half_).array().floor(), ceil = (centre + half_).array().ceil();
    if ((ceil.array() < 0.0).any() || (floor.array() > last_.cast<double>().array()).any()) return Around::Outside;
    const Eigen::Vector3i low = floor.cast<int>().cwiseMax(0), high = ceil.cast<int>().cwiseMin(last_);
    bool some = false, all = true;
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i) {
          const bool inside = field_.at(i, j, k) > level_;
          some = some || inside;
          all = all && inside;
        }
    return all ? Around::Inside : some ? Around::Both : Around::Outside;
  }

  const image::ScalarVolume& field_;
  float level_;
  Eigen::Matrix3d columns_;  ///< a cell's edges, in cubes of the field
  Eigen::Vector3d offset_, half_;
  Eigen::Vector3i last_;
  std::array<Eigen::Vector3f, 64> samples_;  ///< from the cell's centre
};

}  // namespace

SmoothBody::SmoothBody(const image::Mask& mask) : field_(smoothed(covered(mask))) {
  const double all_mm3 = static_cast<double>(image::count(mask)) * mask.grid.voxelVolume_mm3();
  volume_mm3_ = all_mm3;
  // Other pieces take their share of the volume along; a new level may bring new specks, which go as well.
  for (double kept = 0.0; kept < 1.0;) {
    level_ = Histogram(field_).levelFor(volume_mm3_);
    kept = keepLargest(field_, level_);
    volume_mm3_ *= kept;
  }
  leftOut_mm3_ = all_mm3 - volume_mm3_;
}

image::Mask SmoothBody::mask() const {
  return above(field_, level_);
}

double SmoothBody::value(const Eigen::Vector3d& p_lps_mm) const {
  return static_cast<double>(image::sampleLinear(field_, p_lps_mm, 0.0f));
}

Eigen::Vector3d SmoothBody::gradient(const Eigen::Vector3d& p_lps_mm) const {
  Eigen::Vector3d along;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d step = cube_mm * field_.grid.direction.col(a);
    along[a] = (value(p_lps_mm + step) - value(p_lps_mm - step)) / (2.0 * cube_mm);
  }
  return field_.grid.direction * along;
}

image::ScalarVolume SmoothBody::fractions(const image::Grid& cells) const {
  const std::lock_guard guard(made_->lock);
  if (!made_->fractions.values.empty() && made_->cells.sameGeometry(cells)) return made_->fractions;
  image::Grid grid = cells;
  const Eigen::AlignedBox3d box = extentIn(cells, field_, level_);
  const Eigen::Vector3d outer = cells.size.cast<double>() - Eigen::Vector3d::Constant(0.5);
  const double beyond =
      std::max((Eigen::Vector3d::Constant(-0.5) - box.min()).maxCoeff(), (box.max() - outer).maxCoeff());
  if (beyond > 0.0) {
    const int layers = static_cast<int>(std::ceil(beyond));
    grid.size = cells.size + Eigen::Vector3i::Constant(2 * layers);
    grid.origin_lps_mm = cells.indexToLps(Eigen::Vector3d::Constant(-layers));
  }
  grid.check();

  image::ScalarVolume result(grid);
  const CellCover cover(field_, level_, grid);
  parallelChunks(static_cast<std::size_t>(grid.size.z()), 1, [&](std::size_t begin, std::size_t end) {
    for (int k = static_cast<int>(begin); k < static_cast<int>(end); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) result.at(i, j, k) = cover.of(Eigen::Vector3d(i, j, k));
  });
  made_->cells = cells;
  made_->fractions = result;
  return result;
}

const mechanics::TriangleSurface& SmoothBody::surface() const {
  const std::lock_guard guard(made_->lock);
  if (!made_->surface) made_->surface = largestShell(marchingTetrahedra(field_, level_));
  return *made_->surface;
}

mechanics::TriangleSurface SmoothBody::surface(double spacing_mm) const {
  if (!(spacing_mm > 0.0)) throw BadArgument("SmoothBody::surface: the spacing must be positive");
  if (spacing_mm == cube_mm) return surface();
  image::Grid grid = field_.grid;
  const Eigen::Vector3d extent_mm = (grid.size - Eigen::Vector3i::Ones()).cast<double>() * cube_mm;
  grid.spacing_mm.setConstant(spacing_mm);
  grid.size = (extent_mm / spacing_mm).array().ceil().cast<int>() + 1;
  return largestShell(marchingTetrahedra(image::resampleLinear(field_, grid, 0.0f), level_));
}

}  // namespace glisson::retraction
