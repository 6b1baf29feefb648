// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/map_unit.h"
#include "pipeline/sources.h"

namespace glisson::pipeline {
namespace {

using dicom::MapQuantity;

/// Of tissue, as elastography takes it to turn wave speeds into moduli.
constexpr double density_kg_m3 = 1000.0;

MapQuantity of(StiffnessQuantity quantity) {
  return quantity == StiffnessQuantity::Youngs ? MapQuantity::YoungsModulus : MapQuantity::ShearModulus;
}

/// What the series holds, and what is to be told about how that is known.
MapQuantity quantityOf(const dicom::Series& series, const MapMeaning& meaning, const std::optional<MapUnit>& unit,
                       Diagnostics& said) {
  const bool speed = unit && unit->of == MapUnit::Of::Speed;
  const auto words = dicom::quantityInWords(series.description);
  if (meaning.quantity) {
    if (series.quantity && *series.quantity != of(*meaning.quantity))
      said.add(DiagnosticCode::QuantityAsAsked,
               {{"quantity", dicom::inWords(*series.quantity)}, {"asked", dicom::inWords(of(*meaning.quantity))}});
    return of(*meaning.quantity);
  }
  if (series.quantity == MapQuantity::Other || (!series.quantity && words == MapQuantity::Other))
    throw BadInput("the series '" + series.description +
                   "' says that it holds another quantity than a stiffness (shear modulus, Young's modulus or wave "
                   "speed); choose another, or say what it holds with --quantity (shear or youngs)");
  if (series.quantity) {
    if (words && *words != *series.quantity)
      said.add(DiagnosticCode::QuantitiesContradict,
               {{"quantity", dicom::inWords(*series.quantity)}, {"other", dicom::inWords(*words)}});
    return *series.quantity;
  }
  if (speed) return MapQuantity::WaveSpeed;
  if (words == MapQuantity::WaveSpeed && unit) {
    said.add(DiagnosticCode::UnitsContradict,
             {{"words", std::string("m/s (a wave speed)")}, {"unit", meaning.unit.value_or(series.unit.value_or(""))}});
    return MapQuantity::ShearModulus;
  }
  if (words && *words != MapQuantity::ShearModulus)
    said.add(DiagnosticCode::QuantityByWords, {{"quantity", dicom::inWords(*words)}});
  // MR elastography reports the shear modulus unless told otherwise.
  return words.value_or(MapQuantity::ShearModulus);
}

/// Where voxels of a map hold no value.
void tellUndefined(const dicom::ReadMap& read, Diagnostics& said) {
  if (read.padding > 0) said.add(DiagnosticCode::PaddingLeftOut, {{"voxels", read.padding}});
  if (read.outsideRange > 0) said.add(DiagnosticCode::OutsideMappedRange, {{"voxels", read.outsideRange}});
}

}  // namespace

elastography::StiffnessMap readStiffness(const dicom::Series& series, const MapMeaning& meaning, Diagnostics& said,
                                         const Progress& progress) {
  if (series.colour)
    throw BadInput("the series '" + series.description +
                   "' is in colour: a coloured elastogram is not a stiffness map; "
                   "choose the grey-scale stiffness series");
  const std::optional<std::string> named = meaning.unit ? meaning.unit : series.unit;
  const auto unit = named ? mapUnit(*named) : std::nullopt;
  if (meaning.unit && (!unit || unit->of == MapUnit::Of::Modulus)) elastography::unitFactor_kPa(*meaning.unit);
  if (!unit)
    throw BadInput("the series '" + series.description + "' does not say in which unit its stiffness is" +
                   (named ? " (it says '" + named->substr(0, 32) + "', which is none)" : std::string()) +
                   "; give it with --unit (Pa, kPa or <factor>kPa), and "
                   "--quantity (shear or youngs) where it is not the shear modulus");
  const MapQuantity quantity = quantityOf(series, meaning, unit, said);
  const bool speed = unit->of == MapUnit::Of::Speed;
  if (speed != (quantity == MapQuantity::WaveSpeed))
    throw BadInput("the series '" + series.description + "' says that it holds " + dicom::inWords(quantity) +
                   ", but its unit is " + *named + ": one of the two is wrong; give its unit with --unit");
  dicom::ReadMap read = dicom::readMap(series, progress);
  tellUndefined(read, said);
  elastography::StiffnessMap map;
  if (speed) {
    for (float& v : read.values.values) {
      const double c_m_s = unit->factor * static_cast<double>(v);
      v = static_cast<float>(v < 0.0F ? -1.0 : 1e-3 * density_kg_m3 * c_m_s * c_m_s);
    }
    said.add(DiagnosticCode::SpeedTurnedIntoShear, {{"density_kg_m3", density_kg_m3}});
    map = elastography::makeStiffnessMap(std::move(read.values), StiffnessQuantity::Shear, "kPa");
  } else {
    map = elastography::makeStiffnessMap(
        std::move(read.values),
        quantity == MapQuantity::YoungsModulus ? StiffnessQuantity::Youngs : StiffnessQuantity::Shear, *named);
  }
  map.frameOfReferenceUid = series.frameOfReferenceUid;
  return map;
}

void readConfidence(const dicom::Series& series, std::optional<double> scale, elastography::StiffnessMap& map,
                    Diagnostics& said, const Progress& progress) {
  if (!scale && series.unit == "%") scale = 100.0;
  const dicom::ReadMap read = dicom::readMap(series, progress);
  const elastography::ConfidenceScale used = elastography::attachConfidence(map, read.values, scale);
  said.add(elastography::doubtsAboutConfidence(map, used));
}

}  // namespace glisson::pipeline
