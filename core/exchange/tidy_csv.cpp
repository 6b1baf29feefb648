// SPDX-License-Identifier: GPL-3.0-or-later
#include "exchange/tidy_csv.h"

#include <cmath>

#include "exchange/text_file.h"

namespace glisson::exchange {
namespace {

std::string cell(std::string text) {
  if (!text.empty() && std::string("=+-@\t\r").find(text.front()) != std::string::npos) text.insert(0, "'");
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

std::string tidyCsv(const std::vector<TidyRow>& rows) {
  std::string out = "case,reader,slice,roi,quantity,statistic,value,unit\r\n";
  for (const TidyRow& r : rows) {
    for (const std::string* text : {&r.caseName, &r.reader, &r.slice, &r.roi, &r.quantity, &r.statistic})
      out += cell(*text) + ",";
    out += (std::isfinite(r.value) ? shortest(r.value) : std::string()) + "," + cell(r.unit) + "\r\n";
  }
  return out;
}

}  // namespace glisson::exchange
