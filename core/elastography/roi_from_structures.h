// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/diagnostic.h"
#include "dicom/rtstruct.h"
#include "roi/contour_stack.h"

namespace glisson::elastography {

/// The structure to take: the one of that number where one is given (not 0); else the one called name (case does not
/// matter; "#2" is a number too) where a name is given; otherwise the only one whose name holds "liver" (any case), or
/// the only structure there is. Of several that fit, the only one with contours. Every contour becomes an accepted
/// polygon; repeated neighbours and a repeated last vertex are left out, contours with fewer than three distinct
/// vertices are skipped. Frame of reference and series are the structure's own, else those of the only ones that the
/// set names. said: what is to be told (null: nobody). Throws BadInput listing numbers and names where none or several
/// fit, or where the structure has no usable contour.
roi::ContourStack roiFromStructures(const dicom::StructureSet& structures, const std::string& name = {}, int number = 0,
                                    Diagnostics* said = nullptr);

/// Whether a name says no more than that this is the liver, or a region of interest: words such as "liver", "ROI 1",
/// "liver left lobe" and their kin; not "GTV liver", "body minus liver" or "spleen".
bool organNames(const std::string& name);

/// The reverse, for writing: polygons that count, drafts and repeated ones left out, holes as contours of their own.
dicom::Structure toStructure(const roi::ContourStack& contours, int number);

}  // namespace glisson::elastography
