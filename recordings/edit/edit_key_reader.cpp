// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/edit/edit_key_reader.h"

namespace marey::recordings::recipe {

std::size_t read_choice(TomlReader& in,
                        std::string_view key,
                        std::span<const std::string_view> names) {
  const std::string word = in.text(key);
  const auto found = std::find(names.begin(), names.end(), word);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  in.fail(key, in_quotes(key) + " cannot be " + in_quotes(word), suggestion(word, names));
  return 0;
}

HumanBone read_bone(TomlReader& in, std::string_view key) {
  const std::string word = in.text(key);
  const std::optional<HumanBone> bone = human_bone(word);
  if (!bone) in.fail(key, "there is no bone " + in_quotes(word), bone_suggestion(word));
  return bone.value_or(HumanBone::kHips);
}

std::vector<glm::dvec2> read_places(TomlReader& in, std::string_view key) {
  const std::size_t count = in.count(key);
  const std::vector<double> numbers = in.matrix(key, count, 2);
  check_numbers(in, key, numbers, kPlace);
  std::vector<glm::dvec2> places;
  for (std::size_t i = 0; i < count; ++i) {
    places.emplace_back(numbers[2 * i], numbers[2 * i + 1]);
  }
  return places;
}

}  // namespace marey::recordings::recipe
