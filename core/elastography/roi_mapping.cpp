#include "elastography/roi_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "image/morphology.h"
#include "image/resample.h"
#include "roi/arrangement.h"
#include "roi/interpolate.h"
#include "roi/plane.h"

namespace glisson::elastography {
namespace {

constexpr double coincident_mm = 0.5;
constexpr double leastCoverage = 0.9;

/// Distance along the MRE normal from a height (in MRE slices, not rounded) to the nearest MRE slice, mm.
double toNearestSlice_mm(double k, const image::Grid& mre) {
  const double nearest = std::clamp(std::round(k), 0.0, static_cast<double>(mre.size.z() - 1));
  return std::abs(k - nearest) * mre.spacing_mm.z();
}

/// Fraction of the mask's voxel centres inside the MRE volume.
double coverageOf(const image::Mask& mask, const image::Grid& mre) {
  std::size_t all = 0, inside = 0, at = 0;
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i, ++at) {
        if (mask.values[at] == 0) continue;
        ++all;
        if (image::voxelAt(mre, mask.grid.indexToLps({double(i), double(j), double(k)}))) ++inside;
      }
  return all == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(all);
}

/// Whether two grids of one size hold the same voxels, perhaps counted from other corners (flipped axes).
bool sameVoxels(const image::Grid& a, const image::Grid& b) {
  const Eigen::Vector3d last = (a.size - Eigen::Vector3i::Ones()).cast<double>();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d index(corner & 1 ? last.x() : 0.0, corner & 2 ? last.y() : 0.0, corner & 4 ? last.z() : 0.0);
    const Eigen::Vector3d there = b.lpsToIndex(a.indexToLps(index));
    for (int axis = 0; axis < 3; ++axis)
      if (std::min(std::abs(there[axis]), std::abs(there[axis] - last[axis])) > 0.05) return false;
  }
  return true;
}

/// Why no voxel was met, and what to do. nearest_mm: from the region's slices to the elastogram's; slice_mm: how thick
/// the region's own slices are.
[[noreturn]] void refuse(const MappedRoi& result, const image::Grid& mre, double nearest_mm, double slice_mm) {
  std::ostringstream why;
  why << "the region of interest holds no voxel of the elastogram: ";
  if (nearest_mm > 0.5 * mre.spacing_mm.z() * (1.0 + 1e-6))
    why << "their nearest slices are " << nearest_mm << " mm apart; check that both belong to the same examination";
  else if (result.coverage <= 0.0)
    why << "it lies beside it in the same slices; check that both belong to the same examination";
  else if (nearest_mm > 0.5 * slice_mm)
    why << "it lies between two elastography slices, " << nearest_mm
        << " mm from the nearest; outline the image slice at the height of an elastography slice, or several slices "
           "on both sides of one";
  else
    why << "it is too small to hold the centre of a voxel (" << mre.spacing_mm.x() << " mm); draw it larger";
  if (!result.warnings.empty()) why << "; " << result.warnings.front();
  throw BadInput(why.str());
}

void finish(MappedRoi& result, const image::Grid& mre, double nearest_mm, double slice_mm) {
  if (image::count(result.mask) == 0) refuse(result, mre, nearest_mm, slice_mm);
  const double half_mm = 0.5 * mre.spacing_mm.z();
  if (result.planeDistance_mm > half_mm * (1.0 + 1e-6)) {
    std::ostringstream text;
    text << "a slice of the region of interest lies " << result.planeDistance_mm
         << " mm from the nearest elastography slice, more than half a slice (" << half_mm << " mm)";
    result.warnings.push_back(text.str());
  }
  if (result.coverage < leastCoverage) {
    std::ostringstream text;
    text << "only " << std::round(1000.0 * result.coverage) / 10.0
         << " % of the region of interest lies inside the elastogram (at least 90 % expected)";
    result.warnings.push_back(text.str());
  }
}

/// Heights of the slices of a mask that hold voxels, in MRE slices.
std::vector<double> heights(const image::Mask& mask, const image::Grid& mre) {
  std::vector<double> result;
  const std::size_t perSlice = mask.grid.linear(0, 0, 1);
  for (int k = 0; k < mask.grid.size.z(); ++k) {
    const auto begin = mask.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * perSlice);
    if (std::none_of(begin, begin + static_cast<std::ptrdiff_t>(perSlice), [](auto v) { return v != 0; })) continue;
    const Eigen::Vector3d middle(0.5 * (mask.grid.size.x() - 1), 0.5 * (mask.grid.size.y() - 1), k);
    result.push_back(mre.lpsToIndex(mask.grid.indexToLps(middle)).z());
  }
  return result;
}

/// Sampled slice k of the mask.
void sampleSlice(const image::Mask& source, int k, image::Mask& target) {
  for (int j = 0; j < target.grid.size.y(); ++j)
    for (int i = 0; i < target.grid.size.x(); ++i) {
      const auto voxel = image::voxelAt(source.grid, target.grid.indexToLps({double(i), double(j), double(k)}));
      target.at(i, j, k) = voxel && source.at(*voxel) != 0 ? 1 : 0;
    }
}

struct Distances {
  double least_mm = 0.0, largest_mm = 0.0;
};

/// The polygons of the image slice that holds the polygon nearest to elastography slice k; their in-plane position is
/// kept along the MRE normal. height: of every counted polygon, in MRE slices.
std::vector<std::size_t> nearestMembers(const std::vector<std::vector<std::size_t>>& slices,
                                        const std::vector<std::size_t>& counted, const std::vector<double>& height,
                                        int k) {
  const auto distance = [&](std::size_t c) { return std::abs(height[c] - k); };
  const std::vector<std::size_t>* best = nullptr;
  double nearest = std::numeric_limits<double>::max();
  for (const std::vector<std::size_t>& members : slices)
    for (std::size_t c = 0; c < counted.size(); ++c)
      if (distance(c) < nearest && std::find(members.begin(), members.end(), counted[c]) != members.end()) {
        nearest = distance(c);
        best = &members;
      }
  return best != nullptr ? *best : std::vector<std::size_t>{};
}

/// Of slices at these heights (at least one) from the elastogram's slices.
Distances planeDistances(const std::vector<double>& k, const image::Grid& mre) {
  Distances d{std::numeric_limits<double>::max(), 0.0};
  for (const double height : k) {
    const double here_mm = toNearestSlice_mm(height, mre);
    d.least_mm = std::min(d.least_mm, here_mm);
    d.largest_mm = std::max(d.largest_mm, here_mm);
  }
  return d;
}

}  // namespace

MappedRoi mapRoi(const roi::ContourStack& contours, const std::optional<image::Grid>& mriGrid,
                 const image::Grid& mreGrid, const std::string& mreFrameOfReferenceUid) {
  mreGrid.check();
  MappedRoi result;
  result.mask = image::Mask(mreGrid);
  bool parallel = true;
  std::vector<std::size_t> counted;
  for (std::size_t p = 0; p < contours.polygons.size(); ++p) {
    if (contours.polygons[p].state == roi::PolygonState::Draft) continue;
    counted.push_back(p);
    parallel = parallel && roi::parallelTo(contours.polygons[p], mreGrid);
  }
  if (counted.empty()) throw BadInput("the region of interest has no polygon that counts (drafts do not)");

  result.diagnostics = roi::outlineDoubts(contours, mriGrid.value_or(mreGrid), mriGrid.has_value());
  std::optional<image::Mask> onMri;
  std::vector<std::vector<std::size_t>> onMriSlices;
  if (mriGrid) {
    onMri = roi::rasterise(contours, *mriGrid);
    onMriSlices = roi::polygonsPerSlice(contours, *mriGrid);
    result.coverage = coverageOf(*onMri, mreGrid);
  }
  std::vector<double> height;  // of every counted polygon
  for (const std::size_t p : counted)
    height.push_back(mreGrid.lpsToIndex(contours.polygons[p].points_lps_mm.rowwise().mean()).z());
  const Distances distances = planeDistances(height, mreGrid);
  result.planeDistance_mm = distances.largest_mm;

  if (!mriGrid) {
    result.mask = roi::rasterise(contours, mreGrid);
    const auto slices = roi::polygonsPerSlice(contours, mreGrid);
    result.coincidentSlices =
        static_cast<int>(std::count_if(slices.begin(), slices.end(), [](const auto& s) { return !s.empty(); }));
    if (const std::size_t missing = roi::emptySlicesBetween(contours, mreGrid).size(); missing > 0)
      result.diagnostics.add(
          DiagnosticCode::SlicesWithoutOutline,
          {{"missing", static_cast<std::int64_t>(missing)},
           {"slices", static_cast<std::int64_t>(missing) + static_cast<std::int64_t>(result.coincidentSlices)}});
    // Without the MRI's slices the region's volume is taken as its area; several planes on one slice count each.
    double insideArea_mm2 = 0.0;
    for (std::size_t c = 0; c < counted.size(); ++c) {
      const double k = height[c];
      if (k < -0.5 - 1e-6 || k > mreGrid.size.z() - 0.5 + 1e-6) continue;
      roi::ContourStack alone;
      alone.polygons.push_back(contours.polygons[counted[c]]);
      alone.polygons.front().exclude = false;
      const int slice = std::clamp(static_cast<int>(std::ceil(k - 0.5 - 1e-6)), 0, mreGrid.size.z() - 1);
      image::Mask scratch(mreGrid);
      roi::fillSlice(scratch, slice, alone, {0});
      insideArea_mm2 += static_cast<double>(image::count(scratch)) * mreGrid.spacing_mm.head<2>().prod();
    }
    double area_mm2 = 0.0;
    for (const std::size_t p : counted) {
      roi::ContourStack alone;
      alone.polygons.push_back(contours.polygons[p]);
      alone.polygons.front().exclude = false;
      area_mm2 += roi::area_mm2(alone);
    }
    result.coverage = area_mm2 > 0.0 ? std::min(1.0, insideArea_mm2 / area_mm2) : 0.0;
  } else {
    for (int k = 0; k < mreGrid.size.z(); ++k) {
      double nearest_mm = 1e300;
      for (const double h : height) nearest_mm = std::min(nearest_mm, std::abs(h - k) * mreGrid.spacing_mm.z());
      if (!parallel || nearest_mm > coincident_mm) {
        sampleSlice(*onMri, k, result.mask);
        const std::size_t perSlice = mreGrid.linear(0, 0, 1);
        const auto begin =
            result.mask.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * perSlice);
        if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(perSlice), [](auto v) { return v != 0; }))
          ++result.sampledSlices;
        continue;
      }
      roi::fillSlice(result.mask, k, contours, nearestMembers(onMriSlices, counted, height, k));
      ++result.coincidentSlices;
    }
    // Few planes between two elastography slices: no voxel centre lies in an MRI slice that holds the region, though
    // the planes are within the half slice that counts as the same place.
    if (image::count(result.mask) == 0 && parallel &&
        distances.least_mm <= 0.5 * mreGrid.spacing_mm.z() * (1.0 + 1e-6)) {
      const auto slices = roi::polygonsPerSlice(contours, mreGrid);
      for (int k = 0; k < mreGrid.size.z(); ++k) {
        const auto& members = slices[static_cast<std::size_t>(k)];
        roi::fillSlice(result.mask, k, contours, members);
        result.coincidentSlices += members.empty() ? 0 : 1;
      }
    }
  }
  for (const std::string& text : result.diagnostics.texts(Severity::Warning)) result.warnings.push_back(text);
  if (!contours.frameOfReferenceUid.empty() && !mreFrameOfReferenceUid.empty() &&
      contours.frameOfReferenceUid != mreFrameOfReferenceUid)
    result.warnings.push_back(
        "the region of interest and the elastogram have different frames of reference; confirm that they fit");
  if (!parallel)
    result.warnings.push_back("the slices the region was drawn on and the elastography slices are not parallel");
  finish(result, mreGrid, distances.least_mm, mriGrid ? mriGrid->spacing_mm.z() : mreGrid.spacing_mm.z());
  return result;
}

MappedRoi mapRoi(const image::Mask& roi, const image::Grid& mreGrid) {
  mreGrid.check();
  if (image::count(roi) == 0) throw BadInput("the region of interest is empty (no voxel inside)");
  MappedRoi result;
  if (roi.grid.size == mreGrid.size && !roi.grid.sameGeometry(mreGrid) && !sameVoxels(roi.grid, mreGrid))
    result.warnings.push_back(
        "the mask has as many voxels along each axis as the elastogram, but its header puts them elsewhere in the "
        "patient; if it was drawn on the elastogram, its header has lost the place: save it with the elastogram's");
  result.mask = image::resampleNearest(roi, mreGrid);
  result.coverage = coverageOf(roi, mreGrid);
  // Of a mask with thinner slices than the elastogram, only distances beyond the outer slices say something.
  const Distances distances = planeDistances(heights(roi, mreGrid), mreGrid);
  result.planeDistance_mm = distances.largest_mm;
  const std::size_t perSlice = mreGrid.linear(0, 0, 1);
  for (std::size_t k = 0; k < static_cast<std::size_t>(mreGrid.size.z()); ++k)
    for (std::size_t v = k * perSlice; v < (k + 1) * perSlice; ++v)
      if (result.mask.values[v] != 0) {
        ++result.sampledSlices;
        break;
      }
  finish(result, mreGrid, distances.least_mm, roi.grid.spacing_mm.z());
  return result;
}

}  // namespace glisson::elastography
