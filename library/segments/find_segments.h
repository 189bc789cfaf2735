// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/frame_range.h"
#include "core/library/clip_record.h"
#include "core/library/library_motion.h"
#include "core/library/library_settings.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Divides a motion into clips: ranges of poses, ascending by first, then by last pose.
///
/// - kNone: one range, the whole motion.
/// - kLabels: one range per interval of a label that a person or a table states (not by
///   "marey"), of 0.1 s or more, cut to the motion. Labels of one interval share a range;
///   ranges may overlap, and frames without a label belong to none.
/// - kStillness: the parts between runs of 0.5 s or longer in which no joint is faster
///   than 5 cm/s (still_frames()), with 0.25 s of stillness at either side. Disjoint; the
///   rest of the still frames belong to none. A motion that is still all the time has no
///   range.
/// - kSteps: cycles, from the frame in which the left foot starts a stance to the frame
///   before its next one, of 0.4 to 3 s, in which the right foot starts a stance, too.
///   Disjoint; frames before the first, after the last and between distant cycles belong
///   to none.
/// - kChange: a partition at the changes of the content (find_changes()). No range is
///   shorter than 0.9 s, but for a motion that is shorter itself.
///
/// Deterministic. Linear in frames times joints. Preconditions: `map` was made from the
/// motion's skeleton; the rate is positive; there is a pose, and an entry of contacts for
/// each.
[[nodiscard]] std::vector<FrameRange> find_segments(
    const LibraryMotion& motion,
    const retarget::BodyMap& map,
    SegmentBy by,
    std::span<const ClipLabel> labels = {});

/// Returns the first frames of the stances of a foot, ascending, without one that begins
/// before the motion. Side 0 is left, 1 is right. Linear in frames.
[[nodiscard]] std::vector<int> find_strikes(const std::vector<FootParts>& contacts,
                                            int side);

/// Returns the cycles of kSteps. Linear in frames.
[[nodiscard]] std::vector<FrameRange> find_cycles(const std::vector<FootParts>& contacts,
                                                  double hz);

}  // namespace marey::library
