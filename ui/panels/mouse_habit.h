// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class QWidget;

namespace glisson::panels {

/// What a drag with the right button does over an image.
enum class RightDrag {
  Zoom,   ///< as shipped
  Window  ///< changes window and level, as viewers of a PACS do
};

RightDrag preferredRightDrag();  ///< as chosen last
void rememberRightDrag(RightDrag what);
/// Every slice view below the widget does so from now on.
void applyRightDrag(RightDrag what, QWidget& below);

}  // namespace glisson::panels
