// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/detail/pdf_canvas.h"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <array>
#include <fstream>
#include <numbers>

#include "base/error.h"
#include "render/font.h"

namespace glisson::report::detail {
namespace {

using render::Point;
using render::Rgb;

template <auto release>
struct Release {
  template <typename T>
  void operator()(T* p) const {
    release(p);
  }
};
using Surface = std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Release<cairo_destroy>>;
using FontFace = std::unique_ptr<cairo_font_face_t, Release<cairo_font_face_destroy>>;

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(std::string("the PDF report cannot be written: ") + cairo_status_to_string(status));
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int n) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), n);
  return CAIRO_STATUS_SUCCESS;
}

/// The font that the program carries, regular and bold (cairo keeps a face for as long as it needs it, and FreeType has
/// to outlive that: one for the whole program).
struct Fonts {
  FT_Library library = nullptr;
  FT_Face regular = nullptr, bold = nullptr;
  Fonts() {
    const auto bytes = render::builtInFont();
    const auto open = [&](FT_Face& face) {
      return FT_New_Memory_Face(library, bytes.data(), static_cast<FT_Long>(bytes.size()), 0, &face) == 0;
    };
    if (FT_Init_FreeType(&library) != 0 || !open(regular) || !open(bold))
      throw Error("the built-in font cannot be opened");
  }
};

Fonts& fonts() {
  static Fonts* const one = new Fonts;
  return *one;
}

class CairoPainter final : public render::Painter {
 public:
  CairoPainter(cairo_t* cairo, cairo_font_face_t* regular, cairo_font_face_t* bold)
      : cairo_(cairo), regular_(regular), bold_(bold) {}

  void line(const Point& a, const Point& b, const render::Stroke& s) override {
    if (!a.allFinite() || !b.allFinite()) return;
    colour(s.colour, s.alpha);
    cairo_set_line_width(cairo_, s.width);
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
    const std::array<double, 2> dashes = {std::max(6.0, 4.0 * s.width), std::max(4.0, 2.5 * s.width)};
    cairo_set_dash(cairo_, dashes.data(), s.dashed ? 2 : 0, 0.0);
    cairo_move_to(cairo_, a.x(), a.y());
    cairo_line_to(cairo_, b.x(), b.y());
    cairo_stroke(cairo_);
  }
  void polygon(const std::vector<Point>& corners, Rgb fill, double alpha) override {
    colour(fill, alpha);
    for (const Point& p : corners) cairo_line_to(cairo_, p.x(), p.y());
    cairo_close_path(cairo_);
    cairo_fill(cairo_);
  }
  void disc(const Point& centre, double radius, Rgb fill, double alpha) override {
    colour(fill, alpha);
    cairo_new_sub_path(cairo_);
    cairo_arc(cairo_, centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
    cairo_fill(cairo_);
  }
  void text(const Point& at, const std::string& utf8, const render::TextStyle& style) override {
    if (utf8.empty()) return;
    colour(style.colour, style.alpha);
    cairo_set_font_face(cairo_, style.bold ? bold_ : regular_);
    cairo_set_font_size(cairo_, style.size_px);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, utf8.c_str(), &extents);
    const double back = style.anchor == render::Anchor::Left     ? 0.0
                        : style.anchor == render::Anchor::Centre ? 0.5 * extents.x_advance
                                                                 : extents.x_advance;
    cairo_save(cairo_);
    cairo_translate(cairo_, at.x(), at.y());
    cairo_rotate(cairo_, -style.angle_deg * std::numbers::pi / 180.0);
    cairo_move_to(cairo_, -back, 0.0);
    cairo_show_text(cairo_, utf8.c_str());
    cairo_restore(cairo_);
    cairo_new_path(cairo_);
  }

 private:
  void colour(Rgb c, double alpha) { cairo_set_source_rgba(cairo_, c.r / 255.0, c.g / 255.0, c.b / 255.0, alpha); }
  cairo_t* cairo_;
  cairo_font_face_t *regular_, *bold_;
};

}  // namespace

struct PdfCanvas::State {
  std::string bytes;
  FontFace regular, bold;
  Surface surface;
  Context cairo;
  std::unique_ptr<CairoPainter> painter;
};

PdfCanvas::PdfCanvas(const std::string& title) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.regular.reset(cairo_ft_font_face_create_for_ft_face(fonts().regular, FT_LOAD_NO_HINTING));
  s.bold.reset(cairo_ft_font_face_create_for_ft_face(fonts().bold, FT_LOAD_NO_HINTING));
  cairo_ft_font_face_set_synthesize(s.bold.get(), CAIRO_FT_SYNTHESIZE_BOLD);
  s.surface.reset(cairo_pdf_surface_create_for_stream(append, &s.bytes, width_pt, height_pt));
  check(cairo_surface_status(s.surface.get()));
  cairo_pdf_surface_restrict_to_version(s.surface.get(), CAIRO_PDF_VERSION_1_5);
  cairo_pdf_surface_set_metadata(s.surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
  cairo_pdf_surface_set_metadata(s.surface.get(), CAIRO_PDF_METADATA_CREATOR, "Glisson");
  // No date, so that the same report is the same file.
  cairo_pdf_surface_set_metadata(s.surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  s.cairo.reset(cairo_create(s.surface.get()));
  check(cairo_status(s.cairo.get()));
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(s.cairo.get(), options);
  cairo_font_options_destroy(options);
  s.painter = std::make_unique<CairoPainter>(s.cairo.get(), s.regular.get(), s.bold.get());
}

PdfCanvas::~PdfCanvas() = default;

void PdfCanvas::nextSheet() {
  cairo_show_page(state_->cairo.get());
}

void PdfCanvas::bookmark(const std::string& text, int sheet, double y_pt) {
  const std::string place = "page=" + std::to_string(sheet) + " pos=[0 " + std::to_string(std::lround(y_pt)) + "]";
  cairo_pdf_surface_add_outline(state_->surface.get(), CAIRO_PDF_OUTLINE_ROOT, text.c_str(), place.c_str(),
                                CAIRO_PDF_OUTLINE_FLAG_OPEN);
}

void PdfCanvas::drawing(const std::function<void(render::Painter&)>& drawing, double x_pt, double y_pt, double scale) {
  cairo_t* c = state_->cairo.get();
  cairo_save(c);
  cairo_translate(c, x_pt, y_pt);
  cairo_scale(c, scale, scale);
  drawing(*state_->painter);
  cairo_restore(c);
}

void PdfCanvas::picture(const std::filesystem::path& png, double x_pt, double y_pt, double w_pt) {
  const Surface image(cairo_image_surface_create_from_png(png.c_str()));
  if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS)
    throw BadInput("the report cannot read the picture '" + png.filename().string() + "'");
  cairo_t* c = state_->cairo.get();
  const double scale = w_pt / cairo_image_surface_get_width(image.get());
  cairo_save(c);
  cairo_translate(c, x_pt, y_pt);
  cairo_scale(c, scale, scale);
  cairo_set_source_surface(c, image.get(), 0.0, 0.0);
  cairo_paint(c);
  cairo_restore(c);
}

render::Painter& PdfCanvas::painter() {
  return *state_->painter;
}

std::string PdfCanvas::finish() {
  check(cairo_status(state_->cairo.get()));
  cairo_surface_finish(state_->surface.get());
  check(cairo_surface_status(state_->surface.get()));
  return std::move(state_->bytes);
}

render::ChartSize sizeOfPng(const std::filesystem::path& png) {
  std::ifstream in(png, std::ios::binary);
  std::array<unsigned char, 24> head{};
  in.read(reinterpret_cast<char*>(head.data()), head.size());
  const auto big = [&](std::size_t at) {
    return (head[at] << 24) | (head[at + 1] << 16) | (head[at + 2] << 8) | head[at + 3];
  };
  if (!in || head[1] != 'P' || head[2] != 'N' || head[3] != 'G' || big(16) <= 0 || big(20) <= 0)
    throw BadInput("the report cannot read the picture '" + png.filename().string() + "'");
  return {big(16), big(20)};
}

}  // namespace glisson::report::detail
