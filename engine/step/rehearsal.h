// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/step/blend_player.h"
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/adapt/adapter.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_pose.h"

namespace marey::engine {

/// A foot after the last step.
struct StandingFoot {
  bool stands = false;
  glm::dvec3 ankle_in_world{0.0};
  glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 from_reference_m{0.0};  ///< Displacement of the ankle by the feet's hold.
};

/// The body after the last step, against the blend of the clips.
struct BodyShift {
  glm::dvec3 hips_m{0.0};  ///< Displacement of the hips by the adaptation.
  double lift_m = 0.0;     ///< Lift by which the soles meet the floor, before that.
  std::array<StandingFoot, 2> feet{};
};

/// Poses a body at times that are not shown: just ahead, or between two steps. Allocates
/// nothing after it was made.
class Rehearsal {
 public:
  /// Both must outlive it.
  Rehearsal(const Skeleton& skeleton, const retarget::BodyMap& map);

  /// Computes the joints of the blend on this body at a time, if nothing changes; false:
  /// nothing plays. Cost: some microseconds.
  bool predict(double now_s, double time_s, const BlendPlayer& blend);
  /// The same for one clip alone, from the start of its path, at the origin.
  void sample(double source_s, const MotionClip& clip, const PostureLayout& layout);
  [[nodiscard]] std::span<const RigidTransform> joints() const { return joints_; }
  [[nodiscard]] const RootPlace& root() const { return root_; }

  /// Adapts the posture of the last predict(): standing feet stay, others are those of
  /// the prediction; the other constraints have the targets that they have now.
  std::span<const RigidTransform> adapt(
      double time_s,
      const BodyShift& shift,
      std::span<std::optional<retarget::Adapter::Handle>> supports,
      retarget::Adapter& adapter);

 private:
  const Skeleton* skeleton_;
  const retarget::BodyMap* map_;
  retarget::NormalizedPose normalized_;
  std::vector<RigidTransform> joints_;
  std::vector<RigidTransform> led_joints_;
  Pose pose_;
  Pose adapted_;
  BlendPosture posture_;
  RootPlace root_;
  PostureLayout layout_;
  Rig rig_;
};

/// Returns place and heading of the hips of a posed body.
[[nodiscard]] RootPlace posed_root(std::span<const RigidTransform> world_from_joint,
                                   const retarget::BodyMap& map);
/// Returns the wrist of an arm; its rotation is that from the T-pose.
[[nodiscard]] RigidTransform posed_wrist(std::span<const RigidTransform> world_from_joint,
                                         const retarget::BodyMap& map,
                                         int side);
/// Returns the time of the engine at which a time of the clip plays; `now_s` if it is
/// over.
[[nodiscard]] double event_time_s(const PhaseWarp& warp, double now_s, double event_s);

}  // namespace marey::engine
