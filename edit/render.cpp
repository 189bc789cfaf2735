// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/render.h"

#include <algorithm>
#include <utility>

#include "edit/apply_op.h"
#include "edit/state/op_error.h"

#include "core/base/assert.h"

namespace marey::edit {
namespace {

/// Returns the first source and the number of operations that are known already.
struct RenderStart {
  Rendered result;
  std::size_t done = 0;
};

RenderStart start_of(const EditRecipe& recipe,
                     const EditInputs& inputs,
                     const RenderOptions& options,
                     std::size_t count) {
  if (options.cache != nullptr && !options.keys.empty()) {
    for (std::size_t done = count; done > 0; --done) {
      const Rendered* known = options.cache->find(options.keys[done - 1]);
      if (known != nullptr) return {*known, done};
    }
  }
  const auto source = inputs.sources.find(recipe.sources.front().id);
  MAREY_ASSERT(source != inputs.sources.end());
  RenderStart out;
  out.result.outputs.push_back(source->second);
  return out;
}

Status apply_to_all(const OpContext& context, Rendered& result) {
  std::vector<EditState> made;
  for (const EditState& state : result.outputs) {
    OpReport report;
    auto parts = apply_op(context, state, report);
    if (!parts) return parts.error();
    result.reports.push_back(std::move(report));
    std::move(parts->begin(), parts->end(), std::back_inserter(made));
  }
  result.outputs = std::move(made);
  return Done{};
}

}  // namespace

const Rendered* EditCache::find(const std::string& key) {
  const auto entry = std::find_if(
      entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  if (entry == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, entry);
  return &entries_.front().result;
}

void EditCache::store(const std::string& key, const Rendered& result) {
  if (find(key) != nullptr) return;
  std::size_t bytes = 0;
  for (const EditState& state : result.outputs) bytes += bytes_of(state);
  if (bytes > max_bytes_) return;
  entries_.push_front({key, result, bytes});
  bytes_ += bytes;
  while (bytes_ > max_bytes_) {
    bytes_ -= entries_.back().bytes;
    entries_.pop_back();
  }
}

std::size_t bytes_of(const EditState& state) {
  const std::size_t joints = state.motion.skeleton.joints.size();
  const std::size_t frame =
      sizeof(Pose) + joints * sizeof(glm::dquat) + sizeof(FrameLineage) +
      (state.uncertainty.empty() ? 0 : joints * sizeof(JointUncertainty)) +
      state.annotations.curves.size() * sizeof(double);
  return state.motion.poses.size() * frame;
}

Result<Rendered> render(const EditRecipe& recipe,
                        const EditInputs& inputs,
                        const RenderOptions& options,
                        const Progress& progress) {
  MAREY_ASSERT(options.keys.empty() || options.keys.size() == recipe.ops.size());
  const std::size_t count =
      std::min(options.until.value_or(recipe.ops.size()), recipe.ops.size());
  RenderStart start = start_of(recipe, inputs, options, count);
  Rendered out = std::move(start.result);
  if (progress && start.done > 0) {
    progress(static_cast<int>(start.done), static_cast<int>(count));
  }
  for (std::size_t i = start.done; i < count; ++i) {
    const EditOp& op = recipe.ops[i];
    if (options.is_cancelled && options.is_cancelled()) {
      return bad_input(options.recipe_file, "the rendering was stopped", "");
    }
    if (!op.off) {
      const OpContext context{op, static_cast<int>(i), inputs};
      if (const Status ok = apply_to_all(context, out); !ok) {
        return at_recipe_line(ok.error(), op, i, options.recipe_file);
      }
    }
    if (options.cache != nullptr && !options.keys.empty()) {
      options.cache->store(options.keys[i], out);
    }
    if (progress) progress(static_cast<int>(i + 1), static_cast<int>(count));
  }
  return out;
}

}  // namespace marey::edit
