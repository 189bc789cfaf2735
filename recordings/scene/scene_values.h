// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

#include "core/constraint.h"
#include "core/engine/scene.h"
#include "core/engine/scene_action.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings::stage {

// Values that several tables of a scene have in common. Each reads a key only if it is
// there; mistakes are stored in the document (TomlReader).

void read_number(TomlReader& in, std::string_view key, double& out, const Limits& limits);
void read_number(TomlReader& in,
                 std::string_view key,
                 std::optional<double>& out,
                 const Limits& limits);
/// Reads an angle in degrees as radians.
void read_degrees(TomlReader& in,
                  std::string_view key,
                  double& out_rad,
                  const Limits& limits);
void read_degrees(TomlReader& in,
                  std::string_view key,
                  std::optional<double>& out_rad,
                  const Limits& limits);
void read_integer(TomlReader& in,
                  std::string_view key,
                  std::optional<int>& out,
                  const Limits& limits);
void read_boolean(TomlReader& in, std::string_view key, bool& out);
void read_text(TomlReader& in,
               std::string_view key,
               std::string& out,
               std::size_t max_bytes);
void read_vector(TomlReader& in,
                 std::string_view key,
                 glm::dvec3& out,
                 const Limits& limits);
/// Reads two numbers of which the first is at most the second.
void read_range(TomlReader& in,
                std::string_view key,
                std::array<double, 2>& out,
                const Limits& limits);
void read_hand(TomlReader& in, std::string_view key, SceneHand& out);
/// Reads "segment", which must be there, and "offset_m".
[[nodiscard]] BodyPoint read_point(TomlReader& in);

/// Reads a choice of words as the enumerator at its position.
template <class E>
void read_word(TomlReader& in,
               std::string_view key,
               E& out,
               std::span<const std::string_view> words);

/// Reads an id that must be there: letters, digits, "_", "-" and ".", at most 100 bytes.
/// Mistake: it is one of `taken`, or has another form.
[[nodiscard]] std::string read_id(TomlReader& in,
                                  std::string_view key,
                                  std::span<const std::string> taken);

/// Stores the mistake that a reference names nothing, with the nearest of `known`.
/// `kind`: "body".
void fail_unknown(TomlReader& in,
                  std::string_view key,
                  std::string_view kind,
                  const std::string& name,
                  std::span<const std::string> known);

/// Stores the mistake that bodies named `users` cannot be paired with the bodies named
/// `partners`: these are neither one nor as many. `what` has them: "the target \"t\"".
void check_pairs(TomlReader& in,
                 std::string_view key,
                 const Scene& scene,
                 const std::string& users,
                 const std::string& partners,
                 const std::string& what);
/// The same for the bodies of a target; no mistake if it is not on bodies.
void check_target_pairs(TomlReader& in,
                        std::string_view key,
                        const Scene& scene,
                        const std::string& users,
                        const std::string& target);

/// Stores the mistake that there are more tables than `max`.
void check_count(TomlReader& in, std::string_view key, std::size_t max);

/// Returns the position of a word. Mistake: it is none of `words`.
[[nodiscard]] std::size_t read_choice_of(TomlReader& in,
                                         std::string_view key,
                                         std::span<const std::string_view> words);

template <class E>
void read_word(TomlReader& in,
               std::string_view key,
               E& out,
               std::span<const std::string_view> words) {
  if (in.has(key)) out = static_cast<E>(read_choice_of(in, key, words));
}

}  // namespace marey::recordings::stage
