// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/frame_range.h"
#include "core/base/in_quotes.h"

namespace marey::live {

/// Reads the members of one object of a page's message by name, and keeps the first
/// error.
class RequestMembers {
 public:
  explicit RequestMembers(const nlohmann::json& object) : object_(object) {}

  /// Returns a whole number that is not negative.
  int count(const char* member) {
    const nlohmann::json* value = require(member);
    return value == nullptr ? 0 : count_of(*value, member);
  }
  /// The same; nullopt: absent or null.
  std::optional<int> optional_count(const char* member) {
    const nlohmann::json* value = find(member);
    if (value == nullptr || value->is_null()) return std::nullopt;
    return count_of(*value, member);
  }
  /// Returns the value of a list that is the member `member`.
  int count_of(const nlohmann::json& value, const char* member) {
    const bool is_good = value.is_number_unsigned() &&
                         value.get<std::uint64_t>() <= std::uint64_t{kMaxCount};
    if (!is_good) fail(member, "a whole number that is not negative");
    return is_good ? value.get<int>() : 0;
  }
  bool flag(const char* member) {
    const nlohmann::json* value = require(member);
    if (value == nullptr) return false;
    return flag_of(*value, member);
  }
  /// The same; false if absent.
  bool optional_flag(const char* member) {
    const nlohmann::json* value = find(member);
    return value != nullptr && flag_of(*value, member);
  }
  double seconds(const char* member) {
    return require(member) == nullptr ? 0.0 : optional_seconds(member).value_or(0.0);
  }
  std::optional<double> optional_seconds(const char* member) {
    const nlohmann::json* value = find(member);
    if (value == nullptr || value->is_null()) return std::nullopt;
    const bool is_good = value->is_number() && std::isfinite(value->get<double>()) &&
                         value->get<double>() >= 0.0 &&
                         value->get<double>() <= kMaxSeconds;
    if (!is_good) fail(member, "a time in seconds");
    return is_good ? value->get<double>() : 0.0;
  }
  std::optional<FrameRange> optional_span(const char* member) {
    const nlohmann::json* value = find(member);
    if (value == nullptr || value->is_null()) return std::nullopt;
    if (!value->is_array() || value->size() != 2) {
      fail(member, "a list of two frames");
      return std::nullopt;
    }
    const FrameRange span{count_of((*value)[0], member), count_of((*value)[1], member)};
    if (span.last < span.first) fail(member, "in the order first, last");
    return span;
  }
  std::string text(const char* member, std::size_t max_bytes) {
    const nlohmann::json* value = require(member);
    if (value == nullptr) return {};
    if (!value->is_string() || value->get_ref<const std::string&>().size() > max_bytes) {
      fail(member, "a text of a permitted length");
      return {};
    }
    return value->get<std::string>();
  }
  const nlohmann::json* require(const char* member) {
    const nlohmann::json* value = find(member);
    if (value == nullptr && cause_.empty()) {
      cause_ = std::string(member) + " is missing";
    }
    return value;
  }
  const nlohmann::json* find(const char* member) {
    read_.push_back(member);
    const auto found = object_.find(member);
    return found == object_.end() ? nullptr : &*found;
  }
  /// Checks that all members were read.
  void finish() {
    for (const auto& [key, value] : object_.items()) {
      if (!cause_.empty()) return;
      if (std::find(read_.begin(), read_.end(), key) == read_.end()) {
        cause_ = "the member " + in_quotes(key) + " is unknown here";
      }
    }
  }
  void fail(const std::string& member, const std::string& want) {
    if (cause_.empty()) cause_ = member + " is not " + want;
  }
  void fail(std::string cause) {
    if (cause_.empty()) cause_ = std::move(cause);
  }
  /// Returns the first error; empty: none.
  [[nodiscard]] const std::string& cause() const { return cause_; }

 private:
  bool flag_of(const nlohmann::json& value, const char* member) {
    if (!value.is_boolean()) fail(member, "true or false");
    return value.is_boolean() && value.get<bool>();
  }

  static constexpr int kMaxCount = 1 << 30;
  static constexpr double kMaxSeconds = 1e6;

  const nlohmann::json& object_;
  std::vector<std::string> read_;
  std::string cause_;
};

}  // namespace marey::live
