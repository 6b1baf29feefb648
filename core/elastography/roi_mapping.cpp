// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Whether slice k of a mask holds a voxel.
bool holdsVoxels(const image::Mask& mask, int k) {
  const auto perSlice = static_cast<std::ptrdiff_t>(mask.grid.linear(0, 0, 1));
  const auto begin = mask.values.begin() + k * perSlice;
  return std::any_of(begin, begin + perSlice, [](auto v) { return v != 0; });
}

/// Heights of the slices of a mask that hold voxels, in MRE slices.
std::vector<double> heights(const image::Mask& mask, const image::Grid& mre) {
  std::vector<double> result;
  for (int k = 0; k < mask.grid.size.z(); ++k) {
    if (!holdsVoxels(mask, k)) continue;
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

/// The polygons that count, seen from the elastogram.
struct CountedPolygons {
  std::vector<std::size_t> index;  ///< in the stack
  std::vector<double> height;      ///< of each, in MRE slices
  bool parallel = true;            ///< all lie in planes parallel to the elastogram's slices
};

/// Throws BadInput where no polygon counts.
CountedPolygons countedPolygons(const roi::ContourStack& contours, const image::Grid& mre) {
  CountedPolygons counted;
  for (std::size_t p = 0; p < contours.polygons.size(); ++p) {
    const roi::Polygon& polygon = contours.polygons[p];
    if (polygon.state == roi::PolygonState::Draft) continue;
    counted.index.push_back(p);
    counted.height.push_back(mre.lpsToIndex(polygon.points_lps_mm.rowwise().mean()).z());
    counted.parallel = counted.parallel && roi::parallelTo(polygon, mre);
  }
  if (counted.index.empty()) throw BadInput("the region of interest has no polygon that counts (drafts do not)");
  return counted;
}

roi::ContourStack alone(const roi::Polygon& polygon) {
  roi::ContourStack one;
  one.polygons.push_back(polygon);
  one.polygons.front().exclude = false;
  return one;
}

/// Share of the polygons' area that the elastogram holds: without the MRI's slices the region's volume is taken as its
/// area; several planes on one slice count each.
double coveredArea(const roi::ContourStack& contours, const CountedPolygons& counted, const image::Grid& mre) {
  double inside_mm2 = 0.0, all_mm2 = 0.0;
  for (std::size_t c = 0; c < counted.index.size(); ++c) {
    const roi::ContourStack polygon = alone(contours.polygons[counted.index[c]]);
    all_mm2 += roi::area_mm2(polygon);
    const double k = counted.height[c];
    if (k < -0.5 - 1e-6 || k > mre.size.z() - 0.5 + 1e-6) continue;
    const int slice = std::clamp(static_cast<int>(std::ceil(k - 0.5 - 1e-6)), 0, mre.size.z() - 1);
    image::Mask scratch(mre);
    roi::fillSlice(scratch, slice, polygon, {0});
    inside_mm2 += static_cast<double>(image::count(scratch)) * mre.spacing_mm.head<2>().prod();
  }
  return all_mm2 > 0.0 ? std::min(1.0, inside_mm2 / all_mm2) : 0.0;
}

/// Outlines whose image is not known are filled on the elastogram itself.
void mapDirectly(const roi::ContourStack& contours, const CountedPolygons& counted, MappedRoi& result) {
  const image::Grid mre = result.mask.grid;
  result.mask = roi::rasterise(contours, mre);
  const auto slices = roi::polygonsPerSlice(contours, mre);
  result.coincidentSlices =
      static_cast<int>(std::count_if(slices.begin(), slices.end(), [](const auto& s) { return !s.empty(); }));
  if (const std::size_t missing = roi::emptySlicesBetween(contours, mre).size(); missing > 0)
    result.diagnostics.add(
        DiagnosticCode::SlicesWithoutOutline,
        {{"missing", static_cast<std::int64_t>(missing)},
         {"slices", static_cast<std::int64_t>(missing) + static_cast<std::int64_t>(result.coincidentSlices)}});
  result.coverage = coveredArea(contours, counted, mre);
}

/// Few planes between two elastography slices: no voxel centre lies in an MRI slice that holds the region, though the
/// planes are within the half slice that counts as the same place.
void fillFromBetween(const roi::ContourStack& contours, MappedRoi& result) {
  const auto slices = roi::polygonsPerSlice(contours, result.mask.grid);
  for (int k = 0; k < result.mask.grid.size.z(); ++k) {
    const auto& members = slices[static_cast<std::size_t>(k)];
    roi::fillSlice(result.mask, k, contours, members);
    result.coincidentSlices += members.empty() ? 0 : 1;
  }
}

/// Outlines drawn on the MRI: a slice of the elastogram that coincides with a drawn one takes its outlines, all others
/// the region's voxels on the MRI.
void mapFromMri(const roi::ContourStack& contours, const CountedPolygons& counted, const image::Grid& mri,
                double least_mm, MappedRoi& result) {
  const image::Grid& mre = result.mask.grid;
  const image::Mask onMri = roi::rasterise(contours, mri);
  const auto slices = roi::polygonsPerSlice(contours, mri);
  result.coverage = coverageOf(onMri, mre);
  for (int k = 0; k < mre.size.z(); ++k) {
    double nearest_mm = 1e300;
    for (const double h : counted.height) nearest_mm = std::min(nearest_mm, std::abs(h - k) * mre.spacing_mm.z());
    if (!counted.parallel || nearest_mm > coincident_mm) {
      sampleSlice(onMri, k, result.mask);
      if (holdsVoxels(result.mask, k)) ++result.sampledSlices;
    } else {
      roi::fillSlice(result.mask, k, contours, nearestMembers(slices, counted.index, counted.height, k));
      ++result.coincidentSlices;
    }
  }
  if (image::count(result.mask) == 0 && counted.parallel && least_mm <= 0.5 * mre.spacing_mm.z() * (1.0 + 1e-6))
    fillFromBetween(contours, result);
}

}  // namespace

MappedRoi mapRoi(const roi::ContourStack& contours, const std::optional<image::Grid>& mriGrid,
                 const image::Grid& mreGrid, const std::string& mreFrameOfReferenceUid) {
  mreGrid.check();
  const CountedPolygons counted = countedPolygons(contours, mreGrid);
  const Distances distances = planeDistances(counted.height, mreGrid);
  MappedRoi result;
  result.mask = image::Mask(mreGrid);
  result.diagnostics = roi::outlineDoubts(contours, mriGrid.value_or(mreGrid), mriGrid.has_value());
  result.planeDistance_mm = distances.largest_mm;
  if (mriGrid)
    mapFromMri(contours, counted, *mriGrid, distances.least_mm, result);
  else
    mapDirectly(contours, counted, result);
  for (const std::string& text : result.diagnostics.texts(Severity::Warning)) result.warnings.push_back(text);
  if (!contours.frameOfReferenceUid.empty() && !mreFrameOfReferenceUid.empty() &&
      contours.frameOfReferenceUid != mreFrameOfReferenceUid)
    result.warnings.push_back(
        "the region of interest and the elastogram have different frames of reference; confirm that they fit");
  if (!counted.parallel)
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
  for (int k = 0; k < mreGrid.size.z(); ++k) result.sampledSlices += holdsVoxels(result.mask, k) ? 1 : 0;
  finish(result, mreGrid, distances.least_mm, roi.grid.spacing_mm.z());
  return result;
}

}  // namespace glisson::elastography
