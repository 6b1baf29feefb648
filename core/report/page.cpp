// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page.h"

#include <fstream>

#include "base/error.h"

namespace glisson::report {

void Page::table(const std::vector<std::pair<std::string, std::string>>& rows) {
  Table t;
  for (const auto& [what, value] : rows) t.rows.push_back({what, value});
  blocks_.emplace_back(std::move(t));
}

void Page::table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  for (const auto& row : rows)
    if (row.size() != header.size())
      throw BadArgument("report::Page: a row has " + std::to_string(row.size()) + " cells, not " +
                        std::to_string(header.size()));
  blocks_.emplace_back(Table{header, rows});
}

void Page::picture(const std::filesystem::path& png, const std::string& caption) {
  if (!std::ifstream(png, std::ios::binary))
    throw BadInput("the report cannot read the picture '" + png.filename().string() + "'");
  blocks_.emplace_back(Figure{.png = png, .caption = caption});
}

void Page::drawing(const std::filesystem::path& png, std::function<void(render::Painter&)> drawing,
                   const render::ChartSize& size, const std::string& caption) {
  picture(png, caption);
  auto& figure = std::get<Figure>(blocks_.back());
  figure.drawing = std::move(drawing);
  figure.size = size;
}

}  // namespace glisson::report
