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
#include "core/motion.h"
#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/live_stance.h"

namespace marey::retarget {

/// Where a body's weight is and what may bear it, in one frame.
struct BalanceFrame {
  glm::dvec3 centre_of_mass_in_world{0.0};
  /// What bears, seen from above, as track_balance() says: X and Z of its corners, in
  /// turn. Empty: nothing does.
  std::vector<glm::dvec2> support_xz_m;
};

/// Of one posture, on the feet that stand; in `out`, which allocates nothing once it has
/// held corners. Preconditions: `map` is of the posture's body; of `masses` as below.
void balance_of_posture(const BodyMap& map,
                        std::span<const PointMass> masses,
                        std::span<const RigidTransform> world_from_joint,
                        const std::array<StandingFoot, 2>& standing,
                        BalanceFrame& out);

/// Frame by frame. Cost and preconditions as track_balance()'s.
[[nodiscard]] std::vector<BalanceFrame> balance_frames(const Motion& motion,
                                                       const BodyMap& map,
                                                       std::span<const PointMass> masses,
                                                       const Contacts& contacts);

/// How far the centre of mass is outside of what bears, seen from above, frame by frame;
/// negative: within, that far from the edge. nullopt: no foot bears. [m]
using BalanceTrack = std::vector<std::optional<double>>;

/// What bears is the convex hull of the soles of the feet that stand: of a flat foot from
/// heel to tip, of a raised heel from the ball on, of a foot on its heel the hindmost
/// quarter; 0.38 of its length broad, as feet are on average. A sole of no length bears
/// at a point, and nothing is within points and lines. Linear in frames. Precondition:
/// `map` was made from the motion's skeleton, `masses` are on its joints and weigh
/// something, `contacts` has its frames.
[[nodiscard]] BalanceTrack track_balance(const Motion& motion,
                                         const BodyMap& map,
                                         std::span<const PointMass> masses,
                                         const Contacts& contacts);

struct BalanceFigures {
  int supported_frames = 0;  ///< A foot bears.
  int over_frames = 0;       ///< And the centre of mass is above what bears.
  /// And it is not, though it is in the motion that this is held against.
  int lost_frames = 0;

  /// Of the frames with support; 0 without one.
  [[nodiscard]] double over_share() const {
    return supported_frames > 0 ? static_cast<double>(over_frames) / supported_frames
                                : 0.0;
  }
};

/// Precondition: as many frames, or no `source`.
[[nodiscard]] BalanceFigures balance_figures(const BalanceTrack& track,
                                             const BalanceTrack& source = {});

}  // namespace marey::retarget
