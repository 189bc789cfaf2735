// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"

namespace marey::retarget {

/// Target of a hand: the middle of its capsule, and its rotation from the T-pose.
struct HandPlace {
  glm::dvec3 middle_in_world{0.0};
  glm::dquat world_from_t_pose{1.0, 0.0, 0.0, 0.0};
};

/// Both hands of a standing body; nullopt hangs.
using HandPlaces = std::array<std::optional<HandPlace>, 2>;

inline constexpr int kSceneFrames = 240;  ///< At 60 Hz.
inline constexpr int kHeldFirst = 90;     ///< The hands are there from this frame
inline constexpr int kHeldLast = 150;  ///< to this one, and hang before 60 and after 180.

/// An average adult that stands, raises its hands to these places, and lowers them again;
/// every joint's rotation has noise of `noise_rad` and the root of `noise_m` (standard
/// deviations, fixed seed).
[[nodiscard]] Motion hands_go_to(const HandPlaces& places,
                                 double noise_rad = 0.0,
                                 double noise_m = 0.0);

/// The adult of these scenes.
[[nodiscard]] Skeleton adult();

/// Palms on each other in front of the chest; the left hand on top of the head; hands at
/// the sides of the pelvis. Surfaces 3 mm apart.
[[nodiscard]] HandPlaces clapping();
[[nodiscard]] HandPlaces hand_on_head();
[[nodiscard]] HandPlaces hands_on_hips();
[[nodiscard]] HandPlaces hand_on_belly();

/// An adult whose shoulders and hips are `factor` times as far apart.
[[nodiscard]] Skeleton broad(double factor);

/// An adult with short legs and long arms, whose hands would be a decimetre below the
/// floor.
[[nodiscard]] Skeleton ape();

/// Returns the maximum depth of hands in the floor Y = 0 over a motion. [m]
[[nodiscard]] double deepest_hand_m(const Motion& motion);

/// The same body with an abdomen and pelvis `factor` times as wide and deep.
[[nodiscard]] BodyVolume with_belly(BodyVolume volume, double factor);

/// Returns the minimum distance between the surfaces of two parts, by sampling points of
/// both axes.
[[nodiscard]] double gap_m(const BodyVolume& volume,
                           std::span<const RigidTransform> world_from_joint,
                           VolumePart a,
                           VolumePart b);

}  // namespace marey::retarget
