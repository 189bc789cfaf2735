// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/frame_range.h"
#include "core/source.h"

namespace marey::edit {

/// Origin of one frame of an edited motion.
struct FrameLineage {
  int source = 0;  ///< Index in EditRecipe::sources; where two overlap, the later one.
  double source_frame = 0.0;  ///< Index in the source's poses, with its fraction.
  /// kMeasured: as the source; kInferred: at least one operation invented the posture.
  Source trust = Source::kMeasured;
  std::optional<std::size_t> history;  ///< Index in Lineage::touches; nullopt: none.
};

/// One operation in the history of frames.
struct LineageTouch {
  int op = 0;                          ///< Index in EditRecipe::ops.
  std::optional<std::size_t> earlier;  ///< The operation before it.
};

/// Origins of all frames. Frames with the same history share it.
struct Lineage {
  std::vector<FrameLineage> frames;  ///< One per pose.
  std::vector<LineageTouch> touches;
};

/// Returns the lineage of a source that no operation has changed.
[[nodiscard]] Lineage lineage_of_source(int source, int frame_count);

/// Adds an operation to the history of these frames. Linear in frames.
/// Precondition: the range is within the frames, or empty (last < first).
void touch(Lineage& lineage, const FrameRange& frames, int op);

/// Returns the operations that changed a frame, in their order.
[[nodiscard]] std::vector<int> ops_of(const Lineage& lineage, int frame);

}  // namespace marey::edit
