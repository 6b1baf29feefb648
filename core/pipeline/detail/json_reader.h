// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace glisson::pipeline::detail {

/// A JSON text with the line on which each value stands, so that a complaint can name key and line.
struct JsonDocument {
  nlohmann::json root;
  std::map<std::string, int> lines;  ///< JSON pointer -> line, from 1
  std::string name;                  ///< what to call the text in messages, e.g. the file's name

  /// Comments are allowed. Throws BadInput (syntax, duplicate key) with the line.
  static JsonDocument parse(const std::string& text, std::string name);

  int lineOf(const std::string& pointer) const;
};

/// Strict reading of one JSON object: every key is asked for by name and type; finish() refuses what nobody asked for.
class JsonObject {
 public:
  JsonObject(const JsonDocument& document, std::string pointer, const nlohmann::json& value);

  bool has(const std::string& key) const;
  /// Number that is finite; range is checked by the caller through fail().
  double number(const std::string& key);
  double number(const std::string& key, double fallback);
  int integer(const std::string& key, int fallback);
  bool boolean(const std::string& key, bool fallback);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  /// One of the allowed words.
  std::string word(const std::string& key, const std::vector<std::string>& allowed);
  std::string word(const std::string& key, const std::vector<std::string>& allowed, const std::string& fallback);
  /// The value of an enumeration by its word, of a table as EnumNames.
  template <class Names>
  auto named(const std::string& key, const Names& names) {
    return names.named(word(key, names.words()));
  }
  template <class Names, class E>
  E named(const std::string& key, const Names& names, E fallback) {
    return names.named(word(key, names.words(), names.nameOf(fallback)));
  }
  Eigen::Vector3d vector3(const std::string& key);
  std::vector<Eigen::Vector3d> vectors3(const std::string& key);
  std::vector<double> numbers(const std::string& key, std::size_t count);
  JsonObject object(const std::string& key);
  std::vector<JsonObject> objects(const std::string& key);
  /// Raw access for values that may be a word or an object; counts as asked for.
  const nlohmann::json& raw(const std::string& key);

  /// Throws BadInput for the first key that was never asked for, naming those that may stand there.
  void finish() const;

  /// Throws BadInput: "<name>, line n: "key": message".
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  const nlohmann::json& need(const std::string& key);

  const JsonDocument* document_;
  std::string pointer_;
  const nlohmann::json* value_;
  std::set<std::string> asked_;
  mutable std::set<std::string> offered_;  ///< looked for, there or not: what may stand here
};

}  // namespace glisson::pipeline::detail
