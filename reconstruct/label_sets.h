// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace marey::reconstruct {

/// What a laboratory calls a place. In `label`, which is lower case and without
/// punctuation, a question mark stands for a side, l, r, left or right; one that begins
/// a label may as well end it. A per cent sign stands for o, a, l and p, the four points
/// with which Plug-in Gait tells a segment's axes.
struct LabelRow {
  std::string_view label;
  /// find_landmark()'s name, a question mark for "left_" or "right_"; empty for what is
  /// no marker on the body: computed points, devices.
  std::string_view landmark;
};

/// Labels that go together, as a maker or a model has them.
struct LabelSet {
  std::string_view name;  ///< Empty: labels seen here and there.
  std::span<const LabelRow> rows;
  /// In other company its labels mean other things: it names nothing unless chosen.
  bool alone = false;
};

/// Every set that is known, those of animation and those of gait laboratories. When
/// several cover labels equally well, the first counts.
[[nodiscard]] std::span<const LabelSet> label_sets();

/// Parts of label_sets(), by who made them.
[[nodiscard]] std::span<const LabelSet> gait_label_sets();
[[nodiscard]] std::span<const LabelSet> model_label_sets();
[[nodiscard]] std::span<const LabelSet> palpated_label_sets();
[[nodiscard]] std::span<const LabelSet> animation_label_sets();
[[nodiscard]] std::span<const LabelSet> studio_label_sets();

}  // namespace marey::reconstruct
