// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The format in which a reader process answers. Both ends run on one machine and come from one build; what arrives is
// nevertheless checked as if a stranger had written it, because a hostile file may have taken over its writer.
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"

namespace glisson::dicom::detail {

/// Appends values to a message: numbers as 8 bytes, text and lists with their length first.
class WireWriter {
 public:
  static constexpr bool writes = true;
  std::string bytes;

  template <typename T>
  void operator()(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      put(static_cast<double>(value));
    } else if constexpr (std::is_enum_v<T> || std::is_integral_v<T>) {
      put(static_cast<std::int64_t>(value));
    } else {
      (*this)(value, 0);
    }
  }

 private:
  template <typename T>
  void put(T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void operator()(const std::string& value, int) {
    put(static_cast<std::int64_t>(value.size()));
    bytes += value;
  }
  void operator()(const Eigen::Vector3d& value, int) {
    for (int axis = 0; axis < 3; ++axis) put(value[axis]);
  }
  template <typename T>
  void operator()(const std::optional<T>& value, int) {
    put(static_cast<std::int64_t>(value.has_value()));
    if (value) (*this)(*value);
  }
  template <typename A, typename B>
  void operator()(const std::pair<A, B>& value, int) {
    (*this)(value.first);
    (*this)(value.second);
  }
  template <typename T>
  void operator()(const std::vector<T>& value, int) {
    put(static_cast<std::int64_t>(value.size()));
    for (const T& one : value) (*this)(one);
  }
};

/// Takes values from a message. Throws BadInput where the message ends before, holds a number out of range, a text of
/// more than 64 KiB or a list longer than the message could hold.
class WireReader {
 public:
  static constexpr bool writes = false;
  explicit WireReader(const std::string& message) : bytes_(message) {}

  template <typename T>
  void operator()(T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      const auto number = take<double>();
      if (!std::isfinite(number)) fail();
      value = static_cast<T>(number);
    } else if constexpr (std::is_enum_v<T>) {
      const auto number = take<std::int64_t>();
      if (number < 0 || number > 64) fail();
      value = static_cast<T>(number);
    } else if constexpr (std::is_integral_v<T>) {
      const auto number = take<std::int64_t>();
      if (!std::in_range<IntegerLike<T>>(number)) fail();
      value = static_cast<T>(number);
    } else {
      (*this)(value, 0);
    }
  }

  void end() const {
    if (at_ != bytes_.size()) fail();
  }

  [[noreturn]] static void fail() {
    throw BadInput("was answered by the reader process with a message that makes no sense; the file is left out");
  }

 private:
  template <typename T>
  using IntegerLike = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;

  template <typename T>
  T take() {
    if (bytes_.size() - at_ < sizeof(T)) fail();
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::size_t length(std::size_t smallest) {
    const auto n = take<std::int64_t>();
    if (n < 0 || static_cast<std::uint64_t>(n) > (bytes_.size() - at_) / smallest) fail();
    return static_cast<std::size_t>(n);
  }
  void operator()(std::string& value, int) {
    const std::size_t n = length(1);
    if (n > 64 * 1024) fail();
    value.assign(bytes_, at_, n);
    at_ += n;
  }
  void operator()(Eigen::Vector3d& value, int) {
    for (int axis = 0; axis < 3; ++axis) (*this)(value[axis]);
  }
  template <typename T>
  void operator()(std::optional<T>& value, int) {
    bool there = false;
    (*this)(there);
    value.reset();
    if (there) {
      value.emplace();
      (*this)(*value);
    }
  }
  template <typename A, typename B>
  void operator()(std::pair<A, B>& value, int) {
    (*this)(value.first);
    (*this)(value.second);
  }
  template <typename T>
  void operator()(std::vector<T>& value, int) {
    value.clear();
    const std::size_t n = length(8);
    for (std::size_t k = 0; k < n; ++k) {
      value.emplace_back();
      (*this)(value.back());
    }
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace glisson::dicom::detail
