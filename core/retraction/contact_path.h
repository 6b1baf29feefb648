// SPDX-License-Identifier: GPL-3.0-or-later
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

/// Force at a travel along the path brought to the answer: followed on coarse cells, it is stretched in travel so that
/// it ends where the answer does. At the answer's own travel that is its own force. Where the path does not bear the
/// answer's force, that of the path as it is.
double answersForceAt(const RigidContact& contact, double travel_mm);

/// Of a bar that is driven by its travel: travel (mm) and the largest force (N) of its path, where the force at its end
/// is clearly below that; else empty.
std::optional<std::array<double, 2>> passedOnTheWay(const RigidContact& contact);

/// Of a bar that reached what it was asked for: travel (mm) and force (N) of the place on its path from which the force
/// fell clearly, before it rose beyond that again; of several the one with the deepest fall; else empty.
std::optional<std::array<double, 2>> gaveWayOnTheWay(const RigidContact& contact);

}  // namespace glisson::retraction
