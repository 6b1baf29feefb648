#include "elastography/roi_from_structures.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "roi/polygon.h"

namespace glisson::elastography {
namespace {

std::string names(const dicom::StructureSet& set) {
  std::string list;
  for (const dicom::Structure& s : set.structures) list += (list.empty() ? "'" : ", '") + s.name.substr(0, 64) + "'";
  return list.empty() ? "none" : list;
}

const dicom::Structure& choose(const dicom::StructureSet& set, const std::string& name) {
  std::vector<const dicom::Structure*> fit;
  for (const dicom::Structure& s : set.structures)
    if (name.empty() ? lowerCase(s.name).find("liver") != std::string::npos : lowerCase(s.name) == lowerCase(name))
      fit.push_back(&s);
  if (name.empty() && fit.empty() && set.structures.size() == 1) fit.push_back(&set.structures.front());
  if (fit.size() == 1) return *fit.front();
  const std::string wanted = name.empty() ? "with 'liver' in its name" : "called '" + name.substr(0, 64) + "'";
  throw BadInput("the structure set has " + std::to_string(fit.size()) + " structures " + wanted +
                 "; say which one to take. There are: " + names(set));
}

}  // namespace

roi::ContourStack roiFromStructures(const dicom::StructureSet& structures, const std::string& name) {
  const dicom::Structure& structure = choose(structures, name);
  roi::ContourStack result;
  result.name = structure.name;
  result.frameOfReferenceUid = structures.frameOfReferenceUid;
  result.seriesUid = structures.referencedSeriesUid;
  for (const dicom::StructureContour& contour : structure.contours) {
    roi::Polygon polygon;
    polygon.points_lps_mm = roi::distinctRing(contour.points_lps_mm);
    polygon.sopInstanceUid = contour.referencedSopInstanceUid;
    if (polygon.points_lps_mm.cols() >= 3) result.polygons.push_back(std::move(polygon));
  }
  if (result.polygons.empty())
    throw BadInput("the structure '" + structure.name.substr(0, 64) +
                   "' has no contour with three distinct vertices (" + std::to_string(structure.contours.size()) +
                   " contours in all)");
  return result;
}

dicom::Structure toStructure(const roi::ContourStack& contours, int number) {
  dicom::Structure result;
  result.number = number;
  result.name = contours.name;
  for (const roi::Polygon& polygon : contours.polygons)
    if (polygon.state != roi::PolygonState::Draft && !polygon.exclude)
      result.contours.push_back({polygon.points_lps_mm, polygon.sopInstanceUid});
  return result;
}

}  // namespace glisson::elastography
