// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/credibility.h"

#include <algorithm>
#include <array>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/version.h"
#include "report/page.h"
#include "study/detail/credibility_parts.h"
#include "study/rows.h"

namespace glisson::study {
namespace {

namespace fs = std::filesystem;

struct Part {
  CredibilityTopic topic;
  const char* what;
  const char* command;
  std::function<Lines(const Progress&)> make;
  double share;  ///< of the time, roughly
};

/// What the page says of a part that ended in an error.
Evidence failed(const Part& part, const std::string& message) {
  Evidence e;
  e.topic = part.topic;
  e.state = EvidenceState::NotRun;
  e.what = part.what;
  e.command = part.command;
  e.why = "ended with: " + message;
  return e;
}

}  // namespace

std::string nameOf(CredibilityTopic topic) {
  constexpr std::array<const char*, credibilityTopics> names = {
      "Context of use", "Code verification", "Calculation verification", "Validation", "Uncertainty", "Applicability"};
  return names[static_cast<std::size_t>(topic)];
}

std::string nameOf(EvidenceState state) {
  constexpr std::array<const char*, 5> names = {"met", "missed", "shown", "stated", "not run"};
  return names[static_cast<std::size_t>(state)];
}

Credibility studyCredibility(const CredibilityOptions& options, const Progress& progress) {
  using enum CredibilityTopic;
  const std::vector<Part> parts = {
      {ContextOfUse, "context of use", "", [](const Progress&) { return statedContext(); }, 0.0},
      {CodeVerification, "manufactured solutions", "glisson-cli validate --credibility",
       [&](const Progress& p) { return manufacturedLines(options, p); }, 1.0},
      {CodeVerification, "cantilever", "glisson-cli validate beam",
       [&](const Progress& p) { return beamLines(options, p); }, 2.0},
      {CodeVerification, "contact and large deformation", "glisson-cli validate contact",
       [&](const Progress& p) { return contactLines(options, p); }, 3.0},
      {CodeVerification, "stiff and extreme scenes", "glisson-cli stability",
       [&](const Progress& p) { return stabilityLines(options, p); }, 5.0},
      {CalculationVerification, "a synthetic patient", "glisson-cli demo",
       [&](const Progress& p) { return patientLines(options, p); }, options.quick ? 3.0 : 8.0},
      {Validation, "validation", "", [](const Progress&) { return statedValidation(); }, 0.0},
      {Applicability, "applicability", "", [](const Progress&) { return statedApplicability(); }, 0.0}};
  double whole = 0.0, done = 0.0;
  for (const Part& part : parts) whole += part.share;
  Credibility study{options, {}};
  for (const Part& part : parts) {
    const Progress own = progress.part(done / whole, (done + part.share) / whole);
    done += part.share;
    try {
      for (Evidence& e : part.make(own)) study.lines.push_back(std::move(e));
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& e) {
      study.lines.push_back(failed(part, e.what()));
    }
  }
  std::stable_sort(study.lines.begin(), study.lines.end(),
                   [](const Evidence& a, const Evidence& b) { return a.topic < b.topic; });
  progress.report(1.0, "credibility");
  return study;
}

std::string table(const Credibility& study) {
  std::string text;
  for (const Evidence& e : study.lines) {
    text += nameOf(e.topic) + ": " + e.what + ": " + nameOf(e.state);
    for (const std::string* part : {&e.found, &e.wanted, &e.why})
      if (!part->empty()) text += "; " + (part == &e.wanted ? "wanted " + *part : *part);
    text += "\n";
  }
  return text;
}

std::vector<fs::path> writeCredibility(const fs::path& folder, const Credibility& study) {
  report::Page page("Credibility of Glisson " + version());
  page.paragraph("After ASME V&V 40-2018. Every figure was computed for this page by commit " + buildCommit() +
                 ", the lines marked 'not run' were not; each line names the command that gives it again." +
                 (study.options.quick ? " Quick: coarser grids, and no uncertainty of the patient." : ""));
  for (int t = 0; t < credibilityTopics; ++t) {
    const auto topic = static_cast<CredibilityTopic>(t);
    page.heading(nameOf(topic));
    std::vector<std::vector<std::string>> rows;
    for (const Evidence& e : study.lines)
      if (e.topic == topic)
        rows.push_back({e.what, nameOf(e.state), e.found + (e.why.empty() ? "" : (e.found.empty() ? "" : "; ") + e.why),
                        e.wanted, e.command});
    if (rows.empty())
      page.warning("Nothing was done here.");
    else
      page.table({"What", "", "Found", "Wanted", "Command"}, rows);
  }
  fs::create_directories(folder);
  std::vector<fs::path> files;
  for (const auto& [name, text] :
       {std::pair{"credibility.html", report::html(page)}, {"credibility.pdf", report::pdf(page)}}) {
    files.push_back(folder / name);
    writeAtomically(files.back(), text);
  }
  return files;
}

}  // namespace glisson::study
