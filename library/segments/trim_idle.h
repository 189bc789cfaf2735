// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/frame_range.h"
#include "core/library/clip_record.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Frames without action at an end of a motion.
struct IdleFrames {
  FrameRange frames;
  std::string name;  ///< "tpose" or "still".
};

struct TrimmedIdle {
  FrameRange kept;              ///< Poses of the motion.
  std::vector<IdleFrames> cut;  ///< Ascending, in poses of the motion.
  /// One for each entry of `cut`, in frames of the kept clip: 0 for a cut before it, its
  /// last frame for a cut after it.
  std::vector<ClipEvent> events;
};

/// Finds the frames at both ends of a motion in which the body is in the T-pose
/// (t_pose_frames()), or still for 0.5 s or longer (still_frames()), also one after the
/// other. The last 0.25 s of stillness before a movement, and the first after one, are
/// kept. If less than 0.5 s would be kept, nothing is cut: a motion of a standing body
/// stays.
///
/// Linear in frames times joints. Precondition: `map` was made from the motion's
/// skeleton; the rate is positive; there is a pose.
[[nodiscard]] TrimmedIdle trim_idle(const Motion& motion, const retarget::BodyMap& map);

}  // namespace marey::library
