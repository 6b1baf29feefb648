// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "render/charts.h"

namespace glisson::report::detail {

/// Sheets of a PDF document, to be written one after the other. Lengths in points (1/72 inch), y down from the top
/// edge.
class PdfCanvas {
 public:
  static constexpr double width_pt = 595.276, height_pt = 841.89;  ///< A4

  explicit PdfCanvas(const std::string& title);
  ~PdfCanvas();
  PdfCanvas(const PdfCanvas&) = delete;
  PdfCanvas& operator=(const PdfCanvas&) = delete;

  /// The rest goes onto a new sheet.
  void nextSheet();
  /// A bookmark to a place of the current sheet.
  void bookmark(const std::string& text, int sheet, double y_pt);
  /// What is drawn by `drawing` in pixels of its own, with its first pixel at (x, y) and `scale` points a pixel.
  void drawing(const std::function<void(render::Painter&)>& drawing, double x_pt, double y_pt, double scale);
  /// A PNG file, w_pt wide. Throws BadInput where it cannot be read.
  void picture(const std::filesystem::path& png, double x_pt, double y_pt, double w_pt);
  /// Points as pixels: text, lines and areas of the page itself.
  render::Painter& painter();

  /// The document; nothing can be drawn afterwards.
  std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Width and height of a PNG file, pixels, from its header. Throws BadInput where it is none.
render::ChartSize sizeOfPng(const std::filesystem::path& png);

}  // namespace glisson::report::detail
