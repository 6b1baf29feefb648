// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "pacs/node.h"

class OFCondition;
struct T_ASC_Parameters;

namespace glisson::pacs::detail {

/// "host:port".
std::string placeOf(const Node& node);

/// Why no association came about, as a sentence that says what to do. parameters: of the request, for the reason of a
/// rejection.
std::string whyNoAssociation(const Node& node, const OFCondition& condition, T_ASC_Parameters* parameters);

/// Meaning of a status [PS3.7 annex C, PS3.4 annexes B and C], with its number; ourTitle: as move destination.
std::string meaningOf(std::uint16_t status, const std::string& ourTitle);

/// Pending, or pending with a remark on optional keys.
inline bool isPending(std::uint16_t status) {
  return status == 0xff00 || status == 0xff01;
}
/// Success, or a warning: the object was stored nevertheless.
inline bool isStored(std::uint16_t status) {
  return status == 0 || (status & 0xf000) == 0xb000;
}

}  // namespace glisson::pacs::detail
