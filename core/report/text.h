// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace glisson::report {

/// A number with a few significant digits for tables and captions, never in a locale's own way.
std::string number(double value, int significant = 4);

/// Rows of "tidy" CSV: quoted where needed, '.' as decimal point.
class Csv {
 public:
  explicit Csv(const std::vector<std::string>& header);
  void row(const std::vector<std::string>& cells);
  const std::string& text() const { return text_; }

 private:
  std::size_t columns_;
  std::string text_;
};

}  // namespace glisson::report
