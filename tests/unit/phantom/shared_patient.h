// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "phantom/phantom.h"

namespace glisson::test {

/// One patient, made once for all tests of this program.
inline const phantom::PhantomPatient& sharedPatient() {
  static const phantom::PhantomPatient patient = phantom::makePhantom(1);
  return patient;
}

}  // namespace glisson::test
