// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pipeline/detail/step_table.h"

/// What each step of the table is expected to take, and why it is needed or left out.
namespace glisson::pipeline::detail::estimates {

Estimate readMri(const Forecast& forecast);
Estimate readRoi(const Forecast& forecast);
Estimate readMre(const Forecast& forecast);
Estimate measureStiffness(const Forecast& forecast);
Estimate readMap(const Forecast& forecast);
Estimate vessels(const Forecast& forecast);
Estimate liverSurface(const Forecast& forecast);
Estimate mesh(const Forecast& forecast);
Estimate placeBar(const Forecast& forecast);
Estimate capsule(const Forecast& forecast);
Estimate ligaments(const Forecast& forecast);
Estimate loadsThatFollow(const Forecast& forecast);
Estimate assembledStiffnessMatrix(const Forecast& forecast);
Estimate meshFreeFrames(const Forecast& forecast);
Estimate massMatrix(const Forecast& forecast);
Estimate damping(const Forecast& forecast);
Estimate solve(const Forecast& forecast);
Estimate timeSteps(const Forecast& forecast);
Estimate largeDeformation(const Forecast& forecast);
Estimate linearSolve(const Forecast& forecast);
Estimate condensedResponse(const Forecast& forecast);
Estimate atlasSolve(const Forecast& forecast);
Estimate discretisationError(const Forecast& forecast);
Estimate difference(const Forecast& forecast);
Estimate uncertainty(const Forecast& forecast);
Estimate linearGap(const Forecast& forecast);
Estimate strain(const Forecast& forecast);
Estimate cellDisplacements(const Forecast& forecast);
Estimate writeDisplacementField(const Forecast& forecast);
Estimate pictureData(const Forecast& forecast);
Estimate sliceOverlay(const Forecast& forecast);
Estimate overlay3D(const Forecast& forecast);
Estimate uncertaintyPictures(const Forecast& forecast);
Estimate report(const Forecast& forecast);
Estimate sofa(const Forecast& forecast);

}  // namespace glisson::pipeline::detail::estimates
