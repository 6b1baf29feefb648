#pragma once

#include <array>
#include <optional>
#include <vector>

namespace glisson::retraction {

struct RigidContact;

/// The way of a rigid bar: travel (mm, growing) and force (N) of each step.
using ContactPath = std::vector<std::array<double, 2>>;

/// Force at a travel, linear between the steps; that of the first or last step before or beyond them.
double forceAt(const ContactPath& path, double travel_mm);

/// Travel at which the largest force is borne. The path is followed on coarse cells, which may bear more than those of
/// the answer: where the capacity lies below the path's largest force, where the path first comes to it.
double travelAtCapacity(const RigidContact& contact);

/// Of a bar that is driven by its travel: the largest force of its path, N, where the force at its end is clearly below
/// that; else empty.
std::optional<double> passedOnTheWay_N(const RigidContact& contact);

}  // namespace glisson::retraction
