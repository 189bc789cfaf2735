// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/engine/blend_play.h"
#include "core/humanoid.h"

namespace marey::app {

/// Slide of the feet that bear by the labels of the clip that weighs more.
struct BlendSlide {
  double mean_cm_s = 0.0;
  double worst_cm_s = 0.0;
  /// Mean of the same points and times in the clips on the same body.
  double clips_mean_cm_s = 0.0;
};

/// Figures of a transition, by forward kinematics of the result.
struct BlendFigures {
  std::string transition;  ///< "synchronised", "inertial", "crossfade" or "cut".
  double entry_s = 0.0;    ///< Time in B at the switch.
  /// Incompatible supports of the plan that was used or rejected; nullopt: no plan.
  std::optional<double> incompatible_s;
  /// Over 0.3 s after the switch, or the fade if it is longer. nullopt: no foot bears.
  std::optional<BlendSlide> slide;
  /// Largest acceleration of a joint within 0.5 s of the switch, over the largest one of
  /// both clips on the same body. [1]
  double acceleration_ratio = 0.0;
  HumanBone accelerated_bone = HumanBone::kHips;
  double accelerated_s = 0.0;        ///< In the result.
  double hips_departure_cm = 0.0;    ///< Largest distance of the hips from the blend's.
  std::vector<std::string> remarks;  ///< Clips without contacts.
};

/// Linear in the frames of the result and of both clips.
[[nodiscard]] BlendFigures measure_blend(const BlendArguments& args,
                                         const BlendInputs& inputs,
                                         const PlayedBlend& played);

}  // namespace marey::app
