// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "edit/state/edit_state.h"
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/human/contacts.h"

namespace marey::edit {

/// A foot that rests in one stance: a point of the foot, and its height above the sole.
struct RestingSole {
  glm::dvec3 p_in_world{0.0};  ///< Mean over the frames in which the foot is flat.
  double height_m = 0.0;
  FrameRange stance;
};

/// Returns one point per stance that lies within these frames: the middle between ankle
/// and toe joint while both rest; otherwise the joint that rests. Heights above the sole
/// are those of the body (FootMap). Linear in frames.
[[nodiscard]] std::vector<RestingSole> resting_soles(const EditState& state,
                                                     const Contacts& contacts,
                                                     const FrameRange& frames);

/// Properties of the floor that footprints determine.
enum class FloorRank {
  kHeight,  ///< Its height only: all stances are at one place.
  kLine,    ///< Its tilt along the line on which they lie, too.
  kPlane,   ///< Its tilt.
};

struct FloorFit {
  FloorRank rank = FloorRank::kHeight;
  glm::dvec3 normal{0.0, 1.0, 0.0};  ///< Unit, upwards.
  glm::dvec3 support_in_world{0.0};  ///< Mean point of the soles, on the floor.
  double residual_m = 0.0;           ///< Root mean square distance of the soles.
  double largest_residual_m = 0.0;
  int worst_frame = 0;  ///< Start of the stance with that distance.
  /// Standard deviation of the tilt about its least certain axis, from the residuals; 0
  /// unless the rank is kPlane. [rad]
  double tilt_sigma_rad = 0.0;
};

/// Fits a plane to soles by least squares, with the weights of Huber (1964) beyond 10 mm.
/// The soles' standard deviation along an axis must be at least `min_spread_m` for the
/// tilt along it to count as observed; a plane needs three soles, a line two. Returns
/// nullopt without soles. Linear in soles.
[[nodiscard]] std::optional<FloorFit> fit_floor(std::span<const RestingSole> soles,
                                                double min_spread_m);

}  // namespace marey::edit
