// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/library/clip_record.h"
#include "core/library/library_motion.h"
#include "retarget/body/body_map.h"

namespace marey::library {

/// Labels and events that the motion of a clip shows.
struct FoundLabels {
  std::vector<ClipLabel> labels;  ///< By "marey". Ascending by start, then text, end.
  std::vector<ClipEvent> events;  ///< Ascending by frame, then name.
};

/// Finds them. A label lasts from its first to its last frame. Texts:
///
/// - the words of a relation (library/search/relations.h): "hand_left above head";
/// - "hand_left touches head": a hand and a part of the body (retarget::find_touches()),
///   also "hand_left touches right hand";
/// - "still", "tpose": 0.5 s or longer (still_frames(), t_pose_frames());
/// - "cycle": from one start of a left stance to the frame before the next one
///   (find_cycles()).
///
/// Runs shorter than 0.1 s are left out. At most 10 labels of a text, and one more per
/// second of the clip, are returned: the longest ones, and the first ones of equal
/// length.
///
/// Events: "left.strike" in the first and "left.toe_off" in the last frame of a stance,
/// right as well, unless the clip begins or ends within it (the names of contact events
/// in edit/state/resolve_moment.h); "take_off" and "landing" in the first and last frame
/// of a flight of 0.1 s or longer within the clip; "left.touch" and "left.release" in the
/// first and last frame of a touch.
///
/// Stances are those of `motion.contacts`. Linear in frames times joints.
/// Preconditions: `map` was made from the motion's skeleton; the rate is positive; there
/// is an entry of contacts for each pose.
[[nodiscard]] FoundLabels find_labels(const LibraryMotion& motion,
                                      const retarget::BodyMap& map);

}  // namespace marey::library
