// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastography/roi_from_structures.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "roi/arrangement.h"
#include "roi/polygon.h"

namespace glisson::elastography {
namespace {

std::string names(const dicom::StructureSet& set) {
  std::string list;
  for (const dicom::Structure& s : set.structures)
    list += (list.empty() ? "number " : ", number ") + std::to_string(s.number) + " '" + s.name.substr(0, 64) + "' (" +
            std::to_string(s.contours.size()) + " contours)";
  return list.empty() ? "none" : list;
}

/// The number of a name "#2"; 0 where it is none.
int numberIn(const std::string& name) {
  int number = 0;
  if (name.size() < 2 || name.front() != '#') return 0;
  const auto [end, problem] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
  return problem == std::errc() && end == name.data() + name.size() ? number : 0;
}

const dicom::Structure& choose(const dicom::StructureSet& set, const std::string& name, int number, Diagnostics* said) {
  if (number == 0) number = numberIn(name);
  std::vector<const dicom::Structure*> fit;
  for (const dicom::Structure& s : set.structures)
    if (number != 0    ? s.number == number
        : name.empty() ? lowerCase(s.name).find("liver") != std::string::npos
                       : lowerCase(s.name) == lowerCase(name))
      fit.push_back(&s);
  if (number == 0 && name.empty() && fit.empty() && set.structures.size() == 1) fit.push_back(&set.structures.front());
  if (fit.size() > 1) {
    // What a template or a copy leaves behind.
    std::vector<const dicom::Structure*> drawn;
    std::copy_if(fit.begin(), fit.end(), std::back_inserter(drawn), [](const auto* s) { return !s->contours.empty(); });
    if (drawn.size() == 1 && said != nullptr)
      said->add(DiagnosticCode::EmptyTwins, {{"count", static_cast<std::int64_t>(fit.size() - 1)},
                                             {"number", static_cast<std::int64_t>(drawn.front()->number)}});
    if (drawn.size() == 1) fit = drawn;
  }
  if (fit.size() == 1) {
    if (said != nullptr && number == 0 && name.empty() && !organNames(fit.front()->name))
      said->add(DiagnosticCode::StructureByName,
                {{"kind", std::string("structure")},
                 {"number", static_cast<std::int64_t>(fit.front()->number)},
                 {"that", std::string(set.structures.size() == 1 ? "there" : "with 'liver' in its name")}});
    return *fit.front();
  }
  const std::string wanted = number != 0    ? "of number " + std::to_string(number)
                             : name.empty() ? std::string("with 'liver' in its name")
                                            : "called '" + name.substr(0, 64) + "'";
  throw BadInput("the structure set has " + std::to_string(fit.size()) + " structures " + wanted +
                 "; say which one to take, by its number (--label 2, or --name '#2') or a name that only one has. "
                 "There are: " +
                 names(set));
}

/// The series that the set says it was drawn on in a frame of reference (empty: in any); empty where it names several.
std::string seriesIn(const dicom::StructureSet& set, const std::string& frame) {
  std::string series;
  for (const dicom::ReferencedSeries& r : set.references) {
    if (r.seriesUid.empty() || (!frame.empty() && r.frameOfReferenceUid != frame)) continue;
    if (!series.empty() && series != r.seriesUid) return {};
    series = r.seriesUid;
  }
  return series;
}

/// Where the structure names no frame of reference of its own: the only one that the set names.
std::string onlyFrame(const dicom::StructureSet& set) {
  std::string frame;
  for (const dicom::ReferencedSeries& r : set.references) {
    if (!frame.empty() && frame != r.frameOfReferenceUid) return {};
    frame = r.frameOfReferenceUid;
  }
  return set.references.empty() ? set.frameOfReferenceUid : frame;
}

}  // namespace

bool organNames(const std::string& name) {
  static const std::set<std::string> plain = {
      "liver", "leber", "foie",   "higado",  "fegato",  "hepar",    "hepatic", "parenchyma",   "whole", "organ",
      "roi",   "voi",   "region", "contour", "outline", "mask",     "segment", "segmentation", "seg",   "lobe",
      "left",  "right", "inner",  "mre",     "mri",     "mr",       "ct",      "elastogram",   "auto",  "manual",
      "draft", "final", "reader", "slice",   "of",      "interest", "the",     "new",          "copy",  "corrected"};
  std::string word;
  for (const char c : lowerCase(name) + ' ') {
    if (c >= 'a' && c <= 'z') {
      word += c;
      continue;
    }
    if (static_cast<unsigned char>(c) >= 0x80) return false;  // a word in letters that the list does not know
    if (word.size() > 1 && !plain.contains(word)) return false;
    word.clear();
  }
  return true;
}

roi::ContourStack roiFromStructures(const dicom::StructureSet& structures, const std::string& name, int number,
                                    Diagnostics* said) {
  const dicom::Structure& structure = choose(structures, name, number, said);
  roi::ContourStack result;
  result.name = structure.name;
  result.frameOfReferenceUid =
      structure.frameOfReferenceUid.empty() ? onlyFrame(structures) : structure.frameOfReferenceUid;
  result.seriesUid =
      structures.references.empty() ? structures.referencedSeriesUid : seriesIn(structures, result.frameOfReferenceUid);
  std::int64_t twiceRound = 0;
  for (const dicom::StructureContour& contour : structure.contours) {
    roi::Polygon polygon;
    polygon.points_lps_mm = roi::distinctRing(contour.points_lps_mm);
    if (auto once = roi::onceRound(polygon.points_lps_mm)) {
      polygon.points_lps_mm = *std::move(once);
      ++twiceRound;
    }
    polygon.sopInstanceUid = contour.referencedSopInstanceUid;
    if (contour.exclusiveOr) polygon.combine = roi::Combine::Parity;
    if (polygon.points_lps_mm.cols() >= 3) result.polygons.push_back(std::move(polygon));
  }
  if (result.polygons.empty())
    throw BadInput("the structure '" + structure.name.substr(0, 64) +
                   "' has no contour with three distinct vertices (" + std::to_string(structure.contours.size()) +
                   " contours in all)");
  if (said != nullptr && twiceRound > 0)
    said->add(DiagnosticCode::OutlinesCrossThemselves, {{"count", twiceRound}, {"slices", twiceRound}});
  return result;
}

dicom::Structure toStructure(const roi::ContourStack& contours, int number) {
  dicom::Structure result;
  result.number = number;
  result.name = contours.name;
  for (const roi::Polygon& polygon : roi::withoutRepeats(contours).polygons)
    if (polygon.state != roi::PolygonState::Draft && !polygon.exclude)
      result.contours.push_back(
          {polygon.points_lps_mm, polygon.sopInstanceUid, polygon.combine == roi::Combine::Parity});
  return result;
}

}  // namespace glisson::elastography
