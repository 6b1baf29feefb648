// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/trust.h"

#include <QCoreApplication>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "retraction/offered.h"
#include "session/said.h"
#include "session/setup_of.h"

namespace glisson::session {

namespace {

using Code = DiagnosticCode;

constexpr double leastCell_mm = 1.0;  // what the Model page lets be set

struct Advice {
  Code code;
  Remedy remedy;
  const char* words;
};

/// What to do about each code that a run of the window can have; resources/manual/messages.advice says the same to
/// those who write scenes.
constexpr Advice adviceOf[] = {
    {Code::DisplacementBeyondBody, Remedy::None,
     QT_TRANSLATE_NOOP("advice",
                       "Check stiffness, supports and force on Model and Retract: one of them has another unit.")},
    {Code::CellsInsideOut, Remedy::SmallerCells,
     QT_TRANSLATE_NOOP("advice", "Do not use what lies there. Smaller cells, or a smaller force, keep cells whole.")},
    {Code::StrainBeyondLinear, Remedy::LargeDeformation,
     QT_TRANSLATE_NOOP("advice", "Run it in large deformation (Model, Kinematics: hyperelastic).")},
    {Code::RotationBeyondLinear, Remedy::LargeDeformation,
     QT_TRANSLATE_NOOP("advice", "Run it in large deformation (Model, Kinematics: hyperelastic).")},
    {Code::LinearGapLarge, Remedy::LargeDeformation,
     QT_TRANSLATE_NOOP("advice", "Run it in large deformation (Model, Kinematics: hyperelastic).")},
    {Code::LinearUnstable, Remedy::LargeDeformation,
     QT_TRANSLATE_NOOP("advice", "Run it in large deformation (Model, Kinematics: hyperelastic).")},
    {Code::StrainBeyondCorotational, Remedy::LargeDeformation,
     QT_TRANSLATE_NOOP("advice", "Run it in large deformation (Model, Kinematics: hyperelastic).")},
    {Code::RetractorSlips, Remedy::BorneForce,
     QT_TRANSLATE_NOOP("advice",
                       "Ask for less, or lay the bar where the liver is thicker and level across it. What is borne is "
                       "itself a result.")},
    {Code::RetractorFolds, Remedy::BorneForce,
     QT_TRANSLATE_NOOP("advice", "Ask for less, or take a thicker bar or other cells.")},
    {Code::RetractorCuts, Remedy::BorneForce,
     QT_TRANSLATE_NOOP("advice", "Ask for less, or take a thicker bar or smaller cells.")},
    {Code::RetractorPastLimit, Remedy::None,
     QT_TRANSLATE_NOOP("advice", "Only a held travel stays here: under a force the bar would move on.")},
    {Code::RetractorJumps, Remedy::FoundPlace,
     QT_TRANSLATE_NOOP("advice",
                       "Read this as the second of two equilibria, or lay the bar where the liver bears more.")},
    {Code::LoadsNotBorne, Remedy::BorneForce,
     QT_TRANSLATE_NOOP("advice", "Ask for a smaller force, or hold the liver at more places.")},
    {Code::BarFoldsSurface, Remedy::SmallerCells,
     QT_TRANSLATE_NOOP("advice",
                       "Do not quote what lies within a cell of that place; smaller cells show whether it stays.")},
    {Code::CellsCrushed, Remedy::SmallerCells,
     QT_TRANSLATE_NOOP(
         "advice",
         "Do not quote pressures or places beside the bar. A smaller force, a thicker bar or smaller cells "
         "help.")},
    {Code::NotConverged, Remedy::BorneForce,
     QT_TRANSLATE_NOOP("advice", "Use none of its numbers. Ask for less, or take other cells.")},
    {Code::MeshfreeLimited, Remedy::None,
     QT_TRANSLATE_NOOP("advice", "Take more sites or another kernel, and compare with voxel hexahedra.")},
    {Code::NoPlaceBears, Remedy::BorneForce,
     QT_TRANSLATE_NOOP("advice", "Ask for less, take a shorter or thicker bar, or lay it by hand.")},
    {Code::DiscretisationLarge, Remedy::SmallerCells,
     QT_TRANSLATE_NOOP("advice", "Smaller cells make this error smaller; until then quote it beside the numbers.")},
    {Code::SignificanceOpen, Remedy::SmallerCells,
     QT_TRANSLATE_NOOP("advice", "Until then report the difference with its error, and no verdict.")},
    {Code::DifferenceWithheld, Remedy::None,
     QT_TRANSLATE_NOOP("advice", "Mend the run that is named; its own reason says how.")},
    {Code::ValueImplausible, Remedy::None,
     QT_TRANSLATE_NOOP("advice", "Check the number and its unit on Model and Retract.")},
    {Code::MotionNotAtRest, Remedy::None,
     QT_TRANSLATE_NOOP("advice", "Give the motion more time, where the liver at rest is wanted.")},
    {Code::ContactByCells, Remedy::None,
     QT_TRANSLATE_NOOP("advice", "Compare area and pressure between runs with cells of one size only.")},
};

QString inTrust(const char* text) {
  return QCoreApplication::translate("trust", text);
}

/// Which answers say it.
struct Said {
  Diagnostic diagnostic;
  bool own = false, atlas = false;
};

bool alike(const Diagnostic& a, const Diagnostic& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.first == y.first && (x.first == "stiffness" || x == y);
  };
  return a.code == b.code &&
         std::equal(a.arguments.begin(), a.arguments.end(), b.arguments.begin(), b.arguments.end(), same);
}

/// The name of a stiffness inside a sentence.
QString nameOf(bool own, bool atlas) {
  if (own && atlas)
    return QCoreApplication::translate("trust", "measured and atlas", "of a stiffness, inside a sentence");
  return own ? QCoreApplication::translate("trust", "measured", "of a stiffness, inside a sentence")
             : QCoreApplication::translate("trust", "atlas", "of a stiffness, inside a sentence");
}

/// Why an answer is none (core/pipeline/told.cpp).
constexpr const char* reasons[] = {QT_TRANSLATE_NOOP("trust", "slips"),
                                   QT_TRANSLATE_NOOP("trust", "folds"),
                                   QT_TRANSLATE_NOOP("trust", "cuts"),
                                   QT_TRANSLATE_NOOP("trust", "loads not borne"),
                                   QT_TRANSLATE_NOOP("trust", "not converged"),
                                   QT_TRANSLATE_NOOP("trust", "it moves the body by more than its size"),
                                   QT_TRANSLATE_NOOP("trust", "a cell is turned inside out")};

void translateReason(std::string& word) {
  const auto known = std::find(std::begin(reasons), std::end(reasons), word);
  if (known != std::end(reasons)) word = inTrust(*known).toStdString();
}

Doubt doubtOf(Said s, bool compared) {
  bool named = !compared;  // where there is one answer, nobody asks whose
  for (auto& [key, value] : s.diagnostic.arguments) {
    if (!std::holds_alternative<std::string>(value)) continue;
    if (key == "reason") translateReason(std::get<std::string>(value));
    if (key != "stiffness") continue;
    if (!s.own && !s.atlas) (std::get<std::string>(value) == "atlas" ? s.atlas : s.own) = true;
    value = nameOf(s.own, s.atlas).toStdString();
    named = true;
  }
  Doubt doubt;
  doubt.severity = s.diagnostic.severity();
  doubt.text = said(s.diagnostic);
  if (!named && (s.own || s.atlas))
    doubt.text = (s.own && s.atlas ? inTrust(QT_TRANSLATE_NOOP("trust", "MRE and atlas: %1"))
                  : s.own          ? inTrust(QT_TRANSLATE_NOOP("trust", "MRE: %1"))
                                   : inTrust(QT_TRANSLATE_NOOP("trust", "Atlas: %1")))
                     .arg(doubt.text);
  const auto advice = std::find_if(std::begin(adviceOf), std::end(adviceOf),
                                   [&](const Advice& a) { return a.code == s.diagnostic.code; });
  if (advice != std::end(adviceOf)) {
    doubt.advice = QCoreApplication::translate("advice", advice->words);
    doubt.remedy = advice->remedy;
  }
  return doubt;
}

/// What both answers say, each reason once.
std::vector<Said> ofAnswers(const pipeline::RunResult& r) {
  std::vector<Said> all;
  for (const bool atlas : {false, true}) {
    if (atlas && !r.atlas) continue;
    const retraction::Result& answer = atlas ? *r.atlas : r.primary;
    Diagnostics both = answer.doubts;
    if (atlas) both.add(answer.solver.diagnostics);  // the run says those of its own stiffness itself
    for (const Diagnostic& d : both) {
      auto there = std::find_if(all.begin(), all.end(), [&](const Said& s) { return alike(s.diagnostic, d); });
      if (there == all.end()) there = all.insert(all.end(), {d});
      (atlas ? there->atlas : there->own) = true;
    }
  }
  return all;
}

double edge_mm(const pipeline::RunResult& result) {
  return result.model.youngs_kPa.grid.spacing_mm.maxCoeff();
}

std::optional<Parameters> withSmallerCells(Parameters p, const pipeline::RunResult& result) {
  if (isDelaunay(p.method)) {
    p.tetEdge_mm *= 0.5;
    p.tetToolEdge_mm *= 0.5;
    return p.tetToolEdge_mm >= leastCell_mm ? std::optional(p) : std::nullopt;
  }
  p.cell_mm = 0.01 * std::round(50.0 * edge_mm(result));
  return p.cell_mm >= leastCell_mm ? std::optional(p) : std::nullopt;
}

std::optional<Parameters> inLargeDeformation(Parameters p, const pipeline::RunResult& result) {
  if (result.primary.kinematics == retraction::Kinematics::Hyperelastic) return std::nullopt;
  p.kinematics = retraction::Kinematics::Hyperelastic;
  if (retraction::largeDeformationRefusal(setupOf(p))) {
    p.method = Method::HexIncompatible;
    p.solver = Solver::Auto;
    p.dynamic = false;
  }
  return retraction::largeDeformationRefusal(setupOf(p)) ? std::nullopt : std::optional(p);
}

std::optional<Parameters> withBorneForce(Parameters p, const pipeline::RunResult& result) {
  if (p.drive == Drive::Travel) return std::nullopt;
  std::optional<double> borne_N;
  for (const retraction::Result* answer : {&result.primary, result.atlas ? &*result.atlas : nullptr}) {
    if (!answer || !answer->contact || answer->contact->answered() || !(answer->contact->capacity_N > 0.0)) continue;
    borne_N = std::min(borne_N.value_or(answer->contact->capacity_N), answer->contact->capacity_N);
  }
  if (!borne_N) return std::nullopt;
  p.drive = Drive::Force;
  p.force_N = 0.1 * std::floor(9.0 * *borne_N);
  return p.force_N >= 0.1 ? std::optional(p) : std::nullopt;
}

}  // namespace

std::vector<Doubt> doubtsAbout(const pipeline::RunResult& r) {
  const std::vector<Said> answers = ofAnswers(r);
  const auto saidBy = [&answers](Code code) {
    return std::any_of(answers.begin(), answers.end(), [code](const Said& s) { return s.diagnostic.code == code; });
  };
  std::vector<Doubt> doubts;
  const auto add = [&doubts](Doubt doubt) {
    const auto same = [&doubt](const Doubt& d) { return d.text == doubt.text; };
    if (std::none_of(doubts.begin(), doubts.end(), same)) doubts.push_back(std::move(doubt));
  };
  for (const Said& s : answers) add(doubtOf(s, r.atlas.has_value()));
  for (const Diagnostic& d : r.diagnostics)
    if (!saidBy(d.code)) add(doubtOf({d}, r.atlas.has_value()));
  // What has no code; of the atlas's own only what was not said above.
  for (const std::string& w : r.warnings) {
    const auto told = [&w](const Said& s) { return s.atlas && "atlas: " + s.diagnostic.text() == w; };
    if (std::none_of(answers.begin(), answers.end(), told))
      add({Severity::Warning, said({w}, r.diagnostics).front(), {}, Remedy::None});
  }
  std::stable_sort(doubts.begin(), doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.severity > b.severity; });
  return doubts;
}

std::optional<Parameters> remedied(Remedy remedy, const Parameters& parameters, const pipeline::RunResult& result) {
  switch (remedy) {
    case Remedy::LargeDeformation: return inLargeDeformation(parameters, result);
    case Remedy::SmallerCells: return withSmallerCells(parameters, result);
    case Remedy::BorneForce: return withBorneForce(parameters, result);
    case Remedy::FoundPlace: {
      if (!parameters.placement.barAt_lps) return std::nullopt;
      Parameters p = parameters;
      p.placement.barAt_lps.reset();
      return p;
    }
    case Remedy::None: break;
  }
  return std::nullopt;
}

bool isNoAnswer(const pipeline::RunResult& result) {
  return result.diagnostics.contains(Code::DifferenceWithheld) || !result.primary.solver.converged();
}

}  // namespace glisson::session
