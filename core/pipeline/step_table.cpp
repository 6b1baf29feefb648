// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/step_table.h"

#include <algorithm>
#include <array>

#include "pipeline/detail/step_estimates.h"
#include "pipeline/detail/step_works.h"

namespace glisson::pipeline::detail {

namespace {

namespace e = estimates;
namespace w = works;
using Id = StepId;

constexpr std::array<Step, stepCount> table{{
    // Reading is done before the first step: it says what the others are about.
    {.id = Id::ReadMri, .name = "read-mri", .estimate = e::readMri},
    {.id = Id::ReadRoi, .name = "read-roi", .estimate = e::readRoi},
    {.id = Id::ReadMre, .name = "read-mre", .estimate = e::readMre},
    {.id = Id::ReadMap, .name = "read-map", .estimate = e::readMap},
    {.id = Id::MeasureStiffness,
     .name = "measure-stiffness",
     .estimate = e::measureStiffness,
     .work = w::measureStiffness},
    {.id = Id::Mesh, .name = "mesh", .estimate = e::mesh, .work = w::mesh},
    {.id = Id::PlaceBar, .name = "place-bar", .estimate = e::placeBar, .work = w::placeBar},
    {.id = Id::Vessels, .name = "vessels", .estimate = e::vessels, .work = w::findVessels},
    // Parts of the solve.
    {.id = Id::Capsule, .name = "capsule", .estimate = e::capsule},
    {.id = Id::Ligaments, .name = "ligaments", .estimate = e::ligaments},
    {.id = Id::LoadsThatFollow, .name = "loads-that-follow", .estimate = e::loadsThatFollow},
    {.id = Id::AssembledStiffnessMatrix, .name = "assembled-stiffness-matrix", .estimate = e::assembledStiffnessMatrix},
    {.id = Id::MeshFreeFrames, .name = "mesh-free-frames", .estimate = e::meshFreeFrames},
    {.id = Id::MassMatrix, .name = "mass-matrix", .estimate = e::massMatrix},
    {.id = Id::Damping, .name = "damping", .estimate = e::damping},
    {.id = Id::LargeDeformation, .name = "large-deformation", .estimate = e::largeDeformation},
    {.id = Id::CondensedResponse, .name = "condensed-response", .estimate = e::condensedResponse},
    {.id = Id::Strain, .name = "strain", .estimate = e::strain},
    {.id = Id::CellDisplacements, .name = "cell-displacements", .estimate = e::cellDisplacements},
    // One of the two leads to the answer.
    {.id = Id::Solve, .name = "solve", .estimate = e::solve, .work = w::solve},
    {.id = Id::TimeSteps,
     .name = "time-steps",
     .estimate = e::timeSteps,
     .work = w::solve,
     .after = w::settleKinematics},
    {.id = Id::AtlasSolve,
     .name = "atlas-solve",
     .estimate = e::atlasSolve,
     .work = w::solveAtlas,
     .before = w::takeAtlasShortcuts,
     .after = w::tellOfAtlas},
    {.id = Id::DiscretisationError,
     .name = "discretisation-error",
     .estimate = e::discretisationError,
     .work = w::estimateDiscretisation,
     .before = w::leaveOutEstimate,
     .after = w::tellOfMissingPicture},
    {.id = Id::LinearSolve,
     .name = "linear-solve",
     .estimate = e::linearSolve,
     .work = w::solveInLinearTheory,
     .before = w::leaveOutLinearSolve,
     .after = w::tellOfContact},
    {.id = Id::LinearGap,
     .name = "linear-gap",
     .estimate = e::linearGap,
     .work = w::findLinearGap,
     .before = w::leaveOutLinearGap},
    {.id = Id::Difference,
     .name = "difference",
     .estimate = e::difference,
     .work = w::compare,
     .before = w::withholdDifference},
    {.id = Id::Uncertainty,
     .name = "uncertainty",
     .estimate = e::uncertainty,
     .work = w::spreadUncertainty,
     .before = w::leaveOutUncertainty,
     .after = w::tellOfSignificance},
    {.id = Id::LiverSurface, .name = "liver-surface", .estimate = e::liverSurface, .work = w::drawScene},
    {.id = Id::WriteDisplacementField,
     .name = "write-displacement-field",
     .estimate = e::writeDisplacementField,
     .work = w::writeDisplacements,
     .before = w::openFolder,
     .after = w::writeTables,
     .writes = true},
    {.id = Id::PictureData,
     .name = "picture-data",
     .estimate = e::pictureData,
     .work = w::writePictureData,
     .writes = true},
    {.id = Id::SliceOverlay,
     .name = "slice-overlay",
     .estimate = e::sliceOverlay,
     .work = w::writeSlices,
     .writes = true},
    {.id = Id::Overlay3D, .name = "3d-overlay", .estimate = e::overlay3D, .work = w::writeOverlays3D, .writes = true},
    {.id = Id::UncertaintyPictures,
     .name = "uncertainty-pictures",
     .estimate = e::uncertaintyPictures,
     .work = w::writeHowSure,
     .before = w::leaveOutHowSure,
     .writes = true},
    {.id = Id::Sofa, .name = "sofa", .estimate = e::sofa, .work = w::writeSofa, .writes = true},
    {.id = Id::Report, .name = "report", .estimate = e::report, .work = w::writeReport, .writes = true},
}};

constexpr bool holdsEveryIdOnce() {
  std::array<int, stepCount> times{};
  for (const Step& step : table) ++times[static_cast<std::size_t>(step.id)];
  for (const int n : times)
    if (n != 1) return false;
  return true;
}
static_assert(holdsEveryIdOnce());

}  // namespace

std::span<const Step> stepTable() {
  return table;
}

const char* nameOf(StepId id) {
  return std::find_if(table.begin(), table.end(), [id](const Step& step) { return step.id == id; })->name;
}

}  // namespace glisson::pipeline::detail
