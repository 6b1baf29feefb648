// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "pacs/query.h"
#include "pacs/retrieve.h"
#include "pacs/send.h"
#include "verbs.h"

namespace glisson::cli {
namespace {

struct PacsArguments {
  pacs::Node node;
  pacs::Query query;
  std::string date;
  pacs::RetrieveOptions get;
  pacs::ReceiveOptions receive;
  int receiveFor_s = 0;
  std::size_t receiveCount = 0;
  std::vector<std::filesystem::path> files;
};

/// What a stranger sends must not take the computer's memory, nor leave images of a patient in a core dump.
void limitProcess() {
  std::ifstream own("/proc/self/statm");
  rlim_t pages = 0;
  if (own >> pages) {
    const rlim_t most = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{3} << 30);
    rlimit memory{};
    getrlimit(RLIMIT_AS, &memory);
    memory.rlim_cur = std::min(memory.rlim_max, most);
    setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  std::signal(SIGPIPE, SIG_IGN);
}

Json orNull(int number) {
  return number < 0 ? Json(nullptr) : Json(number);
}

Json toJson(const pacs::Received& r) {
  Json j;
  j["objects"] = r.files.size();
  j["already_there"] = r.alreadyThere;
  j["bytes"] = r.bytes;
  j["files"] = Json::array();
  for (const auto& f : r.files) j["files"].push_back(f.filename().string());
  j["refused"] = Json::array();
  for (const pacs::Refusal& f : r.refused) j["refused"].push_back({{"reason", f.reason}, {"count", f.count}});
  return j;
}

std::string toText(const pacs::Received& r) {
  std::ostringstream text;
  text << r.files.size() << " objects received";
  if (r.alreadyThere > 0) text << ", " << r.alreadyThere << " were there already";
  text << "\n";
  for (const pacs::Refusal& f : r.refused) text << "refused: " << f.count << " × " << f.reason << "\n";
  return text.str();
}

int echo(const PacsArguments& a, const Context& context) {
  const double seconds = pacs::echo(a.node, context.progress());
  std::ostringstream text;
  text << a.node.calledTitle << " answers after " << static_cast<int>(1000.0 * seconds) << " ms\n";
  context.print({{"answers", true}, {"seconds", seconds}}, text.str());
  return Ok;
}

int find(PacsArguments a, const Context& context) {
  if (!a.date.empty()) a.query.studyDate = pacs::dateRange(a.date);
  const pacs::Found found = pacs::find(a.node, a.query, context.progress());
  Json j;
  j["studies"] = Json::array();
  std::ostringstream text;
  for (const pacs::FoundStudy& s : found.studies) {
    Json one{{"uid", s.uid},
             {"patient", s.patient},
             {"date", s.date},
             {"description", s.description},
             {"modalities", s.modalities},
             {"series_count", orNull(s.seriesCount)},
             {"objects", orNull(s.objects)}};
    text << s.uid << "  patient " << s.patient << "  " << s.date << "  ";
    for (const std::string& m : s.modalities) text << m << " ";
    text << " " << s.description << "\n";
    if (a.query.names) {
      one["patient_name"] = s.patientName;
      one["patient_id"] = s.patientId;
      one["accession"] = s.accession;
      text << "    " << s.patientName << "  " << s.patientId << "  " << s.accession << "\n";
    }
    if (a.query.series) one["series"] = Json::array();
    for (const pacs::FoundSeries& r : s.series) {
      one["series"].push_back({{"uid", r.uid},
                               {"number", r.number},
                               {"modality", r.modality},
                               {"description", r.description},
                               {"objects", orNull(r.objects)}});
      text << "    " << r.uid << "  " << r.number << "  " << r.modality << "  " << r.description << "\n";
    }
    j["studies"].push_back(std::move(one));
  }
  j["truncated"] = found.truncated;
  if (found.studies.empty()) text << "nothing found\n";
  if (found.truncated) text << "there is more: narrow the search, or give a larger --limit\n";
  context.print(j, text.str());
  return Ok;
}

int get(PacsArguments a, const Context& context) {
  limitProcess();
  a.get.folder = context.output;
  const pacs::Retrieved r = pacs::retrieve(a.node, a.get, context.progress());
  Json j = toJson(r.received);
  j["level"] = r.level;
  j["expected"] = orNull(r.expected);
  j["failed"] = r.failed;
  j["complete"] = r.complete;
  std::string text = toText(r.received);
  if (r.expected >= 0) text += "the server said that it has " + std::to_string(r.expected) + "\n";
  if (!r.complete) text += "the " + r.level + " is not complete; the same command again fetches what is missing\n";
  context.print(j, text);
  return r.complete ? Ok : PartialBatch;
}

int receive(PacsArguments a, const Context& context) {
  limitProcess();
  a.receive.folder = context.output;
  if (a.receiveCount > 0) a.receive.count = a.receiveCount;
  if (a.receiveFor_s > 0) a.receive.idle_s = a.receiveFor_s;
  pacs::Receiver receiver(a.receive);
  if (a.receive.bind.rfind("127.", 0) == 0)
    context.note("note: this computer alone can send; --bind opens the port to a network");
  if (a.receive.callers.empty()) context.note("note: any AE title may send; --calling names those that may");
  const Progress progress = context.progress();
  receiver.run(progress);
  const pacs::Received r = receiver.result();
  Json j = toJson(r);
  j["associations"] = r.associations;
  j["rejected"] = r.rejected;
  context.print(j, toText(r));
  // Without an end of its own, it is ended by Ctrl+C.
  if (a.receive.count || a.receive.idle_s) progress.check();
  const bool all = r.refused.empty() && (!a.receive.count || r.files.size() + r.alreadyThere >= *a.receive.count);
  return all ? Ok : PartialBatch;
}

int send(const PacsArguments& a, const Context& context) {
  limitProcess();
  const pacs::Sent s = pacs::send(a.node, a.files, context.progress());
  Json j{{"objects", s.objects}, {"bytes", s.bytes}, {"failed", Json::array()}};
  std::ostringstream text;
  text << s.objects << " objects sent\n";
  for (const pacs::NotSent& f : s.failed) {
    j["failed"].push_back({{"file", f.file.string()}, {"reason", f.reason}});
    text << "not sent: " << f.file.filename().string() << ": " << f.reason << "\n";
  }
  context.print(j, text.str());
  return s.failed.empty() ? Ok : s.objects == 0 ? Failed : PartialBatch;
}

CLI::App* add(CLI::App& verb, Context& context, const std::shared_ptr<PacsArguments>& a, const char* name,
              const char* help, int (*act)(PacsArguments, const Context&)) {
  CLI::App* sub = verb.add_subcommand(name, help);
  sub->callback([&context, a, act] { context.action = [&context, a, act] { return act(*a, context); }; });
  return sub;
}

void addNode(CLI::App& verb, pacs::Node& node) {
  verb.add_option("--host", node.host, "the server's name or address")->capture_default_str();
  verb.add_option("--port", node.port, "the server's port")->capture_default_str();
  verb.add_option("--called", node.calledTitle, "the server's AE title")->capture_default_str();
  verb.add_option("--calling", node.callingTitle, "our AE title")->capture_default_str();
  verb.add_option("--timeout", node.timeout_s, "longest silence, in seconds")->capture_default_str();
}

}  // namespace

void addPacs(CLI::App& app, Context& context) {
  CLI::App* verb = app.add_subcommand(
      "pacs", "query, fetch, receive and send over a DICOM network (not encrypted: for a trusted network)");
  verb->require_subcommand(1);
  auto a = std::make_shared<PacsArguments>();

  addNode(*add(*verb, context, a, "echo", "whether the server answers and knows us (C-ECHO)",
               [](PacsArguments x, const Context& c) { return echo(x, c); }),
          a->node);

  CLI::App* sub = add(*verb, context, a, "find", "list studies and series (C-FIND, study root)", find);
  addNode(*sub, a->node);
  sub->add_option("--patient-id", a->query.patientId, "patient ID; * and ? stand for any text and letter");
  sub->add_option("--patient-name", a->query.patientName, "patient name, e.g. 'DOE^*'");
  sub->add_option("--study-date", a->date, "2026-01-31, or a range 2026-01-01..2026-01-31, either end may be missing");
  sub->add_option("--modality", a->query.modality, "e.g. MR");
  sub->add_option("--accession", a->query.accession, "accession number");
  sub->add_option("--description", a->query.description, "study description");
  sub->add_option("--study", a->query.studyUid, "study UID");
  sub->add_option("--series-uid", a->query.seriesUid, "series UID");
  sub->add_option("--limit", a->query.limit, "most studies, and most series of all")->check(CLI::Range(1, 100000));
  sub->add_flag("--series", a->query.series, "list the series of each study");
  sub->add_flag("--show-names", a->query.names, "ask for and show patient name, patient ID and accession number");

  sub = add(*verb, context, a, "get", "fetch a study or a series into the folder --output (C-GET, or C-MOVE)", get);
  addNode(*sub, a->node);
  sub->add_option("uid", a->get.uid, "study or series UID, as `pacs find` lists it")->required();
  sub->add_option("--study", a->get.studyUid, "study UID of a series, for servers that need it");
  sub->add_flag("--move", a->get.move, "by C-MOVE to a receiver of our own, where the server has no C-GET");
  sub->add_option("--receive-port", a->get.receivePort, "with --move: the port on which the server sends to us");
  sub->add_option("--sender", a->get.sender, "with --move: AE title that sends to us, where it is not --called");

  sub = add(*verb, context, a, "receive", "receive objects into the folder --output until done (C-STORE)", receive);
  sub->add_option("--port", a->receive.port, "port to listen on")->required();
  sub->add_option("--bind", a->receive.bind, "address to listen on; 0.0.0.0 = every network of this computer")
      ->capture_default_str();
  sub->add_option("--called", a->receive.title, "our AE title: calls to another one are rejected")
      ->capture_default_str();
  sub->add_option("--calling", a->receive.callers, "AE titles that may send; any where none is given");
  sub->add_option("--count", a->receiveCount, "end after so many objects");
  sub->add_option("--timeout", a->receiveFor_s, "end after so many seconds without an association");
  sub->add_option("--pdu-timeout", a->receive.timeout_s, "longest silence inside an association, in seconds")
      ->capture_default_str();

  sub = add(*verb, context, a, "send", "send DICOM files and folders to a server (C-STORE)",
            [](PacsArguments x, const Context& c) { return send(x, c); });
  addNode(*sub, a->node);
  sub->add_option("files", a->files, "files and folders")->type_name(value::fileOrFolder)->required();
}

}  // namespace glisson::cli
