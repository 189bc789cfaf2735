// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/humanoid.h"

namespace marey {

/// Rotations of a BlendPosture, by their place in its arrays: limbs as in human_limbs(),
/// segments as in kPostureSegments, then the knots of the spine from low to high.
inline constexpr std::size_t kLimbRotation = 0;
inline constexpr std::size_t kSegmentRotation = 4;
inline constexpr std::size_t kAbdomenRotation = 15;
inline constexpr std::size_t kTorsoRotation = 19;
inline constexpr std::size_t kNeckRotation = 23;
inline constexpr std::size_t kUsedRotations = 26;
/// Length of the arrays: a multiple of four; the last two rotations are the identity.
inline constexpr std::size_t kPostureRotations = 28;

inline constexpr std::size_t kAbdomenKnots = 4;
inline constexpr std::size_t kTorsoKnots = 4;
inline constexpr std::size_t kNeckKnots = 3;

/// Segments of a BlendPosture, in the order of its arrays.
inline constexpr std::array<HumanBone, 11> kPostureSegments{HumanBone::kHips,
                                                            HumanBone::kNeck,
                                                            HumanBone::kHead,
                                                            HumanBone::kLeftShoulder,
                                                            HumanBone::kRightShoulder,
                                                            HumanBone::kLeftHand,
                                                            HumanBone::kRightHand,
                                                            HumanBone::kLeftFoot,
                                                            HumanBone::kRightFoot,
                                                            HumanBone::kLeftToes,
                                                            HumanBone::kRightToes};

/// A posture without a size (retarget::NormalizedPose) for blending: single precision, in
/// structure of arrays, in the heading frame. The heading frame is the world turned about
/// Y by the heading, the yaw of the hips: all rotations are relative to the canonical
/// T-pose, in its axes. Every rotation is present; a body without toes has those of its
/// feet there, and so on.
struct alignas(16) BlendPosture {
  using Rotations = std::array<float, kPostureRotations>;
  /// Unit quaternions.
  Rotations x{};
  Rotations y{};
  Rotations z{};
  Rotations w{};
  /// Values of the limbs: retarget::NormalizedLimb. The fold is the arc cosine of the
  /// extension: 0 is a straight limb. Knees and elbows turn evenly with it, while the
  /// speed of a nearly straight knee grows without bound over that of the extension.
  std::array<float, 4> fold_rad{};
  std::array<float, 4> mid_x{};
  std::array<float, 4> mid_y{};
  std::array<float, 4> upper_twist_rad{};
  std::array<float, 4> lower_twist_rad{};
  /// World Y of the hips joint. [legs]
  float height_legs = 0.0F;
  /// Start of abdomen and torso on the spine: retarget::SpineShares.
  float abdomen_share = 0.0F;
  float torso_share = 0.0F;
  float unused = 0.0F;
  bool operator==(const BlendPosture&) const = default;
};

/// Places of the spine's knots, the same for all clips of a base; each ascends from 0 to
/// 1; the last knot may be repeated, and counts once. See retarget::RotationCurve::at.
struct PostureLayout {
  std::array<float, kAbdomenKnots> abdomen_at{0.0F, 1.0F / 3, 2.0F / 3, 1.0F};
  std::array<float, kTorsoKnots> torso_at{0.0F, 1.0F / 3, 2.0F / 3, 1.0F};
  std::array<float, kNeckKnots> neck_at{0.0F, 0.5F, 1.0F};
  bool operator==(const PostureLayout&) const = default;
};

}  // namespace marey
