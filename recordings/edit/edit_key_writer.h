// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "recordings/base/toml_writer.h"
#include "recordings/edit/edit_constraint_keys.h"
#include "recordings/edit/edit_keys.h"
#include "recordings/edit/edit_rotation_keys.h"
#include "recordings/edit/edit_value_keys.h"

namespace marey::recordings::recipe {

/// Visitor of visit_keys() that writes a value's keys: needed keys always, others if they
/// differ from their defaults.
template <class T>
class KeyWriter {
 public:
  KeyWriter(TomlWriter& out, const T& value) : out_(out), value_(value) {}

  void boolean(std::string_view key, bool T::*member) {
    if (differs(member)) out_.boolean(key, value_.*member);
  }
  void number(std::string_view key, double T::*member, const Limits& /*limits*/) {
    if (differs(member)) out_.number(key, value_.*member);
  }
  void number(std::string_view key,
              std::optional<double> T::*member,
              const Limits& /*limits*/) {
    if (value_.*member) out_.number(key, *(value_.*member));
  }
  void needed_number(std::string_view key, double T::*member, const Limits& /*limits*/) {
    out_.number(key, value_.*member);
  }
  void integer(std::string_view key, int T::*member, const Limits& /*limits*/) {
    if (differs(member)) out_.integer(key, value_.*member);
  }
  void degrees(std::string_view key, double T::*member, const Limits& /*limits*/) {
    if (differs(member)) out_.number(key, degrees_to_write(value_.*member));
  }
  void degrees(std::string_view key,
               std::optional<double> T::*member,
               const Limits& /*limits*/) {
    if (value_.*member) out_.number(key, degrees_to_write(*(value_.*member)));
  }
  void needed_text(std::string_view key, std::string T::*member, std::size_t /*max*/) {
    out_.text(key, value_.*member);
  }
  template <class E, std::size_t kCount>
  void choice(std::string_view key,
              E T::*member,
              const std::array<std::string_view, kCount>& names) {
    if (differs(member)) write_choice(key, value_.*member, names);
  }
  template <class E, std::size_t kCount>
  void choice(std::string_view key,
              std::optional<E> T::*member,
              const std::array<std::string_view, kCount>& names) {
    if (value_.*member) write_choice(key, *(value_.*member), names);
  }
  template <class E, std::size_t kCount>
  void needed_choice(std::string_view key,
                     E T::*member,
                     const std::array<std::string_view, kCount>& names) {
    write_choice(key, value_.*member, names);
  }
  void needed_bone(std::string_view key, HumanBone T::*member) {
    out_.text(key, name(value_.*member));
  }
  void place(std::string_view key, std::optional<glm::dvec2> T::*member) {
    if (const auto& p = value_.*member) out_.numbers(key, {p->x, p->y});
  }
  void place(std::string_view key, std::optional<glm::dvec3> T::*member) {
    if (const auto& p = value_.*member) out_.numbers(key, {p->x, p->y, p->z});
  }
  void needed_place(std::string_view key, glm::dvec3 T::*member) {
    const glm::dvec3& p = value_.*member;
    out_.numbers(key, {p.x, p.y, p.z});
  }
  void places(std::string_view key, std::vector<glm::dvec2> T::*member) {
    if ((value_.*member).empty()) return;
    std::vector<double> numbers;
    for (const glm::dvec2& p : value_.*member) {
      numbers.push_back(p.x);
      numbers.push_back(p.y);
    }
    out_.matrix(key, numbers, 2);
  }
  void moment(std::string_view key, std::optional<Moment> T::*member) {
    if (value_.*member) write_moment(out_, key, *(value_.*member));
  }
  void moment(std::string_view key, Moment T::*member) {
    if (differs(member)) write_moment(out_, key, value_.*member);
  }
  void needed_moment(std::string_view key, Moment T::*member) {
    write_moment(out_, key, value_.*member);
  }
  void rotation(std::string_view key, std::optional<glm::dquat> T::*member) {
    if (value_.*member) write_rotation(out_, key, *(value_.*member));
  }
  template <class Row>
  void list(std::string_view key, std::vector<Row> T::*member) {
    std::vector<TomlWriter> rows;
    for (const Row& row : value_.*member) {
      KeyWriter<Row> writer(rows.emplace_back(), row);
      visit_keys(writer, KeysOf<Row>{});
    }
    if (!rows.empty()) out_.inline_tables(key, rows);
  }
  template <class Part>
  void part(std::string_view key, std::optional<Part> T::*member) {
    if (!(value_.*member)) return;
    TomlWriter keys;
    KeyWriter<Part> writer(keys, *(value_.*member));
    visit_keys(writer, KeysOf<Part>{});
    out_.inline_table(key, keys);
  }
  void moments(std::string_view key, std::vector<Moment> T::*member) {
    std::vector<TomlWriter> rows;
    for (const Moment& at : value_.*member) write_moment(rows.emplace_back(), "at", at);
    if (!rows.empty()) out_.inline_tables(key, rows);
  }
  /// Only for ConstrainOp. A table: no key may follow.
  void constraint() {
    if (value_.constraint) write_constraint_keys(out_, value_);
  }

 private:
  template <class Member>
  [[nodiscard]] bool differs(Member T::*member) const {
    static const T kDefaults{};
    return !(value_.*member == kDefaults.*member);
  }
  template <class E, std::size_t kCount>
  void write_choice(std::string_view key,
                    E choice,
                    const std::array<std::string_view, kCount>& names) {
    out_.text(key, names[static_cast<std::size_t>(choice)]);
  }

  TomlWriter& out_;
  const T& value_;
};

}  // namespace marey::recordings::recipe
