// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkActor.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "render/arrows.h"
#include "render/colour_map.h"
#include "render/detail/scene_fields.h"
#include "render/detail/stage.h"

namespace glisson::render {
namespace {

constexpr double grid_mm = 10.0;
constexpr double apart_mm = 3.0;  ///< vessels that lie this far apart have fully their own colour
constexpr Rgb restGrey{176, 184, 196}, steelGrey{205, 210, 216}, gridGreen{50, 170, 95};

Eigen::AlignedBox3d roundedOut(const Eigen::AlignedBox3d& box, double step) {
  return {Eigen::Vector3d((box.min().array() / step).floor() * step),
          Eigen::Vector3d((box.max().array() / step).ceil() * step)};
}

std::string inWords(double value, int decimals, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f %s", decimals, value, unit);
  return text;
}

Eigen::Vector3d still(const Eigen::Vector3d& p) {
  return p;
}

void cover(Eigen::AlignedBox3d& box, const anatomy::TriangleMesh& mesh) {
  for (Eigen::Index n = 0; n < mesh.vertices_lps_mm.cols(); ++n)
    box.extend(Eigen::Vector3d(mesh.vertices_lps_mm.col(n)));
}

/// Where the bar of a contact lies after a fraction of its way.
std::vector<Eigen::Vector3d> lineAfter(const RetractionScene& scene, const BarContact& contact, double t) {
  return movedLine(scene.bar->centreline_lps_mm, t * contact.travel_mm * scene.retractorDirection.normalized());
}

anatomy::TriangleMesh barAfter(const RetractionScene& scene, const BarContact& contact, double t) {
  return barMesh(lineAfter(scene, contact, t), 0.5 * scene.retractorDiameter_mm);
}

/// One picture in the making: what every kind of it needs.
class Picture3D {
 public:
  Picture3D(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options, SceneFields& fields)
      : scene_(scene),
        options_(options),
        fields_(fields),
        colour_(coloursOf(options.palette)),
        stage_(renderer, options) {}

  void draw() {
    switch (options_.shown) {
      case Shown3D::Answers: answers(); break;
      case Shown3D::HowSure: howSure(); break;
      case Shown3D::PressureMre:
      case Shown3D::PressureAtlas: pressure(); break;
    }
    if (!scene_.valid) stage_.drawNotValidMark();
  }

 private:
  void answers();
  void surfaces(const Motion& mre, const Motion& atlas);
  void tissueBar(const Motion& mre);
  void rigidBar();
  void pressure();
  void howSure();
  void finish(std::vector<LegendRow> legend);
  void ways();

  const RetractionScene& scene_;
  const SceneOptions3D& options_;
  SceneFields& fields_;
  SceneColours colour_;
  Stage stage_;
  Eigen::AlignedBox3d box_;
};

void Picture3D::answers() {
  const InverseMap &mre = fields_.mre(), &atlas = fields_.atlas();
  const auto moving = [](const InverseMap& map, double t) -> Motion {
    return [&map, t](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + t * map.at(p); };
  };
  // The frame of the picture is that of the whole motion, so that the steps of a film share one camera.
  for (const Motion& motion : {Motion(still), moving(mre, 1.0), moving(atlas, 1.0)})
    for (const anatomy::TriangleMesh* mesh : {&scene_.liverSurface, &scene_.vesselSurface})
      for (Eigen::Index n = 0; n < mesh->vertices_lps_mm.cols(); ++n) box_.extend(motion(mesh->vertices_lps_mm.col(n)));
  if (box_.isEmpty()) throw BadInput("the 3-D scene is empty: it has neither a liver surface nor vessels");

  const auto paint = [&](Rgb own) -> Paint {
    return [&, own](const Eigen::Vector3d& p) {
      if (!scene_.compared) return own;
      const double apart = options_.t * (mre.at(p) - atlas.at(p)).norm();
      return mixed(colour_.agree, own, std::clamp(apart / apart_mm, 0.0, 1.0));
    };
  };
  const Motion byMre = moving(mre, options_.t), byAtlas = moving(atlas, options_.t);
  if (scene_.vesselSurface.triangles.cols() > 0) {
    if (scene_.compared) stage_.add(solidSurface(scene_.vesselSurface, byAtlas, paint(colour_.atlas)));
    stage_.add(solidSurface(scene_.vesselSurface, byMre, paint(colour_.mre)));
  }
  if (scene_.bar)
    rigidBar();
  else if (scene_.retractorPoint_lps_mm)
    tissueBar(byMre);
  surfaces(byMre, byAtlas);
  std::vector<LegendRow> legend{{colour_.mre, scene_.stiffness + " stiffness"}};
  if (scene_.compared) {
    legend.push_back({colour_.atlas, "Atlas stiffness"});
    legend.push_back({colour_.agree, "agree"});
  }
  legend.push_back({Rgb{150, 158, 168}, "liver at rest"});
  if (scene_.bar)
    legend.push_back({steelGrey, scene_.bar->atlas ? "bar: " + scene_.stiffness + " steel, atlas glass" : "bar"});
  else if (scene_.retractorPoint_lps_mm)
    legend.push_back({steelGrey, "retractor"});
  finish(std::move(legend));
}

/// The liver at rest and moved, as glass. Where a rigid bar touches it, the surface on which contact was solved: it
/// does not pass through the bar.
void Picture3D::surfaces(const Motion& mre, const Motion& atlas) {
  const auto glass = [&](const anatomy::TriangleMesh& mesh, const Motion& motion, Rgb colour) {
    stage_.add(glassSurface(mesh, motion, colour, 0.02, 0.40));
  };
  const bool exact = scene_.bar && scene_.bar->surface.triangles.cols() > 0;
  const anatomy::TriangleMesh& rest = exact ? scene_.bar->surface : scene_.liverSurface;
  if (rest.triangles.cols() == 0) return;
  stage_.add(glassSurface(rest, still, restGrey, 0.05, 0.55));
  if (!(options_.t > 0.0)) return;
  if (!exact) {
    if (scene_.compared) glass(rest, atlas, colour_.atlas);
    glass(rest, mre, colour_.mre);
    return;
  }
  if (scene_.bar->atlas) glass(movedSurface(*scene_.bar, *scene_.bar->atlas, options_.t), still, colour_.atlas);
  glass(movedSurface(*scene_.bar, scene_.bar->mre, options_.t), still, colour_.mre);
}

/// A bar that is no body of its own goes with the tissue at its point.
void Picture3D::tissueBar(const Motion& mre) {
  const double diameter_mm = scene_.retractorDiameter_mm;
  const Eigen::Vector3d axis = scene_.retractorAxis.normalized(),
                        centre = mre(*scene_.retractorPoint_lps_mm) -
                                 0.5 * diameter_mm * scene_.retractorDirection.normalized();
  const Eigen::Vector3d half = std::max(0.01, 0.5 * (scene_.retractorLength_mm - diameter_mm)) * axis;
  if (options_.retractor) stage_.add(steel(barMesh({centre - half, centre + half}, 0.5 * diameter_mm)));
  for (const double end : {-0.5, 0.5}) box_.extend(Eigen::Vector3d(centre + end * scene_.retractorLength_mm * axis));
}

void Picture3D::rigidBar() {
  const RigidBar& bar = *scene_.bar;
  cover(box_, barAfter(scene_, bar.mre, 0.0));
  cover(box_, barAfter(scene_, bar.mre, 1.0));
  if (bar.atlas) cover(box_, barAfter(scene_, *bar.atlas, 1.0));
  if (!options_.retractor) return;
  if (options_.t > 0.0) stage_.add(glassSurface(barAfter(scene_, bar.mre, 0.0), still, restGrey, 0.08, 0.6));
  stage_.add(steel(barAfter(scene_, bar.mre, options_.t)));
  if (bar.atlas && options_.t > 0.0)
    stage_.add(glassSurface(barAfter(scene_, *bar.atlas, options_.t), still, colour_.atlas, 0.25, 0.95));
}

/// From first touch to the end, beside that end of the bar which is further from the middle of the liver; the way under
/// atlas stiffness further out.
void Picture3D::ways() {
  const RigidBar& bar = *scene_.bar;
  const std::vector<Eigen::Vector3d>& rest = bar.centreline_lps_mm;
  const Eigen::Vector3d middle = bar.surface.vertices_lps_mm.cols() > 0
                                     ? Eigen::Vector3d(bar.surface.vertices_lps_mm.rowwise().mean())
                                     : box_.center();
  const bool front = (rest.front() - middle).norm() > (rest.back() - middle).norm();
  const std::size_t end = front ? 0 : rest.size() - 1, inner = front ? 1 : rest.size() - 2;
  const Eigen::Vector3d outward = (rest[end] - rest[inner]).normalized();
  const auto beside = [&](double beyond_mm) -> Eigen::Vector3d {
    return rest[end] + (0.5 * scene_.retractorDiameter_mm + beyond_mm) * outward;
  };
  const auto way = [&](const BarContact& contact, Rgb colour, double beyond_mm, bool above) {
    const Eigen::Vector3d by = options_.t * contact.travel_mm * scene_.retractorDirection.normalized();
    stage_.drawWay(beside(beyond_mm), beside(beyond_mm) + by, colour);
    stage_.drawWords(beside(16.0) + 0.5 * by, outward, above, colour, inWords(options_.t * contact.travel_mm, 1, "mm"));
  };
  if (options_.shown != Shown3D::PressureAtlas) way(bar.mre, colour_.mre, 5.0, true);
  if (bar.atlas && options_.shown != Shown3D::PressureMre) way(*bar.atlas, colour_.atlas, 12.0, false);
}

void Picture3D::pressure() {
  const bool ofMre = options_.shown == Shown3D::PressureMre;
  if (!scene_.bar || (!ofMre && !scene_.bar->atlas))
    throw BadArgument("the scene has no rigid bar with that answer: there is no contact pressure to show");
  const BarContact& contact = ofMre ? scene_.bar->mre : *scene_.bar->atlas;
  const double scale_kPa = pressureScale_kPa(*scene_.bar);
  cover(box_, movedSurface(*scene_.bar, contact, 1.0));
  for (const double t : {0.0, 1.0}) cover(box_, barAfter(scene_, contact, t));
  stage_.add(colouredSurface(movedSurface(*scene_.bar, contact, options_.t), pressureColours(contact, scale_kPa)));
  if (options_.retractor) {
    stage_.add(glassSurface(barAfter(scene_, contact, 0.0), still, restGrey, 0.02, 0.35));
    stage_.add(glassSurface(barAfter(scene_, contact, options_.t), still, steelGrey, 0.10, 0.95));
  }
  const Rgb own = ofMre ? colour_.mre : colour_.atlas;
  std::vector<LegendRow> legend{
      {own, "way of the bar, " + (ofMre ? scene_.stiffness : std::string("atlas")) + " stiffness"},
      {pressureColour(0.9), "contact: " + inWords(contact.force_N, 1, "N along the hoist,")},
      {std::nullopt, inWords(contact.resultant_N, 1, "N in all, on ") + inWords(1e-2 * contact.area_mm2, 1, "cm²")},
      {pressureColour(0.0), "liver, retracted"},
      {steelGrey, "bar (see-through)"}};
  finish(std::move(legend));
  if (options_.decorate)
    stage_.drawScale({scale_kPa, largestPressure_kPa(*scene_.bar) > scale_kPa, "Pressure (kPa)", pressureColour});
}

/// The vessels where the first answer puts them, coloured by how far off they may be, within what holds them with 95 %.
void Picture3D::howSure() {
  if (!scene_.sure || scene_.sure->vessel95_mm.size() != scene_.vesselSurface.vertices_lps_mm.cols() ||
      scene_.sure->vessel95_mm.size() == 0)
    throw BadArgument("the scene does not say how sure its vessels are: there is nothing to show");
  const HowSure& sure = *scene_.sure;
  const image::ScalarVolume liver = asScalar(scene_.liver);
  const double reach_mm = 3.0 * liver.grid.spacing_mm.maxCoeff() + scene_.retractorDiameter_mm;
  const image::DisplacementField field = extended(scene_.u_mre_mm, liver, reach_mm);
  const InverseMap map(field, true);
  anatomy::TriangleMesh vessels = scene_.vesselSurface;
  std::vector<Rgb> colours;
  const double end_mm = placeScale_mm(sure);
  const ColourMap ramp = ColourMap::viridis();
  for (Eigen::Index n = 0; n < vessels.vertices_lps_mm.cols(); ++n) {
    const Eigen::Vector3d rest = vessels.vertices_lps_mm.col(n);
    vessels.vertices_lps_mm.col(n) = rest + options_.t * map.at(rest);
    colours.push_back(ramp.at(static_cast<double>(sure.vessel95_mm[n]) / end_mm));
  }
  stage_.add(colouredSurface(vessels, colours));
  cover(box_, vessels);
  if (sure.tube.triangles.cols() > 0 && options_.t == 1.0)
    stage_.add(glassSurface(sure.tube, still, colour_.mre, 0.10, 0.65));
  for (const anatomy::TriangleMesh* mesh : {&scene_.liverSurface, &sure.tube}) cover(box_, *mesh);
  const bool exact = scene_.bar && scene_.bar->surface.triangles.cols() > 0;
  if (exact) {
    const anatomy::TriangleMesh moved = movedSurface(*scene_.bar, scene_.bar->mre, options_.t);
    cover(box_, moved);
    stage_.add(glassSurface(moved, still, restGrey, 0.03, 0.45));
    const anatomy::TriangleMesh bar = barAfter(scene_, scene_.bar->mre, options_.t);
    cover(box_, bar);
    if (options_.retractor) stage_.add(steel(bar));
  }
  const auto words = [&](const char* text, std::initializer_list<std::string> values = {}) {
    return phrase(text, options_.language, values);
  };
  std::vector<LegendRow> legend{{ramp.at(0.5), words("vessels, @ stiffness", {scene_.stiffness})},
                                {colour_.mre, words("holds them with 95 %")},
                                {restGrey, words("liver, retracted")}};
  if (exact) legend.push_back({steelGrey, words("bar")});
  finish(std::move(legend));
  const bool beyond = static_cast<double>(sure.vessel95_mm.maxCoeff()) > end_mm;
  if (options_.decorate)
    stage_.drawScale({end_mm, beyond, words("95 % within (mm)"), [ramp](double fraction) { return ramp.at(fraction); },
                      options_.language});
}

void Picture3D::finish(std::vector<LegendRow> legend) {
  const bool sure = options_.shown == Shown3D::HowSure;
  const Language language = sure ? options_.language : Language::English;
  legend.push_back({gridGreen, phrase("grid 10 mm, labels in cm", language)});
  box_ =
      roundedOut({box_.min() - Eigen::Vector3d::Constant(4.0), box_.max() + Eigen::Vector3d::Constant(4.0)}, grid_mm);
  stage_.aim(box_, options_.decorate, legend);
  if (options_.arrows && options_.shown == Shown3D::Answers)
    stage_.drawArrows(displacementArrows(scene_, options_.arrows_mm, mostArrows), colour_, options_.t);
  if (scene_.bar && options_.retractor && options_.t > 0.0 && !sure) ways();
  if (!options_.decorate) return;
  stage_.drawGrid(box_);
  Stage::Words words{scene_.caption, scene_.mark, language};
  if (sure)
    words.caption =
        phrase("Where the vessels lie after the retraction, and how sure that is: all sources of uncertainty together.",
               language);
  stage_.drawText(words, std::move(legend), options_.t);
}

}  // namespace

void populate3D(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options) {
  SceneFields fields(scene);
  populate3D(renderer, scene, options, fields);
}

void populate3D(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options,
                SceneFields& fields) {
  if (!renderer) throw BadArgument("populate3D needs a renderer");
  if (!(options.t >= 0.0 && options.t <= 1.0)) throw BadArgument("the fraction of the displacement must lie in [0, 1]");
  renderer->RemoveAllViewProps();
  renderer->RemoveAllLights();
  renderer->SetBackground(0.055, 0.062, 0.075);
  renderer->SetBackground2(0.13, 0.145, 0.17);
  renderer->GradientBackgroundOn();
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.85);
  lights->AddLightsToRenderer(renderer);
  Picture3D(renderer, scene, options, fields).draw();
  renderer->ResetCameraClippingRange();
}

}  // namespace glisson::render
