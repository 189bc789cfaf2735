// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/base/time.h"
#include "core/constraint.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/body/body_volume.h"
#include "retarget/hands/find_touches.h"

namespace marey::retarget {

/// Position on another body of a hand that was still in the source.
enum class StillPlace {
  kScaled,  ///< Scaled with the body: the object scales too.
  kKept,    ///< At the same height above the floor: the object is the same.
  kFree,    ///< Not constrained.
};

/// Transform from the source's world to the avatar's: p * scale, raised by rise_m.
/// Alternatively keeps the source's metres over the ground, or upwards from its floor.
struct WorldScale {
  double scale = 1.0;
  double rise_m = 0.0;
  bool keeps_path = false;     ///< X and Z are the source's.
  bool keeps_heights = false;  ///< Y is the source's, above its floor.
  double source_floor_m =
      0.0;  ///< World Y of the source's floor, mapped to Y = 0 where metres are kept.

  /// Transforms a position. Precondition: `place` is not kFree.
  [[nodiscard]] glm::dvec3 of(const glm::dvec3& p_in_source, StillPlace place) const {
    const double kept_m = p_in_source.y - source_floor_m;
    if (place == StillPlace::kKept) return {p_in_source.x, kept_m, p_in_source.z};
    const double level = keeps_path ? 1.0 : scale;
    return {level * p_in_source.x,
            keeps_heights ? kept_m : scale * p_in_source.y + rise_m,
            level * p_in_source.z};
  }
};

struct TouchConstraintsOptions {
  double fade_s = 0.3;  ///< Duration of the fade-in before the interval and of the
                        ///< fade-out after it.
  StillPlace still = StillPlace::kScaled;
  WorldScale world;
  double precision_m = 0.005;
  /// If a hand touches several parts at once, constrains the nearest only: no posture may
  /// satisfy more.
  bool nearest_alone = false;
};

/// Returns the activation of a touch: full in its frames, faded before and after. A touch
/// at the start of the motion does not fade in, and one at its end does not fade out.
[[nodiscard]] Activation fading(const FrameRange& frames,
                                int frame_count,
                                int first_frame,
                                FrameRate rate,
                                double fade_s);

/// Converts contacts detected in a source motion to constraints for this body, which can
/// be stored with a motion and edited by hand. A touch keeps the hand at its distance
/// from the mean position on the part's skin (DistanceToBody), a still hand at its
/// position (DistanceToPoint). Ids are "left hand on right thigh 1", "right hand still
/// 2". Parts that the body does not have are omitted. Precondition: map and volume were
/// made from `body`; the rate is positive.
[[nodiscard]] ConstraintSet constraints_of(const Touches& touches,
                                           const Skeleton& body,
                                           const BodyMap& map,
                                           const BodyVolume& volume,
                                           int first_frame,
                                           FrameRate rate,
                                           const TouchConstraintsOptions& options = {});

}  // namespace marey::retarget
