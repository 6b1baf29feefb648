// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>

#include "render/overlay.h"
#include "render/sampling.h"

namespace glisson::render {

/// Both displacements of a scene carried on a little beyond the liver, so that its vessels and surface can be moved:
/// made when first asked for, and once for all pictures of the scene. The scene outlives it.
class SceneFields {
 public:
  explicit SceneFields(const RetractionScene& scene) : scene_(scene) {}
  SceneFields(const SceneFields&) = delete;
  SceneFields& operator=(const SceneFields&) = delete;

  const InverseMap& mre() { return of(mre_, scene_.u_mre_mm); }
  /// Without a comparison both are one.
  const InverseMap& atlas() { return scene_.compared ? of(atlas_, scene_.u_atlas_mm) : mre(); }

 private:
  struct Field {
    image::DisplacementField u_mm;
    InverseMap map{u_mm, true};
    explicit Field(image::DisplacementField u) : u_mm(std::move(u)) {}
  };
  const InverseMap& of(std::optional<Field>& field, const image::DisplacementField& u_mm) {
    if (!field) {
      const image::ScalarVolume liver = asScalar(scene_.liver);
      field.emplace(extended(u_mm, liver, 3.0 * liver.grid.spacing_mm.maxCoeff() + scene_.retractorDiameter_mm));
    }
    return field->map;
  }

  const RetractionScene& scene_;
  std::optional<Field> mre_, atlas_;
};

/// populate3D, with the fields made before.
void populate3D(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options,
                SceneFields& fields);

}  // namespace glisson::render
