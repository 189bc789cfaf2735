// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/motion.h"
#include "core/skeleton.h"

namespace marey::testing {

// Judges whether one motion has the posture of another, by the places of joints alone.
// Uses no normalized skeletons, T-poses or bone finding.

/// The segments whose directions make a posture.
enum class Segment : unsigned char {
  kTrunk,  ///< From between the thighs' joints to the neck (without one, between the
           ///< arms).
  kNeck,   ///< From the neck to the head.
  kLeftUpperArm,
  kLeftForearm,
  kRightUpperArm,
  kRightForearm,
  kLeftThigh,
  kLeftShank,
  kRightThigh,
  kRightShank,
  kLeftFoot,  ///< From the ankle to the toe joint, level; missing where that is steep.
  kRightFoot,
};
inline constexpr std::size_t kSegmentCount = 12;

[[nodiscard]] std::string_view name(Segment segment);

/// The joint of each bone, as the test defines it.
using BoneJoints = std::array<std::optional<JointIndex>, kHumanBoneCount>;

/// By the marks of a skeleton that the tester made.
[[nodiscard]] BoneJoints marked_joints(const Skeleton& skeleton);

/// By name, for files from elsewhere. A "{}" in a name stands for `left` in bones of the
/// left side, and the right side's bone is meant too, with `right`. Names that the
/// skeleton does not have leave the bone out.
struct SideWords {
  std::string_view left;
  std::string_view right;
};
[[nodiscard]] BoneJoints named_joints(
    const Skeleton& skeleton,
    const SideWords& sides,
    std::initializer_list<std::pair<HumanBone, std::string_view>> names);

/// Unit directions in the world; nullopt where a joint is missing.
using Directions = std::array<std::optional<glm::dvec3>, kSegmentCount>;
[[nodiscard]] Directions directions_of(const Skeleton& skeleton,
                                       const BoneJoints& joints,
                                       const Pose& pose);

/// The angles between the segments of two motions, frame by frame. [rad]
struct DirectionErrors {
  /// Over all frames; nullopt where one of the bodies has no such segment.
  std::array<std::optional<double>, kSegmentCount> mean_rad{};
  std::array<std::optional<double>, kSegmentCount> p95_rad{};
  std::array<std::optional<double>, kSegmentCount> worst_rad{};

  /// The largest mean of any segment, and whose it is.
  [[nodiscard]] std::pair<double, Segment> worst_mean() const;
};

/// Compares frame k of one with frame k of the other, as far as both go. Both are in
/// frames with the same axes. Precondition: both have poses.
[[nodiscard]] DirectionErrors compare_directions(const Motion& source,
                                                 const BoneJoints& source_joints,
                                                 const Motion& result,
                                                 const BoneJoints& result_joints);

/// Returns the direction that a body faces: across its thighs' joints, level, Y up. Unit.
[[nodiscard]] glm::dvec3 facing_of(const Skeleton& skeleton,
                                   const BoneJoints& joints,
                                   const Pose& pose);

}  // namespace marey::testing
