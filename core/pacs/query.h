// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pacs/node.h"

namespace glisson::pacs {

/// What to look for; empty: any. Text may hold the wildcards * and ?.
struct Query {
  std::string patientId;
  std::string patientName;
  std::string studyDate;  ///< as dateRange() gives it
  std::string modality;   ///< e.g. MR
  std::string accession;
  std::string studyUid, seriesUid;
  std::string description;   ///< of the study
  bool series = false;       ///< the series of each study, too
  bool names = false;        ///< ask for who the patient is
  std::size_t limit = 1000;  ///< studies, and series of all studies together
};

/// A series that a server knows.
struct FoundSeries {
  std::string uid, modality, description;
  int number = 0;
  int objects = -1;  ///< -1: the server does not say
};

/// A study that a server knows.
struct FoundStudy {
  std::string uid, date, description;
  std::vector<std::string> modalities;
  int patient =
      0;  ///< the same number for the same patient, from 1, in order of the answer: tells patients apart, no more
  int seriesCount = -1, objects = -1;             ///< -1: the server does not say
  std::string patientName, patientId, accession;  ///< only where Query::names
  std::vector<FoundSeries> series;                ///< only where Query::series; by number, then UID
};

/// A server's answer to a query.
struct Found {
  std::vector<FoundStudy> studies;  ///< by date, then UID
  bool truncated = false;           ///< there were more than Query::limit
};

/// A date as a query needs it: 20260131, 2026-01-31, a range 20260101-20260131 or 2026-01-01..2026-01-31, either end of
/// which may be missing. Returns YYYYMMDD, YYYYMMDD-YYYYMMDD, -YYYYMMDD or YYYYMMDD-. Throws BadInput where a day does
/// not exist or the range ends before it begins.
std::string dateRange(const std::string& text);

/// C-FIND, study root. What the server ignores of the query is checked here again (study UID, series UID, modality).
/// Throws BadInput where nothing is looked for, or a key holds a backslash or a control character or is longer than 64
/// characters; NetworkError; Cancelled.
Found find(const Node& node, const Query& query, const Progress& progress = {});

}  // namespace glisson::pacs
