// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>

namespace glisson {

/// Strong types where a mix-up is silent and clinical. Each has one named factory per unit and one named reader per
/// unit; there is no conversion between quantities except the named functions below.

/// Shear modulus µ, what MR elastography reports.
class ShearModulus {
 public:
  static constexpr ShearModulus fromKPa(double kPa) { return ShearModulus(kPa); }
  constexpr double kPa() const { return kPa_; }
  constexpr double Pa() const { return 1e3 * kPa_; }
  constexpr auto operator<=>(const ShearModulus&) const = default;

 private:
  explicit constexpr ShearModulus(double kPa) : kPa_(kPa) {}
  double kPa_;
};

/// Young's modulus E, what the mechanics needs.
class YoungsModulus {
 public:
  static constexpr YoungsModulus fromKPa(double kPa) { return YoungsModulus(kPa); }
  constexpr double kPa() const { return kPa_; }
  constexpr double Pa() const { return 1e3 * kPa_; }
  constexpr auto operator<=>(const YoungsModulus&) const = default;

 private:
  explicit constexpr YoungsModulus(double kPa) : kPa_(kPa) {}
  double kPa_;
};

/// E = 2 (1 + ν) µ, isotropic linear elasticity. poisson: unitless.
constexpr YoungsModulus toYoungs(ShearModulus mu, double poisson) {
  return YoungsModulus::fromKPa(2.0 * (1.0 + poisson) * mu.kPa());
}

/// µ = E / (2 (1 + ν)).
constexpr ShearModulus toShear(YoungsModulus E, double poisson) {
  return ShearModulus::fromKPa(E.kPa() / (2.0 * (1.0 + poisson)));
}

/// Mass density.
class Density {
 public:
  static constexpr Density fromKgPerM3(double v) { return Density(v); }
  constexpr double kgPerM3() const { return v_; }
  constexpr auto operator<=>(const Density&) const = default;

 private:
  explicit constexpr Density(double v) : v_(v) {}
  double v_;
};

/// A length that crosses between the imaging rooms (mm) and mechanics (m).
class Length {
 public:
  static constexpr Length fromMm(double mm) { return Length(mm); }
  static constexpr Length fromM(double m) { return Length(1e3 * m); }
  constexpr double mm() const { return mm_; }
  constexpr double m() const { return 1e-3 * mm_; }
  constexpr auto operator<=>(const Length&) const = default;

 private:
  explicit constexpr Length(double mm) : mm_(mm) {}
  double mm_;
};

/// Which modulus a bare number or map is.
enum class StiffnessQuantity { Shear, Youngs };

/// Defaults of the study (all editable, all written to the run record).
namespace defaults {
inline constexpr Density liverDensity = Density::fromKgPerM3(1060.0);
inline constexpr double poisson = 0.45;                                         // unitless
inline constexpr double gravity_m_s2 = 9.81;                                    // m/s²
inline constexpr ShearModulus atlasShear = ShearModulus::fromKPa(2.1);          // healthy donors [lee2013mr]
inline constexpr Length clinicallySignificant = Length::fromMm(5.0);            // [bernhardt2017status]
inline constexpr Length mriVoxel = Length::fromMm(1.64);                        // GE MR750 study
inline constexpr Length retractorDiameter = Length::fromMm(10.0);               // Nathanson
inline constexpr YoungsModulus phantomSilicone = YoungsModulus::fromKPa(12.0);  // 10 % silicone
inline constexpr double confidenceThreshold = 0.95;                             // unitless, of 1
}  // namespace defaults

}  // namespace glisson
