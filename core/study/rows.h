// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/charts.h"

namespace glisson::study {

/// One method at one resolution, held against one reference.
struct Row {
  std::string method;      ///< "H8-incompatible", "Wendland quadratic", ...
  std::string resolution;  ///< "30x6x6 (1.67 mm)", "60 frames on 60x12x12"
  int dofs = 0;
  double build_s = 0.0;        ///< making the model: mesh, hierarchy or factor, shape functions, matrices
  double solve_s = 0.0;        ///< the static solve
  double step_ms = 0.0;        ///< one implicit Euler step of 1 ms; NaN where it was not measured
  double max_error_mm = 0.0;   ///< largest over the points compared; NaN where there is no usable answer
  double tip_error_mm = 0.0;   ///< at the tip (beam) or at the point that moves most (other scenes)
  std::string reference;       ///< what the errors are against
  bool pareto = false;         ///< no other row of this reference is both faster and closer
  double mean_error_mm = 0.0;  ///< over the points compared
  bool converged = true;
  bool online = false;  ///< answered from a response made once, offline (build_s): not on the chart of total times
  std::string note;     ///< how the solve ended where it did not converge, what the model changed
  double total_s() const { return build_s + solve_s; }
};

/// Marks the rows that no other row with the same reference beats in both build + solve time and largest error. A row
/// whose error is not finite is never marked.
void markPareto(std::vector<Row>& rows);

/// All columns, one line a row; numbers with ten significant digits, nothing where not finite.
std::string csv(const std::vector<Row>& rows);

/// A table for reading: one line a row.
std::string table(const std::vector<Row>& rows);

/// Error against build + solve time on logarithmic axes, one series a method, Pareto front marked; rows of one
/// reference.
render::XyChart chart(const std::vector<Row>& rows, const std::string& reference, const std::string& title,
                      const std::string& caption);

/// Writes <name>.png and <name>.svg of the chart where it has a series; returns what was written. Throws as write.
std::vector<std::filesystem::path> writeChart(const std::filesystem::path& folder, const std::string& name,
                                              const render::XyChart& chart);

/// Writes <name>.csv, and <name>.png and <name>.svg of the chart; returns what was written. Throws BadInput where a
/// file cannot be written.
std::vector<std::filesystem::path> write(const std::filesystem::path& folder, const std::string& name,
                                         const std::vector<Row>& rows, const render::XyChart& chart);

}  // namespace glisson::study
