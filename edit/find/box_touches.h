// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/edit/edit_ops.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"

namespace marey::edit {

/// A hand at rest on an object.
struct BoxTouch {
  int side = 0;            ///< 0 is left, 1 is right.
  std::size_t object = 0;  ///< Index in the objects.
  FrameRange frames;
  /// Mean point of the hand's surface that is nearest to the object, in the hand's joint.
  glm::dvec3 p_in_joint{0.0};
  glm::dvec3 p_in_world{0.0};  ///< Mean nearest point of the object's surface.
  double gap_m = 0.0;          ///< Mean distance of the surfaces; negative: they overlap.
};

struct BoxTouchOptions {
  double max_gap_m =
      0.03;  ///< Distance of the hand's surface from the object's, inside or outside.
  /// A touch lasts while the middle of the hand is slower than this, and contains a frame
  /// with less than the other. Thresholds of retarget::FindTouchesOptions are for hands
  /// on a body that moves itself.
  double keep_speed_legs_per_s = 0.25;
  double start_speed_legs_per_s = 0.12;
  double min_touch_s = 0.1;   ///< Shorter touches are discarded.
  double max_pause_s = 0.05;  ///< Shorter interruptions are closed.
  double smoothing_s = 0.06;  ///< Window of the line fit that gives the speed.
};

/// Detects hands that rest on the surface of boxes, from the motion and the body's volume
/// alone. Ordered by side, then by object, then by time. Linear in frames times objects.
/// Precondition: map and volume were made from the motion's skeleton; the rate is
/// positive; boxes have min <= max.
[[nodiscard]] std::vector<BoxTouch> find_box_touches(const Motion& motion,
                                                     const retarget::BodyMap& map,
                                                     const retarget::BodyVolume& volume,
                                                     std::span<const EditObject> objects,
                                                     const BoxTouchOptions& options = {});

}  // namespace marey::edit
