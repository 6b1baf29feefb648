// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <optional>

#include "base/private_folder.h"
#include "base/quantity.h"
#include "base/version.h"
#include "phantom/phantom.h"
#include "pipeline/run.h"
#include "report/text.h"
#include "study/detail/credibility_parts.h"

namespace glisson::study {
namespace {

using pipeline::RunResult;
using report::number;
using enum CredibilityTopic;

Evidence line(CredibilityTopic topic, EvidenceState state, const std::string& what, const std::string& command) {
  Evidence e;
  e.topic = topic;
  e.state = state;
  e.what = what;
  e.command = command;
  return e;
}

std::string mm(double v) {
  return number(v, 3) + " mm";
}

/// The commands that give the patient and its run again.
std::string commands(const CredibilityOptions& options, const std::string& last) {
  return "glisson-cli phantom --cases 1 --seed " + std::to_string(options.seed) + " --output patients; " + last;
}

Evidence measured(const RunResult& r, const phantom::PhantomTruth& truth, const std::string& command) {
  Evidence e = line(CalculationVerification, EvidenceState::NotRun,
                    "from DICOM to the mean stiffness, against the synthetic patient's truth", command);
  if (!r.stiffness) {
    e.why = "the run measured no stiffness";
    return e;
  }
  const auto& pooled = r.stiffness->pooled;
  const double off = std::abs(r.stiffness->shear_mean_kPa - truth.shear_kPa);
  // An outline drawn by hand takes in and leaves out voxels at its border: 0.5 %, on top of the noise of the mean.
  const double allowed = 5.0 * truth.noise_kPa / std::sqrt(static_cast<double>(pooled.n)) + 0.005 * truth.shear_kPa;
  e.state = off <= allowed ? EvidenceState::Met : EvidenceState::Missed;
  e.found = number(off, 2) + " kPa from " + number(truth.shear_kPa, 4) + " kPa (" +
            number(100 * off / truth.shear_kPa, 2) + " %), " + std::to_string(pooled.n) + " voxels";
  e.wanted = "at most " + number(allowed, 2) + " kPa";
  e.figures = {{"difference", off, "kPa"}, {"truth", truth.shear_kPa, "kPa"}};
  return e;
}

Evidence solvers(const RunResult& r, const std::string& command) {
  Evidence e = line(CalculationVerification, EvidenceState::Missed, "solver, measured and textbook stiffness", command);
  const bool both = r.primary.solver.converged() && (!r.atlas || r.atlas->solver.converged());
  if (both) e.state = EvidenceState::Met;
  e.found = "relative residual " + number(r.primary.solver.residual, 2);
  e.figures = {{"residual", r.primary.solver.residual, ""}};
  if (r.atlas) {
    e.found += " and " + number(r.atlas->solver.residual, 2);
    e.figures.push_back({"residual_textbook", r.atlas->solver.residual, ""});
  }
  e.wanted = "at most " + number(r.primary.solver.tolerance, 2);
  if (!both) e.why = "did not converge";
  return e;
}

Evidence balance(const RunResult& r, const std::string& command) {
  Evidence e = line(CalculationVerification, EvidenceState::Shown, "balance of forces", command);
  const double off = (r.primary.load_N + r.primary.reaction_N).norm();
  e.found = "loads and reactions add up to " + number(off, 2) + " N of " + number(r.primary.load_N.norm(), 3) + " N";
  e.figures = {{"sum", off, "N"}, {"load", r.primary.load_N.norm(), "N"}};
  return e;
}

Evidence cells(const RunResult& r, const std::string& command) {
  Evidence e = line(CalculationVerification, EvidenceState::NotRun, "error from the size of the cells", command);
  if (!r.discretisation || !r.discretisation->known) {
    e.why = r.discretisation ? r.discretisation->note : "no estimate was made";
    return e;
  }
  e.state = EvidenceState::Shown;
  e.found =
      "displacement " + mm(r.discretisation->mean_mm) + " on average, " + mm(r.discretisation->max_mm) + " at most";
  e.figures = {{"mean", r.discretisation->mean_mm, "mm"}, {"max", r.discretisation->max_mm, "mm"}};
  if (r.discretisation->difference && r.difference) {
    const auto& d = *r.discretisation->difference;
    e.found += "; difference of the two predictions " + mm(d.mean_mm) + " of " + mm(r.difference->mean_mm);
    e.figures.push_back({"difference_mean", d.mean_mm, "mm"});
    if (d.at_retractor_mm) {
      e.found += " on average, " + mm(*d.at_retractor_mm) + " of " + mm(r.difference->at_retractor_mm) + " at the bar";
      e.figures.push_back({"difference_at_retractor", *d.at_retractor_mm, "mm"});
    }
  }
  return e;
}

Evidence howSure(const RunResult& r, const CredibilityOptions& options, const std::string& command) {
  Evidence e =
      line(Uncertainty, EvidenceState::NotRun, "of the predicted difference, from the sources of the scene", command);
  if (options.quick) {
    e.why = "left out by --quick";
    return e;
  }
  if (!r.uncertainty || !r.uncertainty->known) {
    e.why = r.uncertainty ? r.uncertainty->why : "the run gave none";
    return e;
  }
  e.state = EvidenceState::Shown;
  e.found = uncertainty::inWords(r.uncertainty->spread);
  if (const auto& h = r.uncertainty->spread.headline)
    e.figures = {{"at_retractor_low", h->at_retractor_mm.low, "mm"},
                 {"at_retractor_high", h->at_retractor_mm.high, "mm"},
                 {"probability_beyond_5mm", h->beyond, ""}};
  if (const auto& missed = r.uncertainty->missedShare) e.figures.push_back({"missed_by_first_order", *missed, ""});
  return e;
}

Evidence kinematics(const RunResult& r, const std::string& command) {
  Evidence e = line(Applicability, EvidenceState::Missed, "kinematics of this patient's retraction", command);
  if (r.primary.linearTrusted) e.state = EvidenceState::Met;
  e.found = "strain " + number(100 * r.primary.p95_strain, 2) + " % at most in 95 % of the liver, rotation " +
            number(r.primary.max_rotation_deg, 2) + " degrees at most";
  e.wanted = "inside what the kinematics used can tell";
  if (!r.primary.validity.empty()) e.why = r.primary.validity.front();
  e.figures = {{"p95_strain", r.primary.p95_strain, ""}, {"max_rotation", r.primary.max_rotation_deg, "deg"}};
  return e;
}

}  // namespace

Lines patientLines(const CredibilityOptions& options, const Progress& progress) {
  phantom::PhantomOptions one;
  one.seed = options.seed;
  const phantom::CaseDraw draw = phantom::drawCohort(one).front();
  one.shear_kPa = draw.shear_kPa;
  const phantom::PhantomPatient patient = phantom::makePhantom(draw.seed, one, progress.part(0.0, 0.1));
  const PrivateFolder folder;
  phantom::writePhantom(patient, folder.path());
  pipeline::Scene scene = pipeline::readScene(folder.path() / "scene.json");
  if (!options.quick) scene.uncertainty.emplace();
  const RunResult r = pipeline::run(scene, {}, progress.part(0.1, 1.0));
  const std::string place = "patients/patient-001/";
  const std::string run = commands(options, "glisson-cli run " + place + "scene.json --output run");
  return {measured(r, patient.truth,
                   commands(options, "glisson-cli measure --mre " + place + "mre --roi " + place + "rtstruct.dcm")),
          solvers(r, run),
          balance(r, run),
          cells(r, run),
          howSure(r, options, commands(options, "glisson-cli run " + place + "scene.json --uncertainty --output run")),
          kinematics(r, run)};
}

Lines statedContext() {
  Evidence question = line(ContextOfUse, EvidenceState::Stated, "question of interest", "");
  question.found =
      "where a patient's hepatic vessels end up when the liver is retracted, and whether the patient's own stiffness "
      "instead of a textbook's changes that by " +
      number(defaults::clinicallySignificant.mm(), 2) + " mm or more";
  Evidence use = line(ContextOfUse, EvidenceState::Stated, "use", "");
  use.found =
      std::string(researchUseOnly) +
      ": studies of simulated retractions from MRI and MR elastography; no diagnosis, no treatment of a patient";
  Evidence risk = line(ContextOfUse, EvidenceState::Stated, "model risk", "");
  risk.found =
      "no decision about a patient rests on it, so no consequence is graded here; another use needs its own page";
  return {question, use, risk};
}

Lines statedValidation() {
  Evidence experiments = line(Validation, EvidenceState::NotRun, "experiments on retracted livers or phantoms", "");
  experiments.why = "no measured retraction comes with this program; nothing here says how near to a real liver it is";
  Evidence published = line(Validation, EvidenceState::NotRun, "the published cohort, studies 1 and 2",
                            "glisson-cli phantom --cases 120 --cohort paper --seed 1 --output patients; glisson-cli "
                            "cohort patients --output cohort");
  published.why = "takes most of an hour; its patients are synthetic, so it compares conclusions and not measurements";
  Evidence data = line(Validation, EvidenceState::NotRun, "public images and elastograms", "ctest -R cli.real_data");
  data.why = "public data are not part of the program; the tests read them where they lie beside the source";
  return {experiments, published, data};
}

Lines statedApplicability() {
  Evidence patients = line(Applicability, EvidenceState::Stated, "livers that were computed", "");
  patients.found =
      "synthetic ones, one for the lines above; real anatomy, disease and deformed rest shapes are outside what was "
      "shown";
  Evidence supports = line(Applicability, EvidenceState::Stated, "what holds the liver", "");
  supports.found =
      "supports, capsule and abdomen are assumed, not measured; run --uncertainty says what they are worth in one "
      "patient, "
      "cohort what they are worth in many";
  return {patients, supports};
}

}  // namespace glisson::study
