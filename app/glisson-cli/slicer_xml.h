// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "option_table.h"

namespace glisson::cli {

/// What 3D Slicer is told of a verb beside its options.
struct SlicerModule {
  std::string title;             ///< as it stands in Slicer's list of modules
  std::vector<PathKind> output;  ///< what the common option --output names for this verb; empty: nothing is written
};

/// The verb in Slicer's execution model, as its ModuleDescriptionParser reads it. Options become parameters of the same
/// name and flag, '-' written as '_'. An option that may be a folder or a volume becomes two parameters with one flag,
/// of which one is filled in; one without a usable default becomes text, which Slicer leaves out while it is empty.
/// common: the options of the command line that this verb offers too.
std::string slicerXml(const SlicerModule& module, const VerbRow& verb, const std::vector<OptionRow>& common);

/// Gives the verb --xml, which prints slicerXml of the verb and of --output, --threads and --strict, and ends.
void addSlicerXml(CLI::App& verb, const SlicerModule& module);

}  // namespace glisson::cli
