#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "phantom/elastogram.h"
#include "phantom/hand_contour.h"
#include "phantom/phantom.h"
#include "phantom/torso.h"
#include "phantom/vessel_tree.h"

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

}  // namespace

PhantomPatient makePhantom(std::uint64_t seed, const PhantomOptions& options, const Progress& progress) {
  if (options.number < 1 || options.number > 9999)
    throw BadArgument("makePhantom: patient number " + std::to_string(options.number) + "; give 1 to 9999");
  if (options.shear_kPa && !(*options.shear_kPa >= 0.5 && *options.shear_kPa <= 15.0))
    throw BadArgument("makePhantom: mean shear modulus " + std::to_string(*options.shear_kPa) + " kPa; give 0.5 to 15");
  PhantomPatient patient;
  patient.number = options.number;
  patient.truth.seed = seed;
  patient.truth.shape = options.shape;
  progress.report(0.0, "anatomy");
  const Torso torso(seed, options.shape);

  // MRE planes lie at multiples of 10 mm and hold the whole liver; the MRI reaches one such step further.
  const double lowest = std::floor(torso.liverBottom_mm() / mreSlice_mm) * mreSlice_mm;
  const double highest = std::ceil(torso.liverTop_mm() / mreSlice_mm) * mreSlice_mm;
  const int mreSlices = static_cast<int>(std::lround((highest - lowest) / mreSlice_mm)) + 1;
  const image::Grid mreGrid = gridOf(lowest, mreSlice_mm, mreSlices);
  const image::Grid grid = gridOf(lowest - mreSlice_mm, mriSlice_mm, (mreSlices + 1) * planesPerMreSlice + 1);
  const auto slice = static_cast<std::size_t>(pixels) * pixels;
  auto position = [&](std::size_t v) {
    return grid.indexToLps(Point(static_cast<double>(v % pixels), static_cast<double>((v / pixels) % pixels),
                                 static_cast<double>(v / slice)));
  };

  std::vector<float> body(grid.voxelCount(), farAway);
  image::ScalarVolume liver(grid, farAway);
  parallelChunks(grid.voxelCount(), slice, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Point p = position(v);
      if (std::abs(p.x()) > 200.0 || std::abs(p.y()) > 140.0) continue;
      body[v] = static_cast<float>(torso.body_mm(p));
      if (body[v] < 0.0F) liver.values[v] = static_cast<float>(torso.liver_mm(p));
    }
  });
  patient.liver = image::Mask(grid);
  std::size_t count = 0;
  for (std::size_t v = 0; v < liver.values.size(); ++v)
    if (liver.values[v] < 0.0F) {
      patient.liver.values[v] = 1;
      ++count;
    }
  patient.truth.volume_mL = static_cast<double>(count) * grid.voxelVolume_mm3() / 1000.0;
  progress.report(0.25, "vessels");

  const LiverVessels vessels = growVessels(
      [&](const Point& p) { return torso.liver_mm(p); }, Point(-165, -115, torso.liverBottom_mm()),
      Point(120, 110, torso.liverTop_mm()), torso.portalHilum_lps_mm(), torso.hepaticConfluence_lps_mm(), seed);
  listBranches(vessels.portal, "portal", patient.truth.vessels);
  const auto portalBranches = static_cast<int>(patient.truth.vessels.size());
  std::vector<VesselBranch> hepatic;
  listBranches(vessels.hepatic, "hepatic", hepatic);
  for (VesselBranch& b : hepatic) {
    if (b.parent >= 0) b.parent += portalBranches;
    patient.truth.vessels.push_back(std::move(b));
  }
  const std::vector<float> vessel = vesselDistance(grid, patient.truth.vessels);
  progress.report(0.4, "magnetic resonance images");

  const CoilShading shading(seed);
  patient.mri = Int16Volume(grid);
  std::vector<float> gradientEcho(grid.voxelCount());
  parallelChunks(grid.voxelCount(), slice, [&](std::size_t begin, std::size_t end) {
    Random r = derived(seed, 1000 + begin / slice);
    for (std::size_t v = begin; v < end; ++v) {
      const Point p = position(v);
      const Torso::Signal s = torso.signal(p, static_cast<double>(body[v]), static_cast<double>(liver.values[v]),
                                           static_cast<double>(vessel[v]));
      const double coil = shading(p);
      patient.mri.values[v] = rician(coil * s.contrast, 16.0, r);
      gradientEcho[v] = static_cast<float>(coil * s.elastography);
    }
  });
  progress.report(0.75, "elastography");

  // MRE slices are thick: the mean over the MRI planes they hold. Distances are those at the middle plane.
  patient.magnitude = Int16Volume(mreGrid);
  std::vector<float> bodyMre(mreGrid.voxelCount());
  std::vector<float> liverMre(mreGrid.voxelCount());
  std::vector<float> vesselMre(mreGrid.voxelCount());
  parallelChunks(mreGrid.voxelCount(), slice, [&](std::size_t begin, std::size_t end) {
    Random r = derived(seed, 3000 + begin / slice);
    const std::size_t middle = (begin / slice + 1) * planesPerMreSlice;  // MRI plane at the same height
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t at = middle * slice + (v - begin);
      bodyMre[v] = body[at];
      liverMre[v] = liver.values[at];
      vesselMre[v] = vessel[at];
      const double mean =
          0.25 * (static_cast<double>(gradientEcho[at - slice]) + static_cast<double>(gradientEcho[at]) +
                  static_cast<double>(gradientEcho[at + slice])) +
          0.125 *
              (static_cast<double>(gradientEcho[at - 2 * slice]) + static_cast<double>(gradientEcho[at + 2 * slice]));
      patient.magnitude.values[v] = rician(mean, 9.0, r);
    }
  });
  Random draw = derived(seed, 81);
  const double drawn_kPa = 2.0 + 4.0 * std::pow(draw.uniform(), 1.6);
  ElastogramInput elastogram;
  elastogram.grid = mreGrid;
  elastogram.body_mm = &bodyMre;
  elastogram.liver_mm = &liverMre;
  elastogram.vessel_mm = &vesselMre;
  elastogram.shear_kPa = options.shear_kPa.value_or(drawn_kPa);
  elastogram.seed = seed;
  fillElastogram(elastogram, patient);
  progress.report(0.95, "contours");
  patient.contours = drawByHand(liver, seed);
  progress.report(1.0, "patient");
  return patient;
}

}  // namespace glisson::phantom
