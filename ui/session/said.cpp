// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/said.h"

#include <QCoreApplication>
#include <algorithm>
#include <iterator>

#include "base/diagnostic_text.h"

namespace glisson::session {

namespace {

struct InWords {
  const char *name, *words;
};

/// Steps of a plan (core/pipeline/plan.cpp), then what they tell of their progress.
constexpr InWords stepNames[] = {
    {"read-mri", QT_TRANSLATE_NOOP("steps", "reading the MRI")},
    {"read-mre", QT_TRANSLATE_NOOP("steps", "reading the elastogram")},
    {"read-map", QT_TRANSLATE_NOOP("steps", "reading the stiffness map")},
    {"read-roi", QT_TRANSLATE_NOOP("steps", "reading the outlines")},
    {"measure-stiffness", QT_TRANSLATE_NOOP("steps", "measuring the stiffness")},
    {"mesh", QT_TRANSLATE_NOOP("steps", "making the cells")},
    {"place-bar", QT_TRANSLATE_NOOP("steps", "finding a place for the bar")},
    {"vessels", QT_TRANSLATE_NOOP("steps", "finding the vessels")},
    {"mesh-free-frames", QT_TRANSLATE_NOOP("steps", "placing mesh-free frames")},
    {"assembled-stiffness-matrix", QT_TRANSLATE_NOOP("steps", "assembling the stiffness matrix")},
    {"mass-matrix", QT_TRANSLATE_NOOP("steps", "assembling the mass matrix")},
    {"damping", QT_TRANSLATE_NOOP("steps", "damping")},
    {"time-steps", QT_TRANSLATE_NOOP("steps", "time steps")},
    {"condensed-response", QT_TRANSLATE_NOOP("steps", "condensing the response")},
    {"large-deformation", QT_TRANSLATE_NOOP("steps", "large deformation")},
    {"capsule", QT_TRANSLATE_NOOP("steps", "Glisson's capsule")},
    {"ligaments", QT_TRANSLATE_NOOP("steps", "ligaments")},
    {"loads-that-follow", QT_TRANSLATE_NOOP("steps", "loads that follow the surface")},
    {"solve", QT_TRANSLATE_NOOP("steps", "solving with the measured stiffness")},
    {"atlas-solve", QT_TRANSLATE_NOOP("steps", "solving with the atlas stiffness")},
    {"linear-solve", QT_TRANSLATE_NOOP("steps", "solving in linear theory")},
    {"linear-gap", QT_TRANSLATE_NOOP("steps", "judging linear theory")},
    {"discretisation-error", QT_TRANSLATE_NOOP("steps", "estimating the error of the cells")},
    {"cell-displacements", QT_TRANSLATE_NOOP("steps", "displacements of the cells")},
    {"strain", QT_TRANSLATE_NOOP("steps", "strains")},
    {"difference", QT_TRANSLATE_NOOP("steps", "comparing both answers")},
    {"uncertainty", QT_TRANSLATE_NOOP("steps", "estimating how sure the answer is")},
    {"liver-surface", QT_TRANSLATE_NOOP("steps", "making the surface")},
    {"write-displacement-field", QT_TRANSLATE_NOOP("steps", "writing displacements")},
    {"picture-data", QT_TRANSLATE_NOOP("steps", "keeping what the pictures show")},
    {"slice-overlay", QT_TRANSLATE_NOOP("steps", "drawing slices")},
    {"3d-overlay", QT_TRANSLATE_NOOP("steps", "drawing in 3-D")},
    {"uncertainty-pictures", QT_TRANSLATE_NOOP("steps", "drawing how sure the answer is")},
    {"sofa", QT_TRANSLATE_NOOP("steps", "writing a SOFA scene")},
    {"report", QT_TRANSLATE_NOOP("steps", "writing the report")},
    {"reading MRI", QT_TRANSLATE_NOOP("steps", "reading the MRI")},
    {"reading elastogram", QT_TRANSLATE_NOOP("steps", "reading the elastogram")},
    {"reading the MRI", QT_TRANSLATE_NOOP("steps", "reading the MRI")},
    {"reading the elastogram", QT_TRANSLATE_NOOP("steps", "reading the elastogram")},
    {"reading the region of interest", QT_TRANSLATE_NOOP("steps", "reading the outlines")},
    {"placing the region of interest", QT_TRANSLATE_NOOP("steps", "placing the outlines")},
    {"inputs read", QT_TRANSLATE_NOOP("steps", "reading the outlines")},
    {"reading files", QT_TRANSLATE_NOOP("steps", "reading files")},
    {"reading slices", QT_TRANSLATE_NOOP("steps", "reading slices")},
    {"reading image headers", QT_TRANSLATE_NOOP("steps", "reading image headers")},
    {"looking at volume files", QT_TRANSLATE_NOOP("steps", "looking at volume files")},
    {"making a synthetic patient", QT_TRANSLATE_NOOP("steps", "making a synthetic patient")},
    {"magnetic resonance images", QT_TRANSLATE_NOOP("steps", "making a synthetic patient")},
    {"elastography", QT_TRANSLATE_NOOP("steps", "making a synthetic patient")},
    {"anatomy", QT_TRANSLATE_NOOP("steps", "making a synthetic patient")},
    {"contours", QT_TRANSLATE_NOOP("steps", "making a synthetic patient")},
    {"laying the elastogram over the MRI", QT_TRANSLATE_NOOP("steps", "laying the elastogram over the MRI")},
    {"comparing readers", QT_TRANSLATE_NOOP("steps", "comparing readers")},
    {"growing from the seed", QT_TRANSLATE_NOOP("steps", "growing a region")},
    {"assembling", QT_TRANSLATE_NOOP("steps", "assembling")},
    {"factorising", QT_TRANSLATE_NOOP("steps", "factorising")},
    {"solving", QT_TRANSLATE_NOOP("steps", "solving")},
    {"time stepping", QT_TRANSLATE_NOOP("steps", "time steps")},
    {"coarse cells", QT_TRANSLATE_NOOP("steps", "estimating the error of the cells")},
    {"tetrahedra", QT_TRANSLATE_NOOP("steps", "making tetrahedra")},
    {"what linear theory misses", QT_TRANSLATE_NOOP("steps", "judging linear theory")},
    {"charts", QT_TRANSLATE_NOOP("steps", "drawing charts")},
    {"slices", QT_TRANSLATE_NOOP("steps", "drawing slices")},
    {"3-D", QT_TRANSLATE_NOOP("steps", "drawing in 3-D")},
    {"done", QT_TRANSLATE_NOOP("steps", "done")},
    {"de-identifying", QT_TRANSLATE_NOOP("steps", "de-identifying")},
    {"asking for studies", QT_TRANSLATE_NOOP("steps", "asking for studies")},
    {"asking for series", QT_TRANSLATE_NOOP("steps", "asking for series")},
};

}  // namespace

QString said(const Diagnostic& diagnostic) {
  const std::string text(templateOf(diagnostic.code));
  const QString translated = QCoreApplication::translate("diagnostics", text.c_str());
  return QString::fromStdString(filledIn(translated.toStdString(), diagnostic));
}

QStringList said(const std::vector<std::string>& texts, const Diagnostics& diagnostics) {
  QStringList all;
  for (const std::string& text : texts) {
    const auto found =
        std::find_if(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& d) { return d.text() == text; });
    all << (found == diagnostics.end() ? QString::fromStdString(text) : said(*found));
  }
  return all;
}

QString withoutOptions(QString reason) {
  // A longer option before one that it begins with.
  static constexpr InWords options[] = {{"--patient-id", "a patient ID"},
                                        {"--patient-name", "a patient name"},
                                        {"--study-date", "a study date"},
                                        {"--modality", "a modality"},
                                        {"--accession", "an accession number"},
                                        {"--description", "a description"},
                                        {"--study", "a study"},
                                        {"--series-uid", "a series"},
                                        {"--host", "the address"},
                                        {"--port", "the port"},
                                        {"--called", "the server's AE title"},
                                        {"--calling", "our AE title"},
                                        {"--receive-port", "our own port"},
                                        {"--move", "C-MOVE"},
                                        {"--timeout", "time-out"},
                                        {" with --output", ""}};
  for (const InWords& option : options) reason.replace(QLatin1String(option.name), QLatin1String(option.words));
  return reason;
}

QString stepInWords(const QString& step) {
  const auto found = std::find_if(std::begin(stepNames), std::end(stepNames),
                                  [&step](const InWords& s) { return step == QLatin1String(s.name); });
  return found == std::end(stepNames) ? step : QCoreApplication::translate("steps", found->words);
}

}  // namespace glisson::session
