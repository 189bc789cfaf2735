// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey::edit {

/// A sequence of rotations q_i as three channels that any linear filter of vectors can
/// process, after Lee & Shin (2002): the filter acts on angular displacements.
///
/// With a smooth reference r_i near q_i, the channels are y_i = x_i + log(r_i^-1 q_i),
/// where x_0 = 0 and x_(i+1) = x_i + log(r_i^-1 r_(i+1)). A filter F gives the rotations
/// r_i exp(F(y)_i - x_i). For r = q and a filter of finite support this is their equation
/// for orientation filters; the sums x extend it to filters of infinite support.
///
/// With filters that are linear, and that return constants plus y for y plus constants:
/// - q_i -> a q_i (other world axes) changes the result to a times it;
/// - q_i -> q_i b (other joint axes) changes the result to it times b, if the three
///   channels share one filter;
/// - a rotation at constant angular velocity is a straight line in the channels.
/// The angle of x is not bounded, so full turns have no seam.
class RotationChannels {
 public:
  /// Builds the channels about a reference computed from the rotations: Lee & Shin's
  /// filter with the binomial weights (1, 4, 6, 4, 1) / 16. Signs of the quaternions do
  /// not matter. Linear. Precondition: unit quaternions, consecutive ones less than half
  /// a turn apart.
  explicit RotationChannels(std::span<const glm::dquat> rotations);

  /// Builds the channels about a given reference. Preconditions: as many elements; each
  /// less than half a turn from its rotation.
  RotationChannels(std::span<const glm::dquat> rotations,
                   std::span<const glm::dquat> reference);

  /// The channels y: components x, y, z of the angle, in the joint's axes. [rad]
  [[nodiscard]] const std::array<std::vector<double>, 3>& channels() const {
    return channels_;
  }

  /// Returns the rotations of filtered channels, each of the sign nearer to its
  /// predecessor. Precondition: three channels of as many elements.
  [[nodiscard]] std::vector<glm::dquat> rotations_of(
      std::span<const std::vector<double>> filtered) const;

 private:
  void develop(std::span<const glm::dquat> rotations);

  std::vector<glm::dquat> reference_;
  std::vector<glm::dvec3> developed_;  ///< x. [rad]
  std::array<std::vector<double>, 3> channels_;
};

/// Filters three channels in place; the same linear filter for each.
using VectorFilter = std::function<void(std::span<std::vector<double>>)>;

/// Filters rotations: once about the reference of RotationChannels, then about the
/// result, which has the least noise as a reference. The second run is omitted if the
/// first one turns a rotation by more than a quarter turn. Cost: two runs of the filter.
/// Preconditions: those of RotationChannels and of the filter.
[[nodiscard]] std::vector<glm::dquat> filter_rotations(
    std::span<const glm::dquat> rotations, const VectorFilter& filter);

}  // namespace marey::edit
