// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "pipeline/run.h"

namespace glisson::pipeline::detail {

// What is said of answers, as pipeline::toldOf says it of scenes. Facts with codes first; sentences are made from them.

/// Why these kinematics were used.
std::string whyKinematics(const Scene& scene, const retraction::Result& result);

/// No place that was tried bears the force.
void tellOfPlaces(RunResult& result);
/// Bars that slip or get no further, each once, and what the figures of contact depend on.
void tellOfContact(const Scene& scene, RunResult& result);
/// What the second stiffness has to say, but slips.
void tellOfAtlas(RunResult& result);

/// Whether a result may be compared: converged and a deformation of the body. Of a linear answer, which is one beyond
/// its limits too and carries its reservations, it is asked only that no cell under a rigid bar is turned inside out as
/// a whole.
bool isAnswer(const retraction::Result& result);
/// Why two runs of which one is no answer have no difference.
void withhold(RunResult& result);

/// Says so where the cells leave open on which side of the clinical line the difference at the retractor lies (an
/// interval of what is uncertain speaks for itself).
void tellOfSignificance(RunResult& result);

/// Where the cells may be off by over a millimetre and a fifth of the displacement.
void tellOfDiscretisation(RunResult& result);

/// Where linear theory was used outside its limits: which kinematics to choose and what that changes, and what to
/// change before where the scene does not offer them. Else empty.
std::string adviceOn(const Scene& scene, const retraction::Result& result);
/// The same of a run: of its own stiffness, or else of the atlas.
std::string adviceOn(const Scene& scene, const RunResult& result);

}  // namespace glisson::pipeline::detail
