// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace glisson::exchange {

/// One value of a tidy table: one row, one number.
struct TidyRow {
  std::string caseName, reader, slice, roi, quantity, statistic;
  double value = 0.0;
  std::string unit;
};

/// "case,reader,slice,roi,quantity,statistic,value,unit" and one line per row (RFC 4180). Values that are not finite
/// are empty cells. Text that a spreadsheet would take for a formula gets a leading apostrophe.
std::string tidyCsv(const std::vector<TidyRow>& rows);

}  // namespace glisson::exchange
