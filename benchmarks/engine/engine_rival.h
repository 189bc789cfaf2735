// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "benchmarks/engine/loop_judge.h"
#include "benchmarks/engine/transition_judge.h"

namespace marey {

/// All switches as one method of the engine played them.
struct EngineTransitions {
  std::string name;                       ///< For the table: "engine, kAuto".
  std::vector<TransitionResult> results;  ///< One per case.
};

/// Plays all switches by the methods of the engine. All cases have the same two clips.
[[nodiscard]] std::vector<EngineTransitions> engine_transitions(
    const std::vector<SwitchCase>& cases, const std::string& only = {});

/// A loop as the engine plays it.
struct EngineLoop {
  std::string name;
  LoopPlayer player;
};

/// Returns players of a loop, which may refer to it.
[[nodiscard]] std::vector<EngineLoop> engine_loops(const LoopClip& loop);

}  // namespace marey
