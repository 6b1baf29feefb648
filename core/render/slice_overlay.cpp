#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "render/arrows.h"
#include "render/overlay.h"
#include "render/painter.h"
#include "render/sampling.h"
#include "render/slice_frame.h"
#include "render/stroke_cover.h"
#include "render/surface_cut.h"

namespace glisson::render {
namespace {

constexpr float dimmed = 0.45F;  // tissue outside the liver, not simulated

/// Grey window from percentiles of the liver, widened for its surroundings.
struct Window {
  float low = 0.0F, high = 1.0F;
  float operator()(float v) const { return std::clamp((v - low) / (high - low), 0.0F, 1.0F); }
};

Window windowOf(const image::ScalarVolume& mri, const image::ScalarVolume& liver) {
  const LpsToIndex toLiver(liver.grid);
  const image::Grid& grid = mri.grid;
  std::vector<float> inside;
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i)
        if (sampleLinear(liver, toLiver(grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>()))) >= 0.5F &&
            std::isfinite(mri.at(i, j, k)))
          inside.push_back(mri.at(i, j, k));
  if (inside.empty())
    throw BadInput("the liver mask and the MRI do not overlap: check that both lie in the same frame of reference");
  const auto percentile = [&](double p) {
    const auto n = static_cast<std::ptrdiff_t>(p * static_cast<double>(inside.size() - 1));
    std::nth_element(inside.begin(), inside.begin() + n, inside.end());
    return inside[static_cast<std::size_t>(n)];
  };
  const float p1 = percentile(0.01), p50 = percentile(0.5), p99 = percentile(0.995);
  // Contrast for vessels: black lies well below the darkest liver, white at its brightest percent.
  Window w{p1 - (p50 - p1) - 0.9F * (p99 - p50), p99};
  if (!(w.high - w.low > 1e-6F * std::max(1.0F, std::abs(w.high))))
    w = {std::min(0.0F, w.high), std::max(w.high, 0.0F)};
  if (!(w.high > w.low)) w.high = w.low + 1.0F;
  return w;
}

/// One simulated state of the scene, ready to be looked up at any point of the moved patient.
struct State {
  image::DisplacementField u_mm;  ///< carried on beyond the liver
  InverseMap inverse;
  std::optional<anatomy::TriangleMesh> surface;  ///< of the liver in contact with a bar, moved
  std::optional<anatomy::TriangleMesh> bar;      ///< where it ends
  State(image::DisplacementField carriedOn, const image::ScalarVolume& liver, const RetractionScene& scene, bool atlas)
      : u_mm(std::move(carriedOn)), inverse(u_mm, true, liver) {
    if (!scene.bar) return;
    const BarContact& contact = atlas && scene.bar->atlas ? *scene.bar->atlas : scene.bar->mre;
    if (scene.bar->surface.triangles.cols() > 0) surface = movedSurface(*scene.bar, contact, 1.0);
    bar = barMesh(movedLine(scene.bar->centreline_lps_mm, contact.travel_mm * scene.retractorDirection.normalized()),
                  0.5 * scene.retractorDiameter_mm);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

/// Both fields carried on beyond the liver, side by side.
std::array<image::DisplacementField, 2> carriedOn(const RetractionScene& scene, const image::ScalarVolume& liver) {
  const std::array<const image::DisplacementField*, 2> fields{&scene.u_mre_mm, &scene.u_atlas_mm};
  const double reach_mm = std::max(largestDisplacement_mm(*fields[0]), largestDisplacement_mm(*fields[1])) +
                          3.0 * liver.grid.spacing_mm.maxCoeff();
  std::array<image::DisplacementField, 2> out;
  parallelChunks(fields.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) out[n] = extended(*fields[n], liver, reach_mm);
  });
  return out;
}

class Composer {
 public:
  explicit Composer(const RetractionScene& scene)
      : scene_(scene),
        liver_(asScalar(scene.liver)),
        window_(windowOf(scene.mri, liver_)),
        fields_(carriedOn(scene, liver_)),
        mre_(std::move(fields_[0]), liver_, scene, false),
        atlas_(std::move(fields_[1]), liver_, scene, true) {}

  Picture draw(const SlicePlane& plane, const SliceOverlayOptions& options) const {
    const Palette palette = options.palette;
    const std::vector<float> atlas = channel(plane, atlas_, options.outlines),
                             mre = channel(plane, mre_, options.outlines);
    const std::vector<float> grid = gridCover(plane, options.grid_mm);
    Picture out = blankPicture(plane.width, plane.height, {0, 0, 0});
    const auto byte = [](float v) {
      return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(v, 0.0F, 1.0F)));
    };
    for (std::size_t n = 0; n < atlas.size(); ++n) {
      float r = atlas[n], b = mre[n], g = grid[n];
      if (palette == Palette::ColourBlind) {  // orange (1, .55, 0) + blue (0, .45, 1): white where they agree
        const float w = 0.75F * g;
        g = (1.0F - w) * (0.55F * r + 0.45F * b) + w * 0.75F;
        r *= 1.0F - w;
        b *= 1.0F - w;
      } else {
        g *= 0.62F;
      }
      out.rgb[3 * n] = byte(r);
      out.rgb[3 * n + 1] = byte(g);
      out.rgb[3 * n + 2] = byte(b);
    }
    return out;
  }

  /// Pixel box of the liver at rest and in both moved states.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> liverBox(const SlicePlane& plane) const {
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    const image::Grid& grid = liver_.grid;
    for (int k = 0; k < grid.size.z(); ++k)
      for (int j = 0; j < grid.size.y(); ++j)
        for (int i = 0; i < grid.size.x(); ++i) {
          if (liver_.at(i, j, k) < 0.5F) continue;
          const Eigen::Vector3d p = grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>());
          for (const Eigen::Vector3d& q :
               {p, Eigen::Vector3d(p + mre_.inverse.at(p)), Eigen::Vector3d(p + atlas_.inverse.at(p))}) {
            low = low.cwiseMin(plane.toPixel(q));
            high = high.cwiseMax(plane.toPixel(q));
          }
        }
    return {low, high};
  }

  bool showsBar(const SlicePlane& plane) const {
    const auto cuts = [&](const State& state) { return state.bar && !cutSurface(plane, *state.bar).lines.empty(); };
    return cuts(mre_) || (scene_.compared && cuts(atlas_));
  }
  /// Largest ‖u_mre − u_atlas‖ of the tissue that lies in the slice as it is drawn, with the own stiffness, mm; of one
  /// answer the largest ‖u‖.
  double largestSeen_mm(int k) const {
    const image::Grid& grid = scene_.mri.grid;
    const LpsToIndex toLiver(liver_.grid), toMre(scene_.u_mre_mm.grid), toAtlas(scene_.u_atlas_mm.grid);
    double largest = 0.0;
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) {
        const InverseMap::Result rest = mre_.inverse.rest(grid.indexToLps(Eigen::Vector3i(i, j, k).cast<double>()));
        if (!rest.found || sampleLinear(liver_, toLiver(rest.x_lps)) < 0.5F) continue;
        Eigen::Vector3f d = sampleLinear(scene_.u_mre_mm, toMre(rest.x_lps));
        if (scene_.compared) d -= sampleLinear(scene_.u_atlas_mm, toAtlas(rest.x_lps));
        largest = std::max(largest, static_cast<double>(d.norm()));
      }
    return largest;
  }

 private:
  /// Brightness 0..1 of one channel: windowed liver, dimmed surroundings, outline of the liver and the vessels. The liver
  /// is what lies within its surface in contact where there is one, else what the mask's cells hold.
  std::vector<float> channel(const SlicePlane& plane, const State& state, bool outlines) const {
    const LpsToIndex toMri(scene_.mri.grid), toLiver(liver_.grid);
    const auto width = static_cast<std::size_t>(plane.width);
    std::optional<SurfaceCut> cut;
    if (state.surface) cut = cutSurface(plane, *state.surface);
    std::vector<float> out(width * static_cast<std::size_t>(plane.height));
    std::vector<float> phi(out.size(), -1.0F);
    std::vector<std::uint8_t> unknown(out.size(), 0);
    parallelChunks(static_cast<std::size_t>(plane.height), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t column = 0; column < width; ++column) {
          const std::size_t n = row * width + column;
          const Eigen::Vector3d y = plane.toLps(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
          const InverseMap::Result rest = state.inverse.rest(y);
          phi[n] = rest.found ? sampleLinear(liver_, toLiver(rest.x_lps)) - 0.5F : -0.5F;
          if (cut && cut->closed[row]) unknown[n] = cut->inside[n] && !rest.found;
          if (cut && cut->closed[row] ? cut->inside[n] != 0 : phi[n] >= 0.0F)
            out[n] = window_(sampleLinear(scene_.mri, toMri(rest.x_lps)));
          else if (sampleLinear(liver_, toLiver(y)) < 0.5F)
            out[n] = dimmed * window_(sampleLinear(scene_.mri, toMri(y)));
        }
    });
    fillFromBeside(unknown, width, out);
    if (state.bar) barCut(plane, *state.bar, outlines, out);
    if (!outlines) return out;
    if (cut)
      for (const auto& [from, to] : cut->lines) line(plane, from, to, outlineWidth(plane), 0.9F, out);
    else
      outline(plane, phi, out);
    vesselCut(plane, state, out);
    return out;
  }

  /// The bar where the plane cuts it: even, with outlines a bright edge, so that it is told from tissue.
  static void barCut(const SlicePlane& plane, const anatomy::TriangleMesh& bar, bool outlines, std::vector<float>& out) {
    constexpr float steel = 0.55F;
    const SurfaceCut cut = cutSurface(plane, bar);
    for (std::size_t n = 0; n < out.size(); ++n)
      if (cut.inside[n] != 0) out[n] = steel;
    if (!outlines) return;
    for (const auto& [from, to] : cut.lines) line(plane, from, to, 1.5 * outlineWidth(plane), 1.0F, out);
  }
  static double outlineWidth(const SlicePlane& plane) {
    return 2.0 * std::max(0.7, std::min(plane.width, plane.height) / 900.0);
  }
  static void line(const SlicePlane& plane, const Point& from, const Point& to, double width, float bright,
                   std::vector<float>& out) {
    coverStroke(from, to, width, plane.width, plane.height, [&](int x, int y, double cover) {
      float& at =
          out[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
      at = std::max(at, bright * static_cast<float>(cover));
    });
  }

  /// A thin bright line where phi changes sign; its distance is |phi| over the gradient.
  static void outline(const SlicePlane& plane, const std::vector<float>& phi, std::vector<float>& out) {
    const auto at = [&](int x, int y) {
      return phi[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
    };
    const auto half = static_cast<float>(0.5 * outlineWidth(plane));
    for (int y = 1; y + 1 < plane.height; ++y)
      for (int x = 1; x + 1 < plane.width; ++x) {
        const float gx = 0.5F * (at(x + 1, y) - at(x - 1, y)), gy = 0.5F * (at(x, y + 1) - at(x, y - 1));
        const float slope = std::sqrt(gx * gx + gy * gy);
        if (slope < 1e-4F) continue;
        const float cover = std::clamp(half + 0.5F - std::abs(at(x, y)) / slope, 0.0F, 1.0F);
        float& to =
            out[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
        to = std::max(to, 0.9F * cover);
      }
  }

  /// Where the moved vessel walls cross the plane.
  void vesselCut(const SlicePlane& plane, const State& state, std::vector<float>& out) const {
    const anatomy::TriangleMesh& mesh = scene_.vesselSurface;
    if (mesh.triangles.cols() == 0) return;
    const Eigen::Vector3d normal = plane.normal();
    std::vector<Eigen::Vector3d> moved(static_cast<std::size_t>(mesh.vertices_lps_mm.cols()));
    std::vector<double> height(moved.size());
    for (std::size_t n = 0; n < moved.size(); ++n) {
      const Eigen::Vector3d p = mesh.vertices_lps_mm.col(static_cast<Eigen::Index>(n));
      moved[n] = p + state.inverse.at(p);
      height[n] = (moved[n] - plane.corner_lps).dot(normal);
    }
    const double width = std::max(1.2, std::min(plane.width, plane.height) / 600.0);
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      std::vector<Point> ends;
      for (int e = 0; e < 3; ++e) {
        const auto a = static_cast<std::size_t>(mesh.triangles(e, t));
        const auto b = static_cast<std::size_t>(mesh.triangles((e + 1) % 3, t));
        if ((height[a] < 0.0) == (height[b] < 0.0)) continue;
        ends.push_back(plane.toPixel(moved[a] + (moved[b] - moved[a]) * (height[a] / (height[a] - height[b]))));
      }
      if (ends.size() != 2) continue;
      line(plane, ends[0], ends[1], width, 1.0F, out);
    }
  }

  /// Coverage of the millimetre grid, every fifth line stronger; lines lie on multiples of grid_mm in the patient
  /// frame.
  static std::vector<float> gridCover(const SlicePlane& plane, double grid_mm) {
    std::vector<float> cover(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height), 0.0F);
    const auto draw = [&](const Eigen::Vector3d& axis, bool vertical) {
      const double start = plane.corner_lps.dot(axis);
      const int extent = vertical ? plane.width : plane.height;
      for (const double v : gridLines_mm(start, start + extent * plane.mmPerPixel, grid_mm)) {
        const double at = (v - start) / plane.mmPerPixel;
        const bool major = std::lround(v / grid_mm) % 5 == 0;
        const double width = (major ? 1.6 : 1.0) * std::max(1.0, std::min(plane.width, plane.height) / 1000.0);
        const Point a = vertical ? Point(at, 0.0) : Point(0.0, at);
        const Point b = vertical ? Point(at, plane.height) : Point(plane.width, at);
        coverStroke(a, b, width, plane.width, plane.height, [&](int x, int y, double c) {
          float& to =
              cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x)];
          to = std::max(to, static_cast<float>((major ? 1.0 : 0.7) * c));
        });
      }
    };
    draw(plane.right, true);
    draw(plane.down, false);
    return cover;
  }

  const RetractionScene& scene_;
  image::ScalarVolume liver_;
  Window window_;
  std::array<image::DisplacementField, 2> fields_;  ///< on their way into the states
  State mre_, atlas_;
};

std::string formatted(const char* pattern, double a, double b = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

/// A straight arrow with a dark edge.
void paintArrow(Painter& painter, const Point& from, const Point& to, Rgb colour, double width) {
  const double length = (to - from).norm();
  if (length < 1.0) return;
  const Point along = (to - from) / length, aside(-along.y(), along.x());
  const double back = std::min(5.0 * width, 0.5 * length);
  for (const auto& [paint, thick] : {std::pair{Rgb{0, 0, 0}, width + 1.6}, {colour, width}}) {
    const Stroke stroke{.colour = paint, .width = thick, .alpha = 0.95};
    painter.line(from, to, stroke);
    painter.line(to, to - back * along + 0.55 * back * aside, stroke);
    painter.line(to, to - back * along - 0.55 * back * aside, stroke);
  }
}

/// Displacements in the plane of the slice and an arrow of 10 mm to compare them with.
void paintArrows(Picture& picture, const SlicePlane& plane, const std::vector<DisplacementArrow>& arrows, Rgb mre,
                 Rgb atlas) {
  RasterPainter painter(picture);
  const double width = std::max(1.4, std::min(picture.width, picture.height) / 420.0);
  for (const DisplacementArrow& a : arrows) {
    paintArrow(painter, plane.toPixel(a.rest), plane.toPixel(a.atlas), atlas, width);
    paintArrow(painter, plane.toPixel(a.rest), plane.toPixel(a.mre), mre, width);
  }
  const double size = frameFontSize(picture), length = 10.0 / plane.mmPerPixel;
  // In the upper left corner: the scale bar is in the lower one.
  const Point from(0.9 * size, 2.3 * size);
  painter.rectangle(0.3 * size, 0.3 * size, from.x() + std::max(length, 8.6 * size) + 0.6 * size, 3.0 * size, {0, 0, 0},
                    0.6);
  painter.text(from - Point(0.0, 0.75 * size), "moved by 10 mm", {.size_px = size, .colour = colours::light});
  paintArrow(painter, from, from + Point(length, 0.0), colours::light, width);
}

/// Both answers and where they agree, or the one that there is: both channels together.
std::vector<LegendItem> legendOf(const RetractionScene& scene, bool redBlue) {
  const Rgb both = redBlue ? Rgb{214, 40, 255} : Rgb{255, 255, 255};
  if (!scene.compared) return {{both, scene.stiffness + " stiffness"}};
  return {{redBlue ? Rgb{40, 60, 255} : Rgb{0, 115, 255}, scene.stiffness},
          {redBlue ? Rgb{255, 30, 30} : Rgb{255, 140, 0}, "Atlas"},
          {both, "agree"}};
}

std::string largestInSlice(const Composer& composer, const RetractionScene& scene, int k) {
  const double largest_mm = composer.largestSeen_mm(k);
  if (!scene.compared) return formatted(". Largest displacement of the liver seen here: %.1f mm.", largest_mm);
  return ". Largest " + scene.stiffness +
         formatted("-atlas difference of the liver seen here: %.1f mm (clinically significant: %g mm).", largest_mm,
                   scene.clinicallySignificant_mm);
}

Picture overlayOf(const Composer& composer, const RetractionScene& scene, const SliceOverlayOptions& options) {
  if (!(options.grid_mm > 0.0) || !(options.zoom_mm > 0.0))
    throw BadArgument("grid spacing and zoom width must be positive millimetres");
  const int k = options.slice < 0 ? sliceOfLargestDifference(scene) : options.slice;
  SlicePlane plane = planeOfSlice(scene.mri.grid, k, options.pixelsPerVoxel);
  if (options.margin_mm) {
    const auto [low, high] = composer.liverBox(plane);
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(*options.margin_mm / plane.mmPerPixel);
    plane = cropOf(plane, low - margin, high + margin);
  }
  Picture picture = composer.draw(plane, options);
  const bool redBlue = options.palette == Palette::RedBlue;
  const Rgb mreColour = redBlue ? Rgb{90, 120, 255} : Rgb{70, 160, 255};
  const Rgb atlasColour = redBlue ? Rgb{255, 80, 80} : Rgb{255, 165, 40};
  if (options.arrows)
    paintArrows(picture, plane, displacementArrows(scene, options.arrows_mm, mostArrows, k), mreColour, atlasColour);
  if (!scene.valid) drawNotValid(picture);
  if (!options.decorate) return picture;

  SliceFrame frame{.plane = plane};
  frame.legend = legendOf(scene, redBlue);
  frame.legend.push_back({colours::gridGreen, formatted("grid %g mm", options.grid_mm), true});
  frame.notes = {formatted("Slice %.0f of %.0f", k + 1, scene.mri.grid.size.z()) + largestInSlice(composer, scene, k),
                 "Surroundings of the liver are not simulated: shown at rest, dimmed."};
  if (composer.showsBar(plane))
    frame.notes.push_back("Even discs or bands with a bright edge: the bar where it ends, cut by the slice.");
  if (options.arrows) frame.notes.push_back("Arrows: displacement from rest in the plane of the slice, true to scale.");
  frame.caption = scene.caption;
  frame.mark = scene.mark;
  frame.gridTicks_mm = options.grid_mm;
  frame.ring_lps_mm = options.ring_lps_mm;
  Picture inset;
  if (options.zoomCentre_lps_mm) {
    const int side = std::max(160, static_cast<int>(0.78 * std::min(picture.width, picture.height)));
    frame.insetPlane = zoomOf(plane, *options.zoomCentre_lps_mm, options.zoom_mm, side);
    inset = composer.draw(*frame.insetPlane, options);
    if (!scene.valid) drawNotValid(inset);
    frame.inset = &inset;
    frame.insetBelow = options.zoomBelow;
    frame.insetTitle =
        formatted("× %.1f, %g mm wide", plane.mmPerPixel / frame.insetPlane->mmPerPixel, options.zoom_mm);
  }
  return frameSlice(picture, frame);
}

}  // namespace

std::vector<Picture> sliceOverlays(const RetractionScene& scene, const std::vector<SliceOverlayOptions>& options) {
  scene.mri.grid.check();
  scene.liver.grid.check();
  scene.u_mre_mm.grid.check();
  scene.u_atlas_mm.grid.check();
  const Composer composer(scene);
  std::vector<Picture> pictures;
  for (const SliceOverlayOptions& one : options) pictures.push_back(overlayOf(composer, scene, one));
  return pictures;
}

Picture sliceOverlay(const RetractionScene& scene, const SliceOverlayOptions& options) {
  return std::move(sliceOverlays(scene, {options}).front());
}

CountedPixels countChannels(const Picture& overlay, int threshold) {
  CountedPixels count;
  for (std::size_t n = 0; n + 2 < overlay.rgb.size(); n += 3) {
    const int r = overlay.rgb[n], b = overlay.rgb[n + 2];
    if (r - b > threshold)
      ++count.redOnly;
    else if (b - r > threshold)
      ++count.blueOnly;
    else if (std::max(r, b) > threshold)
      ++count.both;
  }
  return count;
}

}  // namespace glisson::render
