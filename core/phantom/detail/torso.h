// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "phantom/detail/shape.h"
#include "phantom/liver_shape.h"

namespace glisson::phantom {

/// Everything of the upper abdomen except the vessels in the liver, as implicit shapes drawn from a seed.
/// LPS, mm: x to the patient's left (the right lobe lies at negative x), y to the back, z to the head; the vertebral
/// column runs along z at x = 0.
class Torso {
 public:
  explicit Torso(std::uint64_t seed, LiverShape shape = LiverShape::Usual);

  /// Signed distance to the skin, negative inside the body.
  double body_mm(const Point& p) const;

  /// Signed distance to the liver's surface (capsule), large vessels within included in the liver, vena cava and
  /// gallbladder not.
  double liver_mm(const Point& p) const;

  /// The volume that liver_mm() < 0 was fitted to, mL (to about 1 %, by a coarse count).
  double targetVolume_mL() const { return targetVolume_mL_; }
  double liverTop_mm() const { return liverTop_mm_; }        ///< largest z
  double liverBottom_mm() const { return liverBottom_mm_; }  ///< smallest z

  /// Where the portal vein enters and where the hepatic veins leave: points just inside the liver's surface.
  Point portalHilum_lps_mm() const { return portalHilum_; }
  Point hepaticConfluence_lps_mm() const { return hepaticConfluence_; }

  /// Signals of a contrast-enhanced, fat-suppressed 3-D gradient echo (portal venous phase) and of the MR elastography
  /// gradient echo, arbitrary units, without noise.
  struct Signal {
    double contrast = 0.0;
    double elastography = 0.0;
  };
  /// liver_mm, vessel_mm: signed distances at p to the liver and to its vessels (both known to the caller).
  Signal signal(const Point& p, double body_mm, double liver_mm, double vessel_mm) const;

 private:
  struct Painting;  // of one point, in torso_signal.cpp

  double wall_mm(const Point& p) const;       // thickness of skin, fat and muscle at the angle of p
  double diaphragm_mm(const Point& p) const;  // negative below the diaphragm
  double liverBlobs_mm(const Point& p) const;
  Point cavaCentre(double z_mm) const;
  double cava_mm(const Point& p) const;
  double spineMass_mm(const Point& p) const;
  void reshape(LiverShape shape);
  void fitVolume(double share);
  void placeVesselRoots();

  std::uint64_t seed_;
  double halfWidth_mm_ = 0.0;
  double halfDepth_mm_ = 0.0;
  double fat_mm_ = 0.0;
  double liverOffset_mm_ = 0.0;
  double targetVolume_mL_ = 0.0;
  double liverTop_mm_ = 0.0;
  double liverBottom_mm_ = 0.0;
  Point portalHilum_ = Point::Zero();
  Point hepaticConfluence_ = Point::Zero();
  Ellipsoid rightDome_, leftDome_, centralDome_;
  Ellipsoid rightLobe_, leftLobe_, caudate_;
  std::vector<Ellipsoid> impressions_;  // smooth hollows of the visceral surface
  std::vector<Ellipsoid> fissures_;     // narrow clefts, filled with fat
  std::vector<Ellipsoid> tongues_;      // what hangs from the liver, in odd shapes only
  Ellipsoid gallbladder_, stomach_, antrum_, spleen_, rightKidney_, leftKidney_, heart_, leftVentricle_,
      rightVentricle_;
  Ellipsoid pancreas_;
  std::vector<Capsule> colon_;
  std::vector<Capsule> portalTrunk_;  // outside the liver: confluence to hilum, splenic and mesenteric veins
  std::vector<Capsule> hepaticStubs_;
  double cavaX_mm_ = 0.0;
};

}  // namespace glisson::phantom
