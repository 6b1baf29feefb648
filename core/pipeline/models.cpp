// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/models.h"

#include "anatomy/vessels.h"
#include "base/error.h"
#include "pipeline/detail/build_model.h"

namespace glisson::pipeline {

Models buildModels(const Scene& scene, bool vessels, const Progress& progress, const Inputs* given) {
  Models m;
  Inputs loaded;
  const bool files = scene.geometry.kind != GeometrySpec::Kind::Box || scene.material.kind == MaterialSpec::Kind::Map;
  if (!given && files) loaded = loadInputs(scene, progress.part(0.0, 0.3));
  const Inputs& inputs = given ? *given : loaded;
  m.warnings = inputs.warnings;
  progress.report(0.3, "mesh");
  const image::Mask cells = detail::dropLooseIslands(scene, detail::bodyCells(scene, inputs), m.warnings);
  m.model = detail::buildModel(scene, inputs, cells);
  m.model.smooth = detail::smoothBody(scene, inputs);
  if (scene.compare) {
    m.atlas = detail::buildAtlasModel(scene, cells);
    m.atlas->smooth = m.model.smooth;
  }
  if (vessels && inputs.mri && inputs.liver) {
    const anatomy::VesselModel found = anatomy::findVessels(*inputs.mri, *inputs.liver, progress.part(0.4, 1.0));
    m.landmarks_mm = found.centreline_lps_mm;
    m.landmarkEdges = found.edges;
  }
  progress.report(1.0, "models");
  return m;
}

const std::vector<Eigen::Vector3d>& followedPoints(const Scene& scene, const Models& models) {
  const std::vector<Eigen::Vector3d>& points =
      models.landmarks_mm.empty() ? scene.outputs.probes_mm : models.landmarks_mm;
  if (points.empty())
    throw BadInput(
        "nothing to follow: the scene has neither vessels (a patient's MRI) nor probes; add {\"probe\": ...}");
  return points;
}

}  // namespace glisson::pipeline
