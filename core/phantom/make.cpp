// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "phantom/detail/elastogram.h"
#include "phantom/detail/hand_contour.h"
#include "phantom/detail/torso.h"
#include "phantom/detail/vessel_tree.h"
#include "phantom/phantom.h"

namespace glisson::phantom {
namespace {

constexpr double pixel_mm = 1.64;
constexpr int pixels = 256;
constexpr double mriSlice_mm = 2.5;
constexpr double mreSlice_mm = 10.0;
constexpr int planesPerMreSlice = 4;
constexpr float farAway = 1e3F;

image::Grid gridOf(double lowest_mm, double spacing_mm, int slices) {
  image::Grid g;
  g.size = {pixels, pixels, slices};
  g.spacing_mm = {pixel_mm, pixel_mm, spacing_mm};
  g.origin_lps_mm = {-0.5 * (pixels - 1) * pixel_mm, -0.5 * (pixels - 1) * pixel_mm, lowest_mm};
  return g;
}

// Unbranched runs between forks become branches; parents come before children.
void listBranches(const VesselTree& tree, const std::string& name, std::vector<VesselBranch>& out) {
  const auto& nodes = tree.nodes();
  std::vector<std::pair<int, int>> stack;  // first node of a branch, index of the branch it leaves
  for (auto c = nodes.front().children.rbegin(); c != nodes.front().children.rend(); ++c) stack.emplace_back(*c, -1);
  while (!stack.empty()) {
    auto [node, parent] = stack.back();
    stack.pop_back();
    VesselBranch branch;
    branch.name = name;
    branch.parent = parent;
    branch.radius_mm = tree.radius_mm(node);
    branch.points_lps_mm = nodes[static_cast<std::size_t>(node)].path_lps_mm;
    while (nodes[static_cast<std::size_t>(node)].children.size() == 1) {
      node = nodes[static_cast<std::size_t>(node)].children.front();
      const auto& more = nodes[static_cast<std::size_t>(node)].path_lps_mm;
      branch.points_lps_mm.insert(branch.points_lps_mm.end(), more.begin() + 1, more.end());
    }
    const int self = static_cast<int>(out.size());
    out.push_back(std::move(branch));
    const auto& children = nodes[static_cast<std::size_t>(node)].children;
    for (auto c = children.rbegin(); c != children.rend(); ++c) stack.emplace_back(*c, self);
  }
}

// Signed distance to all branches, within a few millimetres of them; far away elsewhere.
std::vector<float> vesselDistance(const image::Grid& grid, const std::vector<VesselBranch>& vessels) {
  std::vector<float> d(grid.voxelCount(), farAway);
  for (const VesselBranch& branch : vessels)
    for (std::size_t s = 0; s + 1 < branch.points_lps_mm.size(); ++s) {
      const Capsule capsule{branch.points_lps_mm[s], branch.points_lps_mm[s + 1], branch.radius_mm};
      const Point reach = Point::Constant(branch.radius_mm + 4.0);
      const Point low = grid.lpsToIndex(capsule.a_lps_mm.cwiseMin(capsule.b_lps_mm) - reach);
      const Point high = grid.lpsToIndex(capsule.a_lps_mm.cwiseMax(capsule.b_lps_mm) + reach);
      const Eigen::Vector3i from = low.array().ceil().cast<int>().max(0);
      const Eigen::Vector3i to = high.array().floor().cast<int>().min(grid.size.array() - 1);
      for (int k = from.z(); k <= to.z(); ++k)
        for (int j = from.y(); j <= to.y(); ++j)
          for (int i = from.x(); i <= to.x(); ++i) {
            float& value = d[grid.linear(i, j, k)];
            value = std::min(value, static_cast<float>(capsule.distance_mm(grid.indexToLps(Point(i, j, k)))));
          }
    }
  return d;
}

// Magnitude of a complex signal with Gaussian noise in both parts.
std::int16_t rician(double signal, double sigma, Random& r) {
  return static_cast<std::int16_t>(
      std::lround(std::min(std::hypot(signal + sigma * r.normal(), sigma * r.normal()), 32767.0)));
}

// Receive coils: brighter near the skin, and a slow tilt that differs between patients.
struct CoilShading {
  double tiltX = 0.0;
  double tiltY = 0.0;
  double tiltZ = 0.0;
  explicit CoilShading(std::uint64_t seed) {
    Random r = derived(seed, 71);
    tiltX = r.uniform(-0.08, 0.08);
    tiltY = r.uniform(-0.14, 0.02);
    tiltZ = r.uniform(-0.05, 0.05);
  }
  double operator()(const Point& p) const {
    const double ring = std::pow(p.x() / 170.0, 2) + std::pow(p.y() / 115.0, 2);
    return 0.88 + 0.20 * ring + tiltX * p.x() / 170.0 + tiltY * p.y() / 115.0 + tiltZ * p.z() / 100.0;
  }
};

// A patient while it is made, on the grids of its two acquisitions.
class Making {
 public:
  Making(std::uint64_t seed, const PhantomOptions& options, PhantomPatient& patient);
  void anatomy();
  void vessels();
  void mri();
  void elastography(std::optional<double> shear_kPa);
  void contours() { patient_.contours = drawByHand(liver_mm_, seed_); }

 private:
  Point position(std::size_t v) const {
    return grid_.indexToLps(Point(static_cast<double>(v % pixels), static_cast<double>((v / pixels) % pixels),
                                  static_cast<double>(v / slice)));
  }

  static constexpr std::size_t slice = static_cast<std::size_t>(pixels) * pixels;  // voxels of one
  std::uint64_t seed_;
  PhantomPatient& patient_;
  Torso torso_;
  image::Grid grid_, mreGrid_;
  // On the MRI grid; signed distances, negative inside.
  std::vector<float> body_mm_;
  image::ScalarVolume liver_mm_;
  std::vector<float> vessel_mm_;
  std::vector<float> gradientEcho_;  // the elastography sequence's signal
};

Making::Making(std::uint64_t seed, const PhantomOptions& options, PhantomPatient& patient)
    : seed_(seed), patient_(patient), torso_(seed, options.shape) {
  patient.number = options.number;
  patient.truth.seed = seed;
  patient.truth.shape = options.shape;
  // MRE planes lie at multiples of 10 mm and hold the whole liver; the MRI reaches one such step further.
  const double lowest = std::floor(torso_.liverBottom_mm() / mreSlice_mm) * mreSlice_mm;
  const double highest = std::ceil(torso_.liverTop_mm() / mreSlice_mm) * mreSlice_mm;
  const int mreSlices = static_cast<int>(std::lround((highest - lowest) / mreSlice_mm)) + 1;
  mreGrid_ = gridOf(lowest, mreSlice_mm, mreSlices);
  grid_ = gridOf(lowest - mreSlice_mm, mriSlice_mm, (mreSlices + 1) * planesPerMreSlice + 1);
}

void Making::anatomy() {
  body_mm_.assign(grid_.voxelCount(), farAway);
  liver_mm_ = image::ScalarVolume(grid_, farAway);
  parallelChunks(grid_.voxelCount(), slice, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Point p = position(v);
      if (std::abs(p.x()) > 200.0 || std::abs(p.y()) > 140.0) continue;
      body_mm_[v] = static_cast<float>(torso_.body_mm(p));
      if (body_mm_[v] < 0.0F) liver_mm_.values[v] = static_cast<float>(torso_.liver_mm(p));
    }
  });
  patient_.liver = image::Mask(grid_);
  std::size_t count = 0;
  for (std::size_t v = 0; v < liver_mm_.values.size(); ++v)
    if (liver_mm_.values[v] < 0.0F) {
      patient_.liver.values[v] = 1;
      ++count;
    }
  patient_.truth.volume_mL = static_cast<double>(count) * grid_.voxelVolume_mm3() / 1000.0;
}

void Making::vessels() {
  const LiverVessels grown = growVessels(
      [&](const Point& p) { return torso_.liver_mm(p); }, Point(-165, -115, torso_.liverBottom_mm()),
      Point(120, 110, torso_.liverTop_mm()), torso_.portalHilum_lps_mm(), torso_.hepaticConfluence_lps_mm(), seed_);
  std::vector<VesselBranch>& branches = patient_.truth.vessels;
  listBranches(grown.portal, "portal", branches);
  const auto portalBranches = static_cast<int>(branches.size());
  std::vector<VesselBranch> hepatic;
  listBranches(grown.hepatic, "hepatic", hepatic);
  for (VesselBranch& b : hepatic) {
    if (b.parent >= 0) b.parent += portalBranches;
    branches.push_back(std::move(b));
  }
  vessel_mm_ = vesselDistance(grid_, branches);
}

void Making::mri() {
  const CoilShading shading(seed_);
  patient_.mri = Int16Volume(grid_);
  gradientEcho_.resize(grid_.voxelCount());
  parallelChunks(grid_.voxelCount(), slice, [&](std::size_t begin, std::size_t end) {
    Random r = derived(seed_, 1000 + begin / slice);
    for (std::size_t v = begin; v < end; ++v) {
      const Point p = position(v);
      const Torso::Signal s =
          torso_.signal(p, static_cast<double>(body_mm_[v]), static_cast<double>(liver_mm_.values[v]),
                        static_cast<double>(vessel_mm_[v]));
      const double coil = shading(p);
      patient_.mri.values[v] = rician(coil * s.contrast, 16.0, r);
      gradientEcho_[v] = static_cast<float>(coil * s.elastography);
    }
  });
}

void Making::elastography(std::optional<double> shear_kPa) {
  // MRE slices are thick: the mean over the MRI planes they hold. Distances are those at the middle plane.
  patient_.magnitude = Int16Volume(mreGrid_);
  std::vector<float> body(mreGrid_.voxelCount()), liver(mreGrid_.voxelCount()), vessel(mreGrid_.voxelCount());
  parallelChunks(mreGrid_.voxelCount(), slice, [&](std::size_t begin, std::size_t end) {
    Random r = derived(seed_, 3000 + begin / slice);
    const std::size_t middle = (begin / slice + 1) * planesPerMreSlice;  // MRI plane at the same height
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t at = middle * slice + (v - begin);
      body[v] = body_mm_[at];
      liver[v] = liver_mm_.values[at];
      vessel[v] = vessel_mm_[at];
      const auto echo = [&](std::size_t voxel) { return static_cast<double>(gradientEcho_[voxel]); };
      const double mean = 0.25 * (echo(at - slice) + echo(at) + echo(at + slice)) +
                          0.125 * (echo(at - 2 * slice) + echo(at + 2 * slice));
      patient_.magnitude.values[v] = rician(mean, 9.0, r);
    }
  });
  Random draw = derived(seed_, 81);
  const double drawn_kPa = 2.0 + 4.0 * std::pow(draw.uniform(), 1.6);
  ElastogramInput elastogram;
  elastogram.grid = mreGrid_;
  elastogram.body_mm = &body;
  elastogram.liver_mm = &liver;
  elastogram.vessel_mm = &vessel;
  elastogram.shear_kPa = shear_kPa.value_or(drawn_kPa);
  elastogram.seed = seed_;
  fillElastogram(elastogram, patient_);
}

}  // namespace

PhantomPatient makePhantom(std::uint64_t seed, const PhantomOptions& options, const Progress& progress) {
  if (options.number < 1 || options.number > 9999)
    throw BadArgument("makePhantom: patient number " + std::to_string(options.number) + "; give 1 to 9999");
  if (options.shear_kPa && !(*options.shear_kPa >= 0.5 && *options.shear_kPa <= 15.0))
    throw BadArgument("makePhantom: mean shear modulus " + std::to_string(*options.shear_kPa) + " kPa; give 0.5 to 15");
  PhantomPatient patient;
  progress.report(0.0, "anatomy");
  Making making(seed, options, patient);
  making.anatomy();
  progress.report(0.25, "vessels");
  making.vessels();
  progress.report(0.4, "magnetic resonance images");
  making.mri();
  progress.report(0.75, "elastography");
  making.elastography(options.shear_kPa);
  progress.report(0.95, "contours");
  making.contours();
  progress.report(1.0, "patient");
  return patient;
}

}  // namespace glisson::phantom
