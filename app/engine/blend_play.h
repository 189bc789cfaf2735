// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/actions/action.h"
#include "engine/step/blend_player.h"
#include <glm/vec3.hpp>

#include "app/engine/blend_inputs.h"
#include "core/base/result.h"
#include "core/motion.h"

namespace marey::app {

/// Rate of the engine's steps and of the result.
inline constexpr double kBlendRate_hz = 60.0;

/// The words of `--kind`.
[[nodiscard]] std::vector<std::string> blend_kinds();

/// Clips behind one frame of a result: A, then B.
struct BlendFrame {
  std::array<double, 2> source_s{};  ///< Time in each clip.
  std::array<double, 2> weight{};    ///< Share of each in the posture, sum 1.
};

/// A transition as the engine played it.
struct PlayedBlend {
  Motion motion;  ///< At kBlendRate_hz. The first frame is one step after A's start.
  int switch_frame = 0;  ///< The last frame of A alone.
  double entry_s = 0.0;  ///< Time in B at the switch.
  engine::TransitionReport transition;
  std::vector<BlendFrame> frames;  ///< One per pose.
  /// Hips of the blend before feet and adaptation, one per pose.
  std::vector<glm::dvec3> blend_hips_in_world;
};

/// Plays A on the body, switches to B at `at_s`, and plays B to its end, at most 60 s; a
/// B that loops for two cycles. With `seconds` the result lasts as long.
/// Errors: the switch is before the first step or after the end of A (usage); `seconds`
/// end before it (usage); those of Engine::add() and Engine::play().
[[nodiscard]] Result<PlayedBlend> play_blend(const BlendArguments& args,
                                             const BlendInputs& inputs);

/// Returns a whole clip on the body, at kBlendRate_hz.
[[nodiscard]] Motion clip_on_body(const BlendInputs& inputs, std::size_t clip);

}  // namespace marey::app
