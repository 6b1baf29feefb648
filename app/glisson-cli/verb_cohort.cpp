// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>
#include <iostream>
#include <sstream>

#include "base/error.h"
#include "cohort/cohort.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct CohortArguments {
  std::filesystem::path patients;
  cohort::CohortOptions options;
  std::filesystem::path scene;
  std::string shard;
  bool noSensitivity = false;
  std::vector<std::filesystem::path> shards;
};

/// "2/8" → shard 2 of 8.
void readShard(const std::string& text, cohort::CohortOptions& options) {
  if (text.empty()) return;
  const std::size_t slash = text.find('/');
  const char* end = text.data() + text.size();
  const auto a = std::from_chars(text.data(), end, options.shard);
  const bool first = a.ec == std::errc() && slash != std::string::npos && a.ptr == text.data() + slash;
  const auto b = first ? std::from_chars(a.ptr + 1, end, options.shards) : a;
  if (!first || b.ec != std::errc() || b.ptr != end)
    throw BadInput("--shard is i/n, e.g. 2/8; \"" + text + "\" is not");
}

int report(const Context& context, const cohort::CohortResult& r, const cohort::CohortOptions& options) {
  Json j = r.json.empty()
               ? Json{{"schema", "glisson/cohort-shard/1"}, {"shard", options.shard}, {"shards", options.shards}}
               : Json::parse(r.json);
  if (r.json.empty()) {
    j["cases"] = Json::array();
    for (const cohort::CaseOutcome& c : r.cases)
      j["cases"].push_back({{"id", c.id},
                            {"status", c.status == cohort::CaseOutcome::Status::Done       ? "done"
                                       : c.status == cohort::CaseOutcome::Status::Rejected ? "rejected"
                                                                                           : "failed"},
                            {"reason", c.reason}});
  }
  j["files"] = Json::array();
  for (const auto& f : r.files) j["files"].push_back(f.string());
  std::ostringstream text;
  std::size_t done = 0, resumed = 0;
  for (const cohort::CaseOutcome& c : r.cases) {
    if (c.status == cohort::CaseOutcome::Status::Done) {
      ++done;
      if (c.resumed) ++resumed;
    }
    if (!c.reason.empty()) text << c.id << "  left out: " << c.reason << "\n";
  }
  text << done << " of " << r.cases.size() << " patients done";
  if (resumed > 0) text << ", " << resumed << " of them before";
  text << "\n";
  if (!r.json.empty()) {
    const Json& s = j["stiffness"];
    const Json& d = j["retraction"];
    if (s["measured"].get<int>() > 0)
      text << "stiffness    " << 100.0 * s["fraction_over_1kPa"].get<double>() << " % more than 1 kPa above the atlas, "
           << 100.0 * s["fraction_over_twice"].get<double>() << " % more than twice as stiff\n";
    const auto in95 = [&](const char* share) {
      if (!d.contains("how_sure")) return std::string();
      const Json& i = d["how_sure"][share]["interval95"];
      std::ostringstream t;
      t << " (95 %: " << 100.0 * i[0].get<double>() << " to " << 100.0 * i[1].get<double>() << ")";
      return t.str();
    };
    if (d["left"].get<int>() > 0)
      text << "retraction   " << 100.0 * d["fraction_within_voxel"].get<double>() << " %"
           << in95("fraction_within_voxel") << " within one voxel on average, "
           << 100.0 * d["fraction_clinically_significant"].get<double>() << " %"
           << in95("fraction_clinically_significant") << " at 5 mm or more at the retractor\n";
    text << "report       " << (options.output / "report.html").string() << "\n";
  }
  context.print(j, text.str());
  if (r.complete()) return Ok;
  context.note(std::to_string(r.cases.size() - done) + " of " + std::to_string(r.cases.size()) +
               " patients left out; the reasons are in " + (options.shards > 1 ? "each result.json" : "rejected.csv"));
  return PartialBatch;
}

void addShared(CLI::App* verb, const std::shared_ptr<CohortArguments>& a) {
  verb->add_option("--jobs", a->options.jobs, "patients at a time, 0 = what cores and memory allow")
      ->check(CLI::Range(0, 1024));
  verb->add_option("--scene", a->scene, "scene whose geometry is replaced by each patient's")->type_name(value::file);
  verb->add_flag("--as-published", a->options.asPublished, "histogram of Young's moduli against 2.1 kPa");
  verb->add_flag("--no-sensitivity", a->noSensitivity, "leave out the chosen four under other assumptions");
}

cohort::CohortOptions prepared(const CohortArguments& a, const Context& context) {
  cohort::CohortOptions options = a.options;
  options.output = context.output.empty() ? std::filesystem::path("glisson-cohort") : context.output;
  options.executable = std::filesystem::read_symlink("/proc/self/exe");
  if (!a.scene.empty()) options.scene = a.scene;
  options.sensitivity = !a.noSensitivity;
  return options;
}

}  // namespace

void addCohort(CLI::App& app, Context& context) {
  CLI::App* verb =
      app.add_subcommand("cohort", "the paper's studies over a folder of patients; resumes where it stopped");
  verb->fallthrough();
  auto a = std::make_shared<CohortArguments>();
  verb->add_option("patients", a->patients, "folder with one folder per patient")->type_name(value::folder);
  verb->add_option("--shard", a->shard, "i/n: only every n-th patient, for array jobs; then cohort merge");
  verb->add_flag("--uncertainty", a->options.uncertainty,
                 "say how sure every patient is, and give the shares their intervals (four times as long)");
  verb->add_flag("--reports", a->options.reports,
                 "a report of every patient, as HTML and PDF, with its run record (15 s of processor time each)");
  addShared(verb, a);

  CLI::App* merge = verb->add_subcommand("merge", "put the results of shards together and summarise them");
  auto m = std::make_shared<CohortArguments>();
  merge->add_option("shards", m->shards, "output folders of all shards")->type_name(value::folder)->required();
  merge
      ->add_option("--data", m->patients, "the patients again, for the overlays and the sensitivity of the chosen four")
      ->type_name(value::folder);
  addShared(merge, m);
  merge->callback([&context, m] {
    context.action = [&context, m] {
      const cohort::CohortOptions options = prepared(*m, context);
      return report(context, cohort::mergeCohort(m->shards, m->patients, options, context.progress()), options);
    };
  });
  verb->callback([&context, a, merge] {
    if (merge->parsed()) return;
    if (a->patients.empty()) throw CLI::RequiredError("patients: the folder with one folder per patient");
    context.action = [&context, a] {
      cohort::CohortOptions options = prepared(*a, context);
      readShard(a->shard, options);
      return report(context, cohort::runCohort(a->patients, options, context.progress()), options);
    };
  });
}

}  // namespace glisson::cli
