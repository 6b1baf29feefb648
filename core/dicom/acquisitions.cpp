// SPDX-License-Identifier: GPL-3.0-or-later
#include "dicom/acquisitions.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "dicom/detail/evidence.h"
#include "dicom/roles.h"

namespace glisson::dicom {
namespace {

using detail::Evidence;
using detail::stem;
using detail::Tie;
using detail::ties;
using detail::Verdict;

/// Those of the candidates that fit best; last: the evidence that told them from the others, where some were.
struct Chosen {
  std::vector<int> fit;
  std::optional<Tie> last;
};

Chosen bestFor(const Evidence& e, int one, std::vector<int> candidates, bool byOrder = true) {
  Chosen chosen{std::move(candidates), {}};
  for (const Tie tie : ties) {
    if (chosen.fit.size() < 2 || (tie == Tie::Order && !byOrder)) break;
    std::vector<int> kept;
    const auto known = [&](int c) { return e.judge(tie, one, c) != Verdict::Unknown; };
    if (tie == Tie::Time && std::all_of(chosen.fit.begin(), chosen.fit.end(), known)) {
      double least = 1e300;
      for (const int c : chosen.fit) least = std::min(least, e.apart_s(one, c));
      for (const int c : chosen.fit)
        if (e.apart_s(one, c) <= 2.0 * least + 1.0) kept.push_back(c);
    } else {
      Verdict best = Verdict::Other;
      for (const int c : chosen.fit) best = std::max(best, e.judge(tie, one, c));
      for (const int c : chosen.fit)
        if (e.judge(tie, one, c) == best) kept.push_back(c);
    }
    if (kept.size() < chosen.fit.size()) {
      chosen.last = tie;
      chosen.fit = std::move(kept);
    }
  }
  return chosen;
}

std::string tiesOf(const Evidence& e, int a, int b) {
  std::string all;
  for (const Tie tie : ties)
    if (tie != Tie::Order && e.judge(tie, a, b) == Verdict::Same) all += (all.empty() ? "" : ", ") + detail::words(tie);
  return all.empty() ? "nothing else fits" : all;
}

std::optional<Tie> firstAgainst(const Evidence& e, int a, int b) {
  for (const Tie tie : ties)
    if (detail::strong(tie) && e.judge(tie, a, b) != Verdict::Unknown)
      return e.judge(tie, a, b) == Verdict::Other ? std::optional(tie) : std::nullopt;
  return std::nullopt;
}

std::int64_t numberOf(const Evidence& e, int i) {
  return e.series(i).number;
}

/// Whether two stiffness series are maps of one acquisition.
bool sameAcquisition(const Evidence& e, int a, int b) {
  if (!e.together(a, b)) return false;
  bool same = e.series(a).masked != e.series(b).masked;
  for (const Tie tie : ties) {
    if (!detail::strong(tie) && tie != Tie::Number && tie != Tie::Frame) continue;
    if (e.judge(tie, a, b) == Verdict::Other) return false;
    same = same || (detail::strong(tie) && e.judge(tie, a, b) == Verdict::Same);
  }
  return same;
}

class Partners {
 public:
  Partners(const Evidence& e, int stiffness) : e_(e), stiffness_(stiffness) {
    for (int i = 0; i < e.size(); ++i)
      if (e.series(i).role == SeriesRole::Stiffness) anchors_.push_back(i);
    if (std::find(anchors_.begin(), anchors_.end(), stiffness) == anchors_.end()) anchors_.push_back(stiffness);
  }

  /// The series of that role that goes with the stiffness, -1 where there is none.
  int find(SeriesRole role, Diagnostics& said) const {
    std::vector<int> all, hand;
    std::set<int> byOrder;  // those whose stiffness only the order of series tells
    int otherStudy = -1;
    for (int i = 0; i < e_.size(); ++i) {
      const Series& s = e_.series(i);
      if (s.role != role || s.error || i == stiffness_) continue;
      if (!e_.together(i, stiffness_)) {
        if (s.patientKey == e_.series(stiffness_).patientKey) otherStudy = i;
        continue;
      }
      all.push_back(i);
      if (setByHand(s)) hand.push_back(i);
    }
    const std::string what = name(role);
    if (all.empty() && otherStudy >= 0 && role == SeriesRole::Confidence)
      said.add(DiagnosticCode::PartnerElsewhere, {{"role", what},
                                                  {"series", numberOf(e_, otherStudy)},
                                                  {"stiffness", numberOf(e_, stiffness_)},
                                                  {"tie", std::string("another study")}});
    if (all.empty()) return -1;
    std::vector<int> mine = hand;
    if (hand.empty())
      for (const int c : all) {
        const Chosen own = bestFor(e_, c, anchorsWith(c));
        if (std::find(own.fit.begin(), own.fit.end(), stiffness_) == own.fit.end() || firstAgainst(e_, stiffness_, c))
          continue;
        mine.push_back(c);
        if (own.last == Tie::Order) byOrder.insert(c);
      }
    if (mine.empty()) {
      elsewhere(all, what, said);
      return -1;
    }
    // The order of series tells acquisitions apart, not two products of one.
    Chosen chosen = bestFor(e_, stiffness_, mine, anchors_.size() > 1);
    const int taken = chosen.fit.front();
    if (byOrder.count(taken) > 0 && !chosen.last) chosen.last = Tie::Order;
    for (const int other : chosen.fit)
      if (stem(e_.series(other)) != stem(e_.series(taken))) {
        ambiguous(chosen.fit, what, said);
        return -1;
      }
    tellAbout(taken, all, chosen, what, said);
    return taken;
  }

 private:
  std::vector<int> anchorsWith(int c) const {
    std::vector<int> out;
    for (const int a : anchors_)
      if (e_.together(a, c)) out.push_back(a);
    return out;
  }

  void elsewhere(const std::vector<int>& all, const std::string& what, Diagnostics& said) const {
    const int nearest = bestFor(e_, stiffness_, all).fit.front();
    const auto against = firstAgainst(e_, stiffness_, nearest);
    const std::vector<int> own = bestFor(e_, nearest, anchorsWith(nearest)).fit;
    const std::string tie = against ? detail::words(*against) : tiesOf(e_, nearest, own.front());
    said.add(
        DiagnosticCode::PartnerElsewhere,
        {{"role", what}, {"series", numberOf(e_, nearest)}, {"stiffness", numberOf(e_, stiffness_)}, {"tie", tie}});
  }

  void ambiguous(const std::vector<int>& fit, const std::string& what, Diagnostics& said) const {
    std::string all;
    for (const int i : fit) all += (all.empty() ? "" : ", ") + std::to_string(e_.series(i).number);
    said.add(DiagnosticCode::PartnerAmbiguous, {{"role", what}, {"all", all}, {"stiffness", numberOf(e_, stiffness_)}});
  }

  void tellAbout(int taken, const std::vector<int>& all, const Chosen& chosen, const std::string& what,
                 Diagnostics& said) const {
    const auto about = [&](std::vector<std::pair<std::string, DiagnosticValue>> more) {
      std::vector<std::pair<std::string, DiagnosticValue>> arguments = {
          {"role", what}, {"series", numberOf(e_, taken)}, {"stiffness", numberOf(e_, stiffness_)}};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return arguments;
    };
    const bool several = std::any_of(anchors_.begin(), anchors_.end(),
                                     [&](int a) { return a != stiffness_ && !sameAcquisition(e_, a, stiffness_); });
    if (several && chosen.last == Tie::Order)
      said.add(DiagnosticCode::PartnerByOrder, about({}));
    else if (several)
      said.add(DiagnosticCode::PartnerTaken, about({{"tie", tiesOf(e_, stiffness_, taken)}}));
    for (const Tie tie : {Tie::References, Tie::Uid, Tie::SeriesNumbers, Tie::Number, Tie::Frame, Tie::Time}) {
      if (e_.judge(tie, stiffness_, taken) != Verdict::Other) continue;
      const auto rival = std::find_if(
          all.begin(), all.end(), [&](int c) { return c != taken && e_.judge(tie, stiffness_, c) == Verdict::Same; });
      if (rival != all.end()) {
        said.add(DiagnosticCode::PartnerContradicted, about({{"tie", tiesOf(e_, stiffness_, taken)},
                                                             {"against", detail::words(tie)},
                                                             {"other", numberOf(e_, *rival)}}));
        return;
      }
      const bool numbered = e_.judge(Tie::SeriesNumbers, stiffness_, taken) == Verdict::Same;
      if (detail::strong(tie) || tie == Tie::Frame || (tie == Tie::Number && !numbered))
        said.add(DiagnosticCode::PartnerDoubtful, about({{"what", detail::words(tie)}}));
    }
  }

  const Evidence& e_;
  int stiffness_;
  std::vector<int> anchors_;
};

/// Every volume of that wave's series, of the same acquisition.
std::vector<int> volumesOf(const Evidence& e, int wave) {
  std::vector<int> all;
  for (int i = 0; wave >= 0 && i < e.size(); ++i)
    if (e.series(i).role == SeriesRole::Wave && stem(e.series(i)) == stem(e.series(wave)) &&
        e.judge(Tie::Number, i, wave) != Verdict::Other)
      all.push_back(i);
  return all;
}

/// Whether the partner goes on with the same slices where those of the stiffness end: slices of the stiffness are lost.
bool goesOn(const Series& stiffness, const Series& partner) {
  const image::Grid &a = stiffness.grid, &b = partner.grid;
  if (a.size.z() >= b.size.z() || stiffness.error || a.spacing_mm.z() <= 0.0) return false;
  if (stiffness.frameOfReferenceUid != partner.frameOfReferenceUid) return false;
  if (std::abs(a.spacing_mm.z() - b.spacing_mm.z()) > 0.02 * b.spacing_mm.z() && a.size.z() > 1) return false;
  constexpr double onSlice = 0.1;  // of their distance
  for (const double k : {0.0, a.size.z() - 1.0}) {
    const double at = b.lpsToIndex(a.indexToLps({0.0, 0.0, k})).z();
    if (std::abs(at - std::round(at)) > onSlice || at < -0.5 || at > b.size.z() - 0.5) return false;
  }
  return true;
}

/// The first partner that has more slices than the stiffness.
void tellMoreSlices(const Evidence& e, Acquisition& a) {
  for (const int p : {a.confidence, a.magnitude, a.wave.empty() ? -1 : a.wave.front()}) {
    if (p < 0 || !goesOn(e.series(a.stiffness), e.series(p))) continue;
    a.diagnostics.add(DiagnosticCode::PartnerHasMoreSlices,
                      {{"role", name(e.series(p).role)},
                       {"series", numberOf(e, p)},
                       {"there", std::int64_t{e.series(p).grid.size.z()}},
                       {"stiffness", numberOf(e, a.stiffness)},
                       {"here", std::int64_t{e.series(a.stiffness).grid.size.z()}}});
    return;
  }
}

Acquisition partners(const Evidence& e, int stiffness) {
  Acquisition a;
  a.stiffness = stiffness;
  const Partners find(e, stiffness);
  a.confidence = find.find(SeriesRole::Confidence, a.diagnostics);
  a.magnitude = find.find(SeriesRole::Magnitude, a.diagnostics);
  a.wave = volumesOf(e, find.find(SeriesRole::Wave, a.diagnostics));
  const auto say = [&](const char* what, int other) {
    if (other >= 0)
      a.why += (a.why.empty() ? "" : "; ") + std::string(what) + " by " +
               (setByHand(e.series(other)) ? "hand" : tiesOf(e, stiffness, other));
  };
  say("magnitude", a.magnitude);
  say("wave", a.wave.empty() ? -1 : a.wave.front());
  say("confidence", a.confidence);
  tellMoreSlices(e, a);
  if (a.why.empty()) a.why = "the stiffness alone: nothing else here belongs to it";
  return a;
}

/// Products that no stiffness claims: those that strong evidence ties together are one acquisition.
void addRest(const Evidence& e, std::vector<Acquisition>& all) {
  std::set<int> used;
  for (const Acquisition& a : all) {
    used.insert({a.magnitude, a.confidence});
    used.insert(a.wave.begin(), a.wave.end());
  }
  const std::size_t first = all.size();
  for (int i = 0; i < e.size(); ++i) {
    const SeriesRole role = e.series(i).role;
    if (used.count(i) > 0 || e.series(i).error) continue;
    if (role != SeriesRole::Magnitude && role != SeriesRole::Wave && role != SeriesRole::Confidence) continue;
    const auto fits = [&](Acquisition& a) {
      std::vector<int> members = a.wave;
      for (const int m : {a.magnitude, a.confidence})
        if (m >= 0) members.push_back(m);
      if (role == SeriesRole::Magnitude && a.magnitude >= 0 && stem(e.series(a.magnitude)) != stem(e.series(i)))
        return false;
      if (role == SeriesRole::Confidence && a.confidence >= 0) return false;
      return std::all_of(members.begin(), members.end(), [&](int m) {
        if (!e.together(m, i)) return false;
        if (stem(e.series(m)) == stem(e.series(i))) return true;  // time steps and directions of one series
        for (const Tie tie : ties)
          if ((detail::strong(tie) || tie == Tie::Number) && e.judge(tie, m, i) != Verdict::Unknown)
            return e.judge(tie, m, i) == Verdict::Same;
        return false;
      });
    };
    auto home = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(), fits);
    if (home == all.end()) {
      all.emplace_back();
      home = std::prev(all.end());
      home->why = "no stiffness series belongs to it";
    }
    if (role == SeriesRole::Wave) home->wave.push_back(i);
    if (role == SeriesRole::Magnitude && home->magnitude < 0) home->magnitude = i;
    if (role == SeriesRole::Confidence) home->confidence = i;
  }
}

}  // namespace

Acquisition partnersOf(const ScanResult& scan, int stiffness) {
  if (stiffness < 0 || stiffness >= static_cast<int>(scan.series.size()))
    throw BadArgument("partnersOf: there is no such series");
  return partners(Evidence(scan), stiffness);
}

std::vector<Acquisition> acquisitions(const ScanResult& scan) {
  const Evidence e(scan);
  std::vector<Acquisition> all;
  for (int i = 0; i < e.size(); ++i) {
    if (e.series(i).role != SeriesRole::Stiffness) continue;
    const auto home =
        std::find_if(all.begin(), all.end(), [&](const Acquisition& a) { return sameAcquisition(e, a.stiffness, i); });
    if (home == all.end()) {
      all.push_back(partners(e, i));
    } else if (e.series(home->stiffness).masked && !e.series(i).masked) {
      Acquisition better = partners(e, i);
      better.otherStiffness = home->otherStiffness;
      better.otherStiffness.push_back(home->stiffness);
      *home = std::move(better);
    } else {
      home->otherStiffness.push_back(i);
    }
  }
  addRest(e, all);
  return all;
}

}  // namespace glisson::dicom
