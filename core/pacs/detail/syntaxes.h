// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "pacs/detail/association.h"

namespace glisson::pacs::detail {

inline constexpr const char* verification = "1.2.840.10008.1.1";
inline constexpr const char* studyRootFind = "1.2.840.10008.5.1.4.1.2.2.1";
inline constexpr const char* studyRootMove = "1.2.840.10008.5.1.4.1.2.2.2";
inline constexpr const char* studyRootGet = "1.2.840.10008.5.1.4.1.2.2.3";
inline constexpr const char* implicitLittle = "1.2.840.10008.1.2";
inline constexpr const char* explicitLittle = "1.2.840.10008.1.2.1";

/// Explicit and implicit little endian, the first preferred.
const std::vector<std::string>& plainSyntaxes();
/// Compressed, and big-endian ones, that `scan` can read or name.
const std::vector<std::string>& packedSyntaxes();
bool isPlainSyntax(const std::string& uid);

/// The kinds of object that are received: images (also compressed), and what is derived from them.
const std::vector<std::string>& imageClasses();
const std::vector<std::string>& derivedClasses();
bool isReceivedClass(const std::string& uid);

/// At most 127 proposals for objects that a server sends to us.
std::vector<Proposal> proposalsToReceive();

}  // namespace glisson::pacs::detail
