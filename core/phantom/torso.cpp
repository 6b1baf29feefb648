// SPDX-License-Identifier: GPL-3.0-or-later
#include "phantom/detail/torso.h"

#include "base/error.h"

namespace glisson::phantom {
namespace {

// Draws one organ: centre and radii vary a little from patient to patient.
Ellipsoid organ(Random& random, const Point& centre, const Point& radii, const Eigen::Matrix3d& axes,
                double shift_mm = 4.0, double spread = 0.06) {
  Ellipsoid e;
  for (int i = 0; i < 3; ++i) e.centre_lps_mm[i] = centre[i] + random.uniform(-shift_mm, shift_mm);
  for (int i = 0; i < 3; ++i) e.radii_mm[i] = radii[i] * (1.0 + random.uniform(-spread, spread));
  e.axes = axes;
  return e;
}

// A dome is the upper half of an ellipsoid on a cylinder.
double dome_mm(const Ellipsoid& e, const Point& p) {
  Point q = p;
  q.z() = std::max(p.z(), e.centre_lps_mm.z());
  return e.distance_mm(q);
}

double shareOfUsualVolume(LiverShape shape) {
  switch (shape) {
    case LiverShape::Short: return 0.72;
    case LiverShape::ThinLobe: return 0.68;
    case LiverShape::Riedel: return 1.10;
    case LiverShape::Usual:
    case LiverShape::Wide:
    case LiverShape::LargeLeft: break;
  }
  return 1.0;
}

}  // namespace

Torso::Torso(std::uint64_t seed, LiverShape shape) : seed_(seed) {
  Random r = derived(seed, 11);
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  halfWidth_mm_ = r.uniform(162.0, 178.0);
  halfDepth_mm_ = r.uniform(110.0, 121.0);
  fat_mm_ = r.uniform(11.0, 19.0);
  rightDome_ = organ(r, {-64, 0, -12}, {88, 100, 96}, upright, 2.0, 0.02);
  leftDome_ = organ(r, {66, 2, -14}, {84, 96, 80}, upright, 2.0, 0.02);
  centralDome_ = organ(r, {0, -6, -34}, {152, 116, 82}, upright, 2.0, 0.02);
  rightLobe_ = organ(r, {-76, 6, -6}, {84, 92, 104}, rotation(0, r.uniform(-4, 10), 0));
  leftLobe_ = organ(r, {2, -46, 27}, {86, 44, 37}, rotation(r.uniform(-6, 6), r.uniform(-14, -2), r.uniform(-4, 12)),
                    5.0, 0.12);
  caudate_ = organ(r, {-14, 12, 24}, {17, 15, 28}, rotation(0, 0, -20), 2.0);
  cavaX_mm_ = -24.0 + r.uniform(-2, 2);

  // Visceral surface: duodenum and colon from below and left, stomach from the left, right kidney from behind.
  impressions_.push_back(organ(r, {36, 36, -104}, {112, 118, 106}, rotation(0, 8, 0)));
  impressions_.push_back(organ(r, {78, 28, 38}, {66, 62, 78}, rotation(0, 0, 14)));
  impressions_.push_back(organ(r, {-58, 66, -74}, {33, 32, 58}, rotation(-8, 8, 0)));
  impressions_.push_back(organ(r, {-72, -78, -98}, {52, 46, 44}, upright));               // hepatic flexure
  fissures_.push_back(organ(r, {6, -42, -4}, {4.0, 30, 26}, rotation(0, 0, 10), 2.0));    // ligamentum teres
  fissures_.push_back(organ(r, {4, -7, 26}, {30, 3.0, 27}, rotation(0, 0, -24), 1.5));    // ligamentum venosum
  fissures_.push_back(organ(r, {-26, 2, -12}, {30, 7.0, 9.0}, rotation(0, 0, 16), 2.0));  // porta hepatis

  gallbladder_ = organ(r, {-48, -36, -36}, {15, 32, 16}, rotation(28, 0, 16), 3.0, 0.12);
  stomach_ = organ(r, {62, -14, 22}, {42, 54, 58}, rotation(0, -10, 16), 3.0);
  antrum_ = organ(r, {30, -46, -12}, {52, 24, 25}, rotation(0, -22, -12));
  spleen_ = organ(r, {98, 42, 20}, {31, 49, 54}, rotation(12, 10, 24), 3.0, 0.1);
  rightKidney_ = organ(r, {-57, 58, -66}, {27, 25, 52}, rotation(-8, 10, 18), 2.0);
  leftKidney_ = organ(r, {62, 56, -44}, {27, 26, 53}, rotation(-8, -10, -18), 2.0);
  heart_ = organ(r, {28, -42, 88}, {62, 46, 44}, rotation(0, 12, -24));
  leftVentricle_ = organ(r, {46, -32, 88}, {30, 23, 26}, rotation(0, 12, -24), 2.0);
  rightVentricle_ = organ(r, {6, -58, 84}, {34, 18, 24}, rotation(0, 12, -24), 2.0);
  pancreas_ = organ(r, {24, 12, -38}, {52, 11, 14}, rotation(0, -24, 14), 3.0);
  colon_ = {{{-96, -22, -140}, {-92, -24, -76}, 17.0}, {{-92, -24, -76}, {-60, -62, -80}, 15.0},
            {{-60, -62, -80}, {14, -70, -82}, 14.0},   {{14, -70, -82}, {84, -50, -36}, 14.0},
            {{84, -50, -36}, {108, -8, 2}, 15.0},      {{108, -8, 2}, {110, 22, -140}, 12.0}};
  for (Capsule& piece : colon_) piece.radius_mm *= 1.0 + r.uniform(-0.1, 0.1);
  reshape(shape);
  fitVolume(shareOfUsualVolume(shape));
  placeVesselRoots();
}

void Torso::reshape(LiverShape shape) {
  switch (shape) {
    case LiverShape::Usual: break;
    case LiverShape::Short:
      rightLobe_.centre_lps_mm.z() += 26.0;
      rightLobe_.radii_mm.z() *= 0.60;
      break;
    case LiverShape::Wide:
      rightLobe_.radii_mm = rightLobe_.radii_mm.cwiseProduct(Point(1.05, 0.80, 0.76));
      rightLobe_.centre_lps_mm.z() += 12.0;
      leftLobe_.centre_lps_mm += Point(34, 4, 0);
      leftLobe_.radii_mm = leftLobe_.radii_mm.cwiseProduct(Point(1.40, 1.05, 1.05));
      break;
    case LiverShape::ThinLobe:
      rightLobe_.radii_mm.y() *= 0.42;
      rightLobe_.centre_lps_mm.y() += 4.0;
      break;
    case LiverShape::Riedel: tongues_.push_back({{-103, -6, -112}, {30, 25, 74}, rotation(4, 3, 0)}); break;
    case LiverShape::LargeLeft:
      rightLobe_.radii_mm = rightLobe_.radii_mm.cwiseProduct(Point(0.82, 0.88, 0.80));
      leftLobe_.centre_lps_mm += Point(30, 14, -6);
      leftLobe_.radii_mm = leftLobe_.radii_mm.cwiseProduct(Point(1.25, 1.45, 1.50));
      impressions_[1].radii_mm *= 0.6;  // the stomach gives way
      break;
  }
}

double Torso::body_mm(const Point& p) const {
  // Superellipse of exponent 2.25, a little narrower to the head; first-order distance f / |grad f|.
  const double narrow = 1.0 - 0.0004 * std::max(p.z(), 0.0);
  const double a = halfWidth_mm_ * narrow;
  const double b = halfDepth_mm_ * narrow;
  constexpr double n = 2.25;
  const double x = std::abs(p.x()) / a;
  const double y = std::abs(p.y()) / b;
  const double xs = std::pow(x, n - 1.0);
  const double ys = std::pow(y, n - 1.0);
  const double sum = xs * x + ys * y;
  if (sum < 1e-6) return -std::min(a, b);
  const double f = std::pow(sum, 1.0 / n);
  const double g = f / sum;  // d f / d(sum) * n
  const double gradient = std::hypot(g * xs / a, g * ys / b);
  const double backGroove = 5.0 * std::exp(-std::pow(p.x() / 15.0, 2)) * smoothStep(40.0, 90.0, p.y());
  return (f - 1.0) / gradient + backGroove + 4.0 * noise({p.x(), p.y(), 0.4 * p.z()}, 95.0, seed_ + 1);
}

double Torso::wall_mm(const Point& p) const {
  const double angle = std::atan2(p.y() * halfWidth_mm_, p.x() * halfDepth_mm_);
  const double side = std::cos(angle) * std::cos(angle);
  return fat_mm_ * (0.8 + 0.35 * side) + 9.0 + 4.0 * side;
}

double Torso::diaphragm_mm(const Point& p) const {
  return smoothMin(smoothMin(dome_mm(rightDome_, p), dome_mm(leftDome_, p), 26.0), dome_mm(centralDome_, p), 16.0);
}

Point Torso::cavaCentre(double z_mm) const {
  return {cavaX_mm_ + 0.03 * z_mm, 38.0 - 9.0 * smoothStep(0.0, 80.0, z_mm), z_mm};
}

double Torso::cava_mm(const Point& p) const {
  const Point q = p - cavaCentre(p.z());
  const double k0 = std::hypot(q.x() / 13.5, q.y() / 10.0);
  return (k0 - 1.0) * 11.0;
}

double Torso::spineMass_mm(const Point& p) const {
  const double k0 = std::hypot(p.x() / 48.0, (p.y() - 86.0) / 46.0);
  return (k0 - 1.0) * 46.0;
}

double Torso::liverBlobs_mm(const Point& p) const {
  double d = smoothMin(rightLobe_.distance_mm(p), leftLobe_.distance_mm(p), 26.0);
  d += 2.2 * noise(p, 46.0, seed_ + 2) + 0.8 * noise(p, 20.0, seed_ + 3);
  return d;
}

double Torso::liver_mm(const Point& p) const {
  double d = liverBlobs_mm(p) + 0.35 * liverOffset_mm_;
  if (d > 30.0 && tongues_.empty()) return d;
  for (const Ellipsoid& e : impressions_) d = without(d, e.distance_mm(p) - liverOffset_mm_, 14.0);
  d = smoothMin(d, caudate_.distance_mm(p), 8.0);
  for (const Ellipsoid& e : tongues_) d = smoothMin(d, e.distance_mm(p), 24.0);
  const double cavity = body_mm(p) + wall_mm(p) + 2.5;
  d = smoothMax(d, cavity, 16.0);
  d = smoothMax(d, diaphragm_mm(p) + 1.5, 5.0);
  d = without(d, spineMass_mm(p), 12.0);
  d = without(d, cava_mm(p) - 0.8, 3.0);
  for (const Ellipsoid& e : fissures_) d = without(d, e.distance_mm(p), 4.0);
  return without(d, gallbladder_.distance_mm(p) - 1.5, 4.0);
}

void Torso::fitVolume(double share) {
  // A count on a coarse lattice, and a bisection of the offset that fills or hollows the liver, mostly from below:
  // the dome stays under the diaphragm.
  Random r = derived(seed_, 12);
  targetVolume_mL_ = share * r.uniform(1300.0, 1850.0);
  constexpr double h = 5.0;
  const double lowest = tongues_.empty() ? -150.0 : -230.0;
  auto volume_mL = [&] {
    std::size_t count = 0;
    liverTop_mm_ = -1e3;
    liverBottom_mm_ = 1e3;
    for (double z = lowest; z < 130; z += h)
      for (double y = -115; y < 115; y += h)
        for (double x = -170; x < 125; x += h)
          if (liver_mm({x, y, z}) < 0.0) {
            ++count;
            liverTop_mm_ = std::max(liverTop_mm_, z);
            liverBottom_mm_ = std::min(liverBottom_mm_, z);
          }
    return static_cast<double>(count) * h * h * h / 1000.0;
  };
  double grow = -22.0;
  double shrink = 46.0;
  for (int i = 0; i < 10; ++i) {
    liverOffset_mm_ = 0.5 * (grow + shrink);
    (volume_mL() > targetVolume_mL_ ? grow : shrink) = liverOffset_mm_;
  }
  liverTop_mm_ += h;
  liverBottom_mm_ -= h;
}

void Torso::placeVesselRoots() {
  auto walk = [&](Point from, const Point& to, double depth_mm) {
    const int steps = 160;
    for (int i = 0; i <= steps; ++i) {
      const Point p = from + (to - from) * i / steps;
      if (liver_mm(p) < -depth_mm) return p;
    }
    throw BadArgument("phantom: no way into the liver for its vessels (seed " + std::to_string(seed_) + ")");
  };
  portalHilum_ = walk({-20, 8, -14}, {-80, 0, 0}, 9.0);
  const double top = liverTop_mm_ - 34.0;
  const Point cava = cavaCentre(top);
  hepaticConfluence_ = walk(cava, cava + Point(-40, -50, -20), 9.0);

  const Point confluence(-2, 30, -48);
  const Point middle = 0.5 * (confluence + portalHilum_) + Point(2, 3, 1);
  portalTrunk_ = {{confluence, middle, 6.6},
                  {middle, portalHilum_, 6.4},
                  {confluence, {0, 26, -140}, 5.4},
                  {confluence, {40, 22, -24}, 4.4},
                  {{40, 22, -24}, {84, 40, 0}, 4.0}};
  hepaticStubs_ = {{cava, hepaticConfluence_, 6.6}};
}

}  // namespace glisson::phantom
