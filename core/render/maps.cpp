// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/maps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/quantity.h"
#include "render/sampling.h"
#include "render/slice_frame.h"

namespace glisson::render {
namespace {

constexpr Rgb isolineColour{90, 235, 255};

void checkOptions(const image::Grid& grid, const MapOptions& options) {
  grid.check();
  if (!(options.high > options.low)) throw BadArgument("the colour range must grow from low to high");
}

/// Corners of the polygons that lie on the plane (within half a slice).
struct Outline {
  std::vector<Point> corners;
  bool exclude, interpolated;
};
std::vector<Outline> outlinesOn(const roi::ContourStack& contours, const SlicePlane& plane, double sliceSpacing_mm) {
  std::vector<Outline> found;
  for (const roi::Polygon& polygon : contours.polygons) {
    if (polygon.state == roi::PolygonState::Draft || polygon.points_lps_mm.cols() < 3) continue;
    const Eigen::Vector3d middle = polygon.points_lps_mm.rowwise().mean();
    if (std::abs((middle - plane.corner_lps).dot(plane.normal())) > 0.5 * sliceSpacing_mm) continue;
    Outline outline{{}, polygon.exclude, polygon.state == roi::PolygonState::Interpolated};
    for (Eigen::Index n = 0; n < polygon.points_lps_mm.cols(); ++n)
      outline.corners.push_back(plane.toPixel(polygon.points_lps_mm.col(n)));
    found.push_back(std::move(outline));
  }
  return found;
}

SlicePlane cutTo(const SlicePlane& plane, const std::vector<Outline>& outlines, const MapOptions& options) {
  if (!options.margin_mm || outlines.empty()) return plane;
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const Outline& outline : outlines)
    for (const Point& p : outline.corners) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(*options.margin_mm / plane.mmPerPixel);
  return cropOf(plane, low - margin, high + margin);
}

void drawOutlines(Picture& picture, const std::vector<Outline>& outlines, Rgb include) {
  RasterPainter paint(picture);
  const double width = std::max(1.5, std::min(picture.width, picture.height) / 320.0);
  for (const Outline& outline : outlines) {
    std::vector<Point> closed = outline.corners;
    closed.push_back(closed.front());
    const bool dashed = outline.exclude || outline.interpolated;
    if (!dashed) paint.polyline(closed, {.colour = {0, 0, 0}, .width = width + 2.0, .alpha = 0.5});
    paint.polyline(closed, {.colour = outline.exclude ? colours::orange : include, .width = width, .dashed = dashed});
  }
}

/// Grey ramp from percentiles of a volume.
class Grey {
 public:
  explicit Grey(const image::ScalarVolume& volume) {
    std::vector<float> values;
    std::copy_if(volume.values.begin(), volume.values.end(), std::back_inserter(values),
                 [](float v) { return std::isfinite(v); });
    if (values.empty()) throw BadInput("the image has no finite value");
    const auto percentile = [&](double p) {
      const auto n = static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), values.begin() + n, values.end());
      return values[static_cast<std::size_t>(n)];
    };
    low_ = percentile(0.01);
    high_ = std::max(percentile(0.995), low_ + 1e-6F * std::max(1.0F, std::abs(low_)));
  }
  std::uint8_t operator()(float v) const {
    return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp((v - low_) / (high_ - low_), 0.0F, 1.0F)));
  }

 private:
  float low_ = 0.0F, high_ = 1.0F;
};

template <typename ColourAt>
Picture painted(const SlicePlane& plane, ColourAt&& colourAt) {
  Picture picture = blankPicture(plane.width, plane.height, {0, 0, 0});
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const Rgb c = colourAt(plane.toLps(x + 0.5, y + 0.5), x, y);
      std::uint8_t* to = picture.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) +
                                                   static_cast<std::size_t>(x));
      to[0] = c.r;
      to[1] = c.g;
      to[2] = c.b;
    }
  return picture;
}

std::string sliceNote(int k, const image::Grid& grid) {
  return "Slice " + std::to_string(k + 1) + " of " + std::to_string(grid.size.z());
}

int sliceOr(int slice, const image::Grid& grid) {
  return slice < 0 ? grid.size.z() / 2 : slice;
}

/// |u_mre − u_atlas| anywhere in a scene, carried on a little beyond the liver.
class DifferenceField {
 public:
  explicit DifferenceField(const RetractionScene& scene)
      : liver_(asScalar(scene.liver)),
        mre_(extended(scene.u_mre_mm, liver_, reach_mm())),
        atlas_(extended(scene.u_atlas_mm, liver_, reach_mm())),
        toLiver_(liver_.grid),
        toMre_(mre_.grid),
        toAtlas_(atlas_.grid) {}

  bool inLiver(const Eigen::Vector3d& p_lps) const { return !(sampleLinear(liver_, toLiver_(p_lps)) < 0.5F); }
  double at(const Eigen::Vector3d& p_lps) const {
    return static_cast<double>((sampleLinear(mre_, toMre_(p_lps)) - sampleLinear(atlas_, toAtlas_(p_lps))).norm());
  }

 private:
  double reach_mm() const { return 2.0 * liver_.grid.spacing_mm.maxCoeff(); }

  image::ScalarVolume liver_;
  image::DisplacementField mre_, atlas_;
  LpsToIndex toLiver_, toMre_, toAtlas_;
};

/// HowSure::beyond anywhere in the liver, in percent.
class ProbabilityField {
 public:
  explicit ProbabilityField(const RetractionScene& scene)
      : liver_(asScalar(scene.liver)), beyond_(scene.sure->beyond), toLiver_(liver_.grid), toBeyond_(beyond_.grid) {}

  bool inLiver(const Eigen::Vector3d& p_lps) const {
    return !(sampleLinear(liver_, toLiver_(p_lps)) < 0.5F) && std::isfinite(at(p_lps));
  }
  double at(const Eigen::Vector3d& p_lps) const {
    return 100.0 * static_cast<double>(sampleKnown(beyond_, toBeyond_(p_lps)));
  }

 private:
  image::ScalarVolume liver_;
  const image::ScalarVolume& beyond_;
  LpsToIndex toLiver_, toBeyond_;
};

/// What of the liver a plane shows: the largest value, and the box of its pixels.
struct LiverOnPlane {
  double largest = 0.0;
  Eigen::Vector2d low{1e9, 1e9}, high{-1e9, -1e9};
};

template <class Field>
LiverOnPlane liverOn(const SlicePlane& plane, const Field& field) {
  LiverOnPlane liver;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const Eigen::Vector3d p = plane.toLps(x + 0.5, y + 0.5);
      if (!field.inLiver(p)) continue;
      liver.largest = std::max(liver.largest, field.at(p));
      liver.low = liver.low.cwiseMin(Eigen::Vector2d(x, y));
      liver.high = liver.high.cwiseMax(Eigen::Vector2d(x + 1, y + 1));
    }
  return liver;
}

/// A colour with an isoline over it. cover: of the pixel by the line, in [0, 1].
Rgb withIsoline(Rgb c, double cover) {
  const auto mix = [cover](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + cover * (b - a)));
  };
  return {mix(c.r, isolineColour.r), mix(c.g, isolineColour.g), mix(c.b, isolineColour.b)};
}

/// The plane, or that part of it that holds the liver and a margin.
SlicePlane cutTo(const SlicePlane& plane, const LiverOnPlane& liver, const MapOptions& options) {
  if (!options.margin_mm || liver.low.x() > liver.high.x()) return plane;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(*options.margin_mm / plane.mmPerPixel);
  return cropOf(plane, liver.low - margin, liver.high + margin);
}

/// The field in colours over the liver, an isoline at the bar's mark, dimmed anatomy around.
template <class Field>
Picture paintField(const RetractionScene& scene, const SlicePlane& plane, const Field& field, const ColourBar& bar) {
  const LpsToIndex toMri(scene.mri.grid);
  const Grey grey(scene.mri);
  return painted(plane, [&](const Eigen::Vector3d& p, int, int) -> Rgb {
    if (!field.inLiver(p)) {
      const auto v = static_cast<std::uint8_t>(grey(sampleLinear(scene.mri, toMri(p))) * 0.6);
      return {v, v, v};
    }
    const double d = field.at(p);
    const double dx = field.at(p + plane.mmPerPixel * plane.right) - d;
    const double dy = field.at(p + plane.mmPerPixel * plane.down) - d;
    const double slope = std::hypot(dx, dy);  // not a number at the rim of what is known: no line there
    const double cover = slope > 1e-9 ? std::clamp(1.6 - std::abs(d - *bar.mark) / slope, 0.0, 1.0) : 0.0;
    return withIsoline(bar.map.at((d - bar.low) / (bar.high - bar.low)), cover);
  });
}

}  // namespace

Picture stiffnessPicture(const image::ScalarVolume& stiffness_kPa, const std::string& barTitle,
                         const roi::ContourStack* contours, const image::ScalarVolume* confidence,
                         const MapOptions& options) {
  const image::Grid& grid = stiffness_kPa.grid;
  checkOptions(grid, options);
  const int k = sliceOr(options.slice, grid);
  SlicePlane plane = planeOfSlice(grid, k, options.pixelsPerVoxel);
  if (contours) plane = cutTo(plane, outlinesOn(*contours, plane, grid.spacing_mm.z()), options);
  const ColourMap map = ColourMap::viridis();
  const LpsToIndex toMap(grid);
  const int hatch = std::max(6, options.pixelsPerVoxel + 2);
  Picture picture = painted(plane, [&](const Eigen::Vector3d& p, int x, int y) -> Rgb {
    const Eigen::Vector3i index = toMap(p).array().round().matrix().cast<int>();
    if (!grid.contains(index)) return {0, 0, 0};
    const double v = stiffness_kPa.at(index);
    if (!std::isfinite(v)) return {0, 0, 0};
    const Rgb c = map.at((v - options.low) / (options.high - options.low));
    if (confidence) {
      const Eigen::Vector3i at = confidence->grid.lpsToIndex(p).array().round().matrix().cast<int>();
      const bool sure =
          confidence->grid.contains(at) && confidence->at(at) >= static_cast<float>(defaults::confidenceThreshold);
      if (!sure && (x + y) % hatch < 2) return {235, 235, 235};
    }
    return c;
  });
  if (contours) drawOutlines(picture, outlinesOn(*contours, plane, grid.spacing_mm.z()), {255, 255, 255});
  if (!options.decorate) return picture;
  SliceFrame frame{.plane = plane};
  frame.title = options.title;
  if (contours) frame.legend.push_back({{255, 255, 255}, "region of interest", true});
  frame.notes = {sliceNote(k, grid)};
  if (confidence) frame.notes[0] += ". Hatched: confidence below 0.95, left out of statistics.";
  frame.caption = options.caption;
  frame.colourBar = ColourBar{.map = map, .low = options.low, .high = options.high, .title = barTitle};
  return frameSlice(picture, frame);
}

Picture roiPicture(const image::ScalarVolume& mri, const roi::ContourStack& contours, const MapOptions& options) {
  const image::Grid& grid = mri.grid;
  checkOptions(grid, options);
  const int k = sliceOr(options.slice, grid);
  SlicePlane plane = planeOfSlice(grid, k, options.pixelsPerVoxel);
  plane = cutTo(plane, outlinesOn(contours, plane, grid.spacing_mm.z()), options);
  const Grey grey(mri);
  const LpsToIndex toMri(grid);
  Picture picture = painted(plane, [&](const Eigen::Vector3d& p, int, int) -> Rgb {
    const std::uint8_t v = grey(sampleLinear(mri, toMri(p)));
    return {v, v, v};
  });
  const std::vector<Outline> outlines = outlinesOn(contours, plane, grid.spacing_mm.z());
  drawOutlines(picture, outlines, colours::warning);
  if (!options.decorate) return picture;
  SliceFrame frame{.plane = plane};
  frame.title = options.title;
  frame.legend.push_back({colours::warning, "region of interest", true});
  if (std::any_of(outlines.begin(), outlines.end(), [](const Outline& o) { return o.exclude; }))
    frame.legend.push_back({colours::orange, "left out (dashed)", true});
  frame.notes = {sliceNote(k, grid)};
  frame.caption = options.caption;
  return frameSlice(picture, frame);
}

Picture differencePicture(const RetractionScene& scene, const MapOptions& options) {
  const image::Grid& grid = scene.mri.grid;
  checkOptions(grid, options);
  const int k = options.slice < 0 ? sliceOfLargestDifference(scene) : options.slice;
  SlicePlane plane = planeOfSlice(grid, k, options.pixelsPerVoxel);
  const DifferenceField difference(scene);
  const LiverOnPlane liver = liverOn(plane, difference);
  plane = cutTo(plane, liver, options);
  ColourBar bar{.map = ColourMap::magma(),
                .low = options.low,
                .high = std::max(options.high, std::ceil(liver.largest)),
                .title = "|u " + scene.stiffness + " − u atlas| (mm)",
                .mark = scene.clinicallySignificant_mm};
  bar.markColour = isolineColour;
  Picture picture = paintField(scene, plane, difference, bar);
  if (!scene.valid) drawNotValid(picture);
  if (!options.decorate) return picture;
  SliceFrame frame{.plane = plane};
  frame.title = options.title;
  char text[120];
  std::snprintf(text, sizeof text, "%g mm: clinically significant", scene.clinicallySignificant_mm);
  frame.legend.push_back({isolineColour, text, true});
  std::snprintf(text, sizeof text, ". Largest difference of the liver that lies here at rest: %.1f mm.", liver.largest);
  frame.notes = {sliceNote(k, grid) + text};
  frame.caption = scene.caption.empty() ? options.caption : scene.caption;
  frame.mark = scene.mark;
  frame.ring_lps_mm = options.ring_lps_mm;
  frame.colourBar = bar;
  return frameSlice(picture, frame);
}

Picture probabilityPicture(const RetractionScene& scene, const MapOptions& options) {
  const image::Grid& grid = scene.mri.grid;
  if (!scene.sure || scene.sure->beyond.values.empty())
    throw BadArgument("the scene has no probabilities of a difference to show");
  checkOptions(grid, options);
  const int k = options.slice < 0 ? sliceOfLargestDifference(scene) : options.slice;
  SlicePlane plane = planeOfSlice(grid, k, options.pixelsPerVoxel);
  const ProbabilityField probability(scene);
  const LiverOnPlane liver = liverOn(plane, probability);
  plane = cutTo(plane, liver, options);
  ColourBar bar{.map = ColourMap::magma(), .low = 0.0, .high = 100.0, .title = "P (%)", .mark = 50.0};
  bar.markColour = isolineColour;
  Picture picture = paintField(scene, plane, probability, bar);
  if (!scene.valid) drawNotValid(picture);
  if (!options.decorate) return picture;
  SliceFrame frame{.plane = plane};
  frame.language = options.language;
  const auto words = [&](const char* text, std::initializer_list<std::string> values = {}) {
    return phrase(text, options.language, values);
  };
  const auto whole = [](double v) { return std::to_string(std::lround(v)); };
  frame.title =
      words("Chance that the two predictions differ by @ mm or more", {whole(scene.clinicallySignificant_mm)});
  frame.legend.push_back({isolineColour, words("one half (50 %)"), true});
  frame.notes = {words("Slice @ of @. Largest chance of the liver that lies here at rest: @ %.",
                       {whole(k + 1), whole(grid.size.z()), whole(liver.largest)})};
  frame.caption = words("All sources of uncertainty together; the textbook stiffness is exact by definition.");
  frame.mark = scene.mark;
  frame.ring_lps_mm = options.ring_lps_mm;
  frame.colourBar = bar;
  return frameSlice(picture, frame);
}

}  // namespace glisson::render
