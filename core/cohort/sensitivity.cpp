// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <nlohmann/json.hpp>

#include "cohort/detail/summary.h"

namespace glisson::cohort::detail {
namespace {

using Json = nlohmann::ordered_json;

/// Multiplies the stiffness of every spring support; false where there is none.
bool scaleSprings(Json& scene, double factor) {
  bool any = false;
  for (Json& s : scene["supports"])
    if (s.value("kind", "") == "spring") {
      s["stiffness_kPa_per_mm"] = factor * s["stiffness_kPa_per_mm"].get<double>();
      any = true;
    }
  return any;
}

/// Sets a key of the retractor; false where there is none.
bool setTool(Json& scene, const char* key, const Json& value) {
  bool any = false;
  for (Json& l : scene["loads"])
    if (l.value("kind", "") == "retractor") {
      l[key] = value;
      any = true;
    }
  return any;
}

/// What an assumption does is seen in the figures themselves: how sure each of them is would cost four times as much.
Json unasked(const std::string& sceneJson) {
  Json scene = Json::parse(sceneJson);
  scene.erase("uncertainty");
  return scene;
}

bool hasPatch(const Json& scene) {
  return std::any_of(scene["loads"].begin(), scene["loads"].end(), [](const Json& l) {
    return l.value("kind", "") == "retractor" && l.value("contact", "") == "patch";
  });
}

}  // namespace

std::vector<Variation> variations(const std::string& sceneJson) {
  const Json base = unasked(sceneJson);
  std::vector<Variation> out = {{"as simulated", base.dump(2)}};
  const auto add = [&](const std::string& name, const auto& change) {
    Json scene = base;
    if (change(scene) && scene != base) out.push_back({name, scene.dump(2)});
  };
  const auto poisson = [](double nu) {
    return [nu](Json& s) {
      s["material"]["poisson"] = nu;
      return true;
    };
  };
  add("abdomen half as stiff", [](Json& s) { return scaleSprings(s, 0.5); });
  add("abdomen twice as stiff", [](Json& s) { return scaleSprings(s, 2.0); });
  add("Poisson's ratio 0.30", poisson(0.30));
  add("Poisson's ratio 0.49", poisson(0.49));
  add("2.1 kPa as Young's modulus", [](Json& s) {
    s["compare"] = {{"against", "atlas"}, {"youngs_kPa", 2.1}};
    return true;
  });
  if (hasPatch(base)) {
    add("bare bar", [](Json& s) { return setTool(s, "spread_mm", 0.0); });
    add("contact spread 20 mm", [](Json& s) { return setTool(s, "spread_mm", 20.0); });
    // A liver folds under its whole weight on a narrow patch: on coarser cells with a wider one, and linear theory on
    // just the same beside it.
    for (const std::string kinematics : {"linear", "corotational"})
      add(kinematics + ", 10 mm cells, 20 mm spread", [&](Json& s) {
        s["geometry"]["cell_mm"] = 10;
        s["kinematics"] = kinematics;
        return setTool(s, "spread_mm", 20.0);
      });
    return out;
  }
  add("no capsule", [](Json& s) {
    s["capsule"] = false;
    return true;
  });
  add("capsule 0.6 N/mm", [](Json& s) {
    s["capsule"] = {{"tension_N_per_mm", 0.6}};
    return true;
  });
  add("bar 15 mm thick", [](Json& s) { return setTool(s, "diameter_mm", 15.0); });
  add("hoist tilted 20° cephalad", [](Json& s) { return setTool(s, "direction", Json::array({0.0, -0.940, 0.342})); });
  add("force 8 N", [](Json& s) { return setTool(s, "force", 8.0); });
  add("lifted by 30 mm", [](Json& s) {
    for (Json& l : s["loads"]) l.erase("force");
    return setTool(s, "drive", Json({{"travel_mm", 30.0}}));
  });
  add("logarithmic law", [](Json& s) {
    s["material"]["law"] = "neo-hookean-log";
    return true;
  });
  add("linear, patch of pressure", [](Json& s) {
    s["kinematics"] = "linear";
    return setTool(s, "contact", "patch");
  });
  return out;
}

}  // namespace glisson::cohort::detail
