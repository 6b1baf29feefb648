// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "report/text.h"
#include "study/beam.h"
#include "study/contact_study.h"
#include "study/detail/credibility_parts.h"
#include "study/detail/manufactured.h"
#include "study/stability.h"

namespace glisson::study {
namespace {

using report::number;
using enum CredibilityTopic;

std::string command(const std::string& verb, const CredibilityOptions& options) {
  return "glisson-cli " + verb + (options.quick ? " --quick" : "");
}

}  // namespace

Lines manufacturedLines(const CredibilityOptions& options, const Progress& progress) {
  constexpr double wantedOrder = 1.8;  // of 2, which is reached in the limit only
  Lines lines;
  constexpr std::array<std::pair<Manufactured, int>, 2> kinds = {
      {{Manufactured::VaryingModulus, 12}, {Manufactured::FiniteStrain, 8}}};
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto& [kind, cells] = kinds[k];
    const double from = 0.5 * static_cast<double>(k);
    const ManufacturedResult r =
        solveManufactured(kind, options.quick ? cells / 2 / 2 * 2 : cells, progress.part(from, from + 0.5));
    Evidence e;
    e.topic = CodeVerification;
    e.what = "manufactured solution: " + r.what;
    e.command = command("validate --credibility", options);
    e.found = "error falls with order " + number(r.order, 3) + " from " + std::to_string(r.coarse) + " to " +
              std::to_string(r.fine) + " cells along an edge, to " + number(r.fineError, 2) +
              " of the largest displacement";
    e.wanted = "converged, order at least " + number(wantedOrder, 2);
    e.state = r.converged && r.order >= wantedOrder ? EvidenceState::Met : EvidenceState::Missed;
    if (!r.converged) e.why = "a solve did not converge";
    e.figures = {{"order", r.order, ""}, {"coarse_error", r.coarseError, ""}, {"fine_error", r.fineError, ""}};
    lines.push_back(e);
  }
  Evidence contact;
  contact.topic = CodeVerification;
  contact.what = "manufactured solution: contact";
  contact.why = "there is none; closed forms and another program stand for it in the lines of validate contact";
  lines.push_back(contact);
  return lines;
}

Lines beamLines(const CredibilityOptions& options, const Progress& progress) {
  BeamOptions beam;
  beam.quick = options.quick;
  const BeamStudy s = studyBeam(beam, progress);
  Lines lines;
  for (const BeamGoal& g : s.goals) {
    Evidence e;
    e.topic = CodeVerification;
    e.what = "cantilever: " + g.what + ", Poisson's ratio " + number(g.poisson, 3);
    e.command = command("validate beam", options);
    e.found = number(g.value, 3) + " " + g.quantity + (g.beside.empty() ? "" : " (" + g.beside + ")");
    e.wanted = (g.quantity == "mm" ? "at most " : "at least ") + number(g.limit, 3) + " " + g.quantity;
    e.state = g.met() ? EvidenceState::Met : EvidenceState::Missed;
    e.figures = {{g.what, g.value, g.quantity == "mm" ? "mm" : ""}};
    lines.push_back(e);
  }
  Evidence e;
  e.topic = CodeVerification;
  e.state = EvidenceState::Shown;
  e.what = "cantilever: the reference itself";
  e.command = command("validate beam", options);
  e.found = "converged 3-D on " + s.clamped.grid + ", order " + number(s.clamped.order, 3) + ", uncertain by " +
            number(s.clamped.uncertainty_mm, 2) + " mm; with a free root " + number(s.gapTimoshenkoTip_mm, 2) +
            " mm from Timoshenko's theory at the tip";
  e.figures = {{"order", s.clamped.order, ""},
               {"uncertainty", s.clamped.uncertainty_mm, "mm"},
               {"gap_to_timoshenko", s.gapTimoshenkoTip_mm, "mm"}};
  lines.push_back(e);
  return lines;
}

Lines contactLines(const CredibilityOptions& options, const Progress& progress) {
  const ContactStudy s = studyContact({options.quick}, progress);
  std::map<std::string, const Row*> closest;
  for (const Row& r : s.rows) {
    if (!r.converged || !std::isfinite(r.max_error_mm)) continue;
    const Row*& best = closest[r.reference];
    if (best == nullptr || r.max_error_mm < best->max_error_mm) best = &r;
  }
  Lines lines;
  for (const char* reference : {hertz, calculix, elastica}) {
    Evidence e;
    e.topic = CodeVerification;
    e.what = std::string("contact and large deformation against ") + reference;
    e.command = command("validate contact", options);
    if (const Row* r = closest[reference]) {
      e.state = EvidenceState::Shown;
      e.found = "largest error " + number(r->max_error_mm, 3) + " mm, " + r->method + ", " + r->resolution;
      e.figures = {{"max_error", r->max_error_mm, "mm"}, {"dofs", static_cast<double>(r->dofs), ""}};
    } else {
      e.state = EvidenceState::Missed;
      e.why = "no solve converged";
    }
    lines.push_back(e);
  }
  return lines;
}

Lines stabilityLines(const CredibilityOptions& options, const Progress& progress) {
  const std::vector<StabilityCase> cases = stabilitySweep({options.quick}, progress);
  Evidence e;
  e.topic = CodeVerification;
  e.what = "stiff and extreme scenes";
  e.command = command("stability", options);
  int failed = 0, refused = 0;
  for (const StabilityCase& c : cases) {
    refused += c.verdict == "refused as expected" ? 1 : 0;
    if (c.verdict != "fail") continue;
    ++failed;
    e.why += (e.why.empty() ? "not as expected: " : ", ") + c.name;
  }
  const int all = static_cast<int>(cases.size());
  e.found = std::to_string(all - failed) + " of " + std::to_string(all) + " as expected, " + std::to_string(refused) +
            " of them refused with a reason";
  e.wanted = "all";
  e.state = allAsExpected(cases) ? EvidenceState::Met : EvidenceState::Missed;
  e.figures = {{"cases", static_cast<double>(all), ""},
               {"failed", static_cast<double>(failed), ""},
               {"refused", static_cast<double>(refused), ""}};
  return {e};
}

}  // namespace glisson::study
