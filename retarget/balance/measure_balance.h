// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/live_stance.h"

namespace marey::retarget {

/// Centre of mass and support area of a body in one frame.
struct BalanceFrame {
  glm::dvec3 centre_of_mass_in_world{0.0};
  /// Corners of the support area in ground projection (X, Z), in order, as in
  /// track_balance(). Empty without support.
  std::vector<glm::dvec2> support_xz_m;
  /// Zero moment point on the floor. Set by callers that know it; nullopt: not computed,
  /// or undefined (flight).
  std::optional<glm::dvec2> zmp_xz_m{};
};

/// Computes the frame of one posture with the given standing feet. Writes to `out`;
/// allocates nothing once `out` has had corners. Preconditions: `map` belongs to the
/// posture's body; `masses` as below.
void balance_of_posture(const BodyMap& map,
                        std::span<const PointMass> masses,
                        std::span<const RigidTransform> world_from_joint,
                        const std::array<StandingFoot, 2>& standing,
                        BalanceFrame& out);

/// Computes all frames. Cost and preconditions as track_balance().
[[nodiscard]] std::vector<BalanceFrame> balance_frames(const Motion& motion,
                                                       const BodyMap& map,
                                                       std::span<const PointMass> masses,
                                                       const Contacts& contacts);

/// Horizontal distance [m] of the centre of mass outside of the support area, frame by
/// frame; negative inside: distance to the edge. nullopt: no foot bears.
using BalanceTrack = std::vector<std::optional<double>>;

/// Computes the balance track of a motion. The support area is the convex hull of the
/// soles of the standing feet. A flat foot counts from heel to tip, a raised heel from
/// the ball on, a foot on its heel with the rear quarter. The width is 0.38 of the
/// length, the average of human feet. A sole without length bears at a point; points and
/// lines have no inside. Linear in frames. Precondition: `map` was made from the motion's
/// skeleton; `masses` are on its joints and their sum is above 0; `contacts` has its
/// frames.
[[nodiscard]] BalanceTrack track_balance(const Motion& motion,
                                         const BodyMap& map,
                                         std::span<const PointMass> masses,
                                         const Contacts& contacts);

struct BalanceFigures {
  int supported_frames = 0;  ///< A foot bears.
  int over_frames = 0;       ///< A foot bears, and the centre of mass is above the
                             ///< support area.
  /// A foot bears, and the centre of mass is outside the support area although it is
  /// inside in the source motion.
  int lost_frames = 0;

  /// Returns the share among frames with support; 0 without such frames.
  [[nodiscard]] double over_share() const {
    return supported_frames > 0 ? static_cast<double>(over_frames) / supported_frames
                                : 0.0;
  }
};

/// Computes figures of a track. Precondition: both have the same frames, or `source` is
/// absent.
[[nodiscard]] BalanceFigures balance_measures(const BalanceTrack& track,
                                              const BalanceTrack& source = {});

}  // namespace marey::retarget
