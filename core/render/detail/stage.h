// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/language.h"
#include "render/detail/scene3d_parts.h"
#include "render/detail/viewpoint.h"
#include "render/overlay.h"

class vtkRenderer;

namespace glisson::render {

struct DisplacementArrow;

/// Colours of the two answers, and of where they agree, in 3-D.
struct SceneColours {
  Rgb mre, atlas, agree;
};
SceneColours coloursOf(Palette palette);
Rgb mixed(Rgb a, Rgb b, double t);

/// A line of the legend.
struct LegendRow {
  std::optional<Rgb> colour;  ///< none: the text goes on with that of the row above
  std::string text;
};

/// The renderer with its camera, grid, legend and texts.
class Stage {
 public:
  Stage(vtkRenderer* renderer, const SceneOptions3D& options);

  void add(const vtkSmartPointer<vtkProp>& prop);
  /// Parallel projection: a centimetre of the grid is a centimetre everywhere in its plane.
  void aim(const Eigen::AlignedBox3d& box, bool decorated, const std::vector<LegendRow>& legend);

  // After aim().
  /// Grid walls behind and below, centimetre labels and letters of the patient's sides along their edges, a 5 cm bar.
  /// A number that would stand in a letter or another number is left out.
  void drawGrid(const Eigen::AlignedBox3d& box);
  /// Displacements from rest, true to scale, heads in the plane of the screen.
  void drawArrows(const std::vector<DisplacementArrow>& arrows, const SceneColours& colour, double t);
  /// A way with its head at the end.
  void drawWay(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Rgb colour);
  /// Words that begin at a place and go on aside of it, a little above or below.
  void drawWords(const Eigen::Vector3d& at, const Eigen::Vector3d& aside, bool above, Rgb colour,
                 const std::string& words);
  /// Legend, caption, reservation, research-use line.
  struct Words {
    std::string caption, mark;
    Language language = Language::English;
  };
  void drawText(const Words& words, std::vector<LegendRow> legend, double t);
  /// A colour scale at the right, from 0 up to its end.
  struct ColourScale {
    double end = 1.0;
    bool beyond = false;  ///< some values are larger
    std::string title;
    std::function<Rgb(double)> colour;  ///< of a fraction of the end
    Language language = Language::English;
  };
  void drawScale(const ColourScale& scale);
  /// Drawn whether decorated or not: an invalid run must not look like a valid one.
  void drawNotValidMark();

 private:
  /// How far from its edge a label stands.
  static double labelOffset_mm(const Eigen::AlignedBox3d& box) { return 0.035 * box.diagonal().norm(); }
  double legendWidth_px(const std::vector<LegendRow>& legend) const;
  /// Whether the text covers none that was placed before; its room is taken then.
  bool takeRoom(const Eigen::Vector3d& at_lps, const std::string& text, double size_px);
  /// A line from one place to another with a head at its end, in the plane of the screen.
  void arrow(std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& lines, const Eigen::Vector3d& from,
             const Eigen::Vector3d& to, double head_mm) const;

  vtkRenderer* renderer_;
  Viewpoint view_;
  double width_, height_, font_px_, line_px_;
  double mmPerPixel_ = 1.0;
  std::size_t arrows_ = 0;
  std::vector<Eigen::AlignedBox2d> taken_px_;  ///< on the screen, from the projection of the patient's origin
};

}  // namespace glisson::render
