// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/engine/motion_clip.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_pose.h"

namespace marey::app {

/// A clip that plays on a body alone, without feet and constraints: the reference of
/// figures. Borrows all of its arguments.
class ClipOnBody {
 public:
  /// Precondition: `map` was made from `skeleton`; `layout` is that of the clip's base.
  ClipOnBody(const MotionClip& clip,
             const PostureLayout& layout,
             const Skeleton& skeleton,
             const retarget::BodyMap& map);

  /// Computes the joints in the world at a time of the clip, from its start at the
  /// origin. A clip that loops has cycles at any time; another one is clamped.
  std::span<const RigidTransform> joints_at(double clip_s);
  /// The pose of the last joints_at().
  [[nodiscard]] const Pose& pose() const { return pose_; }
  [[nodiscard]] const MotionClip& clip() const { return clip_; }

 private:
  const MotionClip& clip_;
  const PostureLayout& layout_;
  const Skeleton& skeleton_;
  const retarget::BodyMap& map_;
  BlendPosture posture_;
  retarget::NormalizedPose normalized_;
  Pose pose_;
  std::vector<RigidTransform> joints_;
};

}  // namespace marey::app
