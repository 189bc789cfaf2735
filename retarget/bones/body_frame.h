// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/bone_map.h"
#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// Orientation and scale of a body in its file, and the transform to marey's frame: Y up,
/// facing +Z, metres.
struct BodyFrame {
  glm::dquat marey_from_file{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;                 ///< Metres per length as it was read.
  double unit_m = 1.0;                ///< Resulting unit of the file's numbers. [m]
  double stature_m = 0.0;             ///< Estimated from the bones. [m]
  glm::dvec3 up_in_file{0, 1, 0};     ///< Unit.
  glm::dvec3 front_in_file{0, 0, 1};  ///< Unit.
  std::vector<std::string> remarks;   ///< The assumptions made, one sentence each.

  /// True if nothing is to be turned or scaled.
  [[nodiscard]] bool is_marey() const {
    return marey_from_file == glm::dquat(1.0, 0.0, 0.0, 0.0) && scale == 1.0;
  }
};

/// Unit of a file, known before its body is examined.
struct FileUnit {
  double read_m = 1.0;  ///< Unit in which it was read. [m]
  /// True if the format states it; false if it is a convention only.
  bool is_stated = true;
};

/// Finds the body's orientation at rest, and which of two similar sides is the left one.
///
/// Up is the direction from the feet to the hips. The front is left x up (`found` holds
/// which side is left); within 12 degrees of an axis it is that axis. Toes that point the
/// other way reject the mapping; if the sides follow from the shape alone, they are
/// exchanged instead. The unit is the file's if the stature is 0.25 to 12 m in it (0.4 to
/// 4 m if the format does not state the unit). Otherwise it is the one of metre,
/// decimetre, centimetre, millimetre, inch and CMU's 1/0.45 inch that gives the stature
/// nearest to 1.7 m. The user's `overrides` have priority over all of this.
///
/// Errors (bad input), with the joint: the legs are not below the hips or the head not
/// above them, including a body that stands on its hands; sides that contradict the
/// front.
[[nodiscard]] Result<BodyFrame> find_body_frame(const Skeleton& skeleton,
                                                const FileUnit& unit,
                                                const BoneMap& overrides,
                                                FoundBones& found);

/// Returns true if at rest the legs are below the hips, side by side, and the trunk
/// above. Motion files often do not satisfy this.
[[nodiscard]] bool stands_at_rest(const Skeleton& skeleton, const FoundBones& found);

/// Returns the mean distance of the arm and leg joints at rest from the mirror image of
/// the other side's, in leg lengths. 0 in a T-pose.
[[nodiscard]] double asymmetry(const Skeleton& skeleton, const FoundBones& found);

/// Turns and scales a motion, or a body without one, into marey's frame.
void put_into_frame(const BodyFrame& frame, Motion& motion);

/// Returns the name of an axis, "+Z", or the three numbers if the direction is no axis.
[[nodiscard]] std::string axis_word(const glm::dvec3& direction);

}  // namespace marey::retarget
