// SPDX-License-Identifier: GPL-3.0-or-later
#include "phantom/detail/torso.h"

namespace glisson::phantom {
namespace {

// Signals relative to 1000. Contrast: fat-suppressed T1-weighted gradient echo in the portal venous phase (blood and
// renal cortex brightest, fat and fluid dark). Elastography: gradient echo with a long echo time (fluid and fat
// brighter).
constexpr Torso::Signal air{4, 3}, skin{300, 210}, fat{120, 300}, muscle{235, 150}, cortical{40, 20}, marrow{205, 120},
    disc{120, 170}, fluid{55, 420}, cord{170, 230}, liverTissue{430, 215}, blood{760, 330}, bile{60, 430},
    spleenTissue{500, 330}, renalCortex{760, 350}, renalMedulla{560, 380}, gutWall{380, 230}, gutContent{110, 260},
    gas{10, 5}, lung{22, 8}, myocardium{360, 190}, gland{400, 220}, diaphragmMuscle{210, 120};

double cylinder_mm(const Point& p, double x, double y, double rx, double ry) {
  const double k0 = std::hypot((p.x() - x) / rx, (p.y() - y) / ry);
  return (k0 - 1.0) * std::min(rx, ry);
}

Torso::Signal scaled(const Torso::Signal& s, double factor) {
  return {s.contrast * factor, s.elastography * factor};
}

}  // namespace

// One point while its tissues are laid over each other, from the skin inwards. Distances in mm, negative inside.
struct Torso::Painting {
  Painting(const Torso& torso, const Point& point, double body_mm)
      : t(torso),
        p(point),
        seed(torso.seed_),
        body(body_mm),
        depth(body_mm + torso.wall_mm(point)),
        cavity(depth + 1.0),
        dome(torso.diaphragm_mm(point)),
        grain(noise(point, 7.0, seed + 20)),
        coarse(noise(point, 24.0, seed + 21)) {}

  void wall();
  void cavityFat();
  void chest();
  void smallBowel();
  void colon();
  // Pancreas, stomach and spleen, which the stomach dents.
  void upperOrgans();
  void kidneys();
  void backMuscles();
  void spine();
  void gallbladder();
  void liver(double liver_mm);
  void largeVessels(double vessel_mm);

  // Paints one tissue over what is there; the soft edge stands for the partial volume effect.
  void over(double d_mm, const Signal& tissue, double strength = 1.0, double edge_mm = 2.2) {
    if (d_mm > 0.5 * edge_mm) return;
    const double a = std::min(0.5 - d_mm / edge_mm, 1.0) * strength;
    s.contrast += a * (tissue.contrast - s.contrast);
    s.elastography += a * (tissue.elastography - s.elastography);
  }

  const Torso& t;
  const Point& p;
  std::uint64_t seed;
  double body;    // to the skin
  double depth;   // to the inside of the body's wall
  double cavity;  // to the cavity of abdomen and chest
  double dome;    // to the diaphragm, negative below it
  double grain, coarse;
  Signal s = air;
};

void Torso::Painting::wall() {
  over(body, skin);
  over(body + 2.4, scaled(fat, 1.0 + 0.10 * coarse + 0.22 * std::max(grain, 0.0)));
  const double muscleOuter = depth - 10.0 - 3.0 * coarse;
  over(muscleOuter, scaled(muscle, 1.0 + 0.13 * grain));
  over(muscleOuter + 5.5, fat, 0.55 * smoothStep(-0.1, 0.35, grain), 3.0);
  if (depth < 14.0 && depth > -6.0 && !(p.y() < -52.0 && p.z() < -18.0)) {  // ribs slope down to the front
    const double pitch = 27.0;
    const double along = std::fmod(p.z() - 0.42 * p.y() + 1000.0 * pitch + 0.04 * std::abs(p.x()), pitch) - 0.5 * pitch;
    const double rib = std::hypot(along / 6.4, (depth - 3.2) / 4.4) - 1.0;
    over(rib * 4.4, cortical);
    over(rib * 4.4 + 1.5, marrow);
  }
}

void Torso::Painting::cavityFat() {
  over(cavity, scaled(fat, 1.05 + 0.22 * coarse + 0.12 * grain));
  // Mesenteric and omental vessels: where two smooth fields vanish together there runs a curve.
  const double threads = 22.0 * std::hypot(noise(p, 31.0, seed + 32), noise(p, 31.0, seed + 33));
  over(std::max({threads - 1.3, cavity + 6.0, p.z() - 40.0}), scaled(blood, 0.8));
}

void Torso::Painting::chest() {
  if (!(dome > -5.0)) return;
  over(std::max(cavity, -dome - 1.2), diaphragmMuscle);
  const double air_mm = std::max(cavity + 1.0, -dome + 1.8);
  over(air_mm, scaled(lung, 1.0 + 1.1 * grain + 5.0 * smoothStep(0.42, 0.75, noise(p, 13.0, seed + 22))));
  const double heart = std::max(t.heart_.distance_mm(p) + 2.0 * coarse, -dome + 2.0);
  over(heart - 4.0 < -dome + 2.0 ? -dome + 2.0 : heart - 4.0, fat);
  over(heart, myocardium);
  over(std::max(heart + 5.0, std::min(t.leftVentricle_.distance_mm(p), t.rightVentricle_.distance_mm(p))),
       scaled(blood, 0.95));
}

// What lies between two levels of a warped field makes winding loops; its value sets wall and content.
void Torso::Painting::smallBowel() {
  const double roof = -28.0 + 0.2 * p.x() - 0.35 * std::max(p.y(), 0.0) + 12.0 * coarse;
  if (!(p.z() < roof + 8.0 && cavity < 0.0)) return;
  const Point warped = p + 7.0 * Point(noise(p, 33.0, seed + 24), noise(p, 33.0, seed + 25), noise(p, 33.0, seed + 26));
  const double loops = std::abs(noise(warped, 34.0, seed + 27));
  const double shell = smoothMax(smoothMax(p.z() - roof, cavity + 5.0, 10.0), p.y() - 30.0 + 10.0 * coarse, 10.0);
  const double d = smoothMax(30.0 * (0.10 - loops), shell, 8.0);
  over(d, scaled(gutWall, 0.85 + 0.2 * grain));
  over(d + 3.0, scaled(gutContent, 2.2 + 1.3 * noise(p, 48.0, seed + 28) + 0.5 * grain), 0.85, 4.0);
}

void Torso::Painting::colon() {
  double d = 1e3;
  for (const Capsule& piece : t.colon_) d = smoothMin(d, piece.distance_mm(p), 8.0);
  const double haustra = 1.8 * noise(p, 22.0, seed + 31);
  d = smoothMax(d + haustra, cavity + 3.0, 6.0);
  over(d, scaled(gutWall, 0.8 + 0.2 * grain));
  over(d + 2.6, scaled(gutContent, 1.3 + 1.0 * coarse + 0.8 * grain));
  over(smoothMax(d + 3.4, p.y() + 52.0 + 24.0 * noise(p, 70.0, seed + 29), 3.0), gas);
}

void Torso::Painting::upperOrgans() {
  over(t.pancreas_.distance_mm(p) + 3.5 * grain + 2.0 * coarse, scaled(gland, 0.95 + 0.12 * grain));
  const double gut = smoothMin(t.stomach_.distance_mm(p), t.antrum_.distance_mm(p), 16.0) + 5.0 * coarse;
  const double stomach = std::max({gut, cavity + 3.0, dome + 3.0});
  const double folds = 3.0 * std::abs(noise(p, 13.0, seed + 30));
  over(stomach, scaled(gutWall, 1.1 + 0.2 * grain));
  over(stomach + 3.0 + folds, scaled(gutContent, 1.3 + 0.8 * coarse + 0.7 * std::max(grain, 0.0)));
  over(std::max(stomach + 4.0 + folds, 0.5 * (p.y() + 26.0) + 1.5 * coarse), gas);  // on the back: gas in front

  const double spleen =
      smoothMax(smoothMax(without(t.spleen_.distance_mm(p) + 3.0 * coarse, stomach - 3.0, 8.0), cavity + 2.0, 9.0),
                dome + 1.5, 5.0);
  over(spleen, scaled(spleenTissue, 1.0 + 0.035 * grain));
}

void Torso::Painting::kidneys() {
  for (const Ellipsoid* k : {&t.rightKidney_, &t.leftKidney_}) {
    const double side = k == &t.rightKidney_ ? 1.0 : -1.0;
    double d = k->distance_mm(p);
    if (d > 12.0) continue;
    Ellipsoid hilum = *k;
    hilum.centre_lps_mm += Point(side * 20.0, -13.0, 0.0);
    hilum.radii_mm = Point(15.0, 12.0, 22.0);
    const double sinus = hilum.distance_mm(p);
    d = without(d, sinus + 5.0, 4.0);
    over(d, scaled(renalCortex, 1.0 + 0.04 * grain));
    over(d + 6.0 + 9.0 * std::max(noise(p, 14.0, seed + 23), 0.0), renalMedulla, 0.85, 3.0);
    over(std::max(d - 1.0, sinus), scaled(fat, 1.2));
  }
}

void Torso::Painting::backMuscles() {
  const double paraspinal = std::min(cylinder_mm(p, -33, 92, 29, 17), cylinder_mm(p, 33, 92, 29, 17));
  over(std::max(paraspinal, body + 8.0), scaled(muscle, 1.0 + 0.2 * grain));
  if (p.z() < 0.0) {  // the psoas widens downwards from the first lumbar vertebra
    const double width = 15.0 * smoothStep(10.0, -90.0, p.z());
    over(std::min(cylinder_mm(p, -33, 68, 15, 16), cylinder_mm(p, 33, 68, 15, 16)) + 15.0 - width,
         scaled(muscle, 1.0 + 0.1 * grain));
  }
  const double crura = smoothMin(cylinder_mm(p, -10, 48, 6, 10), cylinder_mm(p, 21, 50, 5, 11), 6.0);
  over(smoothMin(crura, cylinder_mm(p, 5, 53, 20, 8), 8.0) + 1.5 * coarse, scaled(muscle, 1.05));
}

void Torso::Painting::spine() {
  const double level = std::abs(std::fmod(p.z() + 1000.0 * 34.0, 34.0) - 17.0);  // 17: middle of a disc
  const double vertebra =
      cylinder_mm(p, 0, 66, 24.0 - 2.0 * smoothStep(17.0, 0.0, level), 18.0 - 1.5 * smoothStep(17.0, 0.0, level));
  over(vertebra, cortical);
  over(vertebra + 1.8, scaled(marrow, 1.25 + 0.16 * grain));
  over(std::max(vertebra + 1.2, level - 4.5), disc);
  const double arch = std::max(cylinder_mm(p, 0, 91, 18, 14), level - 12.0);
  over(arch, cortical);
  over(arch + 2.2, marrow);
  over(std::max({std::abs(p.x()) - 3.5, 96.0 - p.y(), p.y() - 112.0, body + 5.0, level - 10.0}), marrow);
  over(cylinder_mm(p, 0, 89, 11.5, 9.5), fluid);
  over(cylinder_mm(p, 0, 89.5, 6.0, 5.0), cord);
}

void Torso::Painting::gallbladder() {
  const double d = t.gallbladder_.distance_mm(p);
  over(d, scaled(gutWall, 0.9));
  over(d + 1.6, scaled(bile, 1.0 + 1.2 * smoothStep(0.0, 14.0, p.y() - t.gallbladder_.centre_lps_mm.y())));
}

void Torso::Painting::liver(double liver_mm) {
  over(liver_mm, scaled(liverTissue, 1.0 + 0.03 * grain + 0.035 * coarse));
}

void Torso::Painting::largeVessels(double vessel_mm) {
  const double flow = 1.0 + 0.05 * grain;
  over(cylinder_mm(p, 13.0, 39.0 + 0.03 * p.z(), 10.5, 10.5), cortical, 0.6);
  over(cylinder_mm(p, 13.0, 39.0 + 0.03 * p.z(), 9.8, 9.8), scaled(blood, 1.0 * flow));
  over(t.cava_mm(p), scaled(blood, 0.92 * flow));
  for (const Capsule& trunk : t.portalTrunk_) over(trunk.distance_mm(p), scaled(blood, flow));
  for (const Capsule& stub : t.hepaticStubs_) over(stub.distance_mm(p), scaled(blood, 0.95 * flow));
  over(vessel_mm, scaled(blood, 0.97));
}

Torso::Signal Torso::signal(const Point& p, double body, double liver, double vessel) const {
  if (body > 2.0) return air;
  Painting painting(*this, p, body);
  painting.wall();
  painting.cavityFat();
  painting.chest();
  painting.smallBowel();
  painting.colon();
  painting.upperOrgans();
  painting.kidneys();
  painting.backMuscles();
  painting.spine();
  // Liver last of the organs, then everything that holds enhanced blood.
  painting.gallbladder();
  painting.liver(liver);
  painting.largeVessels(vessel);
  return painting.s;
}

}  // namespace glisson::phantom
