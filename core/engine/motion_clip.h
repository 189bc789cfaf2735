// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/constraint.h"
#include "core/edit/annotation.h"
#include "core/engine/blend_posture.h"

namespace marey {

/// Place of the hips on the floor in a clip.
struct ClipRoot {
  float x_legs = 0.0F;  ///< World X of the hips joint. [legs]
  float z_legs = 0.0F;
  /// Yaw of the hips, continuous over the clip: 0 faces +Z, positive turns towards +X.
  float heading_rad = 0.0F;
  bool operator==(const ClipRoot&) const = default;
};

/// Time since the first frame of a clip. [s]
struct ClipSpan {
  float start_s = 0.0F;
  float end_s = 0.0F;
  bool operator==(const ClipSpan&) const = default;
};

/// Parts of the feet in MotionClip::contacts.
enum class ClipFootPart { kLeftHeel, kLeftBall, kRightHeel, kRightBall };

/// One motion as the engine plays it: the run-time form of a motion document. Made by
/// engine::make_clip(), stored by recordings::write_moves().
struct MotionClip {
  std::string name;  ///< Unique in its base; "walk.start".
  float rate_hz = 0.0F;
  /// At least two. Frame i is at time i / rate.
  std::vector<BlendPosture> frames;
  std::vector<ClipRoot> path;  ///< One per frame.
  /// Contacts by ClipFootPart, ascending and disjoint. All empty: the clip has no
  /// contacts, and its supports are unknown.
  std::array<std::vector<ClipSpan>, 4> contacts;
  /// The last frame equals the first one, except for the path.
  bool loops = false;
  std::vector<std::string> tags;  ///< Ascending, without duplicates.
  std::vector<Annotation> notes;  ///< Events and annotations, ascending by start.
  /// Constraints of the document. Places are in the clip's own world, in metres of its
  /// body.
  ConstraintSet constraints;
  float leg_length_m = 0.0F;    ///< For the body that it was made on.
  std::string body;             ///< Name of that body; may be empty.
  std::string document_sha256;  ///< For the motion's file, 64 hexadecimal digits.
  std::string recipe_sha256;    ///< Recipe's sum; empty without a recipe.

  [[nodiscard]] double duration_s() const {
    return frames.size() < 2
               ? 0.0
               : static_cast<double>(frames.size() - 1) / static_cast<double>(rate_hz);
  }
};

/// All clips of one `moves.marey`.
struct MoveSet {
  PostureLayout layout;
  std::vector<MotionClip> clips;  ///< Ascending by name.
};

}  // namespace marey
