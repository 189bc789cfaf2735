// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/bone_map.h"
#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "retarget/identify_bones.h"

namespace marey::retarget {

/// How a body stands in its file, and what makes it stand as marey's do: Y up, facing +Z,
/// in metres.
struct BodyFrame {
  glm::dquat marey_from_file{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;                 ///< Metres per length as it was read.
  double unit_m = 1.0;                ///< Of the file's numbers, after all. [m]
  double stature_m = 0.0;             ///< Estimated from the bones.
  glm::dvec3 up_in_file{0, 1, 0};     ///< Unit.
  glm::dvec3 front_in_file{0, 0, 1};  ///< Unit.
  std::vector<std::string> remarks;   ///< What was assumed, a sentence each.

  /// Nothing is to be turned or scaled.
  [[nodiscard]] bool is_marey() const {
    return marey_from_file == glm::dquat(1.0, 0.0, 0.0, 0.0) && scale == 1.0;
  }
};

/// What is known of a file before its body is looked at.
struct FileUnit {
  double read_m = 1.0;    ///< Unit in which it was read. [m]
  bool is_stated = true;  ///< Its format says so, and not a custom alone.
};

/// Finds out how the body stands at rest, and which of two like sides is the left one.
///
/// Up is where the hips are from the feet; the front is to the right hand of up and left
/// (`found` says which is left), within 12 degrees of an axis the axis itself. Toes that
/// point the other way decline the mapping, but exchange sides that only the shape told.
/// The unit is the file's when the stature is 0.25 to 12 m in it (0.4 to 4 m when the
/// format does not state it); else the one of metre, decimetre, centimetre, millimetre,
/// inch and CMU's 1/0.45 inch in which it is nearest to 1.7 m. What the user told goes
/// before all of this.
///
/// Errors (bad input), with the joint: the legs do not stand below the hips and the head
/// above; a body that stands on its hands too; sides that the front contradicts.
[[nodiscard]] Result<BodyFrame> find_body_frame(const Skeleton& skeleton,
                                                const FileUnit& unit,
                                                const BoneMap& told,
                                                FoundBones& found);

/// Whether legs are below the hips, side by side, and the trunk above at rest: what a
/// file of motion need not care for.
[[nodiscard]] bool stands_at_rest(const Skeleton& skeleton, const FoundBones& found);

/// How unlike the two sides of a body are at rest: the mean distance of its arms' and
/// legs' joints from the mirror image of the other side's, in leg lengths. 0 in a T-pose.
[[nodiscard]] double asymmetry(const Skeleton& skeleton, const FoundBones& found);

/// Turns and scales a motion, or a body without one, into marey's frame.
void put_into_frame(const BodyFrame& frame, Motion& motion);

/// "+Z", or its three numbers when it is no axis.
[[nodiscard]] std::string axis_word(const glm::dvec3& direction);

}  // namespace marey::retarget
