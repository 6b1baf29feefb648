// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "retraction/body.h"
#include "retraction/simulate.h"

namespace glisson::exchange::testing_bodies {

/// An L-shaped body whose cells all have moduli of their own, on a grid whose axes are the columns of `direction`.
inline retraction::Model lBody(const Eigen::Matrix3d& direction = Eigen::Matrix3d::Identity()) {
  image::Grid g;
  g.size = {4, 3, 3};
  g.spacing_mm = {4.0, 5.0, 6.0};
  g.direction = direction;
  g.origin_lps_mm = {10.0, -20.0, 30.0};
  image::ScalarVolume E(g, 0.0f);
  float value = 2.0f;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        if (i < 2 || k == 0) E.at(i, j, k) = (value += 0.37f);
  return retraction::makeModel(std::move(E), 0.4, defaults::liverDensity, false);
}

/// A rotation about no axis in particular.
inline Eigen::Matrix3d oblique() {
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
  return turn.toRotationMatrix();
}

inline std::string readText(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace glisson::exchange::testing_bodies
