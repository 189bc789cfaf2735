// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace marey::recordings {

/// What to write instead of `wrong`: `perhaps you mean "stature_m"`, by the fewest
/// letters changed, added or left out (Levenshtein 1965; a change of case counts a
/// quarter), the first of equals. When nothing is close (more than 40 % of the letters
/// differ), the whole list: `choose one of "a", "b"`. Precondition: `words` not empty.
[[nodiscard]] std::string suggestion(std::string_view wrong,
                                     std::span<const std::string_view> words);

/// suggestion() among the names of human_bones().
[[nodiscard]] std::string bone_suggestion(std::string_view wrong);

}  // namespace marey::recordings
