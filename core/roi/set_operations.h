// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace glisson::roi {

/// Whether points that lie inside the rings named by in (each by the even-odd rule) belong to a set.
using Membership = std::function<bool(const std::vector<bool>& in)>;

/// The boundary of the set of points for which belongs() holds: closed rings (2 × n), anticlockwise around what
/// belongs (x to y), clockwise around holes. No ring crosses or touches itself or runs over another one; parts that
/// meet in single points are rings of their own. rings: closed, 2 × n, one plane, mm; they may cross themselves and
/// each other, touch, or coincide. belongs: false where no ring is around.
/// Worked out in integers on a lattice of 2^-30 mm (coarser beyond 1 m from the origin): exact but for crossings, which
/// are moved to the lattice. Vertices of the input that stay keep their bits; slivers thinner than 1e-8 mm go.
/// Throws BadInput where a coordinate is not finite or beyond 1e6 mm.
std::vector<Eigen::Matrix2Xd> boundaryOf(const std::vector<Eigen::Matrix2Xd>& rings_mm, const Membership& belongs);

/// Outlines of one plane that make a region together (arrangement.h). flips: those that flip what they enclose
/// (Combine::Parity); of the size of rings_mm.
struct FlatRegion {
  std::vector<Eigen::Matrix2Xd> rings_mm;
  std::vector<bool> flips;
};

/// What is made of two regions.
enum class SetOperation { Union, Difference, Intersection };

/// first with second, as sets of points; empty rings_mm for the empty set. The result has flips where it is so thin
/// that its outlines would be taken for one that is drawn twice. Throws BadInput as boundaryOf.
FlatRegion combined(const FlatRegion& first, const FlatRegion& second, SetOperation operation);

/// Whether two rings share more than single points: area, or a part of their border. Throws BadInput as boundaryOf.
bool meet(const Eigen::Matrix2Xd& a_mm, const Eigen::Matrix2Xd& b_mm);

/// Sum of the signed areas of rings, mm²: of a boundary, the area of what it bounds.
double signedArea_mm2(const std::vector<Eigen::Matrix2Xd>& rings_mm);

}  // namespace glisson::roi
