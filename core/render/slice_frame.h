// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/language.h"
#include "render/colour_map.h"
#include "render/painter.h"
#include "render/slice_plane.h"

namespace glisson::render {

/// A line of the legend.
struct LegendItem {
  Rgb colour;
  std::string text;
  bool asLine = false;  ///< a stroke instead of a filled swatch
};

/// The scale of a coloured map.
struct ColourBar {
  ColourMap map;
  double low = 0.0, high = 1.0;
  std::string title{};           ///< quantity and unit
  std::optional<double> mark{};  ///< a value to mark by a line across the bar
  Rgb markColour = colours::orange;
};

/// What surrounds the image of a slice: everything a reader needs to take measures from it.
struct SliceFrame {
  SlicePlane plane;
  std::string title{};  ///< above the image; may be empty
  std::vector<LegendItem> legend{};
  std::vector<std::string> notes{};      ///< lines under the legend
  std::string caption{};                 ///< wrapped
  std::string mark{};                    ///< a reservation, wrapped, in the colour of warnings; may be empty
  std::optional<double> gridTicks_mm{};  ///< labels (cm) for grid lines at this spacing
  std::optional<ColourBar> colourBar{};
  const Picture* inset = nullptr;  ///< drawn to the right, or below; square
  bool insetBelow = false;
  std::optional<Eigen::Vector3d> ring_lps_mm{};  ///< a place to mark, in the image and in the inset
  std::optional<SlicePlane> insetPlane{};
  std::string insetTitle{};
  Language language = Language::English;  ///< of the line of research use
};

/// The image with its frame: orientation letters, scale bar, labels, legend, inset, caption, research-use line.
Picture frameSlice(const Picture& image, const SliceFrame& frame);

/// Font size that suits an image of this size, pixels.
double frameFontSize(const Picture& image);

/// A "not converged / outside validity" mark across the picture.
void drawNotValid(Picture& picture);

/// In-plane position of grid lines: coordinates (mm along direction) of all multiples of spacing_mm inside [low, high].
std::vector<double> gridLines_mm(double low_mm, double high_mm, double spacing_mm);

}  // namespace glisson::render
