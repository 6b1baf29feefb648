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

bool setSpread(Json& scene, double spread_mm) {
  bool any = false;
  for (Json& l : scene["loads"])
    if (l.value("kind", "") == "retractor") {
      l["spread_mm"] = spread_mm;
      any = true;
    }
  return any;
}

}  // namespace

std::vector<Variation> variations(const std::string& sceneJson) {
  const Json base = Json::parse(sceneJson);
  std::vector<Variation> out = {{"as simulated", sceneJson}};
  const auto add = [&](const char* name, const auto& change) {
    Json scene = base;
    if (change(scene) && scene != base) out.push_back({name, scene.dump(2)});
  };
  add("abdomen half as stiff", [](Json& s) { return scaleSprings(s, 0.5); });
  add("abdomen twice as stiff", [](Json& s) { return scaleSprings(s, 2.0); });
  add("bare bar", [](Json& s) { return setSpread(s, 0.0); });
  add("contact spread 20 mm", [](Json& s) { return setSpread(s, 20.0); });
  add("Poisson's ratio 0.30", [](Json& s) {
    s["material"]["poisson"] = 0.30;
    return true;
  });
  add("Poisson's ratio 0.49", [](Json& s) {
    s["material"]["poisson"] = 0.49;
    return true;
  });
  add("2.1 kPa as Young's modulus", [](Json& s) {
    s["compare"] = {{"against", "atlas"}, {"youngs_kPa", 2.1}};
    return true;
  });
  // Large deformation takes many solves, and a liver folds under its whole weight on a narrow bar: on coarser cells
  // with a wider contact, and linear theory on just the same beside it.
  add("linear, 10 mm cells, 20 mm spread", [](Json& s) {
    s["geometry"]["cell_mm"] = 10;
    return setSpread(s, 20.0);
  });
  add("corotational, 10 mm cells, 20 mm spread", [](Json& s) {
    s["geometry"]["cell_mm"] = 10;
    s["kinematics"] = "corotational";
    return setSpread(s, 20.0);
  });
  return out;
}

}  // namespace glisson::cohort::detail
