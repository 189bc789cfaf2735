// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/engine_rival.h"

namespace marey {

std::vector<EngineTransitions> engine_transitions(
    const std::vector<SwitchCase>& /*cases*/) {
  return {};
}

std::vector<EngineLoop> engine_loops(const LoopClip& /*loop*/) {
  return {};
}

}  // namespace marey
