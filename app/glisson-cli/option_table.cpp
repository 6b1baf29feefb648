// SPDX-License-Identifier: GPL-3.0-or-later
#include "option_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace glisson::cli {
namespace {

std::vector<std::string> split(const std::string& text, const std::string& at) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t to; (to = text.find(at, from)) != std::string::npos; from = to + at.size())
    parts.push_back(text.substr(from, to - from));
  parts.push_back(text.substr(from));
  return parts;
}

std::optional<double> numberIn(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return {};
  return value;
}

std::vector<PathKind> pathsIn(const std::string& type) {
  constexpr std::array<std::pair<const char*, PathKind>, 4> words = {{{value::file, PathKind::File},
                                                                      {value::folder, PathKind::Folder},
                                                                      {value::volume, PathKind::Volume},
                                                                      {value::mask, PathKind::Mask}}};
  std::vector<PathKind> kinds;
  for (const std::string& one : split(type, "|"))
    for (const auto& [word, kind] : words)
      if (one == word) kinds.push_back(kind);
  return kinds;
}

/// The parser's own words for its checks: "{a,b}", "INT in [0 - 10]", "POSITIVE", "NONNEGATIVE".
void takeCheck(OptionRow& row, const std::string& check) {
  if (check.size() > 1 && check.front() == '{' && check.back() == '}') {
    row.choices = split(check.substr(1, check.size() - 2), ",");
    row.kind = row.kind == ValueKind::Integer ? ValueKind::IntegerChoice : ValueKind::Choice;
  } else if (const std::size_t open = check.find(" in ["); open != std::string::npos) {
    const std::vector<std::string> ends = split(check.substr(open + 5, check.size() - open - 6), " - ");
    if (ends.size() == 2) {
      row.least = numberIn(ends[0]);
      row.most = numberIn(ends[1]);
    }
  } else if (check == "POSITIVE") {
    row.above0 = true;
  } else if (check == "NONNEGATIVE") {
    row.least = 0.0;
  }
}

/// A default that the option itself would refuse stands for "not given".
std::string usablePreset(const OptionRow& row, const std::string& preset) {
  if (preset.empty() || preset == "[]" || preset == "\"\"" || row.many) return {};
  if (!row.choices.empty() && std::find(row.choices.begin(), row.choices.end(), preset) == row.choices.end()) return {};
  if (row.kind == ValueKind::Integer || row.kind == ValueKind::Number) {
    const auto number = numberIn(preset);
    if (!number || (row.above0 && *number <= 0.0) || (row.least && *number < *row.least) ||
        (row.most && *number > *row.most))
      return {};
  }
  return preset;
}

VerbRow verbOf(CLI::App& app) {
  VerbRow verb;
  verb.name = app.get_name();
  verb.help = app.get_description();
  for (CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) verb.options.push_back(rowOf(*option));
  for (CLI::App* sub : app.get_subcommands([](CLI::App* one) { return !one->get_group().empty(); }))
    verb.verbs.push_back(verbOf(*sub));
  return verb;
}

}  // namespace

OptionRow rowOf(CLI::Option& option) {
  OptionRow row;
  row.longNames = option.get_lnames();
  row.shortNames = option.get_snames();
  if (option.get_positional()) row.positional = option.get_name(true, false);
  row.help = option.get_description();
  row.required = option.get_required();
  row.typeName = option.get_type_name();
  row.delimiter = option.get_delimiter();
  if (option.get_items_expected_max() == 0) {
    row.kind = ValueKind::Flag;
    row.typeName.clear();
    return row;
  }
  row.many = option.get_items_expected_max() > 1;
  const std::vector<std::string> words = split(row.typeName, ":");
  row.paths = pathsIn(words.front());
  if (!row.paths.empty())
    row.kind = ValueKind::Path;
  else if (words.front() == value::point)
    row.kind = ValueKind::Point;
  else if (words.front() == "INT" || words.front() == "UINT")
    row.kind = ValueKind::Integer;
  else if (words.front() == "FLOAT")
    row.kind = ValueKind::Number;
  for (std::size_t w = 1; w < words.size(); ++w) takeCheck(row, words[w]);
  option.capture_default_str();
  row.preset = usablePreset(row, option.get_default_str());
  return row;
}

VerbRow tableOf(CLI::App& app) {
  VerbRow table = verbOf(app);
  if (table.name.empty()) table.name = programName;
  return table;
}

}  // namespace glisson::cli
