// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "exchange/detail/sofa_scene.h"
#include "exchange/text_file.h"

namespace glisson::exchange::detail {
namespace {

void writePoints(std::ostream& out, const char* title, const std::vector<Eigen::Vector3d>& points_mm) {
  out << "# vtk DataFile Version 3.0\n" << title << "\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  out << "POINTS " << points_mm.size() << " double\n";
  for (const Eigen::Vector3d& p : points_mm)
    out << shortest(p.x()) << ' ' << shortest(p.y()) << ' ' << shortest(p.z()) << '\n';
}

}  // namespace

std::string sofaMesh(const SofaScene& scene) {
  std::ostringstream out;
  writePoints(out, "liver, mm, LPS; youngModulus in kPa", scene.points_mm);
  const std::size_t corners = scene.tetrahedra ? 4 : 8;
  out << "CELLS " << scene.elements.size() << ' ' << scene.elements.size() * (corners + 1) << '\n';
  for (const std::vector<int>& e : scene.elements) {
    out << corners;
    for (const int node : e) out << ' ' << node;
    out << '\n';
  }
  out << "CELL_TYPES " << scene.elements.size() << '\n';
  for (std::size_t i = 0; i < scene.elements.size(); ++i) out << (scene.tetrahedra ? 10 : 12) << '\n';
  out << "CELL_DATA " << scene.elements.size() << "\nSCALARS youngModulus double 1\nLOOKUP_TABLE default\n";
  for (const double E : scene.youngs_kPa) out << shortest(E) << '\n';
  return out.str();
}

std::string sofaLandmarkMesh(const SofaLandmarks& landmarks) {
  std::ostringstream out;
  writePoints(out, "vessel centrelines, mm, LPS", landmarks.points_lps_mm);
  const std::size_t lines = landmarks.edges.size(), points = lines == 0 ? landmarks.points_lps_mm.size() : 0;
  out << "CELLS " << lines + points << ' ' << 3 * lines + 2 * points << '\n';
  for (const std::array<int, 2>& e : landmarks.edges) out << "2 " << e[0] << ' ' << e[1] << '\n';
  for (std::size_t i = 0; i < points; ++i) out << "1 " << i << '\n';
  out << "CELL_TYPES " << lines + points << '\n';
  for (std::size_t i = 0; i < lines; ++i) out << "3\n";
  for (std::size_t i = 0; i < points; ++i) out << "1\n";
  return out.str();
}

}  // namespace glisson::exchange::detail
