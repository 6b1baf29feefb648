// SPDX-License-Identifier: GPL-3.0-or-later
#include "retraction/body.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/io.h"

namespace glisson::retraction {
namespace {

constexpr double mmToM = 1e-3;

mechanics::VoxelBody toVoxels(const Model& model) {
  mechanics::VoxelBody b;
  const image::Grid& g = model.youngs_kPa.grid;
  b.cells = g.size;
  b.h_m = mmToM * g.spacing_mm;
  b.poisson = model.poisson;
  b.density_kg_m3 = model.density.kgPerM3();
  b.E_Pa.resize(model.youngs_kPa.values.size());
  for (std::size_t i = 0; i < b.E_Pa.size(); ++i)
    b.E_Pa[i] = YoungsModulus::fromKPa(static_cast<double>(model.youngs_kPa.values[i])).Pa();
  return b;
}

/// The grid axis and sign that comes closest to an LPS axis.
std::pair<int, int> gridSide(const Eigen::Matrix3d& direction, int lpsAxis, int sign) {
  Eigen::Index axis = 0;
  direction.row(lpsAxis).cwiseAbs().maxCoeff(&axis);
  const int s = direction(lpsAxis, axis) > 0 ? sign : -sign;
  return {static_cast<int>(axis), s};
}

}  // namespace

Body::Body(const Model& model)
    : voxels_(toVoxels(model)), mesh_(voxels_), grid_(model.youngs_kPa.grid), direction_(grid_.direction) {
  auto add = [&](const std::vector<mechanics::Face>& faces, bool cavity) {
    for (const mechanics::Face& face : faces) {
      SurfaceFace f;
      f.face = face;
      f.cavity = cavity;
      f.nodes = mechanics::faceNodes(mesh_, face);
      f.area_m2 = mechanics::faceArea_m2(mesh_, face.side);
      f.normal = direction_ * mechanics::faceNormal(face.side);
      f.centre_mm = grid_.indexToLps(mesh_.cellOf(face.filledCell).cast<double>()) +
                    0.5 * grid_.spacing_mm[face.side / 2] * f.normal;
      surface_.push_back(f);
    }
  };
  add(mechanics::exteriorFaces(mesh_), false);
  add(mechanics::cavityFaces(mesh_), true);
}

Eigen::Vector3d Body::nodePosition_mm(int node) const {
  return grid_.indexToLps(mesh_.latticeOf(node).cast<double>() - Eigen::Vector3d::Constant(0.5));
}

Eigen::Vector3d Body::toLocal_m(const Eigen::Vector3d& p_mm) const {
  return (grid_.lpsToIndex(p_mm) + Eigen::Vector3d::Constant(0.5)).cwiseProduct(voxels_.h_m);
}

Eigen::Vector3d Body::toLps_mm(const Eigen::Vector3d& p_m) const {
  return grid_.indexToLps(p_m.cwiseQuotient(voxels_.h_m) - Eigen::Vector3d::Constant(0.5));
}

std::string Body::name(const Region& region) {
  struct Name {
    std::string operator()(const FaceRegion& r) const { return "face \"" + r.face + "\""; }
    std::string operator()(const SurfaceRegion& r) const { return "surface \"" + r.surface + "\""; }
    std::string operator()(const BoxRegion&) const { return "box_mm"; }
    std::string operator()(const PlaneRegion&) const { return "plane"; }
    std::string operator()(const MaskRegion& r) const { return "mask \"" + r.file.filename().string() + "\""; }
  };
  return std::visit(Name{}, region);
}

bool Body::inside(const Region& region, const Eigen::Vector3d& p) const {
  const double slack = 1e-6 * grid_.spacing_mm.maxCoeff() + 1e-9;
  if (const auto* box = std::get_if<BoxRegion>(&region))
    return (p.array() >= box->low_mm.array() - slack).all() && (p.array() <= box->high_mm.array() + slack).all();
  const auto& plane = std::get<PlaneRegion>(region);
  return std::abs((p - plane.point_mm).dot(plane.normal)) <= plane.tolerance_mm + slack;
}

std::vector<const SurfaceFace*> Body::faces(const Region& region) const {
  std::vector<const SurfaceFace*> out;
  auto keep = [&](auto&& test) {
    for (const SurfaceFace& f : surface_)
      if (test(f)) out.push_back(&f);
  };
  if (const auto* face = std::get_if<FaceRegion>(&region)) {
    const auto [gridAxis, sign] = gridSide(direction_, face->face[0] - 'x', face->face[1] == '+' ? 1 : -1);
    const int axis = gridAxis;
    const int side = 2 * axis + (sign > 0 ? 1 : 0);
    int extreme = sign > 0 ? -1 : voxels_.cells[axis];
    for (int c = 0; c < mesh_.cellCount(); ++c) {
      const int at = mesh_.cellOf(c)[axis];
      extreme = sign > 0 ? std::max(extreme, at) : std::min(extreme, at);
    }
    keep([&](const SurfaceFace& f) { return f.face.side == side && mesh_.cellOf(f.face.filledCell)[axis] == extreme; });
  } else if (const auto* s = std::get_if<SurfaceRegion>(&region)) {
    if (s->surface == "all") {
      keep([](const SurfaceFace&) { return true; });
    } else if (s->surface == "outer") {
      keep([](const SurfaceFace& f) { return !f.cavity; });
    } else if (s->surface == "inner") {
      keep([](const SurfaceFace& f) { return f.cavity; });
    } else {
      static const std::vector<std::pair<std::string, std::pair<int, int>>> words = {
          {"left", {0, 1}},      {"right", {0, -1}},   {"posterior", {1, 1}},
          {"anterior", {1, -1}}, {"superior", {2, 1}}, {"inferior", {2, -1}}};
      const auto word = std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == s->surface; });
      if (word == words.end()) throw BadInput("surface \"" + s->surface + "\" is not known");
      const auto [axis, sign] = gridSide(direction_, word->second.first, word->second.second);
      const int side = 2 * axis + (sign > 0 ? 1 : 0);
      keep([&](const SurfaceFace& f) { return f.face.side == side && !f.cavity; });
    }
  } else if (const auto* m = std::get_if<MaskRegion>(&region)) {
    const image::Mask mask = image::readMask(m->file, m->label);
    keep([&](const SurfaceFace& f) {
      // The face belongs to the mask where the cell under it does.
      const Eigen::Vector3d p = f.centre_mm - 0.5 * grid_.spacing_mm[f.face.side / 2] * f.normal;
      const Eigen::Vector3i ijk = mask.grid.lpsToIndex(p).array().round().cast<int>();
      return mask.grid.contains(ijk) && mask.at(ijk) != 0;
    });
  } else {
    keep([&](const SurfaceFace& f) { return inside(region, f.centre_mm); });
  }
  if (out.empty())
    throw BadInput("region " + name(region) + " holds no part of the body's surface" +
                   (std::holds_alternative<SurfaceRegion>(region) && std::get<SurfaceRegion>(region).surface == "inner"
                        ? "; the body has no enclosed cavity"
                        : "; check its place (mm, LPS for masks and patients)"));
  return out;
}

std::vector<int> Body::nodes(const Region& region) const {
  std::vector<int> out;
  if (std::holds_alternative<BoxRegion>(region) || std::holds_alternative<PlaneRegion>(region)) {
    for (int node = 0; node < mesh_.nodeCount(); ++node)
      if (inside(region, nodePosition_mm(node))) out.push_back(node);
  } else if (const auto* m = std::get_if<MaskRegion>(&region)) {
    const image::Mask mask = image::readMask(m->file, m->label);
    for (int cell = 0; cell < mesh_.cellCount(); ++cell) {
      const Eigen::Vector3i ijk =
          mask.grid.lpsToIndex(grid_.indexToLps(mesh_.cellOf(cell).cast<double>())).array().round().cast<int>();
      if (!mask.grid.contains(ijk) || mask.at(ijk) == 0) continue;
      for (const int node : mesh_.nodesOf(cell)) out.push_back(node);
    }
  } else {
    for (const SurfaceFace* f : faces(region)) out.insert(out.end(), f->nodes.begin(), f->nodes.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  if (out.empty())
    throw BadInput("region " + name(region) +
                   " holds no node of the body; check its place (mm, LPS for masks and patients)");
  return out;
}

}  // namespace glisson::retraction
