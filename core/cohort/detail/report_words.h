// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cohort/detail/summary.h"
#include "report/page.h"
#include "report/text.h"

namespace glisson::cohort::detail {

/// A number of few digits, a dash where it is not finite.
std::string orDash(double v, int digits = 3);
/// 0.3 → "30 %"
std::string percent(double fraction);
/// "1 patient", "2 patients".
std::string patients(std::size_t n);
/// "shear modulus µ", or what the published study draws.
std::string quantityOf(const StiffnessStudy& s);
/// Mean, spread and range in one line.
std::string inWords(const Spread& s, const char* unit);

/// The studies' answers in a few lines, before anything else.
void inShort(report::Page& page, const Summary& s);
void methods(report::Page& page, const Summary& s);
/// What stands against the numbers of the retraction study.
void reservations(report::Page& page, const Summary& s);
void sensitivityTable(report::Page& page, const Summary& s);

}  // namespace glisson::cohort::detail
