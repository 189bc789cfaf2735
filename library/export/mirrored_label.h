// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace marey::library {

/// Result of mirrored_label().
struct MirroredLabel {
  std::string text;  ///< With sides exchanged; as given if a word is unknown.
  /// A word that contains "left" or "right" and is not in the list; empty: none. The
  /// label is then not valid for a mirrored motion.
  std::string unknown_word;
};

/// Returns a label or the name of an event with all its sides exchanged: "left to right"
/// becomes "right to left", "turning_left" "turning_right", "LeftFoot" "RightFoot".
///
/// Words are runs of letters; a capital after a small letter begins a new one. The list:
/// left and right, alone or followed by ward, wards, hand, handed, foot, footed, leg,
/// arm, side, most; clockwise with counterclockwise and anticlockwise. Lower case,
/// capitals and a capital at the beginning are kept. Words such as "upright", "bright",
/// "leftover" are in a list of words that name no side, and stay. Linear in letters.
[[nodiscard]] MirroredLabel mirrored_label(std::string_view label);

}  // namespace marey::library
