// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/text.h"

#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace glisson::report {

std::string number(double value, int significant) {
  if (!std::isfinite(value)) return "not available";
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", significant, value);
  return text;
}

Csv::Csv(const std::vector<std::string>& header) : columns_(header.size()) {
  row(header);
}

void Csv::row(const std::vector<std::string>& cells) {
  if (cells.size() != columns_)
    throw BadArgument("Csv: a row has " + std::to_string(cells.size()) + " cells, not " + std::to_string(columns_));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i) text_ += ',';
    if (cells[i].find_first_of(",\"\n") == std::string::npos) {
      text_ += cells[i];
      continue;
    }
    text_ += '"';
    for (const char c : cells[i]) text_ += c == '"' ? std::string("\"\"") : std::string(1, c);
    text_ += '"';
  }
  text_ += '\n';
}

}  // namespace glisson::report
