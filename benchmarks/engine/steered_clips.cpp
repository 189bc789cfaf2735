// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/steered_clips.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "edit/render.h"
#include "edit/state/edit_state.h"

#include "app/motion/retarget_files.h"

namespace marey {
namespace {

void keep_frames(std::vector<FrameRange>& runs, int last) {
  for (FrameRange& run : runs) run.last = std::min(run.last, last);
  // Contacts of one frame at the seam are rests of those of the neighbouring cycles.
  std::erase_if(runs, [](const FrameRange& run) { return run.last <= run.first; });
}

/// One cycle of a rendered loop of two, with the first frame of the second one.
engine::ClipSource one_cycle(edit::EditState state, const std::string& name) {
  const int last = state.frame_count() / 2;
  state.motion.poses.resize(static_cast<std::size_t>(last) + 1);
  for (auto& foot : state.contacts.feet) {
    keep_frames(foot.heel, last);
    keep_frames(foot.ball, last);
    keep_frames(foot.stance, last);
  }
  engine::ClipSource source;
  source.name = name;
  source.motion = std::move(state.motion);
  source.map = std::move(state.map);
  source.contacts = std::move(state.contacts);
  source.loops = true;
  return source;
}

}  // namespace

Result<engine::ClipSource> read_cycle(const std::filesystem::path& file,
                                      const std::string& name) {
  const bool is_drunk = name == "drunk";
  const auto read = app::read_motion({file});
  if (!read) return read.error();
  auto state = edit::make_edit_state(read->motion);
  if (!state) return state.error();
  EditRecipe recipe;
  recipe.sources.emplace_back();
  if (is_drunk) {
    EditOp sway{ExaggerateOp{.gain = 2.0}};
    sway.groups = {EditGroup::kTrunk};
    recipe.ops.push_back(sway);
  }
  CyclifyOp cyclify;
  cyclify.cycles = 2;
  cyclify.force = true;
  // A drunk's steps differ: his cycle is two strides.
  if (is_drunk) {
    cyclify.min_period_s = 1.6;
    cyclify.max_period_s = 3.5;
  }
  recipe.ops.push_back(EditOp{cyclify});
  edit::EditInputs inputs;
  inputs.sources.emplace("", std::move(*state));
  auto rendered = edit::render(recipe, std::move(inputs));
  if (!rendered) return rendered.error();
  return one_cycle(rendered->outputs.front(), name);
}

}  // namespace marey
