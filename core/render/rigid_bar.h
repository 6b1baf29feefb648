// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "render/painter.h"

namespace glisson::render {

/// What a rigid bar and the liver do to each other under one stiffness, at the end.
struct BarContact {
  double travel_mm = 0.0;    ///< of the bar from its first touch, along the hoist
  double force_N = 0.0;      ///< of the bar on the liver, along the hoist
  double resultant_N = 0.0;  ///< the size of all of it
  double area_mm2 = 0.0;     ///< of the surface that touches
  /// Largest force met on the way, and whether it fell beyond it; slipped: it fell below what was asked for.
  double capacity_N = 0.0;
  bool capacityExceeded = false, slipped = false;
  std::vector<std::array<double, 2>> path;  ///< travel mm, force N, on the coarse cells of the way
  Eigen::Matrix3Xf u_mm;                    ///< displacement of the vertices of RigidBar::surface, LPS
  Eigen::VectorXf pressure_kPa;             ///< on them; 0 where nothing touches
};

/// A rigid bar and the surface that it touches.
struct RigidBar {
  std::vector<Eigen::Vector3d> centreline_lps_mm;  ///< of the bar at first touch
  double asked_N = 0.0;                            ///< force that was asked for; 0: a travel was
  anatomy::TriangleMesh surface;                   ///< on which contact was solved, at rest
  BarContact mre;
  std::optional<BarContact> atlas;
};

/// The surface after a fraction t of the displacement, 0..1.
anatomy::TriangleMesh movedSurface(const RigidBar& bar, const BarContact& contact, double t);

/// The centre line, further along.
std::vector<Eigen::Vector3d> movedLine(const std::vector<Eigen::Vector3d>& line, const Eigen::Vector3d& by);

/// A round bar along a centre line, with round ends, outward oriented. The line has at least two points, none twice in
/// a row; throws BadArgument otherwise.
anatomy::TriangleMesh barMesh(const std::vector<Eigen::Vector3d>& centreline, double radius);

/// End of the colour scale of both contacts: the pressure that 98 % of what touches stays below, rounded up to 1, 2, 3,
/// 4, 6 or 8 times a power of ten. 1 kPa where nothing touches.
double pressureScale_kPa(const RigidBar& bar);
/// The largest pressure of both contacts, 0 where nothing touches.
double largestPressure_kPa(const RigidBar& bar);

/// Colour of a pressure as a fraction of the scale; 0 is the liver's own.
Rgb pressureColour(double fraction);

/// Colour of every vertex of the surface.
std::vector<Rgb> pressureColours(const BarContact& contact, double scale_kPa);

}  // namespace glisson::render
