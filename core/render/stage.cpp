// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/detail/stage.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkProp.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>

#include "render/arrows.h"
#include "render/chart_frame.h"
#include "render/colour_map.h"
#include "render/font.h"
#include "render/slice_frame.h"

namespace glisson::render {
namespace {

constexpr double grid_mm = 10.0;

std::string cm(double mm) {
  const long tenths = std::lround(mm);
  return tenths % 10 == 0 ? std::to_string(tenths / 10)
                          : std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10));
}

}  // namespace

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

Stage::Stage(vtkRenderer* renderer, const SceneOptions3D& options)
    : renderer_(renderer),
      view_(viewpointOf(options)),
      width_(options.width),
      height_(options.height),
      // In a narrow picture the width decides, so that legend and caption leave room for the scene.
      font_px_(std::clamp(std::min(1.0 * options.height, 0.75 * options.width) / 46.0, 11.0, 60.0)),
      line_px_(std::max(1.0, std::min(1.0 * options.height, 0.75 * options.width) / 1100.0)) {}

void Stage::add(const vtkSmartPointer<vtkProp>& prop) {
  renderer_->AddViewProp(prop);
}

void Stage::drawGrid(const Eigen::AlignedBox3d& box) {
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

void Stage::arrow(std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& lines, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to, double head_mm) const {
  const Eigen::Vector3d seen = (to - from) - (to - from).dot(view_.fromEye) * view_.fromEye;
  if ((to - from).norm() < 0.2) return;
  lines.emplace_back(from, to);
  if (seen.norm() < 0.2) return;
  const double back = std::min(head_mm, 0.4 * seen.norm());
  const Eigen::Vector3d along = seen.normalized(), aside = view_.fromEye.cross(along);
  for (const double side : {-0.6, 0.6}) lines.emplace_back(to, to - back * along + side * back * aside);
}

void Stage::drawArrows(const std::vector<DisplacementArrow>& arrows, const SceneColours& colour, double t) {
  constexpr double head_mm = 2.2;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> mre, atlas;
  for (const DisplacementArrow& a : arrows) {
    arrow(mre, a.rest, a.rest + t * (a.mre - a.rest), head_mm);
    arrow(atlas, a.rest, a.rest + t * (a.atlas - a.rest), head_mm);
  }
  if (!atlas.empty()) add(segments(atlas, mixed(colour.atlas, {255, 255, 255}, 0.2), 1.8 * line_px_));
  if (!mre.empty()) add(segments(mre, mixed(colour.mre, {255, 255, 255}, 0.2), 1.8 * line_px_));
  arrows_ = arrows.size();
}

void Stage::drawWay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Rgb colour) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> lines;
  arrow(lines, from, to, 5.0);
  if (!lines.empty()) add(segments(lines, mixed(colour, {255, 255, 255}, 0.35), 3.0 * line_px_));
}

void Stage::drawWords(const Eigen::Vector3d& at, const Eigen::Vector3d& aside, bool above, Rgb colour,
                      const std::string& words) {
  const double size_px = 1.15 * font_px_;
  const double across = aside.dot(view_.right) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d middle =
      at + mmPerPixel_ * (across * (0.5 * textWidth(words, size_px) + 0.4 * size_px) * view_.right +
                          (above ? 0.7 : -0.7) * size_px * view_.up);
  takeRoom(middle, words, size_px);  // a number of the grid stands back
  add(label3D(middle, words, mixed(colour, {255, 255, 255}, 0.35), size_px, true));
}

void Stage::drawText(const Words& words, std::vector<LegendRow> legend, double t) {
  const double lineHeight = 1.55 * font_px_ / height_, side = 1.1 * font_px_;
  double y = 1.0 - 1.9 * font_px_ / height_;
  const double x = font_px_ / width_;
  if (arrows_ > 0) legend.push_back({colours::light, std::to_string(arrows_) + " places, to scale"});
  for (const LegendRow& row : legend) {
    if (row.colour) add(screenSwatch(x, y, side / width_, side / height_, *row.colour));
    add(screenText(x + 1.7 * font_px_ / width_, y + 0.1 * font_px_ / height_, row.text, colours::light, font_px_,
                   false));
    y -= lineHeight;
  }
  if (t < 1.0)
    add(screenText(x, y, std::to_string(std::lround(100.0 * t)) + " % of the retraction", colours::light, font_px_,
                   false));
  std::vector<std::string> lines = wrapText(words.caption, font_px_, width_ - 2.0 * font_px_);
  double below = 0.7 * font_px_ / height_;
  add(screenText(x, below, phrase(researchUseOnly, words.language), colours::warning, font_px_, false));
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    below += lineHeight;
    add(screenText(x, below, *line, colours::faint, font_px_, false));
  }
  if (words.mark.empty()) return;
  const std::vector<std::string> mark = wrapText(words.mark, font_px_, width_ - 2.0 * font_px_);
  for (auto line = mark.rbegin(); line != mark.rend(); ++line) {
    below += lineHeight;
    add(screenText(x, below, *line, colours::warning, font_px_, false));
  }
}

void Stage::drawScale(const ColourScale& scale) {
  constexpr int steps = 96;
  const double left = 1.0 - 6.5 * font_px_ / width_, wide = 1.3 * font_px_ / width_, low = 0.22, high = 0.78;
  for (int n = 0; n < steps; ++n)
    add(screenSwatch(left, low + (high - low) * n / steps, wide, 1.04 * (high - low) / steps,
                     scale.colour((n + 0.5) / steps)));
  for (int n = 0; n <= 4; ++n) {
    char number[24];
    std::snprintf(number, sizeof number, "%s%.4g", n == 4 && scale.beyond ? "≥ " : "", 0.25 * n * scale.end);
    add(screenText(left + 1.6 * wide, low + 0.25 * n * (high - low) - 0.4 * font_px_ / height_,
                   inLanguage(number, scale.language), colours::light, font_px_, false));
  }
  add(screenText(left - 0.5 * textWidth(scale.title, font_px_) / width_, high + 1.0 * font_px_ / height_, scale.title,
                 colours::light, font_px_, true));
}

void Stage::drawNotValidMark() {
  add(screenText(0.5, 0.5, "NOT CONVERGED / OUTSIDE VALIDITY", colours::warning, 0.045 * width_, true, true,
                 std::atan2(height_, width_) * 180.0 / 3.141592653589793));
}

void Stage::aim(const Eigen::AlignedBox3d& box, bool decorated, const std::vector<LegendRow>& legend) {
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
    const double reach = halfWidth + 2.0 * labelOffset_mm(box), legend_px = legendWidth_px(legend);
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

double Stage::legendWidth_px(const std::vector<LegendRow>& legend) const {
  double widest = 0.0;
  for (const LegendRow& row : legend) widest = std::max(widest, textWidth(row.text, font_px_));
  return 3.2 * font_px_ + widest;
}

bool Stage::takeRoom(const Eigen::Vector3d& at_lps, const std::string& text, double size_px) {
  const Eigen::Vector2d middle = Eigen::Vector2d(at_lps.dot(view_.right), at_lps.dot(view_.up)) / mmPerPixel_;
  const Eigen::Vector2d half(0.5 * textWidth(text, size_px) + 0.2 * size_px, 0.45 * size_px);
  const Eigen::AlignedBox2d room(middle - half, middle + half);
  for (const Eigen::AlignedBox2d& other : taken_px_)
    if (room.intersects(other)) return false;
  taken_px_.push_back(room);
  return true;
}

}  // namespace glisson::render
