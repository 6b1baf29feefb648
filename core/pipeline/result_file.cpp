// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/result_file.h"

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <type_traits>
#include <variant>

#include "base/error.h"
#include "base/part_file.h"
#include "base/sha256.h"

namespace glisson::pipeline {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

constexpr char magic[8] = {'G', 'L', 'I', 'S', 'S', 'O', 'N', 'R'};
constexpr std::uint64_t form = 2;  ///< grows with every change of the fields below
constexpr std::size_t digestLength = 64;

DiagnosticCode codeNamed(const std::string& name) {
#define GLISSON_DIAGNOSTIC(code, json, severity, text) \
  if (name == (json)) return DiagnosticCode::code;
#include "base/diagnostics.def"
#undef GLISSON_DIAGNOSTIC
  throw BadInput("it says something that this version does not know");
}

/// Values one after the other, into a text or out of it.
class Archive {
 public:
  Archive() = default;
  explicit Archive(std::string bytes) : bytes_(std::move(bytes)), reads_(true) {}
  bool reads() const { return reads_; }
  const std::string& bytes() const { return bytes_; }
  std::size_t left() const { return bytes_.size() - at_; }

  void raw(void* data, std::size_t count) {
    if (!reads_) {
      bytes_.append(static_cast<const char*>(data), count);
      return;
    }
    if (count > left()) throw BadInput("it ends too early");
    if (count > 0) std::memcpy(data, bytes_.data() + at_, count);
    at_ += count;
  }
  /// Number of entries, of which each takes at least `each` bytes.
  std::size_t count(std::size_t n, std::size_t each) {
    auto stored = static_cast<std::uint64_t>(n);
    raw(&stored, sizeof stored);
    if (reads_ && each > 0 && stored > left() / each) throw BadInput("it ends too early");
    return static_cast<std::size_t>(stored);
  }
  template <typename... T>
  void operator()(T&... values) {
    (one(*this, values), ...);
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
  bool reads_ = false;
};

template <typename T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <Plain T>
void one(Archive& a, T& value) {
  a.raw(&value, sizeof value);
}

void one(Archive& a, std::string& text) {
  text.resize(a.count(text.size(), 1));
  a.raw(text.data(), text.size());
}

void one(Archive& a, fs::path& path) {
  std::string text = path.generic_string();
  one(a, text);
  path = text;
}

void one(Archive& a, Density& density) {
  double value = density.kgPerM3();
  one(a, value);
  density = Density::fromKgPerM3(value);
}

template <typename S, int R, int C>
void one(Archive& a, Eigen::Matrix<S, R, C>& m) {
  if constexpr (R == Eigen::Dynamic || C == Eigen::Dynamic) {
    const auto rows = static_cast<Eigen::Index>(a.count(static_cast<std::size_t>(m.rows()), 0));
    const auto columns = static_cast<Eigen::Index>(a.count(static_cast<std::size_t>(m.cols()), 0));
    if (a.reads()) {
      const auto most = static_cast<Eigen::Index>(a.left() / sizeof(S));
      if (columns < 0 || (rows > 0 && columns > most / rows)) throw BadInput("it ends too early");
      if ((R != Eigen::Dynamic && rows != R) || (C != Eigen::Dynamic && columns != C))
        throw BadInput("a matrix has another size");
      m.resize(rows, columns);
    }
  }
  a.raw(m.data(), static_cast<std::size_t>(m.size()) * sizeof(S));
}

template <typename T>
void one(Archive& a, std::optional<T>& value);
template <typename T>
void one(Archive& a, std::vector<T>& values);
template <typename A, typename B>
void one(Archive& a, std::pair<A, B>& value);

void one(Archive& a, image::Grid& g) {
  a(g.size, g.spacing_mm, g.origin_lps_mm, g.direction);
}

template <typename T>
void one(Archive& a, image::Volume<T>& v) {
  a(v.grid, v.values);
  if (a.reads() && (v.grid.size.minCoeff() < 0 || v.values.size() != v.grid.voxelCount()))
    throw BadInput("a volume has another size than it says");
}

void one(Archive& a, DiagnosticValue& value) {
  std::uint64_t which = value.index();
  one(a, which);
  if (a.reads()) {
    if (which == 0)
      value = double{};
    else if (which == 1)
      value = std::int64_t{};
    else
      value = std::string{};
  }
  std::visit([&a](auto& held) { one(a, held); }, value);
}

void one(Archive& a, Diagnostics& said) {
  const std::size_t n = a.count(said.size(), 1);
  if (a.reads()) {
    for (std::size_t i = 0; i < n; ++i) {
      std::string name;
      std::vector<std::pair<std::string, DiagnosticValue>> arguments;
      a(name, arguments);
      said.add(codeNamed(name), std::move(arguments));
    }
    return;
  }
  for (const Diagnostic& d : said) {
    std::string name(nameOf(d.code));
    auto arguments = d.arguments;
    a(name, arguments);
  }
}

// What a run is made of, field by field; declared before use, since each holds the ones above it.

void one(Archive& a, PlanStep& s) {
  a(s.step, s.needed, s.why, s.seconds, s.peak_MB);
}

void one(Archive& a, retraction::Model& m) {
  a(m.youngs_kPa, m.poisson, m.density, m.cells, m.volume_mL, m.mass_kg, m.stiffness);
}

void one(Archive& a, mechanics::SolveReport& r) {
  a(r.kind, r.why, r.status, r.iterations, r.residual, r.tolerance, r.seconds, r.diagnostics);
}

void one(Archive& a, retraction::LinearGap& g) {
  a(g.known, g.stability, g.mean_mm, g.max_mm, g.at_retractor_mm, g.landmarks_max_mm, g.why);
}

void one(Archive& a, std::array<double, 2>& pair) {
  a(pair[0], pair[1]);
}

void one(Archive& a, retraction::RigidContact& c) {
  a(c.outcome, c.travel_mm, c.capacity_N, c.capacityAt_mm, c.capacityExceeded, c.asked_N, c.asked_mm, c.moved_mm,
    c.force_N, c.moment_Nm, c.area_mm2, c.footprint_mm2, c.pressureMax_kPa, c.penetrationMax_mm, c.smallestJ, c.bar_mm,
    c.barRadius_mm, c.hoist, c.path, c.sample_mm, c.sample_u_mm, c.sample_mm2, c.pressure_kPa, c.cut_u_m);
}

void one(Archive& a, retraction::LigamentPull& p) {
  a(p.name, p.stiffness_N_per_mm, p.force_N);
}

void one(Archive& a, retraction::Result& r) {
  a(r.u_mm, r.nodal_u_m, r.probe_u_mm, r.notes, r.diagnostics, r.dofs, r.frames, r.steps, r.solver, r.load_N,
    r.reaction_N, r.energy_J, r.kinematics, r.max_strain, r.p95_strain, r.p99_strain, r.fraction_over_10pct,
    r.max_rotation_deg, r.max_displacement_mm, r.linearTrusted, r.cellsLeftOut, r.linearGap, r.doubts, r.validity,
    r.drawable, r.retractorPoint_mm, r.contactArea_mm2, r.contactNodes, r.contact, r.ligaments);
}

void one(Archive& a, retraction::DiscretisationError::OfDifference& d) {
  a(d.mean_mm, d.at_retractor_mm, d.vessels_mm, d.vesselsMax_mm);
}

void one(Archive& a, retraction::DiscretisationError& e) {
  a(e.known, e.max_mm, e.p95_mm, e.mean_mm, e.at_retractor_mm, e.vessels_mm, e.vesselsMax_mm, e.cell_mm, e.coarse_mm,
    e.note, e.difference);
}

void one(Archive& a, comparison::Difference::EqualLift& e) {
  a(e.travel_mm, e.force_N, e.other_force_N, e.alongPath);
}

void one(Archive& a, comparison::Difference& d) {
  a(d.mean_mm, d.p95_mm, d.max_mm, d.at_retractor_mm, d.travel_mm, d.window_at_rest_mm, d.contact_mean_mm, d.equal_lift,
    d.clinically_significant, d.vessel_mm, d.vesselMean_mm, d.vesselP95_mm, d.vesselMax_mm, d.vesselFractionBeyond);
}

void one(Archive& a, uncertainty::Interval& i) {
  a(i.low, i.high);
}

void one(Archive& a, uncertainty::LandmarkSpread& s) {
  a(s.landmark, s.sd_mm, s.textbook_sd_mm, s.difference_sd_mm, s.difference95_mm, s.beyond, s.place_mm2);
}

void one(Archive& a, uncertainty::VesselHeadline& h) {
  a(h.mean_mm, h.max_mm, h.beyond, h.furthest, h.furthest_mm, h.furthest95_mm, h.furthestBeyond);
}

void one(Archive& a, uncertainty::Headline& h) {
  a(h.mean_mm, h.at_retractor_mm, h.travel_mm, h.vessels, h.beyond, h.travelBeyond, h.withinVoxel);
}

void one(Archive& a, uncertainty::SourceSpread& s) {
  a(s.kind, s.sd_mm, s.mean_sd_mm, s.travel_sd_mm, s.vessels_sd_mm, s.furthest_sd_mm);
}

void one(Archive& a, uncertainty::VesselTip& tip) {
  a(tip.landmark, tip.moves_mm, tip.place95_mm, tip.apart_mm, tip.apart95_mm, tip.beyond);
}

void one(Archive& a, uncertainty::SourceWords& w) {
  a(w.name, w.spread, w.reference);
}

void one(Archive& a, uncertainty::Check& c) {
  a(c.found, c.change_mm, c.missed_mm, c.at_retractor_mm, c.first_order_mm);
}

void one(Archive& a, uncertainty::Leverage& l) {
  a(l.per10percent_mm, l.half_mL, l.halfWithin_mm);
}

void one(Archive& a, uncertainty::Uncertainty& u) {
  a(u.known, u.why, u.spread.landmarks, u.spread.headline, u.spread.sources, u.spread.cellBeyond, u.words, u.checks,
    u.missedShare, u.leverage, u.tip, u.beyond, u.fields, u.solves, u.iterations, u.diagnostics);
}

void one(Archive& a, LinearBeside& l) {
  a(l.primary, l.atlas, l.difference, l.between);
}

void one(Archive& a, elastography::Statistics& s) {
  a(s.n, s.n_before_mask, s.area_mm2, s.mean_kPa, s.median_kPa, s.sd_kPa, s.min_kPa, s.max_kPa);
}

void one(Archive& a, elastography::MeanUncertainty& u) {
  a(u.correlatedVoxels, u.se_kPa, u.low_kPa, u.high_kPa);
}

void one(Archive& a, elastography::Interval& i) {
  a(i.value, i.se, i.low, i.high);
}

void one(Archive& a, elastography::MeanInterval& m) {
  a(m.correlation.length_mm, m.correlation.exponent, m.correlation.effective, m.correlation.se_kPa, m.bySlices,
    m.slices, m.mean);
}

void one(Archive& a, elastography::SliceStatistics& s) {
  a(s.slice, s.statistics);
}

void one(Archive& a, elastography::Measurement& m) {
  a(m.quantity, m.pooled, m.uncertainty, m.interval, m.slices, m.areaWeightedMean_kPa, m.youngs_mean_kPa,
    m.shear_mean_kPa, m.poisson, m.drawn, m.rim, m.excluded, m.meanOfAll_kPa, m.notFinite, m.notPositive,
    m.lowConfidence, m.noConfidence, m.warnings, m.diagnostics);
}

void one(Archive& a, retraction::Retractor& r) {
  a(r.diameter_mm, r.length_mm, r.spread_mm, r.at_mm, r.force_N, r.direction, r.axis, r.contact, r.travel_mm, r.shape);
}

void one(Archive& a, retraction::Pose& p) {
  a(p.centre_mm, p.axis, p.hoist, p.height_mm, p.covered_mm, p.thickness_mm, p.slope, p.wanted);
}

void one(Archive& a, retraction::PlacedBar::Tried& t) {
  a(t.height_mm, t.borne);
}

void one(Archive& a, retraction::PlacedBar& p) {
  a(p.bar, p.pose, p.tried, p.bears);
}

void one(Archive& a, RunResult& r) {
  a(r.plan, r.model, r.primary, r.atlas, r.discretisation, r.difference, r.uncertainty, r.linear, r.landmarks_mm,
    r.stiffness, r.files, r.warnings, r.diagnostics, r.placed, r.kinematicsWhy, r.json);
}

template <typename T>
void one(Archive& a, std::optional<T>& value) {
  bool there = value.has_value();
  one(a, there);
  if (!a.reads()) {
    if (there) one(a, *value);
    return;
  }
  value.reset();
  if (there) one(a, value.emplace());
}

template <typename T>
void one(Archive& a, std::vector<T>& values) {
  const std::size_t n = a.count(values.size(), Plain<T> ? sizeof(T) : 1);
  if (a.reads()) values.resize(n);
  if constexpr (Plain<T>)
    a.raw(values.data(), n * sizeof(T));
  else
    for (T& value : values) one(a, value);
}

template <typename A, typename B>
void one(Archive& a, std::pair<A, B>& value) {
  a(value.first, value.second);
}

}  // namespace

void writeResultFile(const fs::path& folder, const RunResult& result) {
  RunResult kept = result;  // by value: reading and writing are one description of the fields
  kept.picture.reset();
  for (fs::path& file : kept.files) file = file.lexically_proximate(folder);
  Archive archive;
  archive(kept);
  const std::string& bytes = archive.bytes();
  const std::string digest = sha256(bytes.data(), bytes.size());
  const auto length = static_cast<std::uint64_t>(bytes.size());
  PartFile part(folder / resultFileName);
  part.write(magic, sizeof magic);
  part.write(&form, sizeof form);
  part.write(&length, sizeof length);
  part.write(digest.data(), digest.size());
  part.write(bytes.data(), bytes.size());
  part.become();
}

RunResult readResultFile(const fs::path& folder) {
  const fs::path file = folder / resultFileName;
  constexpr const char* again = "; run the case again";
  std::error_code failed;
  std::ifstream in(file, std::ios::binary);
  if (!in || !fs::is_regular_file(file, failed)) throw BadInput("no results are kept in this folder");
  const std::uint64_t size = fs::file_size(file, failed);
  char start[sizeof magic] = {};
  std::uint64_t formThere = 0, length = 0;
  std::string digest(digestLength, '\0');
  in.read(start, sizeof start);
  in.read(reinterpret_cast<char*>(&formThere), sizeof formThere);
  in.read(reinterpret_cast<char*>(&length), sizeof length);
  in.read(digest.data(), static_cast<std::streamsize>(digest.size()));
  constexpr std::uint64_t head = sizeof magic + 2 * sizeof form + digestLength;
  if (!in || std::memcmp(start, magic, sizeof magic) != 0)
    throw BadInput(std::string("the results of this case are damaged") + again);
  if (formThere != form)
    throw BadInput(std::string("the results of this case were kept by another version of Glisson") + again);
  if (size != head + length) throw BadInput(std::string("the results of this case are cut short") + again);
  std::string bytes(length, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(length));
  if (!in || sha256(bytes.data(), bytes.size()) != digest)
    throw BadInput(std::string("the results of this case are damaged (their SHA-256 differs)") + again);
  RunResult result;
  try {
    Archive archive(std::move(bytes));
    archive(result);
    if (archive.left() != 0) throw BadInput("they hold more than they say");
  } catch (const BadInput& e) {
    throw BadInput(std::string("the results of this case cannot be read: ") + e.what() + again);
  }
  for (fs::path& path : result.files) {
    if (path.is_absolute() || path.lexically_normal().string().rfind("..", 0) == 0)
      throw BadInput(std::string("the results of this case name a file outside their folder") + again);
    path = folder / path;
  }
  return result;
}

}  // namespace glisson::pipeline
