// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/method_study.h"

#include <cmath>
#include <cstdlib>

#include "pipeline/scene.h"

namespace glisson::session {

namespace {

constexpr double budget_s = 60.0;

/// How a row of the study calls the method; empty where the study does not try it.
std::string studied(Method method) {
  switch (method) {
    case Method::HexIncompatible: return "H8-incompatible";
    case Method::HexBBar: return "H8-Bbar";
    case Method::Hex: return "H8";
    case Method::TetQuadratic: return "T10";
    case Method::TetLinear: return "T4";
    case Method::WendlandAffine: return "Wendland affine";
    case Method::WendlandQuadratic: return "Wendland quadratic";
    case Method::Voronoi: return "Voronoi, CG 200 (published)";
    case Method::MovingLeastSquares: return "MLS linear";
    default: return {};
  }
}

/// The point of a row on its own, drawn over the others.
render::XyChart::Series mark(const study::Row& row, const std::string& name) {
  return {.name = name, .x = {row.total_s()}, .y = {row.max_error_mm}, .joined = false};
}

}  // namespace

std::optional<std::size_t> rowOf(const std::vector<study::Row>& rows, const Parameters& parameters) {
  const std::string name = studied(parameters.method);
  std::optional<std::size_t> best;
  double nearest = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (name.empty() || rows[i].method != name || rows[i].online || !std::isfinite(rows[i].max_error_mm)) continue;
    // "60 frames on ...": the number of sites; else the finest cells are the scene's own.
    const double distance = isMeshfree(parameters.method)
                                ? std::abs(std::log(std::max(1, std::atoi(rows[i].resolution.c_str())) /
                                                    static_cast<double>(parameters.frames)))
                                : -static_cast<double>(rows[i].dofs);
    if (!best || distance < nearest) {
      best = i;
      nearest = distance;
    }
  }
  return best;
}

MethodStudy studyMethods(const std::filesystem::path& scene, const Parameters& chosen, const MethodWords& words,
                         const Progress& progress) {
  MethodStudy m;
  m.study = study::studyTradeoff(pipeline::readScene(scene), {.quick = true, .budget_s = budget_s}, progress);
  m.ofDefault = rowOf(m.study.rows, Parameters{});
  m.ofChoice = rowOf(m.study.rows, chosen);
  m.chart = study::chart(m.study.rows, m.study.reference, words.title, {});
  m.chart.x.title = words.time;
  m.chart.y.title = words.error;
  const auto drawn = [&](std::optional<std::size_t> row) { return row && m.study.rows[*row].max_error_mm > 0.0; };
  if (drawn(m.ofDefault) && m.ofDefault == m.ofChoice) {
    m.chart.series.push_back(mark(m.study.rows[*m.ofDefault], words.both));
  } else {
    if (drawn(m.ofDefault)) m.chart.series.push_back(mark(m.study.rows[*m.ofDefault], words.ofDefault));
    if (drawn(m.ofChoice)) m.chart.series.push_back(mark(m.study.rows[*m.ofChoice], words.ofChoice));
  }
  return m;
}

}  // namespace glisson::session
