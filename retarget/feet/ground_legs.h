// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/human/contacts.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/feet/foot_place.h"

namespace marey::retarget {

/// One leg of the reference postures, an entry per frame.
struct LegPath {
  std::vector<FootPlace> foot;
  std::vector<glm::dvec3> hip_from_root;  ///< World axes. [m]
  std::vector<double> extension;          ///< NormalizedLimb::extension.
};

/// Everything that the ground adaptation needs of all frames at once. It is collected and
/// applied posture by posture, because a posture takes ten times the memory of its frame
/// here.
struct GroundLegs {
  double root_unit_m = 1.0;      ///< Length that NormalizedPose::root is divided by.
  std::vector<glm::dvec3> root;  ///< NormalizedPose::root.
  std::array<LegPath, 2> legs;   ///< Left, right.

  [[nodiscard]] std::size_t frame_count() const { return root.size(); }
};

/// Adds the legs of the next frame. `world_from_joint` is working memory, one entry per
/// joint.
void add_legs(const Skeleton& body,
              const BodyMap& map,
              const NormalizedPose& pose,
              std::span<RigidTransform> world_from_joint,
              GroundLegs& out);

/// Returns how far the root sinks in each frame, so that bearing legs reach their feet:
/// smooth over `anticipation_s` to either side. [m] `straight` as in GroundOptions.
/// Precondition: one frame per frame of `contacts`; not empty.
[[nodiscard]] std::vector<double> root_sinks_m(const BodyMap& map,
                                               const Contacts& contacts,
                                               FrameRate rate,
                                               const GroundLegs& ground,
                                               double anticipation_s,
                                               double straight);

/// Sinks the root of the posture of frame `frame`; legs, feet and toes follow. Returns
/// the distance that each ankle, left and right, remains away from its foot. [m]
std::array<double, 2> settle_pose(const BodyMap& map,
                                  const GroundLegs& ground,
                                  std::size_t frame,
                                  double sink_m,
                                  NormalizedPose& pose);

}  // namespace marey::retarget
