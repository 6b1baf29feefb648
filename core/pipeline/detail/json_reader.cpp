// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/detail/json_reader.h"

#include <cmath>

#include "base/error.h"

namespace glisson::pipeline::detail {
namespace {

using nlohmann::json;

/// Walks through a text and counts the lines it has passed.
class LineCountingIterator {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  LineCountingIterator(const char* at, int* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  LineCountingIterator& operator++() {
    if (*at_ == '\n') ++*line_;
    ++at_;
    return *this;
  }
  LineCountingIterator operator++(int) {
    LineCountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const LineCountingIterator& o) const { return at_ == o.at_; }
  bool operator!=(const LineCountingIterator& o) const { return at_ != o.at_; }

 private:
  const char* at_;
  int* line_;
};

/// Notes the line of every value as the parser passes it; the values themselves are read by a second, plain parse.
class LineRecorder : public nlohmann::json_sax<json> {
 public:
  LineRecorder(std::map<std::string, int>& lines, const int& line, const std::string& name)
      : lines_(lines), line_(line), name_(name) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& k) override {
    stack_.back().key = k;
    const std::string p = pointer();
    if (lines_.count(p))
      throw BadInput(name_ + ", line " + std::to_string(line_) + ": \"" + k + "\" stands twice; keep one");
    lines_[p] = line_;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& e) override {
    const std::string what = e.what();
    const auto colon = what.find(": ");
    throw BadInput(name_ + ", line " + std::to_string(line_) +
                   ": this is not JSON: " + (colon == std::string::npos ? what : what.substr(colon + 2)));
  }

 private:
  struct Level {
    bool array;
    std::size_t index = 0;
    std::string key;
  };
  std::string pointer() const {
    std::string p;
    for (const Level& l : stack_) p += "/" + (l.array ? std::to_string(l.index) : l.key);
    return p;
  }
  void note() {
    if (!stack_.empty() && stack_.back().array) lines_[pointer()] = line_;
  }
  bool value() {
    note();
    next();
    return true;
  }
  bool open(bool array) {
    note();
    if (stack_.size() > 64) throw BadInput(name_ + ": nested deeper than 64 levels");
    stack_.push_back({array, 0, {}});
    return true;
  }
  bool close() {
    stack_.pop_back();
    next();
    return true;
  }
  void next() {
    if (!stack_.empty() && stack_.back().array) ++stack_.back().index;
  }

  std::map<std::string, int>& lines_;
  const int& line_;
  const std::string& name_;
  std::vector<Level> stack_;
};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

}  // namespace

JsonDocument JsonDocument::parse(const std::string& text, std::string name) {
  JsonDocument d;
  d.name = std::move(name);
  int line = 1;
  LineRecorder recorder(d.lines, line, d.name);
  const LineCountingIterator begin(text.data(), &line);
  int unused = 0;
  const LineCountingIterator end(text.data() + text.size(), &unused);
  json::sax_parse(begin, end, &recorder, json::input_format_t::json, true, true);
  d.root = json::parse(text, nullptr, true, true);
  return d;
}

int JsonDocument::lineOf(const std::string& pointer) const {
  const auto it = lines.find(pointer);
  return it == lines.end() ? 1 : it->second;
}

JsonObject::JsonObject(const JsonDocument& document, std::string pointer, const json& value)
    : document_(&document), pointer_(std::move(pointer)), value_(&value) {
  if (!value.is_object()) fail("must be an object in braces, but is " + std::string(value.type_name()));
}

bool JsonObject::has(const std::string& key) const {
  offered_.insert(key);
  return value_->contains(key);
}

const json& JsonObject::need(const std::string& key) {
  asked_.insert(key);
  offered_.insert(key);
  if (!has(key)) fail("key \"" + key + "\" is missing");
  return (*value_)[key];
}

const json& JsonObject::raw(const std::string& key) {
  return need(key);
}

double JsonObject::number(const std::string& key) {
  const json& v = need(key);
  if (!v.is_number()) fail(key, "must be a number, but is " + std::string(v.type_name()));
  const double d = v.get<double>();
  if (!std::isfinite(d)) fail(key, "must be a finite number");
  return d;
}

double JsonObject::number(const std::string& key, double fallback) {
  asked_.insert(key);
  offered_.insert(key);
  return has(key) ? number(key) : fallback;
}

int JsonObject::integer(const std::string& key, int fallback) {
  asked_.insert(key);
  offered_.insert(key);
  if (!has(key)) return fallback;
  const double d = number(key);
  if (d != std::floor(d) || std::abs(d) > 2e9) fail(key, "must be a whole number");
  return static_cast<int>(d);
}

bool JsonObject::boolean(const std::string& key, bool fallback) {
  asked_.insert(key);
  offered_.insert(key);
  if (!has(key)) return fallback;
  const json& v = need(key);
  if (!v.is_boolean()) fail(key, "must be true or false");
  return v.get<bool>();
}

std::string JsonObject::text(const std::string& key) {
  const json& v = need(key);
  if (!v.is_string()) fail(key, "must be a text in quotes, but is " + std::string(v.type_name()));
  return v.get<std::string>();
}

std::string JsonObject::text(const std::string& key, const std::string& fallback) {
  asked_.insert(key);
  offered_.insert(key);
  return has(key) ? text(key) : fallback;
}

std::string JsonObject::word(const std::string& key, const std::vector<std::string>& allowed) {
  const std::string w = text(key);
  for (const std::string& a : allowed)
    if (w == a) return w;
  fail(key, "is \"" + w + "\"; it must be one of: " + joined(allowed));
}

std::string JsonObject::word(const std::string& key, const std::vector<std::string>& allowed,
                             const std::string& fallback) {
  asked_.insert(key);
  offered_.insert(key);
  return has(key) ? word(key, allowed) : fallback;
}

std::vector<double> JsonObject::numbers(const std::string& key, std::size_t count) {
  const json& v = need(key);
  if (!v.is_array() || v.size() != count) fail(key, "must be a list of " + std::to_string(count) + " numbers");
  std::vector<double> out;
  for (const json& x : v) {
    if (!x.is_number() || !std::isfinite(x.get<double>()))
      fail(key, "must be a list of " + std::to_string(count) + " finite numbers");
    out.push_back(x.get<double>());
  }
  return out;
}

Eigen::Vector3d JsonObject::vector3(const std::string& key) {
  const std::vector<double> v = numbers(key, 3);
  return {v[0], v[1], v[2]};
}

std::vector<Eigen::Vector3d> JsonObject::vectors3(const std::string& key) {
  const json& v = need(key);
  if (!v.is_array()) fail(key, "must be a list of points [x, y, z]");
  std::vector<Eigen::Vector3d> out;
  for (const json& p : v) {
    if (!p.is_array() || p.size() != 3) fail(key, "must be a list of points [x, y, z]");
    Eigen::Vector3d q;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!p[c].is_number() || !std::isfinite(p[c].get<double>())) fail(key, "holds a point that is not three numbers");
      q[static_cast<Eigen::Index>(c)] = p[c].get<double>();
    }
    out.push_back(q);
  }
  return out;
}

JsonObject JsonObject::object(const std::string& key) {
  const json& v = need(key);
  return {*document_, pointer_ + "/" + key, v};
}

std::vector<JsonObject> JsonObject::objects(const std::string& key) {
  const json& v = need(key);
  if (!v.is_array()) fail(key, "must be a list in brackets, but is " + std::string(v.type_name()));
  std::vector<JsonObject> out;
  for (std::size_t i = 0; i < v.size(); ++i)
    out.emplace_back(*document_, pointer_ + "/" + key + "/" + std::to_string(i), v[i]);
  return out;
}

void JsonObject::finish() const {
  for (const auto& item : value_->items()) {
    if (asked_.count(item.key())) continue;
    fail(item.key(), "is not a key that is known here; these are: " + joined({offered_.begin(), offered_.end()}));
  }
}

void JsonObject::fail(const std::string& key, const std::string& message) const {
  const std::string p = pointer_ + "/" + key;
  throw BadInput(document_->name + ", line " + std::to_string(document_->lineOf(p)) + ": \"" + p.substr(1) + "\" " +
                 message);
}

void JsonObject::fail(const std::string& message) const {
  throw BadInput(document_->name + ", line " + std::to_string(document_->lineOf(pointer_)) + ": " +
                 (pointer_.empty() ? "the scene" : "\"" + pointer_.substr(1) + "\"") + ": " + message);
}

}  // namespace glisson::pipeline::detail
