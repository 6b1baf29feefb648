// SPDX-License-Identifier: GPL-3.0-or-later

// Whether 95 % intervals hold 95 %: the linearised spread of synthetic patients against full solves of resampled maps,
// outlines, loads and supports, and against the patients' own truth. By hand:
//   benchmark_uncertainty PATIENTS DRAWS CELL_MM [SEED]
// Every draw is solved from rest, path and all, with none of the tangent's help.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "base/private_folder.h"
#include "base/quantity.h"
#include "base/random.h"
#include "elastography/fill.h"
#include "phantom/phantom.h"
#include "pipeline/run.h"
#include "uncertainty/columns.h"

using namespace glisson;

namespace {

/// How many of how many lay inside.
struct Coverage {
  int inside = 0, of = 0;
  void add(const uncertainty::Interval& i, double value) {
    inside += value >= i.low && value <= i.high ? 1 : 0;
    ++of;
  }
  double percent() const { return of > 0 ? 100.0 * inside / of : 0.0; }
};

struct Tally {
  Coverage landmarks, retractor, mean, travel, vesselsMax, truthLandmarks, truthRetractor, truthTravel;
  int lost = 0, draws = 0;
  double plain_s = 0, spread_s = 0;
};

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

retraction::Model textbookOf(const retraction::Model& m) {
  image::ScalarVolume E = m.youngs_kPa;
  const float kPa = static_cast<float>(toYoungs(defaults::atlasShear, m.poisson).kPa());
  for (float& v : E.values)
    if (v > 0) v = kPa;
  retraction::Model out = retraction::makeModel(std::move(E), m.poisson, m.density, true);
  out.smooth = m.smooth;
  return out;
}

uncertainty::Elastogram elastogramOf(const pipeline::Inputs& in, const retraction::Model& m,
                                     const uncertainty::Spreads& s) {
  image::Mask body(m.youngs_kPa.grid);
  for (std::size_t i = 0; i < body.values.size(); ++i) body.values[i] = m.youngs_kPa.values[i] > 0 ? 1 : 0;
  const uncertainty::MapScatter scatter = uncertainty::scatterOf(*in.stiffness, &in.roiOnMre->mask, s.correlation_mm);
  return {s.noise >= 0 ? s.noise : scatter.noise, scatter.liver,
          elastography::fillStiffness(*in.stiffness, body, &in.roiOnMre->mask).origin};
}

/// A changed problem from rest; its displacements at the places less those at hand. Nothing where it has no answer.
std::optional<Eigen::VectorXf> fromRest(const uncertainty::OneStiffness& liver, const uncertainty::Places& places,
                                        const mechanics::Change& change, double& travel_mm) {
  const mechanics::EquilibriumMotion m = liver.fromRest(change, {});
  if (!m.found) return {};
  travel_mm = 1e3 * m.travel_m;
  return liver.displacements(places, m);
}

double lengthAt(const Eigen::VectorXf& d, std::size_t place) {
  return static_cast<double>(d.segment<3>(static_cast<Eigen::Index>(3 * place)).norm());
}

void drawsOf(const pipeline::Scene& scene, const pipeline::Inputs& inputs, const pipeline::RunResult& r, int draws,
             Tally& tally) {
  retraction::Setup setup = scene.setup;
  for (retraction::LoadSpec& load : setup.loads)
    if (auto* bar = std::get_if<retraction::Retractor>(&load)) *bar = r.placed->bar;
  const retraction::Model textbook = textbookOf(r.model);
  uncertainty::Options options = *scene.uncertainty;
  options.fields = 1;
  const uncertainty::Case patient{{r.model, r.primary, true},
                                  uncertainty::Retracted{textbook, *r.atlas, true},
                                  setup,
                                  r.landmarks_mm,
                                  elastogramOf(inputs, r.model, options.spreads),
                                  {}};
  uncertainty::OneStiffness own(patient.measured, setup), other(*patient.textbook, setup);
  const uncertainty::Places places = own.places(r.landmarks_mm, &*patient.textbook);
  const Eigen::VectorXf a = own.displacements(places), b = other.displacements(places);
  const uncertainty::Headline& h = *r.uncertainty->spread.headline;
  for (int d = 0; d < draws; ++d) {
    const std::uint64_t seed = 500000 + 1000 * scene.setup.seed + static_cast<std::uint64_t>(d);
    const auto columns = uncertainty::columnsOf(own, &other, patient, options, seed);
    Random random(seed);
    Eigen::VectorXd z(static_cast<Eigen::Index>(columns.size()));
    for (double& v : z) v = random.normal();
    for (std::size_t k = 0; k < columns.size(); ++k)  // a random elastogram as it is
      if (columns[k].kind == uncertainty::SourceKind::ElastogramNoise) z[static_cast<Eigen::Index>(k)] = 1;
    ++tally.draws;
    double travel_mm = 0, otherTravel_mm = 0;
    const auto da = fromRest(own, places, uncertainty::sumOf(columns, z, false), travel_mm);
    const auto db = fromRest(other, places, uncertainty::sumOf(columns, z, true), otherTravel_mm);
    if (!da || !db) {
      ++tally.lost;
      continue;
    }
    const uncertainty::Figures f = uncertainty::figuresOf(places, a + *da, b + *db);
    const Eigen::VectorXf apart = a + *da - b - *db;
    double largest = 0;
    for (std::size_t l = 0; l < places.landmark.size(); ++l) {
      tally.landmarks.add(*r.uncertainty->spread.landmarks[l].difference95_mm, lengthAt(apart, l));
      largest = std::max(largest, lengthAt(apart, l));
    }
    tally.vesselsMax.add(h.vessels->max_mm, largest);
    tally.retractor.add(h.at_retractor_mm, f.at_retractor_mm);
    tally.mean.add(h.mean_mm, f.mean_mm);
    tally.travel.add(h.travel_mm, *r.difference->travel_mm + travel_mm - otherTravel_mm);
  }
}

/// The same patient with the elastogram as it was before noise and doubt.
void truthOf(const pipeline::Scene& scene, pipeline::Inputs inputs, const phantom::PhantomPatient& p,
             const pipeline::RunResult& r, Tally& tally) {
  if (!inputs.stiffness->values_kPa.grid.sameGeometry(p.cleanShear_kPa.grid)) return;
  inputs.stiffness->values_kPa = p.cleanShear_kPa;
  inputs.stiffness->confidence.reset();
  inputs.stiffness->noConfidence.reset();
  pipeline::Scene plain = scene;
  plain.uncertainty.reset();
  const pipeline::RunResult t = pipeline::run(plain, {.output = {}, .discretisation = false}, {}, &inputs);
  if (!t.difference) return;
  const uncertainty::Headline& h = *r.uncertainty->spread.headline;
  for (const uncertainty::LandmarkSpread& l : r.uncertainty->spread.landmarks)
    tally.truthLandmarks.add(*l.difference95_mm, t.difference->vessel_mm[l.landmark]);
  tally.truthRetractor.add(h.at_retractor_mm, t.difference->at_retractor_mm);
  tally.truthTravel.add(h.travel_mm, *t.difference->travel_mm);
}

void print(const std::string& who, const Tally& t) {
  std::cout.precision(3);
  std::cout << who << " | " << t.draws << " (" << t.lost << " lost) | " << t.landmarks.percent() << " | "
            << t.retractor.percent() << " | " << t.mean.percent() << " | " << t.travel.percent() << " | "
            << t.vesselsMax.percent() << " | " << t.truthLandmarks.percent() << " | " << t.truthRetractor.percent()
            << " | " << t.truthTravel.percent() << " | " << t.plain_s << " | " << t.spread_s << "\n"
            << std::flush;
}

void add(Tally& all, const Tally& one) {
  for (Coverage Tally::*c : {&Tally::landmarks, &Tally::retractor, &Tally::mean, &Tally::travel, &Tally::vesselsMax,
                             &Tally::truthLandmarks, &Tally::truthRetractor, &Tally::truthTravel}) {
    (all.*c).inside += (one.*c).inside;
    (all.*c).of += (one.*c).of;
  }
  all.lost += one.lost, all.draws += one.draws, all.plain_s += one.plain_s, all.spread_s += one.spread_s;
}

}  // namespace

int main(int argc, char** argv) {
  const int patients = argc > 1 ? std::atoi(argv[1]) : 1, draws = argc > 2 ? std::atoi(argv[2]) : 2;
  const double cell_mm = argc > 3 ? std::atof(argv[3]) : 8.0;
  phantom::PhantomOptions options;
  options.cases = patients;
  options.paperCohort = true;
  options.seed = argc > 4 ? static_cast<std::uint64_t>(std::atoll(argv[4])) : 77;
  const PrivateFolder work;
  const std::filesystem::path folder = work.path() / "patient";
  std::cout << "patient | draws | landmarks % | at retractor % | mean % | travel % | vessels' largest % | truth: "
               "landmarks % | "
               "at retractor % | travel % | plain s | uncertainty s\n";
  Tally all;
  int number = 0;
  for (const phantom::CaseDraw& draw : phantom::drawCohort(options)) {
    phantom::PhantomOptions one = options;
    one.shear_kPa = draw.shear_kPa;
    const phantom::PhantomPatient p = phantom::makePhantom(draw.seed, one);
    phantom::writePhantom(p, folder);
    pipeline::Scene scene = pipeline::readScene(folder / "scene.json");
    scene.geometry.cell_mm.setConstant(cell_mm);
    scene.outputs = {};
    scene.outputs.vessels = true;
    scene.setup.seed = static_cast<std::uint64_t>(++number);
    scene.uncertainty.emplace();
    const pipeline::Inputs inputs = pipeline::loadInputs(scene);
    const double start = seconds();
    const pipeline::RunResult r = pipeline::run(scene, {.output = {}, .discretisation = false}, {}, &inputs);
    Tally t;
    for (const pipeline::PlanStep& s : r.plan)
      if (s.step == "uncertainty") t.spread_s = s.seconds;
    t.plain_s = seconds() - start - t.spread_s;
    const std::string who = std::to_string(number) + ", " + std::to_string(draw.shear_kPa).substr(0, 4) + " kPa";
    if (!r.uncertainty || !r.uncertainty->known) {
      std::cout << who << " | no interval: " << (r.uncertainty ? r.uncertainty->why : "one of the runs is no answer")
                << "\n";
      std::filesystem::remove_all(folder);
      continue;
    }
    drawsOf(scene, inputs, r, draws, t);
    truthOf(scene, inputs, p, r, t);
    std::filesystem::remove_all(folder);  // the runs above look for its files, to say which they were
    print(who + ", first order misses " +
              (r.uncertainty->missedShare ? std::to_string(100 * *r.uncertainty->missedShare).substr(0, 4) + " %"
                                          : "unknown"),
          t);
    add(all, t);
  }
  print("all", all);
  return all.draws > 0 && all.landmarks.of > 0 ? 0 : 1;
}
