// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Points of a foot by which its contacts are timed.
enum EdgePoint : std::size_t {
  kBackPoint,  ///< Back of the heel of a shoe, at the ankle's height.
  kHeelPoint,  ///< Rear end of the sole.
  kBallPoint,  ///< The toe joint.
  kTipPoint,   ///< Front end of the sole, below the toe tip.
  kEdgePoints
};

/// One point over the motion.
struct EdgePath {
  std::vector<glm::dvec3> p_in_world;
  std::vector<double> across_m_per_s;  ///< Horizontal speed relative to the floor.
  std::vector<double> up_m_per_s;
};

/// Paths of the points of the left and of the right foot.
using EdgePaths = std::array<std::array<EdgePath, kEdgePoints>, 2>;

/// Computes the paths. Speeds are slopes of lines fitted to `smoothing_s`, at least three
/// frames. The floor moves horizontally at `floor_velocity`. Linear in frames.
/// Precondition: `map` was made from the motion's skeleton; the rate is positive.
[[nodiscard]] EdgePaths edge_paths(const Motion& motion,
                                   const BodyMap& map,
                                   double smoothing_s,
                                   const glm::dvec3& floor_velocity);

/// Returns the velocity of a treadmill's belt: the commonest horizontal velocity of the
/// balls in the lowest 35 % of their frames. nullopt if fewer than half of these frames
/// agree with it within 0.35 leg lengths per second. Linear in frames. [m/s]
/// Precondition: as edge_paths().
[[nodiscard]] std::optional<glm::dvec3> belt_velocity(const Motion& motion,
                                                      const BodyMap& map);

}  // namespace marey::retarget
