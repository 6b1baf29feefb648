// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mechanics/loads.h"
#include "mechanics/problem.h"
#include "retraction/setup.h"
#include "retraction/simulate.h"

namespace glisson::retraction {

/// One voxel face on the surface of the body.
struct SurfaceFace {
  mechanics::Face face;                                 ///< of the mesh, in the grid's own axes
  std::array<int, 4> nodes{};                           ///< of the mesh
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< LPS
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();     ///< outward, LPS
  double area_m2 = 0.0;
  bool cavity = false;  ///< borders an enclosed cavity
};

/// The meshed body: the one place where the imaging rooms' mm, kPa and LPS become mechanics' m, Pa and grid axes.
class Body {
 public:
  explicit Body(const Model& model);

  const mechanics::VoxelBody& voxels() const { return voxels_; }
  const mechanics::VoxelMesh& mesh() const { return mesh_; }
  const std::vector<SurfaceFace>& surface() const { return surface_; }

  Eigen::Vector3d nodePosition_mm(int node) const;
  /// Continuous lattice position in metres, grid axes, of a point in mm (LPS).
  Eigen::Vector3d toLocal_m(const Eigen::Vector3d& p_mm) const;
  /// The reverse of toLocal_m.
  Eigen::Vector3d toLps_mm(const Eigen::Vector3d& p_m) const;
  Eigen::Vector3d vectorToLocal(const Eigen::Vector3d& v_lps) const { return direction_.transpose() * v_lps; }
  Eigen::Vector3d vectorToLps(const Eigen::Vector3d& v_local) const { return direction_ * v_local; }

  /// Faces of a region. Throws BadInput naming the region where none is there.
  std::vector<const SurfaceFace*> faces(const Region& region) const;
  /// Nodes of a region: of its faces for surface regions, all nodes inside for boxes, planes and masks; ascending.
  std::vector<int> nodes(const Region& region) const;

  /// Words for messages: "face \"x-\"", ...
  static std::string name(const Region& region);

 private:
  bool inside(const Region& region, const Eigen::Vector3d& p_mm) const;

  mechanics::VoxelBody voxels_;
  mechanics::VoxelMesh mesh_;
  image::Grid grid_;
  Eigen::Matrix3d direction_;
  std::vector<SurfaceFace> surface_;
};

/// Faces that a retractor pushes on, with their share of the force.
struct Contact {
  std::vector<const SurfaceFace*> faces;
  std::vector<double> share;  ///< adds up to 1
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  double area_mm2 = 0.0;  ///< as seen along the hoist
  double away_mm = 0.0;   ///< of the point given, from the middle of the nearest face that bears
};

/// Throws BadInput: "no contact", with the distance to the nearest surface that looks against the hoist (infinite:
/// none).
[[noreturn]] void refuseContact(const Eigen::Vector3d& at_mm, double nearest_mm);

/// The bar lies against the surface at `at_mm`, across the hoist. It pushes on the connected faces under it that look
/// against the hoist, uniformly per area seen along the hoist; with spread, the pressure falls off beyond the bar as a
/// Gaussian. Throws BadInput ("no contact") where `at_mm` is further from such a face than the bar is thick.
Contact findContact(const Body& body, const Retractor& retractor, const Eigen::Vector3d& at_mm);

/// Where the bar is laid when no point is given. It starts at the inferior point of the right lobe (anatomy) and is
/// moved up along z, one cell at a time and 80 mm at most, to the first height at which the faces under the bar, seen
/// along the hoist, cover at least nine tenths of it; where none does, to the height with the largest cover. Its middle
/// is the centroid of those faces. Throws BadInput where no face looks against the hoist.
Eigen::Vector3d findHoistPoint(const Body& body, const Retractor& retractor, const Eigen::Vector3d& inferior_mm);

/// The same for a scene's own model, from its inferior point.
Eigen::Vector3d defaultHoistPoint(const Body& body, const Model& model, const Retractor& retractor);

/// A uniform traction on one voxel face, Pa, grid axes.
struct FaceTraction {
  mechanics::Face face;
  Eigen::Vector3d traction_Pa;
};

/// The scene as a mechanics problem, with what is needed to read the answer back.
struct MechanicsScene {
  mechanics::Problem problem;
  std::vector<mechanics::Foundation> foundations;    ///< what problem.supports.springs are lumped from
  std::vector<mechanics::NodalField> loads_N;        ///< one per load of the setup; their sum is problem.f_N
  std::vector<std::vector<FaceTraction>> tractions;  ///< per load: what it puts on which face; empty for body forces
  std::optional<Contact> contact;
};

/// Throws BadInput: empty regions, contradicting supports, no contact, nothing that holds the body (static).
MechanicsScene toMechanics(const Body& body, const Model& model, const Setup& setup);

}  // namespace glisson::retraction
