// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/sha256.h"
#include "base/version.h"
#include "pipeline/detail/checklist.h"
#include "pipeline/detail/method_text.h"
#include "pipeline/detail/outputs.h"
#include "pipeline/detail/record.h"
#include "pipeline/detail/told.h"
#include "pipeline/detail/uncertainty_record.h"
#include "report/page.h"
#include "report/text.h"
#include "retraction/contact_path.h"

namespace glisson::pipeline::detail {
namespace {

using report::number;
using report::Page;

/// Components that are rounding beside the largest are zero.
std::string inWords(const Eigen::Vector3d& v) {
  const auto part = [least = 1e-6 * v.cwiseAbs().maxCoeff()](double x) {
    return std::abs(x) <= least ? std::string("0") : number(x);
  };
  return part(v.x()) + ", " + part(v.y()) + ", " + part(v.z());
}

using Rows = std::vector<std::pair<std::string, std::string>>;

/// What the bar and the liver of one stiffness do to each other.
void barRows(const std::string& who, const retraction::RigidContact& c, Rows& rows) {
  rows.emplace_back("Bar, " + who, std::string(c.answered() ? "" : "is no answer; its last state: ") + "travels " +
                                       number(c.travel_mm, 3) + " mm, bears " + number(c.force_N.dot(c.hoist), 3) +
                                       " N along the hoist (resultant " + number(c.force_N.norm(), 3) + " N) on " +
                                       number(c.area_mm2, 3) + " mm² (" + number(c.footprint_mm2, 3) +
                                       " mm² seen along the hoist)");
  rows.emplace_back("Largest contact pressure, " + who, number(c.pressureMax_kPa, 3) + " kPa");
  if (c.slipped())
    rows.emplace_back("Capacity, " + who,
                      number(c.capacity_N, 3) + " N after " + number(c.capacityAt_mm, 3) + " mm: the bar slips");
  else if (c.capacityExceeded)
    rows.emplace_back("Capacity, " + who, number(c.capacity_N, 3) + " N, met on the way");
}

/// What the scene's own stiffness is called beside the textbook's.
std::string ownIn(const Scene& scene) {
  return scene.material.kind == MaterialSpec::Kind::Mre ? "measured" : "own";
}

/// What the body is called, in the middle of a sentence.
const char* bodyOf(const Scene& scene) {
  return scene.geometry.kind == GeometrySpec::Kind::Box ? "body" : "liver";
}

const char* wordsOf(Significance s) {
  return s == Significance::Open     ? " (cannot be told from 5 mm)"
         : s == Significance::Beyond ? " (5 mm or more: clinically significant)"
                                     : "";
}

void results(Page& page, const Scene& scene, const RunResult& r) {
  const std::string ownWord = ownIn(scene);
  page.heading("Result");
  Rows rows;
  for (const Diagnostic& d : r.diagnostics)
    if (d.code == DiagnosticCode::DifferenceWithheld) rows.emplace_back("Difference", "withheld: " + d.text());
  if (r.difference) {
    const comparison::Difference& d = *r.difference;
    const bool sure = r.uncertainty && r.uncertainty->known && r.uncertainty->spread.headline;
    const uncertainty::Headline h = sure ? *r.uncertainty->spread.headline : uncertainty::Headline{};
    const auto with95 = [sure](const uncertainty::Interval& i) { return sure ? in95(i, "mm") : std::string(); };
    rows.emplace_back(std::string("Difference over the ") + bodyOf(scene) + ", mean",
                      number(d.mean_mm) + " mm" + with95(h.mean_mm));
    rows.emplace_back(std::string("95 % of the ") + bodyOf(scene) + " below", number(d.p95_mm) + " mm");
    rows.emplace_back("Largest", number(d.max_mm) + " mm");
    rows.emplace_back("At the retractor",
                      number(d.at_retractor_mm) + " mm" + with95(h.at_retractor_mm) + wordsOf(significanceOf(r)));
    if (r.discretisation && r.discretisation->difference && r.discretisation->difference->at_retractor_mm)
      rows.emplace_back("At the retractor, error from the size of the cells",
                        "about " + number(*r.discretisation->difference->at_retractor_mm) + " mm");
    if (d.travel_mm) {
      rows.emplace_back("Travel of the bar, " + ownWord + " less textbook",
                        number(*d.travel_mm) + " mm" + with95(h.travel_mm));
      rows.emplace_back("Force on the bar at equal lift (" + number(d.equal_lift->travel_mm, 3) + " mm)",
                        number(d.equal_lift->force_N, 3) + " N " + ownWord + ", " +
                            number(d.equal_lift->other_force_N, 3) + " N textbook" +
                            (d.equal_lift->alongPath ? " (along the path, brought to the answers)" : ""));
    }
    if (!d.vessel_mm.empty()) {
      rows.emplace_back("Vessel landmarks, mean",
                        number(d.vesselMean_mm) + " mm" + (h.vessels ? in95(h.vessels->mean_mm, "mm") : ""));
      rows.emplace_back("Vessel landmarks, largest",
                        number(d.vesselMax_mm) + " mm" + (h.vessels ? in95(h.vessels->max_mm, "mm") : ""));
      const auto inPercent = [](const uncertainty::Interval& share) {
        return in95({100 * share.low, 100 * share.high}, "%");
      };
      rows.emplace_back("Vessel landmarks 5 mm or more apart", number(100 * d.vesselFractionBeyond, 3) + " %" +
                                                                   (h.vessels ? inPercent(h.vessels->beyond) : ""));
    }
  }
  for (const auto& [who, result] :
       {std::pair(ownWord, &r.primary), std::pair(std::string("textbook"), r.atlas ? &*r.atlas : nullptr)})
    if (result != nullptr && result->contact) barRows(who, *result->contact, rows);
  rows.emplace_back("Kinematics", nameOf(r.primary.kinematics) + ": " + r.kinematicsWhy);
  const Motion motion = motionOf(r.model, r.primary);
  rows.emplace_back("Displacement, mean", number(motion.mean_mm) + " mm");
  rows.emplace_back("Displacement, largest", number(motion.max_mm) + " mm");
  if (r.primary.retractorPoint_mm)
    rows.emplace_back("Displacement at the retractor", number(motion.at_retractor_mm) + " mm");
  if (r.stiffness) {
    const auto& s = r.stiffness->pooled;
    rows.emplace_back(
        r.stiffness->quantity == StiffnessQuantity::Shear ? "Shear modulus in the ROI" : "Young's modulus in the ROI",
        number(s.mean_kPa) + " ± " + number(s.sd_kPa) + " kPa (" + std::to_string(s.n_before_mask) + " voxels, " +
            std::to_string(s.n) + " after the confidence mask)");
  }
  page.table(rows);
}

/// A list where there is something to list.
void listed(Page& page, const std::vector<std::string>& items) {
  if (!items.empty()) page.list(items);
}

/// The verdict on one answer and what is said against it. who: its stiffness, empty where there is one answer only.
void judged(Page& page, const std::string& who, const retraction::Result& r) {
  std::string of = who.empty() ? std::string() : who + " stiffness: ";
  if (!of.empty()) of.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(of.front())));
  const auto sentence = [&of](std::string words) {
    if (!of.empty()) words.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(words.front())));
    return of + words;
  };
  if (!isAnswer(r))
    page.warning(sentence("This is no answer, and its numbers are not to be used."));
  else if (r.linearTrusted)
    page.paragraph(sentence(r.kinematics == retraction::Kinematics::Linear
                                ? "Strains and rotations are small enough for linear theory."
                                : "The large-deformation solve converged, and no cell is turned inside out."));
  else
    page.warning(sentence("The result is outside the limits of its theory; it is shown with this reservation."));
  listed(page, r.validity);
}

void trust(Page& page, const Scene& scene, const RunResult& r) {
  page.heading("Can it be trusted?");
  const std::string own = r.atlas ? ownIn(scene) : std::string();
  judged(page, own, r.primary);
  if (r.atlas) judged(page, "textbook", *r.atlas);
  if (const std::string advice = adviceOn(scene, r); !advice.empty()) page.warning(advice);
  page.table(
      {{"Solver", r.primary.solver.kind + ", relative residual " + number(r.primary.solver.residual, 2)},
       {"Strain, largest / 95 % below", number(r.primary.max_strain, 3) + " / " + number(r.primary.p95_strain, 3)},
       {"Largest rotation",
        number(r.primary.max_rotation_deg, 3) + " degrees" +
            (r.primary.cellsLeftOut > 0 ? " (strain and rotation without " + std::to_string(r.primary.cellsLeftOut) +
                                              " cells of which less than half is tissue)"
                                        : std::string())},
       {"Load", inWords(r.primary.load_N) + " N"},
       {"Reaction", inWords(r.primary.reaction_N) + " N"}});
  if (r.discretisation) {
    const retraction::DiscretisationError& e = *r.discretisation;
    if (e.known) {
      const auto mm = [](double v) { return number(v, 3) + " mm"; };
      const auto there = [&](const std::optional<double>& v) { return v ? mm(*v) : std::string("–"); };
      std::vector<std::vector<std::string>> rows = {{"of a displacement", mm(e.mean_mm), mm(e.p95_mm), mm(e.max_mm),
                                                     there(e.at_retractor_mm), there(e.vessels_mm)}};
      if (e.difference)
        rows.push_back({"of the difference MRE against atlas", mm(e.difference->mean_mm), "–", "–",
                        there(e.difference->at_retractor_mm), there(e.difference->vessels_mm)});
      page.table({"Discretisation error", "mean", "95 % below", "largest", "at the retractor", "vessels, mean"}, rows);
      page.paragraph("Estimated from cells of " + number(e.cell_mm) + " and " + number(e.coarse_mm) + " mm.");
    } else {
      page.paragraph(e.note);
    }
  } else {
    page.paragraph("The discretisation error of this run was not estimated.");
  }
  listed(page, r.warnings);
  listed(page, r.diagnostics.texts());
}

std::string verdict(const retraction::Result& r) {
  if (!r.solver.converged()) return "not converged";
  return r.linearTrusted ? "within its limits" : "outside its limits";
}

void kinematics(Page& page, const RunResult& r) {
  if (!r.linear) return;
  const retraction::Result &own = r.primary, &linear = r.linear->primary;
  const Motion a = motionOf(r.model, linear), b = motionOf(r.model, own);
  page.heading("Linear theory beside " + nameOf(own.kinematics) + " kinematics");
  const auto mm = [](double v) { return number(v) + " mm"; };
  std::vector<std::vector<std::string>> rows = {
      {"Displacement, mean", mm(a.mean_mm), mm(b.mean_mm), mm(r.linear->between.mean_mm)},
      {"Displacement, largest", mm(a.max_mm), mm(b.max_mm), mm(r.linear->between.max_mm)}};
  if (own.retractorPoint_mm)
    rows.push_back({"Displacement at the retractor", mm(a.at_retractor_mm), mm(b.at_retractor_mm),
                    mm(r.linear->between.at_retractor_mm)});
  const auto difference = [&](double x, double y) {
    return std::vector<std::string>{"", mm(x), mm(y), mm(std::abs(x - y))};
  };
  if (r.difference && r.linear->difference) {
    const auto row = [&](const std::string& what, double x, double y) {
      rows.push_back(difference(x, y));
      rows.back().front() = what;
    };
    row("MRE against atlas, mean", r.linear->difference->mean_mm, r.difference->mean_mm);
    row("MRE against atlas, largest", r.linear->difference->max_mm, r.difference->max_mm);
    if (own.retractorPoint_mm)
      row("MRE against atlas, at the retractor", r.linear->difference->at_retractor_mm, r.difference->at_retractor_mm);
  }
  rows.push_back({"Strain, largest", number(linear.max_strain, 3), number(own.max_strain, 3), "–"});
  rows.push_back({"Strain, 95 % below", number(linear.p95_strain, 3), number(own.p95_strain, 3), "–"});
  rows.push_back(
      {"Largest rotation", number(linear.max_rotation_deg, 3) + "°", number(own.max_rotation_deg, 3) + "°", "–"});
  rows.push_back({"Validity", verdict(linear), verdict(own), "–"});
  page.table({"", "linear", nameOf(own.kinematics), "apart"}, rows);
  page.paragraph(
      "\"Apart\" is, for displacements, the distance between the two places of the same tissue (mean, largest, "
      "mean at the retractor); for the differences between the stiffnesses, how much they change.");
  if (!linear.validity.empty()) {
    page.paragraph("What is said against the linear answer:");
    page.list(linear.validity);
  }
}

/// Of the pictures of how sure the run is; empty for others.
std::string captionOfHowSure(const std::string& name) {
  if (name == "tornado-retractor.png")
    return "What the difference at the retractor depends on: each source of uncertainty alone (one standard "
           "deviation), and all together";
  if (name == "tornado-vessel.png") return "The same for the vessels";
  if (name == "probability-map.png")
    return "Probability that the two predictions place the tissue 5 mm or more apart, at rest, with the line of one "
           "half";
  if (name.rfind("how-sure-3d", 0) == 0)
    return "Vessels where the first stiffness puts them, coloured by the distance that holds each place with 95 %, "
           "inside the region that holds them with 95 %";
  return "";
}

/// Names the colours of the palette.
std::string captionOf(const std::string& name, render::Palette palette, const Scene& scene, bool compared) {
  const std::string own = ownIn(scene), body = bodyOf(scene);
  const bool usual = palette == render::Palette::RedBlue;
  const std::string textbook = usual ? "red" : "orange", both = usual ? "purple" : "white";
  if (name == "force-travel.png")
    return "Force of the bar on the " + body + " against its travel, " + own + (compared ? " and textbook" : "") +
           " stiffness, with the force asked for and the capacity of the place where it was met";
  if (name.rfind("contact-pressure", 0) == 0)
    return "Contact pressure on the retracted " + body + ", seen from behind and below through the bar: " +
           (name.rfind("contact-pressure-atlas", 0) == 0 ? "textbook" : own) + " stiffness";
  if (name == "difference-map.png") return "Distance between the two predictions, mm";
  if (const std::string sure = captionOfHowSure(name); !sure.empty()) return sure;
  if (name.rfind("overlay-3d", 0) == 0)
    return compared ? "Vessels where the " + own +
                          " stiffness puts them (blue) and where the textbook stiffness does (" + textbook + ")"
                    : "Body and vessels where the " + own + " stiffness puts them";
  const char* where = name == "overlay-vessels.png"     ? "Slice of the most misplaced vessel"
                      : name == "overlay-retractor.png" ? "Slice of the retractor"
                      : compared                        ? "Slice of the largest difference"
                                                        : "Slice of the largest displacement";
  if (!compared) return std::string(where) + ": the image moved by the prediction";
  return std::string(where) + ": the image moved by each prediction, " + own + " stiffness in blue, textbook in " +
         textbook + ", " + both + " where they agree";
}

}  // namespace

void Writer::report(const Scene& scene, const RunResult& r,
                    const std::vector<std::pair<std::string, std::string>>& inputs, render::Palette palette,
                    Language language) {
  Page page(r.difference ? std::string(bodyOf(scene) == std::string("liver") ? "Liver retraction, " : "Retraction, ") +
                               ownIn(scene) + " against textbook stiffness"
                         : std::string("Deformation under load"));
  results(page, scene, r);
  if (r.uncertainty) detail::howSure(*r.uncertainty, language, page);
  if (r.stiffness) readersChecklist(*r.stiffness, page);
  trust(page, scene, r);
  kinematics(page, r);
  page.heading("Pictures");
  int figure = 0;
  for (const auto& f : r.files)
    if (f.extension() == ".png")
      page.picture(f, "Figure " + std::to_string(++figure) + ". " +
                          captionOf(f.filename().string(), palette, scene, r.atlas.has_value()));
  if (figure == 0) page.paragraph("There is none: what did not converge, or is no deformation, is not drawn.");
  page.heading("Method");
  for (const std::string& paragraph : methodText(scene, r)) page.paragraph(paragraph);
  page.heading("Manifest");
  page.paragraph("Glisson " + version() + ", commit " + buildCommit() + ", seed " + std::to_string(scene.setup.seed) +
                 ". \"glisson-cli replay run.json\" computes this again and compares every file by its SHA-256.");
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, digest] : inputs) rows.push_back({"input", name, digest});
  for (const auto& f : r.files) rows.push_back({"output", f.filename().string(), sha256OfFile(f)});
  if (!rows.empty()) page.table({"", "what", "SHA-256"}, rows);
  text("report.html", report::html(page));
  text("report.pdf", report::pdf(page));
}

}  // namespace glisson::pipeline::detail
