#pragma once

#include <Eigen/Core>

namespace glisson::anatomy {

/// A triangle surface in the patient frame. Closed surfaces are oriented outwards (counter-clockwise from outside).
struct TriangleMesh {
  Eigen::Matrix3Xd vertices_lps_mm;  ///< 3 × nVertices
  Eigen::Matrix3Xi triangles;        ///< 3 × nTriangles, vertex indices
};

}  // namespace glisson::anatomy
