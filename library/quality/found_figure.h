// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/frame_range.h"
#include "core/humanoid.h"

namespace marey::library {

/// A place at which a figure exceeds its limit for warnings.
struct FoundPlace {
  FrameRange frames;
  std::optional<HumanBone> bone = std::nullopt;  ///< nullopt: the whole body.
  double value = 0.0;
};

/// A measured figure, before its verdict.
struct FoundFigure {
  std::string_view name;
  double value = 0.0;
  std::optional<HumanBone> bone = std::nullopt;     ///< Bone with the worst value.
  std::optional<FrameRange> frames = std::nullopt;  ///< Frames with the worst value.
  std::vector<FoundPlace> places = {};              ///< Ascending by first frame.
};

/// Joins places of one bone that are at most `gap` frames apart: frames from the first to
/// the last, the maximum value. Precondition: ascending by first frame.
void add_place(std::vector<FoundPlace>& places, const FoundPlace& place, int gap);

}  // namespace marey::library
