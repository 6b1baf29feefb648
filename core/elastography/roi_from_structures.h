#pragma once

#include <string>

#include "dicom/rtstruct.h"
#include "roi/contour_stack.h"

namespace glisson::elastography {

/// The structure to take: the one called name (case does not matter) where a name is given; otherwise the only one
/// whose name holds "liver" (any case), or the only structure there is. Every contour becomes an accepted polygon;
/// repeated neighbours and a repeated last vertex are left out, contours with fewer than three distinct vertices are
/// skipped. Throws BadInput listing the names where none or several fit, or where the structure has no usable contour.
roi::ContourStack roiFromStructures(const dicom::StructureSet& structures, const std::string& name = {});

/// The reverse, for writing: polygons that count, drafts left out, holes as contours of their own (even-odd).
dicom::Structure toStructure(const roi::ContourStack& contours, int number);

}  // namespace glisson::elastography
