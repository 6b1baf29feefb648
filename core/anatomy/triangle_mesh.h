// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace glisson::anatomy {

/// A triangle surface in the patient frame. Closed surfaces are oriented outwards (counter-clockwise from outside).
struct TriangleMesh {
  Eigen::Matrix3Xd vertices_lps_mm;  ///< 3 × nVertices
  Eigen::Matrix3Xi triangles;        ///< 3 × nTriangles, vertex indices
};

/// Sum of the triangle areas, mm².
double area_mm2(const TriangleMesh& mesh);

/// Enclosed volume of a closed surface, mm³ (divergence theorem); negative where it is oriented inwards.
double volume_mm3(const TriangleMesh& mesh);

/// Moves the vertices along their normals (area-weighted) until the closed surface holds the volume, to about 1e-4 of
/// it. For corrections that are small against its curvature.
void moveToVolume(TriangleMesh& mesh, double volume_mm3);

/// Whether every edge belongs to exactly two triangles that run along it in opposite directions.
bool isClosed(const TriangleMesh& mesh);

}  // namespace glisson::anatomy
