// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// edit_speed [RUNS]
//
// Time of editing a walk of 60 s at 120 Hz on one core: cut, filter, plant, cyclify, and
// the time until a change of the last operation is seen. Prints medians and the 95th
// percentile.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "edit/render.h"
#include "edit/state/edit_state.h"

#include "core/base/stopwatch.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey {
namespace {

EditOp op_of(EditOpParameters parameters) {
  EditOp op;
  op.parameters = std::move(parameters);
  return op;
}

double at_share(std::vector<double> times, double share) {
  std::sort(times.begin(), times.end());
  const auto place =
      static_cast<std::size_t>(share * static_cast<double>(times.size() - 1));
  return times[place];
}

int run(int runs) {
  const Motion walk = testing::synthetic_walk(7200, 120.0, 0.002, 0.0005).motion;
  edit::EditInputs inputs;
  auto source = edit::make_edit_state(walk);
  if (!source) {
    std::printf("%s\n", source.error().message().c_str());
    return 1;
  }
  inputs.sources.emplace("", *std::move(source));
  EditRecipe recipe;
  recipe.sources.emplace_back();
  recipe.ops = {op_of(CutOp{}), op_of(FilterOp{}), op_of(PlantOp{}), op_of(CyclifyOp{})};
  recipe.ops[0].span.from = AtFrame{1.0};

  std::vector<double> whole_s;
  std::vector<std::vector<double>> op_s(recipe.ops.size());
  for (int i = 0; i < runs; ++i) {
    const Stopwatch watch;
    const auto rendered = edit::render(recipe, inputs);
    whole_s.push_back(watch.seconds());
    if (!rendered) {
      std::printf("%s\n", rendered.error().message().c_str());
      return 1;
    }
    for (std::size_t until = 1; until <= recipe.ops.size(); ++until) {
      edit::RenderOptions options;
      options.until = until;
      const Stopwatch part;
      (void)edit::render(recipe, inputs, options).has_value();
      op_s[until - 1].push_back(part.seconds());
    }
  }
  std::printf(
      "60 s at 120 Hz through cut, filter, plant, cyclify: median %.3f s, 95 %% %.3f s\n",
      at_share(whole_s, 0.5),
      at_share(whole_s, 0.95));
  for (std::size_t i = 0; i < op_s.size(); ++i) {
    std::printf("  up to %-8s %.3f s\n",
                std::string(name(recipe.ops[i].parameters)).c_str(),
                at_share(op_s[i], 0.5));
  }

  // A dragged parameter: the operations before it are in the cache.
  edit::EditCache cache;
  recipe.ops.push_back(op_of(PoseOp{}));
  std::vector<std::string> keys{"1", "2", "3", "4", "0"};
  std::vector<double> drag_s;
  for (int i = 0; i < 10 * runs; ++i) {
    PoseOp pose;
    pose.at = AtFrame{40.0};
    pose.bone = HumanBone::kLeftHand;
    pose.moved_m = glm::dvec3(0.0, 0.001 * i, 0.0);
    recipe.ops.back() = op_of(pose);
    keys.back() = "drag " + std::to_string(i);
    edit::RenderOptions options;
    options.keys = keys;
    options.cache = &cache;
    const Stopwatch watch;
    const auto rendered = edit::render(recipe, inputs, options);
    if (!rendered) {
      std::printf("%s\n", rendered.error().message().c_str());
      return 1;
    }
    if (i > 0) drag_s.push_back(watch.seconds());
  }
  std::printf("a dragged hand after them: median %.1f ms, 95 %% %.1f ms\n",
              1e3 * at_share(drag_s, 0.5),
              1e3 * at_share(drag_s, 0.95));
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 5);
}
