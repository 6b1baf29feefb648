// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace glisson::panels {

/// From now on, in the whole program: the wheel over a number or a list of choices that has not the focus scrolls the
/// page and changes nothing. Once is enough; a QApplication has to be there.
void keepWheelForScrolling();

}  // namespace glisson::panels
