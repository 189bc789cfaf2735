// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::dynamics {

/// Rotation of a body about its centre of mass in each frame of a flight, and the angular
/// momentum that the rotated body has. Its constructor allocates all memory.
class FlightTurn {
 public:
  /// Preconditions: as centroidal_states(); 3 poses or more.
  FlightTurn(const Skeleton& skeleton,
             std::span<const PointMass> masses,
             FrameRate rate,
             std::span<const Pose> poses);

  [[nodiscard]] std::size_t frame_count() const { return turns_.size(); }
  /// Rotation added to the posture of a frame, in world axes.
  [[nodiscard]] const glm::dquat& turn(std::size_t frame) const { return turns_[frame]; }
  [[nodiscard]] const glm::dvec3& com_in_world(std::size_t frame) const {
    return coms_in_world_[frame];
  }
  /// Angular momentum of the frames between the first and the last, by central
  /// differences; element 0 is that of frame 1. [kg m^2/s]
  [[nodiscard]] std::span<const glm::dvec3> momenta() const { return momenta_; }
  /// Mean of momenta().
  [[nodiscard]] glm::dvec3 mean_momentum() const;
  /// Standard deviation of the component of momenta() that varies most.
  [[nodiscard]] double sd_kg_m2_s() const;
  /// Largest angle of turn(). [rad]
  [[nodiscard]] double largest_turn_rad() const;

  /// One Newton step on all rotations and on the constant momentum; the first and the
  /// last rotation stay. Returns the largest rotation of the full
  /// step [rad], of which at most 0.4 are taken; nullopt if
  /// the equations have no solution. Allocates nothing.
  std::optional<double> step();

 private:
  struct OwnTurn {
    glm::dmat3 inertia_kg_m2{0.0};                     ///< World axes, as captured.
    glm::dquat after_from_before{1.0, 0.0, 0.0, 0.0};  ///< Between the neighbours.
  };
  /// Rotation vector of a frame as an affine function of the unknowns: the rotation of
  /// frame 1 and the constant momentum.
  struct Row {
    glm::dvec3 constant{0.0};
    glm::dmat3 of_first{0.0};
    glm::dmat3 of_momentum{0.0};
  };
  /// Change of the momentum of a frame, times the time between its neighbours, with small
  /// rotations of the frame and of its neighbours. [kg m^2]
  struct Slopes {
    glm::dmat3 before{0.0};
    glm::dmat3 here{0.0};
    glm::dmat3 after{0.0};
  };
  void measure();
  void march(const glm::dvec3& mean, double scale);
  [[nodiscard]] bool solve(glm::dvec3& first, glm::dvec3& momentum) const;

  double step_s_ = 0.0;
  std::size_t own_count_ = 0;  ///< Masses that are not points.
  std::vector<glm::dquat> turns_;
  std::vector<glm::dvec3> coms_in_world_;
  double inertia_kg_m2_ = 0.0;  ///< Mean of the principal ones in the first frame.
  std::vector<glm::dmat3> cross_moments_;  ///< Sum of m p q^T of a frame and the next.
  std::vector<OwnTurn> own_;               ///< own_count_ per frame of momenta_.
  std::vector<glm::dvec3> momenta_;
  std::vector<Slopes> slopes_;  ///< As momenta_.
  std::vector<Row> rows_;
};

}  // namespace marey::dynamics
