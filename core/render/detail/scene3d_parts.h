// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "anatomy/triangle_mesh.h"
#include "render/overlay.h"
#include "render/painter.h"

class vtkActor;
class vtkProp;
template <class T>
class vtkSmartPointer;

namespace glisson::render {

/// Parts of the 3-D scene; each is one actor in LPS mm.

/// Where a rest point of the patient is shown.
using Motion = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;
/// Colour of a rest point.
using Paint = std::function<Rgb(const Eigen::Vector3d&)>;

/// A smooth opaque surface, moved and coloured per vertex.
vtkSmartPointer<vtkActor> solidSurface(const anatomy::TriangleMesh& mesh, const Motion& motion, const Paint& paint);

/// A smooth opaque surface with a colour per vertex.
vtkSmartPointer<vtkActor> colouredSurface(const anatomy::TriangleMesh& mesh, const std::vector<Rgb>& colours);

/// A faint glass-like surface: clear where it faces the eye, stronger towards its rim, whatever the camera.
/// opacity: face and rim, 0..1.
vtkSmartPointer<vtkActor> glassSurface(const anatomy::TriangleMesh& mesh, const Motion& motion, Rgb colour,
                                       double faceOpacity, double rimOpacity);

/// A surface of steel: the bar.
vtkSmartPointer<vtkActor> steel(const anatomy::TriangleMesh& mesh);

/// Lines of a millimetre grid on a box face. axis: 0..2, the face's normal; at_mm: its position.
vtkSmartPointer<vtkActor> gridLines(const Eigen::AlignedBox3d& box, int axis, double at_mm, double spacing_mm,
                                    bool majorOnly, double lineWidth_px);

/// Straight lines, unlit.
vtkSmartPointer<vtkActor> segments(const std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>& lines, Rgb colour,
                                   double lineWidth_px);

/// Text that faces the eye, centred at a point of the scene.
vtkSmartPointer<vtkProp> label3D(const Eigen::Vector3d& at_lps, const std::string& text, Rgb colour, double size_px,
                                 bool bold);

/// Text on the screen. x, y: fraction of the view, (0, 0) bottom left.
vtkSmartPointer<vtkProp> screenText(double x, double y, const std::string& text, Rgb colour, double size_px, bool bold,
                                    bool centred = false, double angle_deg = 0.0);

/// A filled square on the screen.
vtkSmartPointer<vtkProp> screenSwatch(double x, double y, double width, double height, Rgb colour);

}  // namespace glisson::render
