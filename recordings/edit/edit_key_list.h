// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/edit/edit_ops.h"

namespace marey::recordings::recipe {

/// Visitor of visit_keys() that lists the keys.
class KeyList {
 public:
  template <class... Rest>
  void boolean(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void number(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void needed_number(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void integer(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void degrees(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void needed_text(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void choice(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void needed_choice(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void needed_bone(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void place(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void needed_place(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void places(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void list(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void part(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class... Rest>
  void moments(std::string_view key, const Rest&... /*rest*/) {
    keys_.emplace_back(key);
  }
  template <class Member>
  void moment(std::string_view key, Member /*member*/) {
    add_moment(key);
  }
  template <class Member>
  void needed_moment(std::string_view key, Member /*member*/) {
    add_moment(key);
  }
  template <class Member>
  void rotation(std::string_view key, Member /*member*/) {
    add_rotation(key);
  }
  void constraint() { keys_.emplace_back("constraint"); }

  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }

 private:
  void add_moment(std::string_view key);
  void add_rotation(std::string_view key);

  std::vector<std::string> keys_;
};

/// Returns the keys of an operation in a recipe: common keys first.
[[nodiscard]] std::vector<std::string> edit_op_keys(const EditOpParameters& parameters);

}  // namespace marey::recordings::recipe
