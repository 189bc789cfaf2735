// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: rotations of joints as angles about axes, and angles over time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace marey::reconstruct {

/// A rotation about three successive axes, each rotated by those before it: rotation =
/// about(axes[0], angle[0]) * about(axes[1], angle[1]) * about(axes[2], angle[2])
struct Cardan {
  std::array<double, 3> angle_rad{};  ///< The middle one within +-90 degrees.
  /// The middle one is +-90 degrees: only the sum (at -90, difference) of the others is
  /// determined, and the last one is 0.
  bool locked = false;
};

/// Axes by number, 0 is x; they are even permutations.
inline constexpr std::array<int, 3> kZxy{2, 0, 1};
inline constexpr std::array<int, 3> kYzx{1, 2, 0};

[[nodiscard]] Cardan cardan_angles(const glm::dquat& rotation,
                                   const std::array<int, 3>& axes);

/// Angles of two successive hinges that together come nearest to a rotation.
struct HingeAngles {
  double first_rad = 0.0;
  double second_rad = 0.0;
};

/// Computes the angles that minimize the angle between `rotation` and about(first) *
/// about(second). Closed form. Precondition: unit axes that are not parallel.
[[nodiscard]] HingeAngles nearest_hinges(const glm::dquat& rotation,
                                         const glm::dvec3& first,
                                         const glm::dvec3& second);

/// Returns the angle about a unit axis that comes nearest to `rotation`, in (-pi, pi].
[[nodiscard]] double nearest_hinge(const glm::dquat& rotation, const glm::dvec3& axis);

/// One column of a table with a row per frame.
struct Series {
  double* first = nullptr;
  std::size_t step = 1;  ///< From a frame's number to the next one's.
  std::size_t frames = 0;

  [[nodiscard]] double& operator[](std::size_t frame) const {
    return first[frame * step];
  }
};

/// Adds full turns to each angle so that no step is of more than half a turn.
void unwrap(const Series& angle_rad);

struct AngleRange {
  double low_rad = 0.0;
  double high_rad = 0.0;
};

/// Makes Cardan angles continuous over time, in place. Every rotation has two triples;
/// the sequence with the smallest sum of steps is chosen, with a small cost for angles
/// outside `usual`. The first angle of locked frames is the last determined one, or the
/// next. Finally calls unwrap(). `locked` has a bit `bit` per frame; `way` is working
/// memory. Linear in frames.
void follow_cardan(const std::array<Series, 3>& angles,
                   const std::array<AngleRange, 3>& usual,
                   std::span<const std::uint16_t> locked,
                   unsigned bit,
                   std::vector<std::uint8_t>& way);

}  // namespace marey::reconstruct
