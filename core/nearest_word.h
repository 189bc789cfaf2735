// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace marey {

/// Returns a correction for `wrong`: `perhaps you mean "stature_m"`, the word with the
/// smallest number of letters changed, added or left out (Levenshtein 1965; a change of
/// case counts a quarter), the first of equals. If no word is near (more than 40 % of the
/// letters differ), returns the whole list: `choose one of "a", "b"`.
/// Precondition: `words` not empty.
[[nodiscard]] std::string suggestion(std::string_view wrong,
                                     std::span<const std::string_view> words);

/// Returns the word that a user probably meant by `wrong`: the nearest one by the edit
/// distance of suggestion(), if at most two letters and 40 % of the letters differ, else
/// the first one of which `wrong` is the beginning or that is the beginning of `wrong`
/// (three letters or more). nullopt if there is none.
[[nodiscard]] std::optional<std::string_view> meant_word(
    std::string_view wrong, std::span<const std::string_view> words);

/// Returns the `count` words that are nearest to `wrong`, nearest first, by the edit
/// distance of suggestion(); all when there are fewer.
[[nodiscard]] std::vector<std::string_view> nearest_words(
    std::string_view wrong, std::span<const std::string_view> words, std::size_t count);

/// Returns suggestion() among the names of human_bones().
[[nodiscard]] std::string bone_suggestion(std::string_view wrong);

}  // namespace marey
