#include "render/scene3d.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkProp.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/arrows.h"
#include "render/colour_map.h"
#include "render/detail/scene3d_parts.h"
#include "render/detail/viewpoint.h"
#include "render/font.h"
#include "render/sampling.h"
#include "render/slice_frame.h"

namespace glisson::render {
namespace {

constexpr double grid_mm = 10.0;
constexpr const char* gridEntry = "grid 10 mm, labels in cm";  ///< the longest of the legend
constexpr double apart_mm = 3.0;  ///< vessels that lie this far apart have fully their own colour

struct SceneColours {
  Rgb mre, atlas, agree;
};

SceneColours coloursOf(Palette palette) {
  if (palette == Palette::ColourBlind) return {{40, 130, 255}, {255, 140, 0}, {245, 245, 245}};
  return {{50, 80, 255}, {255, 40, 40}, {190, 60, 230}};
}

Rgb mixed(Rgb a, Rgb b, double t) {
  const auto one = [t](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(x + t * (y - x)));
  };
  return {one(a.r, b.r), one(a.g, b.g), one(a.b, b.b)};
}

Eigen::AlignedBox3d roundedOut(const Eigen::AlignedBox3d& box, double step) {
  return {Eigen::Vector3d((box.min().array() / step).floor() * step),
          Eigen::Vector3d((box.max().array() / step).ceil() * step)};
}

std::string cm(double mm) {
  const long tenths = std::lround(mm);
  return tenths % 10 == 0 ? std::to_string(tenths / 10)
                          : std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10));
}

class Stage {
 public:
  Stage(vtkRenderer* renderer, const SceneOptions3D& options, double pixelScale)
      : renderer_(renderer),
        view_(viewpointOf(options)),
        width_(options.width * pixelScale),
        height_(options.height * pixelScale),
        // In a narrow picture the width decides, so that legend and caption leave room for the scene.
        font_px_(std::clamp(std::min(1.0 * options.height, 0.75 * options.width) / 46.0, 11.0, 60.0) * pixelScale),
        line_px_(std::max(1.0, std::min(1.0 * options.height, 0.75 * options.width) / 1100.0) * pixelScale) {}

  void add(const vtkSmartPointer<vtkProp>& prop) { renderer_->AddViewProp(prop); }

  /// Grid walls behind and below, centimetre labels and letters of the patient's sides along their edges, a 5 cm bar.
  /// A number that would stand in a letter or another number is left out. After aim().
  void drawGrid(const Eigen::AlignedBox3d& box) {
    for (const auto& [axis, upper] : view_.walls) {
      const double at = upper ? box.max()[axis] : box.min()[axis];
      add(gridLines(box, axis, at, grid_mm, false, line_px_));
      add(gridLines(box, axis, at, grid_mm, true, 1.6 * line_px_));
    }
    const double off = labelOffset_mm(box);
    constexpr const char* sides[3][2] = {{"R", "L"}, {"A", "P"}, {"I", "S"}};
    const std::vector<LabelledEdge> edges = labelledEdges(view_, box);
    for (const LabelledEdge& edge : edges)
      for (const int end : {0, 1}) {
        Eigen::Vector3d at = edge.low;
        at[edge.axis] = end ? box.max()[edge.axis] + 1.4 * off : box.min()[edge.axis] - 1.4 * off;
        takeRoom(at, sides[edge.axis][end], 1.5 * font_px_);
        add(label3D(at, sides[edge.axis][end], colours::light, 1.5 * font_px_, true));
      }
    for (const LabelledEdge& edge : edges) {
      Eigen::Vector3d at = edge.low + off * edge.outward;
      for (const double v : gridLines_mm(box.min()[edge.axis], box.max()[edge.axis], 20.0)) {
        at[edge.axis] = v + off * edge.outward[edge.axis];
        if (takeRoom(at, cm(v), 0.8 * font_px_)) add(label3D(at, cm(v), colours::gridGreen, 0.8 * font_px_, false));
      }
    }

    // The bar lies in the back wall, along its horizontal, so it has the grid's scale in every camera.
    const auto [back, backUpper] = view_.walls.front();
    const int b = (back + 1) % 3, c = (back + 2) % 3;
    const bool bAcross = std::abs(view_.right[b]) >= std::abs(view_.right[c]);
    const int across = bAcross ? b : c, vertical = bAcross ? c : b;
    const bool topIsUpper = view_.up[vertical] > 0, rightIsUpper = view_.right[across] > 0;
    Eigen::Vector3d end = box.min();
    end[back] = backUpper ? box.max()[back] : box.min()[back];
    end[vertical] = topIsUpper ? box.max()[vertical] - 0.6 * off : box.min()[vertical] + 0.6 * off;
    end[across] = rightIsUpper ? box.max()[across] - 5.0 : box.min()[across] + 5.0;
    Eigen::Vector3d start = end;
    start[across] += rightIsUpper ? -50.0 : 50.0;
    Eigen::Vector3d middle = 0.5 * (start + end);
    middle[vertical] += (topIsUpper ? -1.0 : 1.0) * 0.8 * off;
    add(segments({{start, end}}, colours::light, 5.0 * line_px_));
    add(label3D(middle, "5 cm", colours::light, font_px_, false));
  }

  /// Displacements from rest, true to scale, heads in the plane of the screen. After aim().
  void drawArrows(const std::vector<DisplacementArrow>& arrows, const SceneColours& colour, double t) {
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> mre, atlas;
    const auto arrow = [&](auto& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& whole) {
      const Eigen::Vector3d to = from + t * (whole - from),
                            seen = (to - from) - (to - from).dot(view_.fromEye) * view_.fromEye;
      if ((to - from).norm() < 0.2) return;
      lines.emplace_back(from, to);
      if (seen.norm() < 0.2) return;
      const double back = std::min(2.2, 0.4 * seen.norm());
      const Eigen::Vector3d along = seen.normalized(), aside = view_.fromEye.cross(along);
      for (const double side : {-0.6, 0.6}) lines.emplace_back(to, to - back * along + side * back * aside);
    };
    for (const DisplacementArrow& a : arrows) {
      arrow(mre, a.rest, a.mre);
      arrow(atlas, a.rest, a.atlas);
    }
    if (!atlas.empty()) add(segments(atlas, mixed(colour.atlas, {255, 255, 255}, 0.2), 1.8 * line_px_));
    if (!mre.empty()) add(segments(mre, mixed(colour.mre, {255, 255, 255}, 0.2), 1.8 * line_px_));
    arrows_ = arrows.size();
  }

  void drawText(const RetractionScene& scene, const SceneColours& colour, double t) {
    const double lineHeight = 1.55 * font_px_ / height_, side = 1.1 * font_px_;
    double y = 1.0 - 1.9 * font_px_ / height_;
    const double x = font_px_ / width_;
    const auto row = [&](Rgb c, const std::string& text) {
      add(screenSwatch(x, y, side / width_, side / height_, c));
      add(screenText(x + 1.7 * font_px_ / width_, y + 0.1 * font_px_ / height_, text, colours::light, font_px_, false));
      y -= lineHeight;
    };
    row(colour.mre, "MRE stiffness");
    row(colour.atlas, "Atlas stiffness");
    row(colour.agree, "agree");
    row({150, 158, 168}, "liver at rest");
    if (scene.retractorPoint_lps_mm) row({205, 210, 216}, "retractor");
    row({50, 170, 95}, gridEntry);
    if (arrows_ > 0) row(colours::light, std::to_string(arrows_) + " places, to scale");
    if (t < 1.0)
      add(screenText(x, y, std::to_string(std::lround(100.0 * t)) + " % of the retraction", colours::light, font_px_,
                     false));
    std::vector<std::string> lines = wrapText(scene.caption, font_px_, width_ - 2.0 * font_px_);
    double below = 0.7 * font_px_ / height_;
    add(screenText(x, below, researchUseOnly, colours::warning, font_px_, false));
    for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
      below += lineHeight;
      add(screenText(x, below, *line, colours::faint, font_px_, false));
    }
    if (scene.mark.empty()) return;
    const std::vector<std::string> mark = wrapText(scene.mark, font_px_, width_ - 2.0 * font_px_);
    for (auto line = mark.rbegin(); line != mark.rend(); ++line) {
      below += lineHeight;
      add(screenText(x, below, *line, colours::warning, font_px_, false));
    }
  }

  /// Drawn whether decorated or not: an invalid run must not look like a valid one.
  void drawNotValidMark() {
    add(screenText(0.5, 0.5, "NOT CONVERGED / OUTSIDE VALIDITY", colours::warning, 0.045 * width_, true, true,
                   std::atan2(height_, width_) * 180.0 / 3.141592653589793));
  }

  /// Parallel projection: a centimetre of the grid is a centimetre everywhere in its plane.
  void aim(const Eigen::AlignedBox3d& box, bool decorated) {
    vtkCamera* camera = renderer_->GetActiveCamera();
    const Eigen::Vector3d &right = view_.right, &up = view_.up;
    double halfWidth = 0.0, halfHeight = 0.0;
    const Eigen::Vector3d centre = box.center();
    for (int n = 0; n < 8; ++n) {
      const Eigen::Vector3d d = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(n)) - centre;
      halfWidth = std::max(halfWidth, std::abs(d.dot(right)));
      halfHeight = std::max(halfHeight, std::abs(d.dot(up)));
    }
    const bool narrow = width_ < height_;  // the legend stands above the scene, not beside it
    const double margin = decorated ? 1.5 : 1.04, marginAside = decorated && narrow ? 1.3 : margin;
    double scale = std::max(margin * halfHeight, marginAside * halfWidth * height_ / width_);
    const double distance = 4.0 * box.diagonal().norm();
    double aside = 0.0;
    if (decorated && !narrow) {  // the legend has the left side to itself
      const double reach = halfWidth + 2.0 * labelOffset_mm(box), legend_px = legendWidth_px();
      scale = std::max(scale, reach * height_ / (width_ - legend_px - font_px_));
      const double perMm = 0.5 * height_ / scale;
      aside = std::max(0.09 * scale, (legend_px - 0.5 * width_) / perMm + reach);
    }
    mmPerPixel_ = 2.0 * scale / height_;
    const Eigen::Vector3d focus = centre - (decorated ? 0.13 * scale : 0.0) * up - aside * right;
    const Eigen::Vector3d eye = focus - distance * view_.fromEye;
    camera->ParallelProjectionOn();
    camera->SetFocalPoint(focus.data());
    camera->SetPosition(eye.data());
    camera->SetViewUp(up.data());
    camera->SetParallelScale(scale);
  }

 private:
  /// How far from its edge a label stands.
  static double labelOffset_mm(const Eigen::AlignedBox3d& box) { return 0.035 * box.diagonal().norm(); }

  double legendWidth_px() const { return 3.2 * font_px_ + textWidth(gridEntry, font_px_); }

  /// Whether the text covers none that was placed before; its room is taken then.
  bool takeRoom(const Eigen::Vector3d& at_lps, const std::string& text, double size_px) {
    const Eigen::Vector2d middle = Eigen::Vector2d(at_lps.dot(view_.right), at_lps.dot(view_.up)) / mmPerPixel_;
    const Eigen::Vector2d half(0.5 * textWidth(text, size_px) + 0.2 * size_px, 0.45 * size_px);
    const Eigen::AlignedBox2d room(middle - half, middle + half);
    for (const Eigen::AlignedBox2d& other : taken_px_)
      if (room.intersects(other)) return false;
    taken_px_.push_back(room);
    return true;
  }

  vtkRenderer* renderer_;
  Viewpoint view_;
  double width_, height_, font_px_, line_px_;
  double mmPerPixel_ = 1.0;
  std::size_t arrows_ = 0;
  std::vector<Eigen::AlignedBox2d> taken_px_;  ///< on the screen, from the projection of the patient's origin
};

}  // namespace

void populateScaled(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options,
                    double pixelScale) {
  if (!renderer) throw BadArgument("populate3D needs a renderer");
  if (!(options.t >= 0.0 && options.t <= 1.0)) throw BadArgument("the fraction of the displacement must lie in [0, 1]");
  renderer->RemoveAllViewProps();
  renderer->RemoveAllLights();
  renderer->SetBackground(0.055, 0.062, 0.075);
  renderer->SetBackground2(0.13, 0.145, 0.17);
  renderer->GradientBackgroundOn();
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.85);
  lights->AddLightsToRenderer(renderer);

  const image::ScalarVolume liver = asScalar(scene.liver);
  const double reach_mm = 3.0 * liver.grid.spacing_mm.maxCoeff() + scene.retractorDiameter_mm;
  const image::DisplacementField mreField = extended(scene.u_mre_mm, liver, reach_mm);
  const image::DisplacementField atlasField = extended(scene.u_atlas_mm, liver, reach_mm);
  const InverseMap mre(mreField, true), atlas(atlasField, true);
  const auto moving = [t = options.t](const InverseMap& map) -> Motion {
    return [&map, t](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + t * map.at(p); };
  };

  Eigen::AlignedBox3d box;
  const auto cover = [&box](const anatomy::TriangleMesh& mesh, const Motion& motion) {
    for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n) box.extend(motion(mesh.vertices_lps_mm.col(n)));
  };
  const Motion still = [](const Eigen::Vector3d& p) { return p; };
  // The frame of the picture is that of the whole motion, so that the steps of a film share one camera.
  const Motion wholeMre = [&mre](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + mre.at(p); };
  const Motion wholeAtlas = [&atlas](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + atlas.at(p); };
  for (const auto& motion : {still, wholeMre, wholeAtlas}) {
    cover(scene.liverSurface, motion);
    cover(scene.vesselSurface, motion);
  }
  if (box.isEmpty()) throw BadInput("the 3-D scene is empty: it has neither a liver surface nor vessels");

  Stage stage(renderer, options, pixelScale);
  const SceneColours colour = coloursOf(options.palette);
  const auto paint = [&](Rgb own) -> Paint {
    return [&, own](const Eigen::Vector3d& p) {
      const double apart = options.t * (mre.at(p) - atlas.at(p)).norm();
      return mixed(colour.agree, own, std::clamp(apart / apart_mm, 0.0, 1.0));
    };
  };
  if (scene.vesselSurface.triangles.cols() > 0) {
    stage.add(solidSurface(scene.vesselSurface, moving(atlas), paint(colour.atlas)));
    stage.add(solidSurface(scene.vesselSurface, moving(mre), paint(colour.mre)));
  }
  if (scene.retractorPoint_lps_mm) {
    const Eigen::Vector3d& rest = *scene.retractorPoint_lps_mm;
    const Eigen::Vector3d contact =
        scene.retractorTravel_mm
            ? Eigen::Vector3d(rest + options.t * *scene.retractorTravel_mm * scene.retractorDirection.normalized())
            : moving(mre)(rest);
    const Eigen::Vector3d centre = contact - 0.5 * scene.retractorDiameter_mm * scene.retractorDirection.normalized();
    if (options.retractor)
      stage.add(steelBar(centre, scene.retractorAxis, scene.retractorLength_mm, scene.retractorDiameter_mm));
    for (const double end : {-0.5, 0.5})
      box.extend(Eigen::Vector3d(centre + end * scene.retractorLength_mm * scene.retractorAxis.normalized()));
  }
  if (scene.liverSurface.triangles.cols() > 0) {
    stage.add(glassSurface(scene.liverSurface, still, {176, 184, 196}, 0.05, 0.55));
    if (options.t > 0.0) {
      stage.add(glassSurface(scene.liverSurface, moving(atlas), colour.atlas, 0.02, 0.40));
      stage.add(glassSurface(scene.liverSurface, moving(mre), colour.mre, 0.02, 0.40));
    }
  }
  box = roundedOut({box.min() - Eigen::Vector3d::Constant(4.0), box.max() + Eigen::Vector3d::Constant(4.0)}, grid_mm);
  stage.aim(box, options.decorate);
  if (options.arrows) stage.drawArrows(displacementArrows(scene, options.arrows_mm, mostArrows), colour, options.t);
  if (options.decorate) {
    stage.drawGrid(box);
    stage.drawText(scene, colour, options.t);
  }
  if (!scene.valid) stage.drawNotValidMark();
  renderer->ResetCameraClippingRange();
}

void populate3D(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options) {
  populateScaled(renderer, scene, options, 1.0);
}

}  // namespace glisson::render
