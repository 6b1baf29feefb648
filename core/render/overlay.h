// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "base/language.h"
#include "image/volume.h"
#include "render/backend.h"
#include "render/how_sure.h"
#include "render/picture.h"
#include "render/rigid_bar.h"

class vtkRenderer;  // shown by pointer only: no VTK header here

namespace glisson::render {

/// Channel colours. RedBlue is the paper's (MRE blue, atlas red, purple where they agree); ColourBlind is orange/blue,
/// white where they agree.
enum class Palette { RedBlue, ColourBlind };

/// Everything that the overlays of one retraction draw. Displacements live at rest positions (see DisplacementField),
/// on grids that cover the liver; zero outside it.
struct RetractionScene {
  image::ScalarVolume mri;  ///< the anatomical image at rest
  image::Mask liver;        ///< on the MRI grid or another
  image::DisplacementField u_mre_mm;
  image::DisplacementField u_atlas_mm;
  anatomy::TriangleMesh liverSurface;                              ///< at rest
  anatomy::TriangleMesh vesselSurface;                             ///< at rest; may be empty
  std::optional<Eigen::Vector3d> retractorPoint_lps_mm;            ///< centre of the contact at rest
  Eigen::Vector3d retractorAxis = Eigen::Vector3d::UnitX();        ///< along the bar, LPS
  Eigen::Vector3d retractorDirection = -Eigen::Vector3d::UnitY();  ///< of the hoist, LPS
  /// A bar that is a body of its own, drawn where it ends under either stiffness; empty: the bar goes with the tissue
  /// at its point.
  std::optional<RigidBar> bar;
  std::optional<HowSure> sure;  ///< where it was asked for and is known
  double retractorDiameter_mm = 10.0;
  double retractorLength_mm = 80.0;
  double clinicallySignificant_mm = 5.0;
  /// False: there is one answer only, and u_atlas_mm repeats it. What is drawn then tells of that answer alone.
  bool compared = true;
  std::string stiffness = "MRE";  ///< what the first answer's stiffness is called in legends
  std::string caption;            ///< method line under the picture; holds no patient text
  std::string mark;   ///< a reservation in words ("outside linear theory: ..."), shown in orange; may be empty
  bool valid = true;  ///< false: a "not converged / outside validity" mark is drawn across
};

/// Arrows that one picture shows at most.
inline constexpr int mostArrows = 400;

/// What an overlay of one slice shows.
struct SliceOverlayOptions {
  int slice = -1;  ///< k of the MRI grid; −1 = the slice with the largest MRE-atlas difference inside the liver
  Palette palette = Palette::RedBlue;
  int pixelsPerVoxel = 4;
  double grid_mm = 10.0;  ///< spacing of the green grid
  bool decorate = true;   ///< scale bar, legend, orientation letters, research-use line, caption
  bool outlines = true;   ///< of the moved liver and vessels, in each channel
  std::optional<Eigen::Vector3d> zoomCentre_lps_mm{};  ///< draw an inset magnified around this point
  double zoom_mm = 40.0;
  bool zoomBelow = false;  ///< the inset under the slice instead of beside it: for a place higher than wide
  std::optional<Eigen::Vector3d> ring_lps_mm{};  ///< a place to mark, as it is seen in this picture
  bool arrows = false;      ///< displacement of both answers, true to scale, with a reference of 10 mm
  double arrows_mm = 12.0;  ///< between arrows; wider apart where there would be more than mostArrows
  std::optional<double>
      margin_mm{};  ///< cut the picture to the liver (at rest and moved) plus this margin; unset: all of it
};

/// The paper's overlay of one slice: the MRI warped by each displacement field into its channel, MRE in blue, atlas in
/// red, purple where they agree, a green millimetre grid, the outline of the liver and of the vessels in each channel.
/// Shown in radiological convention (patient's right on the left, anterior up) with square millimetres, whatever the
/// grid. Inside the warped liver a channel holds the windowed MRI; tissue around it is not simulated and is shown at
/// rest, dimmed; what the liver has left is black. In RedBlue, red = atlas, blue = MRE, green = the grid alone; in
/// ColourBlind the red byte is the atlas, the blue byte MRE away from the grid. Needs no display; safe from any thread.
/// Throws BadInput where a grid is not usable, BadArgument where an option is out of range.
Picture sliceOverlay(const RetractionScene& scene, const SliceOverlayOptions& options = {});

/// Several slices of one scene: what they share is made once; each picture is the one that sliceOverlay gives.
std::vector<Picture> sliceOverlays(const RetractionScene& scene, const std::vector<SliceOverlayOptions>& options);

/// Slice index with the largest difference between the two fields inside the liver; of one answer with its largest
/// displacement.
int sliceOfLargestDifference(const RetractionScene& scene);

/// Pixels of an overlay by what they show.
struct CountedPixels {
  std::size_t redOnly = 0, blueOnly = 0, both = 0;
};
/// Counts pixels of an undecorated overlay whose red and blue differ by more than threshold (0..255), or agree and are
/// not black (either above threshold). A pixel on the green grid counts by its red and blue like any other.
CountedPixels countChannels(const Picture& overlay, int threshold = 24);

/// MRI value at each voxel of target after the material has moved by u (u at rest positions): fixed-point inverse of
/// x + u(x). image and u may have different grids. Where the inverse does not converge the nearest iterate is taken.
image::ScalarVolume warp(const image::ScalarVolume& image, const image::DisplacementField& u_mm,
                         const image::Grid& target);

/// Camera presets for 3-D views; directions from which the eye looks.
enum class View3D { Anterior, Inferior, Oblique, Posterior, Left, Right, Superior };

/// Any other camera: azimuth 0 is anterior and grows towards the patient's left, elevation 90 is superior, degrees.
struct Camera3D {
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
};

/// What of a retraction a 3-D picture shows: liver and vessels of both answers, the contact pressure of a rigid bar on
/// the surface of one, or the vessels of the first answer with what they may be off by.
enum class Shown3D { Answers, PressureMre, PressureAtlas, HowSure };

/// From behind and below, a little from the right: where a bar that hoists towards anterior touches the liver.
inline constexpr Camera3D barCamera{205.0, -28.0};

/// What a 3-D picture shows, and from where.
struct SceneOptions3D {
  Shown3D shown = Shown3D::Answers;       ///< BadArgument where the scene has no rigid bar with that answer, no HowSure
  Language language = Language::English;  ///< of HowSure
  Palette palette = Palette::RedBlue;
  View3D view = View3D::Oblique;
  std::optional<Camera3D> camera{};  ///< instead of view
  int width = 1600;
  int height = 1200;
  double t = 1.0;  ///< fraction of the displacement shown, 0 = rest
  bool decorate = true;
  bool retractor = true;    ///< the bar; false where the caller draws one that moves
  bool arrows = false;      ///< displacement of both answers times t, true to scale
  double arrows_mm = 18.0;  ///< between arrows; wider apart where there would be more than mostArrows
};

/// Fills a renderer (on screen or off) with the 3-D overlay: liver at rest (faint), vessels deformed by MRE (blue) and
/// by atlas (red), retractor bar, millimetre grid, scale, legend, research-use line. A rigid bar is shown where it
/// first touches and where it ends under either stiffness, with the way between and its length. Or the deformed liver
/// with the contact pressure on it and its scale in kPa. Clears what was in it.
void populate3D(vtkRenderer* renderer, const RetractionScene& scene, const SceneOptions3D& options = {});

/// VTK draws the text of all its windows with one renderer that is not safe from several threads: hold this while a
/// window with text is rendered. overlay3D holds it for as long as it draws.
std::mutex& textDrawing();

/// The same scene, drawn off screen. Throws RenderUnavailable where neither EGL nor a display can be had.
Picture overlay3D(const RetractionScene& scene, const SceneOptions3D& options = {});

}  // namespace glisson::render
