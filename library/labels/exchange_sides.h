// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace marey::library {

/// Returns the label of the mirrored motion: words that name a side are exchanged by a
/// list, such as left and right, leftward, left-handed, clockwise. The rest of the label
/// stays, with upper and lower case. A label without a side is returned as it is.
///
/// Words are runs of letters; a capital after a small letter begins a word ("turnLeft").
/// A single l or r is a side next to "_", "." or ":" ("hand_l").
///
/// nullopt: the label contains a side that is not understood: a word with "left" or
/// "right" that is in no list ("leftish"), or one that has another meaning too ("left the
/// room", "right after"). Linear in letters.
[[nodiscard]] std::optional<std::string> exchanged_sides(std::string_view label);

}  // namespace marey::library
