// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/clip_on_body.h"

#include "engine/clips/sample_clip.h"

#include "retarget/body/normalized_skeleton.h"

namespace marey::app {

ClipOnBody::ClipOnBody(const MotionClip& clip,
                       const PostureLayout& layout,
                       const Skeleton& skeleton,
                       const retarget::BodyMap& map)
    : clip_(clip),
      layout_(layout),
      skeleton_(skeleton),
      map_(map),
      pose_(rest_pose(skeleton)),
      joints_(skeleton.joints.size()) {}

std::span<const RigidTransform> ClipOnBody::joints_at(double clip_s) {
  engine::RootPlace root = engine::path_at(clip_, clip_s);
  root.x_m *= map_.leg_length_m;
  root.z_m *= map_.leg_length_m;
  engine::sample_clip(clip_, clip_s, posture_);
  engine::to_normalized(posture_, layout_, root, map_.leg_length_m, normalized_);
  retarget::expand(normalized_, skeleton_, map_, joints_, pose_);
  return joints_;
}

}  // namespace marey::app
