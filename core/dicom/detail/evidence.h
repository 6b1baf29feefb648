// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The evidence that series come from one elastography acquisition; for acquisitions.cpp only.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/text.h"
#include "dicom/series.h"

namespace glisson::dicom::detail {

/// Whether two series come from one acquisition, as far as one sort of evidence tells.
enum class Verdict { Other, Unknown, Same };

/// Sorts of evidence, strongest first.
enum class Tie { Series, References, Uid, SeriesNumbers, Number, Frame, Time, Geometry, Order };
inline constexpr Tie ties[] = {Tie::Series, Tie::References, Tie::Uid,      Tie::SeriesNumbers, Tie::Number,
                               Tie::Frame,  Tie::Time,       Tie::Geometry, Tie::Order};

inline bool strong(Tie tie) {
  return tie <= Tie::SeriesNumbers;
}

inline std::string words(Tie tie) {
  switch (tie) {
    case Tie::Series: return "one series";
    case Tie::References: return "references of the images";
    case Tie::Uid: return "acquisition UID";
    case Tie::SeriesNumbers: return "series numbers";
    case Tie::Number: return "acquisition number";
    case Tie::Frame: return "frame of reference";
    case Tie::Time: return "acquisition time";
    case Tie::Geometry: return "geometry";
    default: return "order of series numbers";
  }
}

inline std::string stem(const Series& s) {
  return s.uid.substr(0, s.uid.find('#'));
}

inline bool ofElastography(SeriesRole role) {
  return role == SeriesRole::Magnitude || role == SeriesRole::Wave || role == SeriesRole::Stiffness ||
         role == SeriesRole::Confidence || role == SeriesRole::Phase;
}

/// Of two that both say something.
inline Verdict compared(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return Verdict::Unknown;
  return a == b ? Verdict::Same : Verdict::Other;
}

template <typename Value>
Verdict compared(const std::optional<Value>& a, const std::optional<Value>& b) {
  if (!a || !b) return Verdict::Unknown;
  return *a == *b ? Verdict::Same : Verdict::Other;
}

/// What the series of a scan say about which of them come from one acquisition.
class Evidence {
 public:
  explicit Evidence(const ScanResult& scan) : scan_(scan), run_(scan.series.size(), -1), leads_(scan.series.size()) {
    orderRuns();
    resolveReferences();
  }

  const Series& series(int i) const { return scan_.series[static_cast<std::size_t>(i)]; }
  int size() const { return static_cast<int>(scan_.series.size()); }

  bool together(int a, int b) const {
    const Series &x = series(a), &y = series(b);
    return compared(x.patientKey, y.patientKey) != Verdict::Other && compared(x.studyUid, y.studyUid) != Verdict::Other;
  }

  Verdict judge(Tie tie, int a, int b) const {
    const Series &x = series(a), &y = series(b);
    switch (tie) {
      case Tie::Series:
        return stem(x) == stem(y) && compared(x.acquired.number, y.acquired.number) != Verdict::Other
                   ? Verdict::Same
                   : Verdict::Unknown;
      case Tie::References: return byReferences(a, b);
      case Tie::Uid: return compared(x.acquired.uid, y.acquired.uid);
      case Tie::SeriesNumbers: return bySeriesNumbers(x, y);
      case Tie::Number: return compared(x.acquired.number, y.acquired.number);
      case Tie::Frame: return compared(x.frameOfReferenceUid, y.frameOfReferenceUid);
      case Tie::Time:
        if (!x.acquired.time_s || !y.acquired.time_s) return Verdict::Unknown;
        return apart_s(a, b) < 1.0 ? Verdict::Same : Verdict::Other;
      case Tie::Geometry: return x.grid.sameGeometry(y.grid) ? Verdict::Same : Verdict::Other;
      default: return run(a) == run(b) ? Verdict::Same : Verdict::Other;
    }
  }

  double apart_s(int a, int b) const { return std::abs(*series(a).acquired.time_s - *series(b).acquired.time_s); }

 private:
  int run(int i) const { return run_[static_cast<std::size_t>(i)]; }

  /// Products follow each other in order of series numbers; a run ends where one comes again.
  void orderRuns() {
    std::vector<int> order;
    for (int i = 0; i < size(); ++i)
      if (ofElastography(series(i).role)) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return series(a).number < series(b).number; });
    int current = 0;
    std::map<SeriesRole, std::string> seen;
    for (const int i : order) {
      const Series& s = series(i);
      const auto known = seen.find(s.role);
      if (known != seen.end() && known->second != stem(s) && !s.masked && s.role != SeriesRole::Phase) {
        ++current;
        seen.clear();
      }
      if (!s.masked) seen.emplace(s.role, stem(s));
      run_[static_cast<std::size_t>(i)] = current;
    }
  }

  /// Which other series of elastography each one names.
  void resolveReferences() {
    std::map<std::string, int> byUid;
    const auto any = [](const Series& s) { return ofElastography(s.role) && !s.acquired.references.empty(); };
    if (std::none_of(scan_.series.begin(), scan_.series.end(), any)) return;
    for (int i = 0; i < size(); ++i) {
      if (!ofElastography(series(i).role)) continue;
      byUid.emplace(stem(series(i)), i);
      for (const std::string& uid : series(i).sopInstanceUids) byUid.emplace(uid, i);
    }
    for (int i = 0; i < size(); ++i)
      for (const std::string& uid : series(i).acquired.references)
        if (const auto found = byUid.find(uid); found != byUid.end() && stem(series(found->second)) != stem(series(i)))
          leads_[static_cast<std::size_t>(i)].insert(stem(series(found->second)));
  }

  Verdict byReferences(int a, int b) const {
    const auto &x = leads_[static_cast<std::size_t>(a)], &y = leads_[static_cast<std::size_t>(b)];
    if (x.count(stem(series(b))) > 0 || y.count(stem(series(a))) > 0) return Verdict::Same;
    if (x.empty() || y.empty()) return Verdict::Unknown;
    return std::any_of(x.begin(), x.end(), [&](const std::string& uid) { return y.count(uid) > 0; }) ? Verdict::Same
                                                                                                     : Verdict::Other;
  }

  /// GE and Philips number the products of acquisition N from 100 N on; other makers may.
  static Verdict bySeriesNumbers(const Series& x, const Series& y) {
    const std::string maker = lowerCase(x.acquired.manufacturer) + lowerCase(y.acquired.manufacturer);
    if (maker.find("siemens") != std::string::npos || x.number <= 0 || y.number <= 0) return Verdict::Unknown;
    if (x.number < 100 && y.number < 100) return x.number == y.number ? Verdict::Same : Verdict::Unknown;
    const auto acquisition = [](int number) { return number >= 100 ? number / 100 : number; };
    if (acquisition(x.number) == acquisition(y.number)) return Verdict::Same;
    const bool numbered = maker.find("ge medical") != std::string::npos || maker.find("philips") != std::string::npos ||
                          lowerCase(x.acquired.sequenceName).find("mre") != std::string::npos;
    return numbered ? Verdict::Other : Verdict::Unknown;
  }

  const ScanResult& scan_;
  std::vector<int> run_;
  std::vector<std::set<std::string>> leads_;
};

}  // namespace glisson::dicom::detail
