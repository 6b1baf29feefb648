// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QRgb>
#include <array>

namespace glisson::views {

/// Colours of the stiffness map, from dark blue (0) by green and yellow to dark red (1): lightness rises and falls
/// once, in the order radiologists know from elastograms.
const std::array<QRgb, 256>& stiffnessColours();

/// Blue below the middle, dark in it, red above: for a wave around 0, which is dark outside the body as well.
const std::array<QRgb, 256>& waveColours();

/// Grey levels.
const std::array<QRgb, 256>& greyLevels();

}  // namespace glisson::views
