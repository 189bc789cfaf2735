// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/identify_bones.h"

namespace marey::retarget {

/// By how much a joint of a known skeleton leans forward in its T-pose, against what its
/// own axes say.
struct NeutralLean {
  std::string_view joint;  ///< The joint's name.
  double forward_rad = 0.0;
};

/// Facts of a skeleton that its file does not state.
struct NamedNeutral {
  std::string_view name;  ///< What users call it: "bandai".
  std::string_view maker;
  /// Angle of the bone from ankle to toe joint below the horizontal, the foot flat.
  double foot_pitch_rad = 0.0;
  /// Height of the toe joint above the floor, the foot flat, over the length of a leg.
  double ball_height_in_legs = 0.0;
  std::span<const NeutralLean> leans;
  /// A skeleton that has all of these joints is this one.
  std::span<const std::string_view> joints;
};

/// All that marey knows.
[[nodiscard]] std::span<const NamedNeutral> named_neutrals();
/// The one of this name.
[[nodiscard]] const NamedNeutral* named_neutral(std::string_view name);
/// The one that a skeleton is by the names of its joints.
[[nodiscard]] const NamedNeutral* named_neutral(const Skeleton& skeleton);

/// Makes a T-pose the rest of a motion's skeleton, standing along `up` (unit, in the
/// file's world), facing along an axis, feet on the floor. Poses keep their places: they do not count from the rest.
///
/// The T-pose follows from the bones: arms and legs are straight along theirs, the
/// vertebrae, the neck and the head stand along the axis of their own that is nearest to
/// their bone, feet are flat by the slope of an average foot (`known` has better). Left
/// is where the hips have their left leg and the chest its left arm. Which way a bone is
/// turned about itself is one of a few choices: an axis of its own, or for upper arms and
/// thighs a multiple of 30 degrees from one. The motion decides between the choices and
/// nothing else, by the bend of elbows and knees and by how bones lie beside each other:
/// all motions of a skeleton get the same rest.
///
/// Precondition: the motion has poses; both legs and the hips are found.
/// Cost: linear in frames times joints.
void rest_as_t_pose(Motion& motion,
                    const FoundBones& found,
                    const glm::dvec3& up,
                    const NamedNeutral* known = nullptr);

}  // namespace marey::retarget
