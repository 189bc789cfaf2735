// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"

namespace marey::app {

/// Paths of a keeper's wrists and hips in the world.
struct KeeperTrack {
  std::vector<double> times_s;  ///< On the clock of the scene, ascending.
  std::array<std::vector<glm::dvec3>, 2> wrists_in_world;  ///< Left, right.
  std::vector<glm::dvec3> hips_in_world;
};

/// Computes the track of a recorded motion. `scene_from_motion_s` is added to its times.
/// nullopt: the skeleton has no hips or no hand.
[[nodiscard]] std::optional<KeeperTrack> keeper_track(const Motion& motion,
                                                      double scene_from_motion_s);

/// A keeper's response to one throw. Times are on the clock of the scene.
struct KeeperResponse {
  int hand = 0;                        ///< The hand that is faster: 0 left, 1 right.
  std::optional<double> hand_moves_s;  ///< nullopt: it moved before the throw began.
  std::optional<double> hips_move_s;
  glm::dvec3 hand_at_arrival_in_world{0.0};  ///< Its wrist. [m]
};

/// Returns the time at which a movement begins: before the largest speed in
/// [from_s, to_s], the last time at which the speed rises above `share` of it.
/// Interpolated between frames. nullopt: it is above at from_s already; fewer than three
/// frames; no movement. Linear in frames. Precondition: times ascend.
[[nodiscard]] std::optional<double> movement_start(std::span<const double> times_s,
                                                   std::span<const glm::dvec3> path,
                                                   double from_s,
                                                   double to_s,
                                                   double share = 0.05);

/// Computes the response to a throw that starts at `start_s` and whose ball arrives at
/// `arrival_s`: movements from the start of the throw to 0.3 s after the arrival.
/// nullopt: the track does not cover the arrival.
[[nodiscard]] std::optional<KeeperResponse> keeper_response(const KeeperTrack& track,
                                                            double start_s,
                                                            double arrival_s);

}  // namespace marey::app
