// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What to do with each attribute; for .cpp files of this room only.
#include <optional>
#include <string>

class DcmTagKey;
class DcmElement;

namespace glisson::dicom {

/// Actions of PS3.15 table E.1-1. Dummy: a value that says nothing (Type 1). Empty: no value (Type 2). Uid: mapped by
/// the key. Date: emptied, or shifted where longitudinal times are kept. Keep: does not identify. Descend: a sequence
/// whose items are treated in turn.
enum class Action { Remove, Empty, Dummy, Uid, Date, Characteristic, Keep, Descend };

/// Action by tag, by value representation where the tag has no row of its own.
Action actionFor(DcmElement& element);

/// A private attribute that is known not to identify: its creator and the last two digits of its element.
bool isSafePrivate(const std::string& creator, const DcmTagKey& tag);

}  // namespace glisson::dicom
