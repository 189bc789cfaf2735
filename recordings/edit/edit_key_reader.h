// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/degrees.h"
#include "core/base/in_quotes.h"
#include "core/humanoid.h"
#include "core/nearest_word.h"
#include "recordings/base/toml_reader.h"
#include "recordings/edit/edit_constraint_keys.h"
#include "recordings/edit/edit_key_list.h"
#include "recordings/edit/edit_keys.h"
#include "recordings/edit/edit_rotation_keys.h"
#include "recordings/edit/edit_value_keys.h"

namespace marey::recordings::recipe {

/// Returns the place of the text `key` in `names`. Mistake: it is none of them.
[[nodiscard]] std::size_t read_choice(TomlReader& in,
                                      std::string_view key,
                                      std::span<const std::string_view> names);
/// Returns the bone with the name `key`. Mistake: unknown name.
[[nodiscard]] HumanBone read_bone(TomlReader& in, std::string_view key);
/// Returns the points of a list [[x, z], ...].
[[nodiscard]] std::vector<glm::dvec2> read_places(TomlReader& in, std::string_view key);

/// Visitor of visit_keys() that reads a table into a value. Mistakes are stored in the
/// document.
template <class T>
class KeyReader {
 public:
  KeyReader(TomlReader& in, T& out) : in_(in), out_(out) {}

  void boolean(std::string_view key, bool T::*member) {
    if (in_.has(key)) out_.*member = in_.boolean(key);
  }
  /// Also of std::optional<double>.
  template <class Number>
  void number(std::string_view key, Number T::*member, const Limits& limits) {
    if (in_.has(key)) out_.*member = in_.number(key, limits);
  }
  void needed_number(std::string_view key, double T::*member, const Limits& limits) {
    out_.*member = in_.number(key, limits);
  }
  void integer(std::string_view key, int T::*member, const Limits& limits) {
    if (in_.has(key)) out_.*member = in_.integer(key, limits);
  }
  template <class Number>
  void degrees(std::string_view key, Number T::*member, const Limits& limits) {
    if (in_.has(key)) out_.*member = in_.number(key, limits) * kRadiansPerDegree;
  }
  void needed_text(std::string_view key, std::string T::*member, std::size_t max_bytes) {
    out_.*member = read_line(in_, key, max_bytes);
  }
  template <class E, std::size_t kCount>
  void choice(std::string_view key,
              E T::*member,
              const std::array<std::string_view, kCount>& names) {
    if (in_.has(key)) out_.*member = static_cast<E>(read_choice(in_, key, names));
  }
  template <class E, std::size_t kCount>
  void choice(std::string_view key,
              std::optional<E> T::*member,
              const std::array<std::string_view, kCount>& names) {
    if (in_.has(key)) out_.*member = static_cast<E>(read_choice(in_, key, names));
  }
  template <class E, std::size_t kCount>
  void needed_choice(std::string_view key,
                     E T::*member,
                     const std::array<std::string_view, kCount>& names) {
    out_.*member = static_cast<E>(read_choice(in_, key, names));
  }
  void needed_bone(std::string_view key, HumanBone T::*member) {
    out_.*member = read_bone(in_, key);
  }
  void place(std::string_view key, std::optional<glm::dvec2> T::*member) {
    if (!in_.has(key)) return;
    const std::vector<double> v = read_numbers(in_, key, 2, kPlace);
    out_.*member = glm::dvec2(v[0], v[1]);
  }
  void place(std::string_view key, std::optional<glm::dvec3> T::*member) {
    if (!in_.has(key)) return;
    const std::vector<double> v = read_numbers(in_, key, 3, kPlace);
    out_.*member = glm::dvec3(v[0], v[1], v[2]);
  }
  void needed_place(std::string_view key, glm::dvec3 T::*member) {
    const std::vector<double> v = read_numbers(in_, key, 3, kPlace);
    out_.*member = glm::dvec3(v[0], v[1], v[2]);
  }
  void places(std::string_view key, std::vector<glm::dvec2> T::*member) {
    if (in_.has(key)) out_.*member = read_places(in_, key);
  }
  void moment(std::string_view key, std::optional<Moment> T::*member) {
    out_.*member = read_moment(in_, key);
  }
  void moment(std::string_view key, Moment T::*member) {
    if (const auto moment = read_moment(in_, key)) out_.*member = *moment;
  }
  void needed_moment(std::string_view key, Moment T::*member) {
    out_.*member = read_needed_moment(in_, key);
  }
  void rotation(std::string_view key, std::optional<glm::dquat> T::*member) {
    out_.*member = read_rotation(in_, key);
  }
  template <class Row>
  void list(std::string_view key, std::vector<Row> T::*member) {
    for (TomlReader& row : in_.tables(key)) {
      row.set_name(std::string(key));
      KeyList known;
      visit_keys(known, KeysOf<Row>{});
      row.allow(std::vector<std::string_view>(known.keys().begin(), known.keys().end()));
      KeyReader<Row> reader(row, (out_.*member).emplace_back());
      visit_keys(reader, KeysOf<Row>{});
      if (!in_.ok()) return;
    }
  }
  /// Reads a table of keys, such as {at = 0.5, height_m = 0.6}.
  template <class Part>
  void part(std::string_view key, std::optional<Part> T::*member) {
    if (!in_.has(key)) return;
    TomlReader table = in_.table(key);
    table.set_name(std::string(key));
    KeyList known;
    visit_keys(known, KeysOf<Part>{});
    table.allow(std::vector<std::string_view>(known.keys().begin(), known.keys().end()));
    KeyReader<Part> reader(table, (out_.*member).emplace());
    visit_keys(reader, KeysOf<Part>{});
  }
  void moments(std::string_view key, std::vector<Moment> T::*member) {
    for (TomlReader& row : in_.tables(key)) {
      row.set_name(std::string(key));
      const std::vector<std::string> known = moment_keys("at");
      row.allow(std::vector<std::string_view>(known.begin(), known.end()));
      (out_.*member).push_back(read_needed_moment(row, "at"));
      if (!in_.ok()) return;
    }
  }
  /// Only for ConstrainOp.
  void constraint() {
    if (in_.has("constraint")) read_constraint_keys(in_.table("constraint"), out_);
  }

 private:
  TomlReader& in_;
  T& out_;
};

}  // namespace marey::recordings::recipe
