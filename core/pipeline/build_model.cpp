// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/build_model.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "elastography/fill.h"
#include "image/components.h"
#include "image/coverage.h"

namespace glisson::pipeline::detail {
namespace {

image::Mask boxCells(const GeometrySpec& g) {
  image::Grid grid;
  grid.size = g.size_mm.cwiseQuotient(g.cell_mm).array().round().cast<int>().max(1);
  grid.spacing_mm = g.size_mm.cwiseQuotient(grid.size.cast<double>());
  grid.origin_lps_mm = 0.5 * grid.spacing_mm;
  return image::Mask(grid, 1);
}

/// Index range of what is filled, grown by `margin` voxels and cut to the grid.
std::pair<Eigen::Vector3i, Eigen::Vector3i> filledRange(const image::Mask& mask) {
  Eigen::Vector3i low = mask.grid.size, high = Eigen::Vector3i::Constant(-1);
  for (int k = 0; k < mask.grid.size.z(); ++k)
    for (int j = 0; j < mask.grid.size.y(); ++j)
      for (int i = 0; i < mask.grid.size.x(); ++i)
        if (mask.at(i, j, k)) {
          const Eigen::Vector3i c(i, j, k);
          low = low.cwiseMin(c);
          high = high.cwiseMax(c);
        }
  if (high.x() < 0) throw BadInput("the region of interest holds no voxel; check the mask and its label");
  return {low, high};
}

image::Mask cropped(const image::Mask& mask) {
  const auto [low, high] = filledRange(mask);
  image::Grid grid = mask.grid;
  grid.size = high - low + Eigen::Vector3i::Ones();
  grid.origin_lps_mm = mask.grid.indexToLps(low.cast<double>());
  image::Mask out(grid);
  for (int k = 0; k < grid.size.z(); ++k)
    for (int j = 0; j < grid.size.y(); ++j)
      for (int i = 0; i < grid.size.x(); ++i) out.at(i, j, k) = mask.at(Eigen::Vector3i(i, j, k) + low) ? 1 : 0;
  return out;
}

/// Cells of the wanted size, laid centrally over the mask, of the mask's volume.
image::Mask resampled(const image::Mask& mask, const Eigen::Vector3d& cell_mm) {
  const auto [low, high] = filledRange(mask);
  image::Grid grid;
  grid.direction = mask.grid.direction;
  grid.spacing_mm = cell_mm;
  const Eigen::Vector3d extent_mm =
      (high - low + Eigen::Vector3i::Ones()).cast<double>().cwiseProduct(mask.grid.spacing_mm);
  grid.size = extent_mm.cwiseQuotient(cell_mm).array().ceil().cast<int>().max(1);
  const Eigen::Vector3d corner_mm = mask.grid.indexToLps(low.cast<double>() - Eigen::Vector3d::Constant(0.5));
  const Eigen::Vector3d slack_mm = 0.5 * (grid.size.cast<double>().cwiseProduct(cell_mm) - extent_mm);
  grid.origin_lps_mm = corner_mm + grid.direction * (0.5 * cell_mm - slack_mm);

  return cropped(image::resampleKeepingVolume(mask, grid));
}

float youngs_kPa(double value_kPa, StiffnessQuantity quantity, double poisson) {
  return static_cast<float>(
      quantity == StiffnessQuantity::Youngs ? value_kPa : toYoungs(ShearModulus::fromKPa(value_kPa), poisson).kPa());
}

retraction::Model uniformModel(const Scene& scene, const image::Mask& cells, double value_kPa,
                               StiffnessQuantity quantity) {
  image::ScalarVolume E(cells.grid, 0.0f);
  // Through a float first: a map holds floats, and equal stiffness must give equal bits.
  const float value = youngs_kPa(static_cast<double>(static_cast<float>(value_kPa)), quantity, scene.setup.poisson);
  for (std::size_t i = 0; i < E.values.size(); ++i)
    if (cells.values[i]) E.values[i] = value;
  return retraction::makeModel(std::move(E), scene.setup.poisson, scene.setup.density,
                               scene.geometry.kind == GeometrySpec::Kind::Patient);
}

/// A map read from a file, as given: nothing is filled, every cell must have a usable value.
image::ScalarVolume mapOnCells(const elastography::StiffnessMap& map, const image::Mask& cells) {
  image::ScalarVolume E(cells.grid, 0.0f);
  const image::Grid& g = cells.grid;
  for (int k = 0; k < g.size.z(); ++k)
    for (int j = 0; j < g.size.y(); ++j)
      for (int i = 0; i < g.size.x(); ++i) {
        if (!cells.at(i, j, k)) continue;
        const Eigen::Vector3d index = map.values_kPa.grid.lpsToIndex(g.indexToLps(Eigen::Vector3d(i, j, k)));
        const Eigen::Vector3i at = index.array().round().cast<int>();
        const bool there = map.values_kPa.grid.contains(at);
        const float v = there ? map.values_kPa.at(at) : 0.0f;
        if (!there || !std::isfinite(v) || v <= 0.0f) {
          std::ostringstream text;
          if (there)
            text << "the stiffness map holds no usable modulus at its voxel (" << at.x() << ", " << at.y() << ", "
                 << at.z() << "), slice " << at.z() << ": " << v << " kPa (0 also stands for what is not a number)";
          else
            text << "the stiffness map does not reach voxel (" << i << ", " << j << ", " << k << ") of the body";
          text << "; every voxel of the body needs a positive modulus";
          throw BadInput(text.str());
        }
        E.at(i, j, k) = v;
      }
  return E;
}

}  // namespace

image::Mask bodyCells(const Scene& scene, const Inputs& inputs) {
  const GeometrySpec& g = scene.geometry;
  if (g.kind == GeometrySpec::Kind::Box) return boxCells(g);
  if (!inputs.liver) throw BadArgument("bodyCells: the inputs hold no region of interest");
  if (g.cell_mm.x() > 0) return resampled(*inputs.liver, g.cell_mm);
  if (g.kind == GeometrySpec::Kind::Mask) return cropped(*inputs.liver);
  const Eigen::Vector3d& s = inputs.liver->grid.spacing_mm;
  return resampled(*inputs.liver, Eigen::Vector3d::Constant(2.0 * std::min(s.x(), s.y())));
}

std::shared_ptr<const retraction::SmoothBody> smoothBody(const Scene& scene, const Inputs& inputs) {
  const auto& loads = scene.setup.loads;
  const bool retractor = std::any_of(loads.begin(), loads.end(), [](const retraction::LoadSpec& load) {
    return std::holds_alternative<retraction::Retractor>(load);
  });
  if (!retractor || scene.geometry.kind == GeometrySpec::Kind::Box) return nullptr;
  if (!inputs.liver) throw BadArgument("smoothBody: the inputs hold no region of interest");
  return std::make_shared<const retraction::SmoothBody>(*inputs.liver);
}

retraction::Model buildModel(const Scene& scene, const Inputs& inputs, const image::Mask& cells) {
  const MaterialSpec& m = scene.material;
  switch (m.kind) {
    case MaterialSpec::Kind::Uniform: return uniformModel(scene, cells, m.value_kPa, m.quantity);
    case MaterialSpec::Kind::Atlas:
      return uniformModel(scene, cells, defaults::atlasShear.kPa(), StiffnessQuantity::Shear);
    default: break;
  }
  if (!inputs.stiffness) throw BadArgument("buildModel: the inputs hold no stiffness map");
  const elastography::StiffnessMap& map = *inputs.stiffness;
  image::ScalarVolume E =
      m.kind == MaterialSpec::Kind::Map
          ? mapOnCells(map, cells)
          : elastography::fillStiffness(map, cells, inputs.roiOnMre ? &inputs.roiOnMre->mask : nullptr).values_kPa;
  for (float& v : E.values)
    if (v != 0.0f) v = youngs_kPa(static_cast<double>(v), map.quantity, scene.setup.poisson);
  return retraction::makeModel(std::move(E), scene.setup.poisson, scene.setup.density,
                               scene.geometry.kind == GeometrySpec::Kind::Patient);
}

retraction::Model buildAtlasModel(const Scene& scene, const image::Mask& cells) {
  retraction::Model model = uniformModel(scene, cells, scene.compare->value_kPa, scene.compare->quantity);
  model.stiffness = "atlas";
  return model;
}

bool sameStiffness(const retraction::Model& a, const retraction::Model& b) {
  for (std::size_t i = 0; i < a.youngs_kPa.values.size(); ++i) {
    const double x = static_cast<double>(a.youngs_kPa.values[i]), y = static_cast<double>(b.youngs_kPa.values[i]);
    if (std::abs(x - y) > 2e-7 * std::abs(y)) return false;
  }
  return true;
}

image::Mask dropLooseIslands(const Scene& scene, const image::Mask& cells, std::vector<std::string>& warnings) {
  if (scene.geometry.kind == GeometrySpec::Kind::Box) return cells;
  const image::Mask largest = image::largestComponent(cells);
  std::size_t all = 0, kept = 0;
  for (const std::uint8_t v : cells.values) all += v;
  for (const std::uint8_t v : largest.values) kept += v;
  if (kept == all || static_cast<double>(all - kept) > 0.01 * static_cast<double>(all)) return cells;
  std::ostringstream text;
  text << all - kept << " voxels (" << 1e-3 * static_cast<double>(all - kept) * cells.grid.voxelVolume_mm3()
       << " mL) that share no face with the rest were left out; islands below 1 % of the volume are dropped";
  warnings.push_back(text.str());
  return cropped(largest);
}

}  // namespace glisson::pipeline::detail
