// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "core/skeleton.h"

namespace marey::retarget {

/// Angle by which a joint of a known skeleton leans forward in its T-pose, relative to
/// the T-pose that its own axes give.
struct NeutralLean {
  std::string_view joint;  ///< The joint's name.
  double forward_rad = 0.0;
};

/// Properties of a known skeleton that its file does not state.
struct NamedNeutral {
  std::string_view name;  ///< Name used on the command line: "bandai".
  std::string_view maker;
  /// Angle of the bone from ankle to toe joint below the horizontal, the foot flat.
  double foot_pitch_rad = 0.0;
  /// Height of the toe joint above the floor, the foot flat, over the length of a leg.
  double ball_height_in_legs = 0.0;
  std::span<const NeutralLean> leans;
  /// Joint names that identify the skeleton: it has all of them.
  std::span<const std::string_view> joints;
};

/// Returns all known skeletons.
[[nodiscard]] std::span<const NamedNeutral> named_neutrals();
/// Returns the known skeleton of this name; nullptr if there is none.
[[nodiscard]] const NamedNeutral* named_neutral(std::string_view name);
/// Returns the known skeleton that has these joint names; nullptr if there is none.
[[nodiscard]] const NamedNeutral* named_neutral(const Skeleton& skeleton);

}  // namespace marey::retarget
