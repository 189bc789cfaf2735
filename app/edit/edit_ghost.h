// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "edit/state/edit_state.h"

#include "core/base/frame_range.h"
#include "core/pose.h"

namespace marey::app {

/// Returns the pose of the first source in each frame of `span` of a result, as its
/// lineage names it; between two frames of the source it is interpolated. nullopt: the
/// frame is of another source. Linear in frames times joints.
/// Precondition: the span lies within the result.
[[nodiscard]] std::vector<std::optional<Pose>> ghost_poses(const edit::EditState& source,
                                                           const edit::EditState& result,
                                                           const FrameRange& span);

/// Returns the block MRMB (docs/formats/page.md) of a part of a result: the ghost, then
/// the result, with its uncertainties if there are any.
[[nodiscard]] std::string edit_block(const edit::EditState& source,
                                     const edit::EditState& result,
                                     const std::vector<std::optional<Pose>>& ghost,
                                     const FrameRange& span);

/// A curve of the result and of the ghost, one value per frame; nullopt: none.
struct EditGraph {
  std::string name;
  std::string unit;
  std::vector<std::optional<double>> values;
  std::vector<std::optional<double>> before;
};

/// Computes the curves of docs/formats/edit_page.md for the frames of a part: heights and
/// speeds of feet and hips, and the uncertainty of all joints. Linear in frames times
/// joints.
[[nodiscard]] std::vector<EditGraph> edit_graphs(
    const edit::EditState& source,
    const edit::EditState& result,
    const std::vector<std::optional<Pose>>& ghost,
    const FrameRange& span);

}  // namespace marey::app
