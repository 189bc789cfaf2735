// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/edit/annotation.h"
#include "core/engine/motion_clip.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

/// A motion document with its name and properties: the input of make_moves().
struct ClipSource {
  std::string name;
  Motion motion;
  retarget::BodyMap map;  ///< For the motion's skeleton.
  Contacts contacts;      ///< One contact frame per pose.
  Annotations annotations;
  ConstraintSet constraints;
  std::vector<std::string> tags;
  bool loops = false;  ///< The last pose equals the first one, moved along the floor.
  std::string body;
  std::string document_sha256;
  std::string recipe_sha256;
};

/// Returns the knots that hold the spines of all these bodies exactly, if there are few
/// enough; else even ones.
[[nodiscard]] PostureLayout choose_layout(std::span<const retarget::BodyMap> bodies);

/// Makes one clip. Contacts become spans between the middles of the frames at their
/// edges. Errors (bad input, naming the clip): fewer than two poses; numbers that are not
/// finite; a body without complete arms and legs; `loops`, and the last posture differs
/// from the first one by more than 2 degrees or 1 cm.
[[nodiscard]] Result<MotionClip> make_clip(const ClipSource& source,
                                           const PostureLayout& layout);

/// Makes all clips, ascending by name, with a layout for all of them.
/// Errors: those of make_clip(); two sources with one name.
[[nodiscard]] Result<MoveSet> make_moves(std::span<const ClipSource> sources);

}  // namespace marey::engine
