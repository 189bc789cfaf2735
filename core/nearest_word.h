// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace marey {

/// What to write instead of `wrong`: `perhaps you mean "stature_m"`, by the fewest
/// letters changed, added or left out (Levenshtein 1965; a change of case counts a
/// quarter), the first of equals. When nothing is close (more than 40 % of the letters
/// differ), the whole list: `choose one of "a", "b"`. Precondition: `words` not empty.
[[nodiscard]] std::string suggestion(std::string_view wrong,
                                     std::span<const std::string_view> words);

/// The `count` words that are nearest to `wrong`, nearest first, by the letters of
/// suggestion(); all when there are fewer.
[[nodiscard]] std::vector<std::string_view> nearest_words(
    std::string_view wrong, std::span<const std::string_view> words, std::size_t count);

/// suggestion() among the names of human_bones().
[[nodiscard]] std::string bone_suggestion(std::string_view wrong);

}  // namespace marey
