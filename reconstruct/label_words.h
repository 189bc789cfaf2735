// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reconstruct/landmarks.h"

namespace marey::reconstruct {

/// The label in lower case, letters and digits alone: "R.Knee_Lat" is "rkneelat".
[[nodiscard]] std::string plain_label(std::string_view label);

enum class BodySide { kLeft, kRight };

/// A label that says a side: "Left Knee", "RKnee", "knee_r".
struct SidedLabel {
  BodySide side = BodySide::kLeft;
  std::string stem;  ///< plain_label() without the side: "knee".
  /// The side is the last letter and nothing parts it from the rest: "ASISr", which may
  /// be somebody's "anterior" as well. To be believed where the other side is there too.
  bool doubtful = false;
};

/// Every way to read a side off the label, the likeliest first.
[[nodiscard]] std::vector<SidedLabel> sides_of(std::string_view label);

/// The place somewhere on a segment that the words of a label mean, numbered or not:
/// "RTH1", "L_Thigh_Upper", "pelvis3". nullptr when they mean none.
[[nodiscard]] const Landmark* segment_of_words(std::string_view label);

}  // namespace marey::reconstruct
