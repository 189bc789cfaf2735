// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/skeleton.h"
#include "core/time.h"
#include "retarget/body_map.h"
#include "retarget/body_volume.h"
#include "retarget/find_touches.h"

namespace marey::retarget {

/// Where a hand that kept still in the source belongs on another body.
enum class StillPlace {
  kScaled,  ///< Where the body's own size puts it: a table of its size.
  kKept,    ///< Where it was over the floor: the same table.
  kFree,    ///< Wherever the arm brings it.
};

/// The avatar's world from the source's: p * scale, risen by rise_m; or the source's own
/// metres, over the ground or upwards from its floor.
struct WorldScale {
  double scale = 1.0;
  double rise_m = 0.0;
  bool keeps_path = false;     ///< X and Z are the source's.
  bool keeps_heights = false;  ///< Y is the source's, above its floor.
  double source_floor_m =
      0.0;  ///< World Y of what becomes Y = 0 where metres stay metres.

  /// Precondition: `place` is not kFree.
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
  double fade_s = 0.3;  ///< In before what was found, and out after it.
  StillPlace still = StillPlace::kScaled;
  WorldScale world;
  double precision_m = 0.005;
  /// Where a hand touches several parts at once, the nearest alone is wished for: no
  /// posture may be able to do more.
  bool nearest_alone = false;
};

/// When a touch holds: fully in its frames, faded before and after. A touch that begins
/// with the motion does not fade in, one that ends with it not out.
[[nodiscard]] Activation fading(const FrameInterval& frames,
                                int frame_count,
                                int first_frame,
                                FrameRate rate,
                                double fade_s);

/// What was found in a source motion, as wishes for this body, to be stored beside a
/// motion and edited by hand. A touch keeps the hand at its distance from the mean place
/// on the part's skin (DistanceToBody), a still hand at its place (DistanceToPoint). Ids
/// are "left hand on right thigh 1", "right hand still 2". Parts that the body does not
/// have are left out.
/// Precondition: map and volume were made from `body`; the rate is positive.
[[nodiscard]] ConstraintSet constraints_of(const Touches& touches,
                                           const Skeleton& body,
                                           const BodyMap& map,
                                           const BodyVolume& volume,
                                           int first_frame,
                                           FrameRate rate,
                                           const TouchConstraintsOptions& options = {});

}  // namespace marey::retarget
