// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reconstruct/labels/landmarks.h"

namespace marey::reconstruct {

/// Returns the label in lower case, letters and digits alone: "R.Knee_Lat" is "rkneelat".
[[nodiscard]] std::string plain_label(std::string_view label);

enum class BodySide { kLeft, kRight };

/// A label with a side: "Left Knee", "RKnee", "knee_r".
struct SidedLabel {
  BodySide side = BodySide::kLeft;
  std::string stem;  ///< plain_label() without the side: "knee".
  /// The side is the last letter without a separator: "ASISr", where it can also stand
  /// for "anterior". Valid only if the other side exists as well.
  bool needs_other_side = false;
};

/// Returns all interpretations of the label with a side, the most likely first.
[[nodiscard]] std::vector<SidedLabel> sides_of(std::string_view label);

/// Returns the landmark somewhere on a segment that the words of a label mean, numbered
/// or not: "RTH1", "L_Thigh_Upper", "pelvis3". nullptr if they mean none.
[[nodiscard]] const Landmark* segment_of_words(std::string_view label);

}  // namespace marey::reconstruct
