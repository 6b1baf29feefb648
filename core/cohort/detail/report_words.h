// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "cohort/detail/summary.h"
#include "report/page.h"
#include "report/text.h"

namespace glisson::cohort::detail {

/// A number of few digits, a dash where it is not finite.
std::string orDash(double v, int digits = 3);
/// 0.3 → "30 %"
std::string percent(double fraction);
/// " (95 %: 20 % to 50 %)" beside a share; empty where the runs do not say how sure they are.
std::string in95(const std::optional<SureShare>& share);
/// "1 patient", "2 patients".
std::string patients(std::size_t n);
/// "shear modulus µ", or what the published study draws.
std::string quantityOf(const StiffnessStudy& s);
/// Mean, spread and range in one line.
std::string inWords(const Spread& s, const char* unit);

/// The studies' answers in a few lines, before anything else.
void inShort(report::Page& page, const Summary& s);
void methods(report::Page& page, const Summary& s);
/// How sure the shares of the retraction study are; nothing where the runs do not say.
void howSure(report::Page& page, const Summary& s);
/// What stands against the numbers of the retraction study.
void reservations(report::Page& page, const Summary& s);
void sensitivityTable(report::Page& page, const Summary& s);

}  // namespace glisson::cohort::detail
