// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/motion.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"

namespace marey::edit {

/// A rigid move on the floor: a turn about the vertical, then a shift along X and Z. It
/// keeps heights.
struct PlanarMove {
  double turn_rad = 0.0;  ///< Positive from +Z to +X, as a rotation about Y.
  glm::dvec2 shift_xz_m{0.0};

  [[nodiscard]] glm::dquat rotation() const;
  [[nodiscard]] RigidTransform transform() const;
  /// Moves a point of the world.
  [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p_in_world) const;
};
/// Returns the move that does `b`, then `a`. Turns add up, beyond half a turn too.
[[nodiscard]] PlanarMove operator*(const PlanarMove& a, const PlanarMove& b);
[[nodiscard]] PlanarMove inverse(const PlanarMove& move);
/// Returns the move done `count` times; a negative count is the inverse. Logarithmic in
/// the count.
[[nodiscard]] PlanarMove power(const PlanarMove& move, int count);
/// Moves a whole posture.
/// Precondition: the first joint is the only root.
void move_pose(const PlanarMove& move, Pose& pose);

/// Returns the move `a_from_b` of points that minimizes the weighted sum of squares
/// sum w |a_k - move(b_k)|^2 (Kovar, Gleicher and Pighin, "Motion graphs", 2002, eq. 2,
/// with weights of any sum). Points on one vertical have no turn: it is 0.
/// Linear in points.
/// Precondition: as many points and weights each; weights not negative, not all 0.
[[nodiscard]] PlanarMove fit_planar(std::span<const glm::dvec3> a,
                                    std::span<const glm::dvec3> b,
                                    std::span<const double> weights);

/// Positions and velocities of the joints that are compared, frame after frame.
struct MatchPoints {
  std::vector<double> weights;         ///< One per point of a frame. Sum is 1.
  std::vector<glm::dvec3> places;      ///< [frame * points + point], in the world. [m]
  std::vector<glm::dvec3> velocities;  ///< As `places`. [m/s]

  [[nodiscard]] int point_count() const { return static_cast<int>(weights.size()); }
  [[nodiscard]] int frame_count() const {
    return weights.empty() ? 0 : static_cast<int>(places.size() / weights.size());
  }
};

/// Returns the joints of a body with their share of its mass. Half of each segment's mass
/// (retarget/body/place_masses.h, de Leva 1996) is at the joint where it begins; the
/// other half is shared by the bones at which it ends. A segment without such a bone has
/// all of its mass at its joint. One weight per joint of the skeleton; sum is 1.
[[nodiscard]] std::vector<double> joint_mass_shares(const Skeleton& skeleton,
                                                    const retarget::BodyMap& map);

/// Computes the points of all frames: the joints whose share of the mass is above 0.
/// Velocities are central differences over velocity_reach() frames before and after, less
/// at both ends; 0 for a single frame. Linear in frames times joints.
/// Precondition: `map` was made from the motion's skeleton.
[[nodiscard]] MatchPoints match_points(const Motion& motion,
                                       const retarget::BodyMap& map);

/// Returns the frames on either side over which velocities are measured: 25 ms, and at
/// least 1. Shorter differences of fast captures are mostly noise.
[[nodiscard]] int velocity_reach(double hz);

struct MatchOptions {
  int half_window = 2;  ///< Frames before and after that are compared too: 2 is 5 frames.
  double velocity_s =
      0.1;  ///< Weight of velocities: a difference times this is a length.
};

/// Similarity of two frames and their neighbours.
struct PlanarMatch {
  PlanarMove a_from_b;      ///< Moves the second motion onto the first.
  double distance_m = 0.0;  ///< sqrt(rms_m^2 + (velocity_s * rms_velocity_m_per_s)^2).
  double rms_m = 0.0;       ///< Weighted difference of places after the move.
  double worst_m = 0.0;     ///< Largest difference of a point in the middle frames.
  double rms_velocity_m_per_s = 0.0;
};

/// Compares frame `frame_a` of one motion with `frame_b` of another. The move is that of
/// fit_planar() over the places of both windows. The cut of a window at an end of a
/// motion cuts the other one by the same frames. Linear in points of the windows;
/// allocates nothing beyond a few kilobytes. Precondition: both have the same points; the
/// frames are within the motions.
[[nodiscard]] PlanarMatch match_windows(const MatchPoints& a,
                                        int frame_a,
                                        const MatchPoints& b,
                                        int frame_b,
                                        const MatchOptions& options = {});

}  // namespace marey::edit
