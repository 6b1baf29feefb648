// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "retraction/simulate.h"

namespace glisson::exchange {

/// Values on points or cells; the unit is part of the name ("E_kPa", "u_mm"). values: components × n.
struct NamedArray {
  std::string name;
  Eigen::MatrixXd values;
};

/// Hexahedra in the patient frame; corners in VTK's order, positively oriented.
struct HexMesh {
  Eigen::Matrix3Xd nodes_lps_mm;
  Eigen::MatrixXi hexes;  ///< 8 × cells
  std::vector<NamedArray> pointArrays, cellArrays;
};

/// The body of a retraction at rest: E_kPa per cell and, where a result is given, u_mm per node.
HexMesh hexMeshOf(const retraction::Model& model, const retraction::Result* result);

/// The same mesh with its nodes moved by the point array u_mm. Throws BadArgument where there is none.
HexMesh deformed(const HexMesh& mesh);

/// Displacements (3 × n, mm, LPS) at points: by the cell that holds them, or of the nearest node where a point lies
/// outside of the body.
Eigen::Matrix3Xd displacementsNear(const retraction::Model& model, const retraction::Result& result,
                                   const Eigen::Matrix3Xd& points_lps_mm);

/// Writes a VTK XML file (.vtu, .vtp): points in LPS mm, which surfaces say in field data too (SPACE = LPS, as 3D
/// Slicer writes it; a body does not, because meshio ends the program that reads texts); numbers appended raw; the same
/// input gives the same bytes. Throws BadArgument where an array has another length, BadInput where the file cannot be
/// written.
void writeVtu(const std::filesystem::path& file, const HexMesh& mesh);
void writeVtp(const std::filesystem::path& file, const anatomy::TriangleMesh& mesh,
              const std::vector<NamedArray>& pointArrays);

/// Writes a ParaView collection: time (s) and file beside it, in order.
void writePvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& timeAndFile);

}  // namespace glisson::exchange
