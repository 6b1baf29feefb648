// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pipeline/detail/run_state.h"

/// What run() does for the steps of the table, and between them.
namespace glisson::pipeline::detail::works {

void measureStiffness(RunState& state, const Progress& progress);
void mesh(RunState& state, const Progress& progress);
void placeBar(RunState& state, const Progress& progress);
void findVessels(RunState& state, const Progress& progress);
void solve(RunState& state, const Progress& progress);
/// After the first answer: whether the kinematics that "auto" began with hold, and what the answer has to say.
void settleKinematics(RunState& state);
/// Before the second solve: where its answer follows from the first, that is taken.
void takeAtlasShortcuts(RunState& state);
void solveAtlas(RunState& state, const Progress& progress);
void tellOfAtlas(RunState& state);
void leaveOutEstimate(RunState& state);
void estimateDiscretisation(RunState& state, const Progress& progress);
/// Says why there is no picture, where it is the second answer's fault.
void tellOfMissingPicture(RunState& state);
void leaveOutLinearSolve(RunState& state);
void solveInLinearTheory(RunState& state, const Progress& progress);
void tellOfContact(RunState& state);
void leaveOutLinearGap(RunState& state);
void findLinearGap(RunState& state, const Progress& progress);
/// Before the comparison: no difference where one of the runs is no answer.
void withholdDifference(RunState& state);
void compare(RunState& state, const Progress& progress);
void leaveOutUncertainty(RunState& state);
void spreadUncertainty(RunState& state, const Progress& progress);
void tellOfSignificance(RunState& state);
void drawScene(RunState& state, const Progress& progress);

/// Takes the folder, and what makes a former run's results look whole out of it.
void openFolder(RunState& state);
void writeDisplacements(RunState& state, const Progress& progress);
/// Tables that are no step of their own.
void writeTables(RunState& state);
void writePictureData(RunState& state, const Progress& progress);
void writeSlices(RunState& state, const Progress& progress);
void writeOverlays3D(RunState& state, const Progress& progress);
void leaveOutHowSure(RunState& state);
void writeHowSure(RunState& state, const Progress& progress);
void writeSofa(RunState& state, const Progress& progress);
void writeReport(RunState& state, const Progress& progress);

}  // namespace glisson::pipeline::detail::works
