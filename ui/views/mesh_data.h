// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vtkSmartPointer.h>

#include "anatomy/triangle_mesh.h"

class vtkPolyData;

namespace glisson::views {

/// A surface with its normals at the vertices, as VTK draws it; LPS mm.
vtkSmartPointer<vtkPolyData> meshWithNormals(const anatomy::TriangleMesh& mesh);

}  // namespace glisson::views
