// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <future>

#include "base/error.h"
#include "retraction/pose.h"
#include "retraction/rigid_contact.h"
#include "retraction/smooth_body.h"

namespace glisson::retraction {

namespace {

constexpr double proof = 1.1;  ///< of the force

/// The share of the force (or travel) asked for that a bar bears there on the path's cells, `proof` at most.
double borne(const Model& model, const Setup& setup, const Retractor& bar, const Progress& progress) {
  const Body body(model);
  const ContactScene contact = contactScene(body, model, setup, toMechanics(body, model, setup), bar);
  mechanics::ContactOptions options;
  options.pathOnly = true;
  options.proof = proof;
  options.tolerance = 1e-2;
  const mechanics::ContactSolution s = mechanics::solveContact(contact.problem, options, progress);
  if (s.outcome == mechanics::ContactOutcome::Reached) return proof;
  const double asked = contact.problem.force_N ? proof * *contact.problem.force_N : 0;
  const double share = asked > 0 ? s.capacity_N / asked : s.travel_m / *contact.problem.travel_m;
  return proof * std::min(share, 1.0);
}

}  // namespace

PlacedBar placeBar(const Model& model, const Model* other, const Setup& setup, const Progress& progress) {
  std::optional<Retractor> bar = rigidBarOf(setup);
  if (!bar) throw BadArgument("placeBar: the scene has no rigid retractor");
  PlacedBar placed;
  if (!model.smooth) {
    if (!bar->at_mm) throw BadInput("the retractor on a box needs its place: give \"at\" as a point");
    findContact(Body(model), *bar, *bar->at_mm);  // refuses a point that is not on a surface looking against the hoist
    placed.bar = *bar;
    placed.bar.axis = bar->patchAxis();
    return placed;
  }
  const mechanics::TriangleSurface& surface = model.smooth->surface();
  const auto at = [&](const Pose& pose) {
    Retractor r = *bar;
    r.at_mm = pose.centre_mm;
    r.axis = pose.axis;
    return r;
  };
  if (bar->at_mm) {
    placed.pose = poseAt(surface, *bar, *bar->at_mm);
    placed.bar = at(*placed.pose);
    return placed;
  }
  constexpr std::size_t most = 6;  // places tried
  const std::vector<Pose> candidates = poseCandidates(*model.smooth, surface, *bar);
  double best = -1;
  for (std::size_t i = 0; i < std::min(most, candidates.size()); ++i) {
    const Retractor r = at(candidates[i]);
    std::future<double> second;
    if (other) second = std::async(std::launch::async, [&] { return borne(*other, setup, r, progress); });
    double least = borne(model, setup, r, progress);
    if (other) least = std::min(least, second.get());
    placed.tried.push_back({candidates[i].height_mm, least});
    if (least > best) {
      best = least;
      placed.pose = candidates[i];
      placed.bar = r;
    }
    if (best >= proof) break;
  }
  placed.bears = best >= 1;
  return placed;
}

}  // namespace glisson::retraction
