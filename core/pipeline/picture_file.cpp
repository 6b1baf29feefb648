// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/picture_file.h"

#include <bit>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/part_file.h"
#include "base/sha256.h"

namespace glisson::pipeline {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr char magic[] = {'G', 'L', 'I', 'S', 'S', 'O', 'N', 'P'};
constexpr std::uint64_t largestHeader = 1 << 20;

std::string named(const std::filesystem::path& file) {
  return "'" + file.filename().string() + "'";
}

template <typename Derived>
Json toJson(const Eigen::MatrixBase<Derived>& m) {
  Json j = Json::array();
  for (Eigen::Index c = 0; c < m.cols(); ++c)
    for (Eigen::Index r = 0; r < m.rows(); ++r) j.push_back(m(r, c));
  return j;
}

template <typename Matrix>
Matrix fromJson(const Json& j) {
  Matrix m;
  if (!j.is_array() || j.size() != static_cast<std::size_t>(m.size())) throw BadInput("a list has the wrong length");
  for (Eigen::Index c = 0; c < m.cols(); ++c)
    for (Eigen::Index r = 0; r < m.rows(); ++r)
      m(r, c) = j.at(static_cast<std::size_t>(c * m.rows() + r)).get<typename Matrix::Scalar>();
  return m;
}

Json toJson(const image::Grid& g) {
  return {{"size", toJson(g.size)},
          {"spacing_mm", toJson(g.spacing_mm)},
          {"origin_lps_mm", toJson(g.origin_lps_mm)},
          {"direction", toJson(g.direction)}};
}

image::Grid gridOf(const Json& j) {
  image::Grid g;
  g.size = fromJson<Eigen::Vector3i>(j.at("size"));
  g.spacing_mm = fromJson<Eigen::Vector3d>(j.at("spacing_mm"));
  g.origin_lps_mm = fromJson<Eigen::Vector3d>(j.at("origin_lps_mm"));
  g.direction = fromJson<Eigen::Matrix3d>(j.at("direction"));
  g.check();
  return g;
}

/// The arrays one after the other.
class Body {
 public:
  explicit Body(std::string bytes = {}) : bytes_(std::move(bytes)) {}

  void put(const void* data, std::size_t count) { bytes_.append(static_cast<const char*>(data), count); }
  void take(void* data, std::size_t count) {
    if (count > bytes_.size() - at_) throw BadInput("it ends too early");
    if (count > 0) std::memcpy(data, bytes_.data() + at_, count);
    at_ += count;
  }
  template <typename T>
  void put(const image::Volume<T>& v) {
    put(v.values.data(), v.values.size() * sizeof(T));
  }
  template <typename T>
  image::Volume<T> volume(const image::Grid& grid) {
    // Before anything is allocated: no more voxels than there are bytes left.
    if (grid.voxelCount() > (bytes_.size() - at_) / sizeof(T)) throw BadInput("it ends too early");
    image::Volume<T> v;
    v.grid = grid;
    v.values.resize(grid.voxelCount());
    take(v.values.data(), v.values.size() * sizeof(T));
    return v;
  }
  void put(const anatomy::TriangleMesh& m) {
    put(m.vertices_lps_mm.data(), static_cast<std::size_t>(m.vertices_lps_mm.size()) * sizeof(double));
    put(m.triangles.data(), static_cast<std::size_t>(m.triangles.size()) * sizeof(int));
  }
  anatomy::TriangleMesh mesh(const Json& j) {
    const auto vertices = j.at("vertices").get<std::size_t>(), triangles = j.at("triangles").get<std::size_t>();
    const std::size_t left = bytes_.size() - at_;
    if (vertices > left / (3 * sizeof(double)) || triangles > left / (3 * sizeof(int)))
      throw BadInput("it ends too early");
    anatomy::TriangleMesh m;
    m.vertices_lps_mm.resize(3, static_cast<Eigen::Index>(vertices));
    m.triangles.resize(3, static_cast<Eigen::Index>(triangles));
    take(m.vertices_lps_mm.data(), 3 * vertices * sizeof(double));
    take(m.triangles.data(), 3 * triangles * sizeof(int));
    if (triangles > 0 && (m.triangles.minCoeff() < 0 || static_cast<std::size_t>(m.triangles.maxCoeff()) >= vertices))
      throw BadInput("a triangle names a vertex that is not there");
    return m;
  }
  template <typename Matrix>
  void putAll(const Matrix& m) {
    put(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Matrix::Scalar));
  }
  template <typename Matrix>
  void takeAll(Matrix& m) {
    take(m.data(), static_cast<std::size_t>(m.size()) * sizeof(typename Matrix::Scalar));
  }
  const std::string& bytes() const { return bytes_; }
  bool used() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

Json sizesOf(const anatomy::TriangleMesh& m) {
  return {{"vertices", m.vertices_lps_mm.cols()}, {"triangles", m.triangles.cols()}};
}

Json toJson(const render::BarContact& c) {
  return {{"travel_mm", c.travel_mm},     {"force_N", c.force_N},
          {"resultant_N", c.resultant_N}, {"area_mm2", c.area_mm2},
          {"capacity_N", c.capacity_N},   {"capacity_exceeded", c.capacityExceeded},
          {"slipped", c.slipped},         {"path", c.path}};
}

Json toJson(const render::RigidBar& bar) {
  Json line = Json::array();
  for (const Eigen::Vector3d& p : bar.centreline_lps_mm) line.push_back(toJson(p));
  Json j = {{"centreline_lps_mm", line},
            {"asked_N", bar.asked_N},
            {"surface", sizesOf(bar.surface)},
            {"mre", toJson(bar.mre)}};
  if (bar.atlas) j["atlas"] = toJson(*bar.atlas);
  return j;
}

/// Surface, then displacement and pressure of either contact.
void put(const render::RigidBar& bar, Body& body) {
  body.put(bar.surface);
  for (const render::BarContact* c : {&bar.mre, bar.atlas ? &*bar.atlas : nullptr}) {
    if (c == nullptr) continue;
    body.putAll(c->u_mm);
    body.putAll(c->pressure_kPa);
  }
}

render::BarContact contactOf(const Json& j, Eigen::Index vertices, Body& body) {
  render::BarContact c;
  c.travel_mm = j.at("travel_mm").get<double>();
  c.force_N = j.at("force_N").get<double>();
  c.resultant_N = j.at("resultant_N").get<double>();
  c.area_mm2 = j.at("area_mm2").get<double>();
  c.capacity_N = j.at("capacity_N").get<double>();
  c.capacityExceeded = j.at("capacity_exceeded").get<bool>();
  c.slipped = j.at("slipped").get<bool>();
  c.path = j.at("path").get<std::vector<std::array<double, 2>>>();
  c.u_mm.resize(3, vertices);
  c.pressure_kPa.resize(vertices);
  body.takeAll(c.u_mm);
  body.takeAll(c.pressure_kPa);
  return c;
}

render::RigidBar barOf(const Json& j, Body& body) {
  render::RigidBar bar;
  for (const Json& p : j.at("centreline_lps_mm")) bar.centreline_lps_mm.push_back(fromJson<Eigen::Vector3d>(p));
  if (bar.centreline_lps_mm.size() < 2) throw BadInput("its bar has no length");
  bar.asked_N = j.at("asked_N").get<double>();
  bar.surface = body.mesh(j.at("surface"));
  bar.mre = contactOf(j.at("mre"), bar.surface.vertices_lps_mm.cols(), body);
  if (j.contains("atlas")) bar.atlas = contactOf(j["atlas"], bar.surface.vertices_lps_mm.cols(), body);
  return bar;
}

void put(const render::HowSure& sure, Body& body) {
  body.put(sure.beyond);
  body.put(sure.tube);
  body.putAll(sure.vessel95_mm);
}

Json toJson(const render::HowSure& sure) {
  Json j = {{"tube", sizesOf(sure.tube)}, {"vessels", sure.vessel95_mm.size()}};
  if (!sure.beyond.values.empty()) j["beyond"] = toJson(sure.beyond.grid);
  return j;
}

render::HowSure howSureOf(const Json& j, Eigen::Index vertices, Body& body) {
  render::HowSure sure;
  if (j.contains("beyond")) sure.beyond = body.volume<float>(gridOf(j["beyond"]));
  sure.tube = body.mesh(j.at("tube"));
  const auto vessels = j.at("vessels").get<Eigen::Index>();
  if (vessels != 0 && vessels != vertices) throw BadInput("its vessels have another number of vertices");
  sure.vessel95_mm.resize(vessels);
  body.takeAll(sure.vessel95_mm);
  return sure;
}

Json toJson(const uncertainty::Interval& i) {
  return {i.low, i.high};
}

uncertainty::Interval intervalOf(const Json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>()};
}

Json toJson(const SureNumbers& n) {
  Json j = {{"at_retractor_mm", n.at_retractor_mm}, {"vessels", n.vessels}, {"sources", Json::array()}};
  for (const uncertainty::SourceSpread& s : n.sources)
    j["sources"].push_back(
        {static_cast<int>(s.kind), s.sd_mm, s.mean_sd_mm, s.travel_sd_mm, s.vessels_sd_mm, s.furthest_sd_mm});
  if (!n.headline) return j;
  const uncertainty::Headline& h = *n.headline;
  Json& k = j["headline"] = {{"mean_mm", toJson(h.mean_mm)},
                             {"at_retractor_mm", toJson(h.at_retractor_mm)},
                             {"travel_mm", toJson(h.travel_mm)},
                             {"beyond", {h.beyond, h.travelBeyond, h.withinVoxel}}};
  if (!h.vessels) return j;
  const uncertainty::VesselHeadline& v = *h.vessels;
  k["vessels"] = {{"mean_mm", toJson(v.mean_mm)},       {"max_mm", toJson(v.max_mm)},
                  {"beyond", toJson(v.beyond)},         {"furthest", v.furthest},
                  {"furthest_mm", v.furthest_mm},       {"furthest95_mm", toJson(v.furthest95_mm)},
                  {"furthest_beyond", v.furthestBeyond}};
  return j;
}

SureNumbers sureNumbersOf(const Json& j) {
  SureNumbers n;
  n.at_retractor_mm = j.at("at_retractor_mm").get<double>();
  n.vessels = j.at("vessels").get<bool>();
  for (const Json& s : j.at("sources")) {
    const int kind = s.at(0).get<int>();
    if (kind < 0 || kind > static_cast<int>(uncertainty::SourceKind::BeyondFirstOrder))
      throw BadInput("it names a source of uncertainty that is not known");
    n.sources.push_back({static_cast<uncertainty::SourceKind>(kind), s.at(1).get<double>(), s.at(2).get<double>(),
                         s.at(3).get<double>(), s.at(4).get<double>(), s.at(5).get<double>()});
  }
  if (!j.contains("headline")) return n;
  const Json& k = j["headline"];
  uncertainty::Headline& h = n.headline.emplace();
  h.mean_mm = intervalOf(k.at("mean_mm"));
  h.at_retractor_mm = intervalOf(k.at("at_retractor_mm"));
  h.travel_mm = intervalOf(k.at("travel_mm"));
  h.beyond = k.at("beyond").at(0).get<double>();
  h.travelBeyond = k.at("beyond").at(1).get<double>();
  h.withinVoxel = k.at("beyond").at(2).get<double>();
  if (k.contains("vessels")) {
    const Json& v = k["vessels"];
    h.vessels = {intervalOf(v.at("mean_mm")),          intervalOf(v.at("max_mm")),
                 intervalOf(v.at("beyond")),           v.at("furthest").get<std::size_t>(),
                 v.at("furthest_mm").get<double>(),    intervalOf(v.at("furthest95_mm")),
                 v.at("furthest_beyond").get<double>()};
  }
  if (n.vessels != h.vessels.has_value()) throw BadInput("it says two things of its vessels");
  return n;
}

PictureData parsed(const Json& j, Body body) {
  PictureData data;
  render::RetractionScene& s = data.scene;
  s.mri = body.volume<float>(gridOf(j.at("mri")));
  s.liver = body.volume<std::uint8_t>(gridOf(j.at("liver")));
  s.u_mre_mm = body.volume<Eigen::Vector3f>(gridOf(j.at("u_mre")));
  s.u_atlas_mm = body.volume<Eigen::Vector3f>(gridOf(j.at("u_atlas")));
  s.liverSurface = body.mesh(j.at("liver_surface"));
  s.vesselSurface = body.mesh(j.at("vessel_surface"));
  if (j.contains("bar")) s.bar = barOf(j["bar"], body);
  if (j.contains("how_sure")) s.sure = howSureOf(j["how_sure"], s.vesselSurface.vertices_lps_mm.cols(), body);
  if (!body.used()) throw BadInput("it holds more than it says");
  const Json& r = j.at("retractor");
  if (r.contains("point_lps_mm")) s.retractorPoint_lps_mm = fromJson<Eigen::Vector3d>(r["point_lps_mm"]);
  s.retractorAxis = fromJson<Eigen::Vector3d>(r.at("axis"));
  s.retractorDirection = fromJson<Eigen::Vector3d>(r.at("direction"));
  s.retractorDiameter_mm = r.at("diameter_mm").get<double>();
  s.retractorLength_mm = r.at("length_mm").get<double>();
  s.clinicallySignificant_mm = j.at("clinically_significant_mm").get<double>();
  s.caption = j.at("caption").get<std::string>();
  s.mark = j.at("mark").get<std::string>();
  s.valid = j.at("valid").get<bool>();
  s.compared = j.value("compared", true);
  s.stiffness = j.value("stiffness", s.stiffness);
  if (j.contains("sure_numbers")) data.sure = sureNumbersOf(j["sure_numbers"]);
  if (j.contains("vessel_lps_mm")) data.vessel_lps_mm = fromJson<Eigen::Vector3d>(j["vessel_lps_mm"]);
  return data;
}

}  // namespace

void writePictureFile(const std::filesystem::path& file, const PictureData& data) {
  const render::RetractionScene& s = data.scene;
  Body body;
  body.put(s.mri);
  body.put(s.liver);
  body.put(s.u_mre_mm);
  body.put(s.u_atlas_mm);
  body.put(s.liverSurface);
  body.put(s.vesselSurface);
  if (s.bar) put(*s.bar, body);
  if (s.sure) put(*s.sure, body);
  Json j;
  j["schema"] = "glisson/pictures/2";
  j["mri"] = toJson(s.mri.grid);
  j["liver"] = toJson(s.liver.grid);
  j["u_mre"] = toJson(s.u_mre_mm.grid);
  j["u_atlas"] = toJson(s.u_atlas_mm.grid);
  j["liver_surface"] = sizesOf(s.liverSurface);
  j["vessel_surface"] = sizesOf(s.vesselSurface);
  j["retractor"] = {{"axis", toJson(s.retractorAxis)},
                    {"direction", toJson(s.retractorDirection)},
                    {"diameter_mm", s.retractorDiameter_mm},
                    {"length_mm", s.retractorLength_mm}};
  if (s.retractorPoint_lps_mm) j["retractor"]["point_lps_mm"] = toJson(*s.retractorPoint_lps_mm);
  if (s.bar) j["bar"] = toJson(*s.bar);
  if (s.sure) j["how_sure"] = toJson(*s.sure);
  if (data.sure) j["sure_numbers"] = toJson(*data.sure);
  j["clinically_significant_mm"] = s.clinicallySignificant_mm;
  j["caption"] = s.caption;
  j["mark"] = s.mark;
  j["valid"] = s.valid;
  j["compared"] = s.compared;
  j["stiffness"] = s.stiffness;
  if (data.vessel_lps_mm) j["vessel_lps_mm"] = toJson(*data.vessel_lps_mm);
  j["bytes"] = body.bytes().size();
  j["sha256"] = sha256(body.bytes().data(), body.bytes().size());
  const std::string header = j.dump();
  const std::uint64_t length = header.size();

  PartFile part(file);
  part.write(magic, sizeof magic);
  part.write(&length, sizeof length);
  part.write(header.data(), header.size());
  part.write(body.bytes().data(), body.bytes().size());
  part.become();
}

PictureData readPictureFile(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code failed;
  if (!in || !std::filesystem::is_regular_file(file, failed))
    throw BadInput(
        "there is no " + named(file) +
        " in this folder: pictures can be drawn again where the run was asked for \"overlay\" or \"report\"");
  const std::uint64_t size = std::filesystem::file_size(file);
  char start[sizeof magic] = {};
  std::uint64_t length = 0;
  in.read(start, sizeof start);
  in.read(reinterpret_cast<char*>(&length), sizeof length);
  if (!in || std::memcmp(start, magic, sizeof magic) != 0 || length > largestHeader || length + 16 > size)
    throw BadInput(named(file) + " is damaged or not written by Glisson; run the scene again");
  std::string header(length, '\0'), bytes(size - 16 - length, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  try {
    if (!in) throw BadInput("it ends too early");
    const Json j = Json::parse(header);
    if (j.at("schema") != "glisson/pictures/2") throw BadInput("it is of another version");
    if (j.at("bytes") != bytes.size() || j.at("sha256") != sha256(bytes.data(), bytes.size()))
      throw BadInput("its content is not what was written");
    return parsed(j, Body(std::move(bytes)));
  } catch (const nlohmann::json::exception&) {
    throw BadInput(named(file) + " is damaged: its header cannot be read; run the scene again");
  } catch (const BadInput& e) {
    throw BadInput(named(file) + " cannot be used: " + e.what() + "; run the scene again");
  }
}

}  // namespace glisson::pipeline
