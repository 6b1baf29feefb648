// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/language.h"
#include "report/page.h"
#include "uncertainty/propagate.h"

namespace glisson::pipeline::detail {

/// "uncertainty" of run.json.
nlohmann::ordered_json uncertaintyToJson(const uncertainty::Uncertainty& u);

/// Adds "interval95" and "probability_beyond_5mm" to "difference" of run.json, where they are known.
void addIntervals(const uncertainty::Uncertainty& u, nlohmann::ordered_json& difference);

/// Columns of vessels.csv, and their values for a landmark (mm; not a number where it lies outside the body).
inline constexpr std::array<const char*, 6> spreadColumns = {
    "sd_mm", "atlas_sd_mm", "difference_sd_mm", "difference_low_mm", "difference_high_mm", "probability_beyond_5mm"};
std::vector<double> spreadOf(const uncertainty::Uncertainty& u, std::size_t landmark);

/// Beside a figure: " (95 %: 4.1 to 10.2 mm)".
std::string in95(const uncertainty::Interval& interval, const char* unit);

/// The section of the report. language: of the sentence for surgeons.
void howSure(const uncertainty::Uncertainty& u, Language language, report::Page& page);

}  // namespace glisson::pipeline::detail
