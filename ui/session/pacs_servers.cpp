// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/pacs_servers.h"

#include <QSettings>
#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/sha256.h"

namespace glisson::session {

namespace {

namespace fs = std::filesystem;
const QString arrayKey = QStringLiteral("pacs");

std::string digestOf(const std::string& uid) {
  return "study-" + sha256(uid.data(), uid.size()).substr(0, 16);
}

void add(const pacs::Retrieved& one, Fetched& all) {
  all.objects += one.received.files.size();
  all.alreadyThere += one.received.alreadyThere;
  all.complete = all.complete && one.complete;
  for (const pacs::Refusal& refusal : one.received.refused) {
    auto found = std::find_if(all.refused.begin(), all.refused.end(),
                              [&](const pacs::Refusal& r) { return r.reason == refusal.reason; });
    if (found == all.refused.end())
      all.refused.push_back(refusal);
    else
      found->count += refusal.count;
  }
}

}  // namespace

std::vector<PacsServer> keptServers() {
  QSettings settings;
  std::vector<PacsServer> servers;
  const int count = settings.beginReadArray(arrayKey);
  for (int n = 0; n < count; ++n) {
    settings.setArrayIndex(n);
    PacsServer s;
    const auto text = [&settings](const char* key, const std::string& otherwise) {
      return settings.value(QLatin1String(key), QString::fromStdString(otherwise)).toString().toStdString();
    };
    s.name = settings.value(QStringLiteral("name")).toString();
    s.node.host = text("host", s.node.host);
    s.node.port = settings.value(QStringLiteral("port"), s.node.port).toInt();
    s.node.calledTitle = text("called", s.node.calledTitle);
    s.node.callingTitle = text("calling", s.node.callingTitle);
    s.node.timeout_s = settings.value(QStringLiteral("timeout_s"), s.node.timeout_s).toInt();
    s.move = settings.value(QStringLiteral("move"), false).toBool();
    s.receivePort = settings.value(QStringLiteral("receivePort"), s.receivePort).toInt();
    servers.push_back(std::move(s));
  }
  settings.endArray();
  return servers;
}

void keepServers(const std::vector<PacsServer>& servers) {
  QSettings settings;
  settings.remove(arrayKey);
  settings.beginWriteArray(arrayKey, static_cast<int>(servers.size()));
  for (std::size_t n = 0; n < servers.size(); ++n) {
    const PacsServer& s = servers[n];
    settings.setArrayIndex(static_cast<int>(n));
    settings.setValue(QStringLiteral("name"), s.name);
    settings.setValue(QStringLiteral("host"), QString::fromStdString(s.node.host));
    settings.setValue(QStringLiteral("port"), s.node.port);
    settings.setValue(QStringLiteral("called"), QString::fromStdString(s.node.calledTitle));
    settings.setValue(QStringLiteral("calling"), QString::fromStdString(s.node.callingTitle));
    settings.setValue(QStringLiteral("timeout_s"), s.node.timeout_s);
    settings.setValue(QStringLiteral("move"), s.move);
    settings.setValue(QStringLiteral("receivePort"), s.receivePort);
  }
  settings.endArray();
}

Fetched fetch(const PacsServer& server, const std::vector<FetchWish>& wishes, const fs::path& folder,
              const Progress& progress) {
  if (wishes.empty()) throw BadInput("choose a study or a series first");
  if (folder.empty()) throw BadInput("choose a folder for what is fetched");
  Fetched all;
  std::set<fs::path> folders;
  const auto count = static_cast<double>(wishes.size());
  for (std::size_t n = 0; n < wishes.size(); ++n) {
    const FetchWish& wish = wishes[n];
    pacs::RetrieveOptions options;
    options.uid = wish.seriesUid.empty() ? wish.studyUid : wish.seriesUid;
    if (!wish.seriesUid.empty()) options.studyUid = wish.studyUid;
    options.folder = folder / digestOf(wish.studyUid);
    options.move = server.move;
    options.receivePort = server.move ? server.receivePort : 0;
    folders.insert(options.folder);
    add(pacs::retrieve(server.node, options,
                       progress.part(static_cast<double>(n) / count, static_cast<double>(n + 1) / count)),
        all);
  }
  all.folder = folders.size() == 1 ? *folders.begin() : folder;
  return all;
}

SentAway sendAway(const pacs::Node& node, const SendWish& wish, const ExportSource* source, const Progress& progress) {
  pacs::check(node);
  SentAway away;
  std::vector<fs::path> paths = wish.paths;
  std::optional<PrivateFolder> made;
  if (!wish.formats.empty() && source != nullptr) {
    ExportWish formats;
    formats.formats = wish.formats;
    formats.folder = made.emplace().path() / "export";
    pipeline::Exported exported = exportFormats(*source, formats, progress.part(0.0, 0.5));
    paths.insert(paths.end(), exported.files.begin(), exported.files.end());
    away.refused = std::move(exported.refused);
  }
  if (paths.empty())
    throw BadInput(away.refused.empty() ? "there is nothing to send: tick what is shown, or add files"
                                        : "nothing could be made to send: " + away.refused.front().reason);
  away.sent = pacs::send(node, paths, progress.part(0.5, 1.0));
  return away;
}

}  // namespace glisson::session
