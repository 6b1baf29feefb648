// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace glisson::cli {

inline constexpr const char* programName = "glisson-cli";

/// What the value of an option is.
enum class ValueKind { Flag, Integer, Number, Text, Choice, IntegerChoice, Point, Path };

/// What may lie at a path.
enum class PathKind { File, Folder, Volume, Mask };

/// The words that help shows for them, given to an option with type_name(); several are joined by '|'.
namespace value {
inline constexpr const char* file = "FILE";
inline constexpr const char* folder = "FOLDER";
inline constexpr const char* folderOrFile = "FOLDER|FILE";
inline constexpr const char* fileOrFolder = "FILE|FOLDER";
inline constexpr const char* folderOrVolume = "FOLDER|VOLUME";
inline constexpr const char* volume = "VOLUME";
inline constexpr const char* mask = "MASK";
inline constexpr const char* fileOrMask = "FILE|MASK";
inline constexpr const char* point = "POINT";
}  // namespace value

/// One option of a verb, as the parser knows it.
struct OptionRow {
  std::vector<std::string> longNames;   ///< without dashes, the first is the usual one
  std::vector<std::string> shortNames;  ///< without dashes
  std::string positional;               ///< its name where it is given by place
  std::string help;
  ValueKind kind = ValueKind::Text;
  std::vector<PathKind> paths;        ///< of a path, the usual first
  std::vector<std::string> choices;   ///< of a choice
  std::optional<double> least, most;  ///< of a number, both included
  bool above0 = false;                ///< a number that must be positive
  std::string preset;                 ///< what is taken where none is given; empty where that is no value of its own
  bool required = false;
  bool many = false;      ///< takes several values
  char delimiter = '\0';  ///< between values in one word; none: '\0'
  std::string typeName;   ///< as help shows it
};

struct VerbRow {
  std::string name, help;
  std::vector<OptionRow> options;
  std::vector<VerbRow> verbs;  ///< of a verb that has verbs of its own
};

/// The whole command line: common options, and verbs in the order of help. Hidden options and verbs are left out.
VerbRow tableOf(CLI::App& app);

/// One option; the same as in tableOf.
OptionRow rowOf(CLI::Option& option);

}  // namespace glisson::cli
