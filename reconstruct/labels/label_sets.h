// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace marey::reconstruct {

/// A laboratory's label of a place. `label` is in lower case and without punctuation. A
/// question mark stands for a side: l, r, left or right; at the beginning of a label it
/// also matches the end. A per cent sign stands for o, a, l and p, the four points that
/// define a segment's axes in Plug-in Gait.
struct LabelRow {
  std::string_view label;
  /// Name for find_landmark(), a question mark for "left_" or "right_"; empty for labels
  /// that are not markers on the body: computed points, devices.
  std::string_view landmark;
};

/// Labels that belong together, as defined by a maker or a model.
struct LabelSet {
  std::string_view name;  ///< Empty: labels from various sources.
  std::span<const LabelRow> rows;
  /// Its labels have other meanings in other sets: it is used only if it is chosen.
  bool alone = false;
};

/// Returns all known sets, those of animation and those of gait laboratories. If several
/// cover labels equally well, the first counts.
[[nodiscard]] std::span<const LabelSet> label_sets();

/// Return parts of label_sets(), by maker.
[[nodiscard]] std::span<const LabelSet> gait_label_sets();
[[nodiscard]] std::span<const LabelSet> model_label_sets();
[[nodiscard]] std::span<const LabelSet> palpated_label_sets();
[[nodiscard]] std::span<const LabelSet> animation_label_sets();
[[nodiscard]] std::span<const LabelSet> studio_label_sets();

}  // namespace marey::reconstruct
