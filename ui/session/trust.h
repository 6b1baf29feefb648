// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <optional>
#include <vector>

#include "pipeline/run.h"
#include "session/parameters.h"

namespace glisson::session {

/// What the window can change by itself about a doubt, before it runs again.
enum class Remedy {
  None,
  LargeDeformation,  ///< hyperelastic kinematics, on voxel hexahedra at rest
  SmallerCells,      ///< of half the edge
  BorneForce,        ///< nine tenths of what both livers bore
  FoundPlace         ///< a bar laid by hand goes where the program finds a place
};

/// Something that is said against a run, or about it.
struct Doubt {
  Severity severity = Severity::Note;
  QString text;    ///< a sentence in the reader's language; of one answer only: with its name
  QString advice;  ///< what to do about it, in the words of the window; empty where nothing is to be done
  Remedy remedy = Remedy::None;
};

/// Everything that is said about both answers of a run and about their comparison, each reason once, errors first.
std::vector<Doubt> doubtsAbout(const pipeline::RunResult& result);

/// The parameters with the remedy; empty where it does not help this run or is not offered.
std::optional<Parameters> remedied(Remedy remedy, const Parameters& parameters, const pipeline::RunResult& result);

/// Whether a difference of two answers was asked for and withheld, or the only answer is none.
bool isNoAnswer(const pipeline::RunResult& result);

}  // namespace glisson::session
