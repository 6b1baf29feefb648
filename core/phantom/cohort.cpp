// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <numeric>

#include "base/error.h"
#include "base/quantity.h"
#include "phantom/detail/shape.h"
#include "phantom/phantom.h"

namespace glisson::phantom {
namespace {

// The i-th of n equal strata of [0, 1), at a random place within.
double stratum(int i, int n, Random& r) {
  return (i + r.uniform()) / n;
}

// Inverse of the standard normal distribution function by bisection of std::erfc.
double normalQuantile(double p) {
  double low = -8.0;
  double high = 8.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    (0.5 * std::erfc(-x / std::numbers::sqrt2) < p ? low : high) = x;
  }
  return 0.5 * (low + high);
}

std::vector<double> paperMeans(int cases, Random& r) {
  const double atlas = defaults::atlasShear.kPa();
  const int stiff = static_cast<int>(std::lround(0.3 * cases));      // more than 1 kPa above the atlas
  const int verystiff = static_cast<int>(std::lround(0.2 * cases));  // more than twice the atlas
  std::vector<double> means;
  for (int i = 0; i < verystiff; ++i)
    means.push_back(2.0 * atlas + 0.15 + 3.6 * std::pow(stratum(i, verystiff, r), 1.4));
  for (int i = 0; i < stiff - verystiff; ++i) means.push_back(atlas + 1.12 + 0.86 * stratum(i, stiff - verystiff, r));
  const int healthy = cases - stiff;
  for (int i = 0; i < healthy; ++i)
    means.push_back(std::clamp(atlas + 0.3 * normalQuantile(stratum(i, healthy, r)), atlas - 0.75, atlas + 0.8));
  for (std::size_t i = means.size(); i > 1; --i) std::swap(means[i - 1], means[r.below(i)]);
  return means;
}

}  // namespace

std::vector<CaseDraw> drawCohort(const PhantomOptions& options) {
  if (options.cases < 1 || options.cases > 9999)
    throw BadArgument("phantom cohort: " + std::to_string(options.cases) + " cases; give 1 to 9999");
  Random seeds = derived(options.seed, 91);
  Random r = derived(options.seed, 92);
  std::vector<CaseDraw> draws(static_cast<std::size_t>(options.cases));
  for (CaseDraw& d : draws) {
    d.seed = seeds.next();
    d.shear_kPa = 2.0 + 4.0 * std::pow(r.uniform(), 1.6);
  }
  if (options.paperCohort) {
    const std::vector<double> means = paperMeans(options.cases, r);
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i].shear_kPa = means[i];
  }
  return draws;
}

std::vector<std::filesystem::path> writeCohort(const PhantomOptions& options, const std::filesystem::path& folder,
                                               const Progress& progress) {
  const std::vector<CaseDraw> draws = drawCohort(options);
  std::vector<std::filesystem::path> folders;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "patient-%03d", static_cast<int>(i) + 1);
    const auto n = static_cast<double>(draws.size());
    const Progress part = progress.part(static_cast<double>(i) / n, static_cast<double>(i + 1) / n);
    PhantomOptions one;
    one.number = static_cast<int>(i) + 1;
    one.shear_kPa = draws[i].shear_kPa;
    one.shape = options.shape;
    const PhantomPatient patient = makePhantom(draws[i].seed, one, part.part(0.0, 0.8));
    part.report(0.8, "writing " + std::string(name));
    writePhantom(patient, folder / name);
    folders.push_back(folder / name);
  }
  progress.report(1.0, "cohort");
  return folders;
}

}  // namespace glisson::phantom
