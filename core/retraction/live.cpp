// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/live.h"

#include <future>

#include "base/error.h"
#include "retraction/live_condensed.h"
#include "retraction/live_contact.h"
#include "retraction/rigid_contact.h"

namespace glisson::retraction {

LiveKind liveKindOf(const Setup& setup) {
  return rigidBarOf(setup) ? LiveKind::Contact : LiveKind::Condensed;
}

LiveLivers makeLive(const Model& model, const Model* atlas, const Setup& setup,
                    const std::vector<Eigen::Vector3d>& points_mm, LiveKind kind, const Progress& progress) {
  LiveLivers livers;
  livers.kind = kind;
  if (kind == LiveKind::Condensed) {
    livers.mre = std::make_unique<CondensedRetraction>(model, setup, points_mm, false, progress.part(0.0, 0.5));
    if (atlas)
      livers.atlas = std::make_unique<CondensedRetraction>(*atlas, setup, points_mm, false, progress.part(0.5, 1.0));
    return livers;
  }
  std::optional<Retractor> bar = rigidBarOf(setup);
  if (!bar) throw BadInput("a liver that follows a rigid bar needs a retractor with rigid contact in the scene");
  if (!bar->at_mm || !bar->axis) bar = placeBar(model, atlas, setup, progress.part(0.0, 0.5)).bar;
  livers.mre = std::make_unique<ContactRetraction>(model, setup, *bar, points_mm, progress.part(0.5, 0.75));
  if (atlas)
    livers.atlas = std::make_unique<ContactRetraction>(*atlas, setup, *bar, points_mm, progress.part(0.75, 1.0));
  return livers;
}

LiveAnswers followBoth(const LiveLivers& livers, const LiveTarget& mre, const LiveTarget& atlas) {
  LiveAnswers answers;
  std::future<LiveAnswer> other;
  if (livers.atlas) {
    const auto policy = livers.kind == LiveKind::Contact ? std::launch::async : std::launch::deferred;
    other = std::async(policy, [&] { return livers.atlas->follow(atlas); });
  }
  answers.mre = livers.mre->follow(mre);
  if (livers.atlas) answers.atlas = other.get();
  return answers;
}

LiveAnswers followScene(const LiveLivers& livers, int frames, const Progress& progress) {
  const LiveTarget mre = livers.mre->sceneTarget(), atlas = livers.atlas ? livers.atlas->sceneTarget() : mre;
  LiveAnswers now;
  for (int frame = 0; frame < frames; ++frame) {
    progress.check();
    now = followBoth(livers, mre, atlas);
    if (now.mre.atRest && now.atlas.atRest) break;
  }
  return now;
}

}  // namespace glisson::retraction
