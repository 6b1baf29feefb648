// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/triangle_mesh.h"

namespace glisson::anatomy {

/// A surface as its file has it.
struct SurfaceFile {
  TriangleMesh mesh;  ///< closed and oriented outwards where `closed`
  bool closed = false;
  std::size_t points = 0;             ///< in the file, inner ones and repeated ones too
  std::size_t volumeCells = 0;        ///< cells of a volume mesh, of which `mesh` is the outside; 0 for surface files
  std::vector<std::string> warnings;  ///< e.g. coordinates taken from RAS
};

/// Whether readSurface knows the extension: .stl, .obj, .vtp, .vtu, .vtk (legacy), .msh (Gmsh 1 and 2, ASCII).
bool isSurfaceFile(const std::filesystem::path& path);

/// Reads a surface, or the outside of a volume mesh. Coordinates are LPS mm; a file that says SPACE=RAS (VTK field
/// data, or a comment in the first lines of STL and OBJ, as 3D Slicer writes it) is turned into LPS. Polygons are cut
/// into triangles, points at the same place are merged (where that does not close the surface: points within 1e-6 of
/// its size, and the walls of bodies that touch go), repeated triangles and those without area dropped. Throws
/// BadInput where the file cannot be read, is larger than 1 GB, or holds indices beyond its points or no triangle.
SurfaceFile readSurface(const std::filesystem::path& path);

}  // namespace glisson::anatomy
