// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "retraction/live.h"

namespace glisson::live {

/// What is served, where, and how often.
struct ServerOptions {
  int port = 18944;                ///< OpenIGTLink's own; 0 = any free one
  std::string bind = "127.0.0.1";  ///< address to listen on: this computer alone; "0.0.0.0" for every network
  double rate_hz = 60.0;           ///< messages a second while the tool rests; a new pose is answered at once
  std::size_t landmarks = 200;     ///< sent at most, spread evenly over those there are
  bool ras = true;                 ///< coordinates of all messages: RAS as 3D Slicer expects, else LPS; always mm
  long frames = 0;                 ///< ends after so many; 0 = until cancelled
};

/// What was measured while serving.
struct ServerStatistics {
  long frames = 0;            ///< sent, or rehearsed
  long poses = 0;             ///< received
  double rate_hz = 0.0;       ///< frames over the time that a client was connected, or that they took
  double evaluate_us = 0.0;   ///< mean time of one answer for both stiffnesses, side by side
  double remaining_mm = 0.0;  ///< of the solver: largest estimated distance of a frame from equilibrium on these cells
  long slipping = 0;          ///< frames in which a liver did not bear the force asked for
  long cutting = 0;           ///< frames in which a bar cut into a liver
  retraction::LiveAnswers last;
  double latency_ms = 0.0, latency_max_ms = 0.0;  ///< from a whole pose read to its answer handed to the network
};

/// Serves one OpenIGTLink client after another (header version 1):
///   receives  TRANSFORM "Retractor"       pose of the tool; its translation is where the contact's centre is taken
///   sends     POINT "LandmarksMRE"        landmarks with the measured stiffness
///             POINT "LandmarksAtlas"      the same with the textbook stiffness (where atlas is given)
///             TRANSFORM "RetractorReached" where the tool is, as it was taken
///             STRING "RetractorState"     where a bar slips: "slips: MRE", "slips: atlas" or "slips: MRE, atlas" (the
///             liver
///                                         does not bear the force asked for, and the bar stays where it slipped), or
///                                         cuts into the liver: "cuts: MRE" and so on ("slips: MRE; cuts: atlas" for
///                                         one of each); "holds" once when that is over. Frames of bars that hold carry
///                                         none.
///             STRING "RetractorForce"     "x y z" in N that the tool pulls with (measured stiffness); ends a frame
/// Until a pose arrives the scene's own drive acts, its force or its travel; a pose takes both livers to the same place
/// of the tool. Under contact a liver that is not there yet goes on with every frame. A pose more than 100 mm from the
/// contact's rest, or not finite, is ignored; a message whose body has another size than its type asks for ends the
/// connection. Carries no identity of the patient; the protocol knows no password, so beyond this computer use it on a
/// network of one's own. landmarks_mm: at rest, LPS, as both livers watch them. listening: called with the port once it
/// can be connected to. Throws BadInput where the address or the port cannot be opened.
ServerStatistics serve(const retraction::LiveLivers& livers, const std::vector<Eigen::Vector3d>& landmarks_mm,
                       const ServerOptions& options, const std::function<void(int)>& listening = {},
                       const Progress& progress = {});

/// The same frames without a network, one after another as fast as they come: from where the livers are towards what
/// the scene asks of the tool, and on at rest there. No poses, no latency.
ServerStatistics rehearse(const retraction::LiveLivers& livers, long frames, const Progress& progress = {});

}  // namespace glisson::live
