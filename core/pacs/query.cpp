// SPDX-License-Identifier: GPL-3.0-or-later
#include "pacs/query.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <map>
#include <memory>
#include <optional>

#include "pacs/detail/association.h"
#include "pacs/detail/identifier.h"
#include "pacs/detail/syntaxes.h"
#include "pacs/detail/trouble.h"

namespace glisson::pacs {

using namespace detail;

namespace {

enum Tag : std::uint32_t {
  StudyDate = 0x00080020,
  AccessionNumber = 0x00080050,
  QueryLevel = 0x00080052,
  Modality = 0x00080060,
  ModalitiesInStudy = 0x00080061,
  StudyDescription = 0x00081030,
  SeriesDescription = 0x0008103e,
  PatientName = 0x00100010,
  PatientId = 0x00100020,
  StudyUid = 0x0020000d,
  SeriesUid = 0x0020000e,
  SeriesNumber = 0x00200011,
  SeriesInStudy = 0x00201206,
  ObjectsInStudy = 0x00201208,
  ObjectsInSeries = 0x00201209
};

[[noreturn]] void noDate(const std::string& text) {
  throw BadInput("'" + shown(text, 40) +
                 "' is no study date: give 20260131 or 2026-01-31, or a range 20260101-20260131 or "
                 "2026-01-01..2026-01-31");
}

/// YYYYMMDD of one day, or of nothing.
std::string dayOf(const std::string& text, const std::string& all) {
  std::string digits = text;
  if (text.size() == 10 && text[4] == '-' && text[7] == '-')
    digits = text.substr(0, 4) + text.substr(5, 2) + text.substr(8);
  if (digits.empty()) return {};
  if (digits.size() != 8 || digits.find_first_not_of("0123456789") != std::string::npos) noDate(all);
  const int number = std::stoi(digits);
  const std::chrono::year_month_day day{std::chrono::year{number / 10000},
                                        std::chrono::month{static_cast<unsigned>(number / 100 % 100)},
                                        std::chrono::day{static_cast<unsigned>(number % 100)}};
  if (!day.ok()) noDate(all);
  return digits;
}

int numberOf(const Keys& keys, Tag tag, int otherwise) {
  const auto found = keys.find(tag);
  if (found == keys.end()) return otherwise;
  int value = otherwise;
  const std::string& s = found->second;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  return error == std::errc() ? value : otherwise;
}

std::string textOf(const Keys& keys, Tag tag, std::size_t limit = 64) {
  const auto found = keys.find(tag);
  return found == keys.end() ? std::string() : shown(found->second, limit);
}

void checkKey(const std::string& value, const std::string& option) {
  const bool bad = std::any_of(value.begin(), value.end(),
                               [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\'; });
  if (bad || value.size() > 64)
    throw BadInput(option + " cannot be looked for: at most 64 bytes, no backslash, no control character");
}

void check(const Query& q) {
  checkKey(q.patientId, "--patient-id");
  checkKey(q.patientName, "--patient-name");
  checkKey(q.modality, "--modality");
  checkKey(q.accession, "--accession");
  checkKey(q.description, "--description");
  if (!q.studyUid.empty()) checkUid(q.studyUid, "--study");
  if (!q.seriesUid.empty()) checkUid(q.seriesUid, "--series-uid");
  if (q.modality.size() > 16) throw BadInput("--modality has more than 16 characters; give e.g. MR");
  if (q.limit < 1) throw BadInput("--limit must be 1 or more");
  const auto nothing = [](const std::string& s) { return s.find_first_not_of("*") == std::string::npos; };
  if (nothing(q.patientId) && nothing(q.patientName) && q.studyDate.empty() && nothing(q.accession) &&
      q.studyUid.empty() && q.seriesUid.empty() && nothing(q.modality) && nothing(q.description))
    throw BadInput("nothing is looked for: give --patient-id, --study-date, --modality, --study or another key");
}

std::vector<std::string> parts(const std::string& text) {
  std::vector<std::string> all;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\\', at), text.size());
    if (end > at) all.push_back(shown(text.substr(at, end - at), 16));
    at = end + 1;
  }
  return all;
}

/// Answers to one C-FIND, at most `limit`; a longer list sets more, and the association is of no use afterwards.
std::vector<Keys> ask(Association& association, const Node& node, const Keys& keys, std::size_t limit, bool& more) {
  const Agreed agreed = association.need(studyRootFind, "queries (C-FIND, study root)");
  Channel& channel = association.channel();
  std::vector<std::uint32_t> wanted;
  for (const auto& [tag, value] : keys) wanted.push_back(tag);
  Command request = Command::of(FindRequest, channel.nextMessageId(), studyRootFind);
  channel.send(agreed.context, request.word(Priority, 0).word(DataSetType, 1));
  channel.sendData(agreed.context, encodedKeys(keys, agreed.transferSyntax));
  std::vector<Keys> answers;
  while (true) {
    const Channel::Message m = channel.receiveAnswer();
    const std::uint16_t status = m.command.wordOr(Status, 0x0110);
    if (m.command.wordOr(Field, 0) != FindResponse)
      throw NetworkError("the server at " + placeOf(node) + " answered a query with another command");
    std::string bytes;
    if (m.command.hasData()) bytes = channel.receiveData(m.context, largestIdentifier);
    if (isPending(status)) {
      if (answers.size() == limit) {
        more = true;
        return answers;
      }
      answers.push_back(decodedKeys(bytes, agreed.transferSyntax, wanted));
      continue;
    }
    if (status != 0)
      throw NetworkError("the server at " + placeOf(node) +
                         " refused the query: " + meaningOf(status, node.callingTitle));
    return answers;
  }
}

bool matches(const std::string& wanted, const std::string& value) {
  // Wildcards are the server's to interpret.
  return wanted.empty() || value.empty() || wanted.find_first_of("*?") != std::string::npos || wanted == value;
}

std::vector<FoundSeries> seriesOf(Association& association, const Node& node, const Query& q,
                                  const std::string& studyUid, std::size_t limit, bool& more) {
  const Keys keys{{QueryLevel, "SERIES"}, {StudyUid, studyUid},    {SeriesUid, q.seriesUid}, {Modality, q.modality},
                  {SeriesNumber, ""},     {SeriesDescription, ""}, {ObjectsInSeries, ""}};
  std::vector<FoundSeries> all;
  for (const Keys& k : ask(association, node, keys, limit, more)) {
    FoundSeries s{textOf(k, SeriesUid), textOf(k, Modality, 16), textOf(k, SeriesDescription),
                  numberOf(k, SeriesNumber, 0), numberOf(k, ObjectsInSeries, -1)};
    if (isUid(s.uid) && matches(q.seriesUid, s.uid) && matches(q.modality, s.modality)) all.push_back(std::move(s));
  }
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return std::tie(a.number, a.uid) < std::tie(b.number, b.uid); });
  return all;
}

std::unique_ptr<Association> associate(const Node& node, const Progress& progress) {
  return std::make_unique<Association>(node, std::vector<Proposal>{{studyRootFind, plainSyntaxes()}}, progress);
}

/// The study that a series belongs to; empty where the server knows none. At study level a server need not look for a
/// series: the study is asked for first.
std::string studyOfSeries(Association& association, const Node& node, const std::string& seriesUid) {
  const Keys keys{{QueryLevel, "SERIES"}, {StudyUid, ""}, {SeriesUid, seriesUid}};
  bool ignored = false;
  std::string studyUid;
  for (const Keys& k : ask(association, node, keys, 1, ignored))
    if (matches(seriesUid, textOf(k, SeriesUid))) studyUid = textOf(k, StudyUid);
  return isUid(studyUid) ? studyUid : std::string();
}

Keys studyKeys(const Query& query, const std::string& studyUid) {
  Keys keys{{QueryLevel, "STUDY"},
            {StudyUid, studyUid},
            {StudyDate, query.studyDate},
            {PatientId, query.patientId},
            {ModalitiesInStudy, query.modality},
            {StudyDescription, query.description},
            {SeriesInStudy, ""},
            {ObjectsInStudy, ""}};
  if (query.names || !query.patientName.empty()) keys[PatientName] = query.patientName;
  if (query.names || !query.accession.empty()) keys[AccessionNumber] = query.accession;
  return keys;
}

/// A study out of an answer; none where it is another than was asked for.
std::optional<FoundStudy> studyOf(const Keys& k, const Query& query, const std::string& studyUid) {
  FoundStudy s;
  s.uid = textOf(k, StudyUid);
  if (!isUid(s.uid) || !matches(studyUid, s.uid)) return {};
  s.date = textOf(k, StudyDate, 8);
  s.description = textOf(k, StudyDescription);
  if (const auto m = k.find(ModalitiesInStudy); m != k.end()) s.modalities = parts(m->second);
  const bool ofModality =
      s.modalities.empty() ||
      std::any_of(s.modalities.begin(), s.modalities.end(), [&](const auto& m) { return matches(query.modality, m); });
  if (!ofModality) return {};
  s.seriesCount = numberOf(k, SeriesInStudy, -1);
  s.objects = numberOf(k, ObjectsInStudy, -1);
  if (query.names) {
    s.patientName = textOf(k, PatientName);
    s.patientId = textOf(k, PatientId);
    s.accession = textOf(k, AccessionNumber, 16);
  }
  return s;
}

struct Row {
  std::string identity;  ///< the patient's
  FoundStudy study;
};

/// By date; sets more where the list was cut.
std::vector<Row> studiesOf(Association& association, const Node& node, const Query& query, const std::string& studyUid,
                           bool& more) {
  std::vector<Row> rows;
  for (const Keys& k : ask(association, node, studyKeys(query, studyUid), query.limit, more))
    if (std::optional<FoundStudy> study = studyOf(k, query, studyUid))
      rows.push_back({textOf(k, PatientId), std::move(*study)});
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::tie(a.study.date, a.study.uid) < std::tie(b.study.date, b.study.uid);
  });
  return rows;
}

/// Patients by number in the order of their first study.
void numberPatients(std::vector<Row>& rows) {
  std::map<std::string, int> patients;
  for (Row& row : rows)
    row.study.patient = patients.try_emplace(row.identity, static_cast<int>(patients.size()) + 1).first->second;
}

/// Gives each study its series, as long as the limit lasts. Returns whether it was reached.
bool addSeries(Association& association, const Node& node, const Query& query, std::vector<Row>& rows,
               const Progress& progress) {
  std::size_t left = query.limit;
  bool truncated = false;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (left == 0) return true;
    progress.report(static_cast<double>(n) / static_cast<double>(rows.size()), "asking for series");
    bool more = false;
    FoundStudy& study = rows[n].study;
    study.series = seriesOf(association, node, query, study.uid, left, more);
    left -= study.series.size();
    if (more) {
      truncated = true;
      left = 0;
    }
  }
  return truncated;
}

}  // namespace

std::string dateRange(const std::string& text) {
  std::string from = text, to;
  bool range = false;
  const bool iso = text.find("..") != std::string::npos;
  // A single ISO day has dashes of its own.
  const bool isoDay = text.size() == 10 && text[4] == '-' && text[7] == '-';
  const std::size_t at = iso ? text.find("..") : isoDay ? std::string::npos : text.find('-');
  if (at != std::string::npos) {
    range = true;
    from = text.substr(0, at);
    to = text.substr(at + (iso ? 2 : 1));
  }
  from = dayOf(from, text);
  to = dayOf(to, text);
  if (from.empty() && to.empty()) noDate(text);
  if (!range) return from;
  if (!from.empty() && !to.empty() && to < from) noDate(text);
  return from + "-" + to;
}

Found find(const Node& node, const Query& query, const Progress& progress) {
  check(node);
  check(query);
  Found found;
  auto association = associate(node, progress);
  progress.report(0.1, "asking for studies");
  std::string studyUid = query.studyUid;
  if (!query.seriesUid.empty() && studyUid.empty()) {
    studyUid = studyOfSeries(*association, node, query.seriesUid);
    if (studyUid.empty()) return found;
  }
  std::vector<Row> rows = studiesOf(*association, node, query, studyUid, found.truncated);
  numberPatients(rows);
  // Where the list was cut, this association still has answers under way.
  if (found.truncated && query.series) association = associate(node, progress);
  if (query.series && addSeries(*association, node, query, rows, progress.part(0.1, 1.0))) found.truncated = true;
  for (Row& row : rows) found.studies.push_back(std::move(row.study));
  if (!found.truncated) association->release();
  progress.report(1.0, "found " + std::to_string(found.studies.size()) + " studies");
  return found;
}

}  // namespace glisson::pacs
