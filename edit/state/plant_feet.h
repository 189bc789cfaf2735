// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "edit/state/edit_state.h"

#include "core/motion.h"
#include "retarget/feet/adapt_to_ground.h"
#include "retarget/feet/foot_place.h"

namespace marey::edit {

struct PlantReport {
  int unreachable_frames = 0;    ///< Frames in which a leg does not reach.
  double largest_moved_m = 0.0;  ///< Largest displacement of an ankle.
  double slide_before_mm = 0.0;  ///< Largest drift of a foot within one contact.
  double slide_after_mm = 0.0;
};

/// Makes the feet stand still during the state's contacts (fast ground adaptation, Kulpa
/// 2005, 4.2.4.1; retarget/feet/adapt_to_ground.h): each stance gets one footprint, the
/// mean of the foot's places in it, on the level floor under the motion. The root sinks
/// where a leg would not reach; only legs, feet and the root's height change. Joints
/// without a bone (fingers) keep their rotation. Frames more than 0.3 s from any contact
/// keep their pose to rounding. Linear in frames.
PlantReport plant_feet(EditState& state);

struct SetFeetOptions {
  retarget::GroundOptions ground{};
  /// A swinging foot that is planned further away than its leg reaches is drawn nearer,
  /// so that the knee does not become straight within a frame.
  bool soft_swings = false;
};

/// Makes the legs reach feet that were planned by the caller: one FootPlace per frame and
/// side (T-pose-relative world rotations). Frames with a foot that is nullopt keep that
/// foot. The root sinks where a leg would not reach (`ground`; 0.2 s by default).
/// Precondition: one entry per pose.
PlantReport set_feet(
    EditState& state,
    const std::array<std::vector<std::optional<retarget::FootPlace>>, 2>& feet,
    const SetFeetOptions& options = {});

/// Returns the place of a foot in each frame of a motion. Side 0 is left.
[[nodiscard]] std::vector<retarget::FootPlace> foot_places(const EditState& state,
                                                           int side);

/// Horizontal speed of the bearing joints over all contacts, and their drift.
struct SlideFigures {
  double mean_cm_per_s = 0.0;
  double worst_drift_mm = 0.0;  ///< Largest distance from the start of one contact.
  int worst_frame = 0;
};
[[nodiscard]] SlideFigures measure_slide(const EditState& state);

}  // namespace marey::edit
