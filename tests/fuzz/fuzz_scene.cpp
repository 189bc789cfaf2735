// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
// Scenes and lists of trials: what is read can be run in every step.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/assert.h"
#include "core/engine/scene_order.h"
#include "recordings/scene/read_scene.h"
#include "recordings/scene/read_trials.h"

namespace {

using namespace marey;
using namespace marey::recordings;

template <class T>
void check_error(const Result<T>& result) {
  if (!result) {
    MAREY_ASSERT(!result.error().cause.empty() && !result.error().next.empty());
  }
}

void check_scene(const Scene& scene) {
  const std::vector<SceneBody> bodies = scene_bodies(scene);
  MAREY_ASSERT(!bodies.empty() && bodies.size() == body_count(scene));
  const std::vector<SceneDependency> dependencies = scene_dependencies(scene);
  std::vector<std::size_t> rounds;
  for (const ActionTime& time : action_times(scene)) {
    MAREY_ASSERT(time.start_s <= time.latest_start_s && time.start_s <= time.end_s);
    solve_rounds(dependencies, time.start_s, bodies.size(), rounds);
    solve_rounds(dependencies, time.end_s, bodies.size(), rounds);
  }
  for (const SceneTarget& target : scene.targets) {
    const auto p = path_at(target.path, scene.duration_s);
    if (p) MAREY_ASSERT(std::isfinite(p->x) && std::isfinite(p->y));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const Result<Scene> scene = parse_scene(text, "fuzz.toml");
  check_error(scene);
  if (scene) check_scene(*scene);
  const Result<TrialList> trials = parse_trials(text, "fuzz.toml");
  check_error(trials);
  if (trials) MAREY_ASSERT(!trial_order(*trials).empty());
  return 0;
}
