// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/edit/edit_ghost.h"
#include "app/edit/edit_messages.h"
#include "app/edit/edit_output_json.h"
#include "core/base/assert.h"

namespace marey::app {
namespace {

using RenderedJson = nlohmann::ordered_json;

const edit::EditState& first_source(const EditResult& result) {
  return result.files.inputs.sources.at(result.recipe.sources.front().id);
}

/// Returns whether the result has the body of an avatar.
bool is_on_avatar(const EditResult& result, std::optional<int> until) {
  const auto count = static_cast<std::ptrdiff_t>(result.recipe.ops.size());
  const std::ptrdiff_t applied = std::min<std::ptrdiff_t>(count, until.value_or(count));
  return std::any_of(result.recipe.ops.begin(),
                     result.recipe.ops.begin() + applied,
                     [](const EditOp& op) {
                       return !op.off &&
                              std::holds_alternative<RetargetOp>(op.parameters);
                     });
}

/// Returns the member `skeletons` of a scene; null if there is none.
RenderedJson skeletons_of(const std::string& scene) {
  if (scene.empty()) return {};
  return RenderedJson::parse(scene).at("skeletons");
}

/// Returns the frames of `wanted` that exist; all if none do.
FrameRange existing(const std::optional<FrameRange>& wanted, int frames) {
  const FrameRange all{0, frames - 1};
  if (!wanted || wanted->first >= frames) return all;
  return {wanted->first, std::min(wanted->last, frames - 1)};
}

}  // namespace

live::PageScene edit_scene(const EditResult& result) {
  MAREY_ASSERT(!result.rendered.outputs.empty());
  live::PageScene scene;
  scene.edit = true;
  scene.title = result.recipe.name;
  scene.rate_hz = result.rendered.outputs.front().motion.rate.hz;
  live::PageSkeleton& source = scene.skeletons.emplace_back();
  source.name = "source";
  source.skeleton = first_source(result).motion.skeleton;
  live::PageSkeleton& edited = scene.skeletons.emplace_back();
  edited.name = "result";
  edited.kind = is_on_avatar(result, std::nullopt) ? live::PageSkeletonKind::kAvatar
                                                   : live::PageSkeletonKind::kPerformer;
  edited.skeleton = result.rendered.outputs.front().motion.skeleton;
  edited.estimate = !result.rendered.outputs.front().uncertainty.empty();
  return scene;
}

RenderedMessage rendered_message(const EditResult& result, const RenderedForm& form) {
  RenderedMessage out;
  const edit::EditState& source = first_source(result);
  const auto& states = result.rendered.outputs;
  const std::vector<std::string> names = edit_names(result.recipe, states.size());
  RenderedJson outputs = RenderedJson::array();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (form.parts.output && static_cast<std::size_t>(*form.parts.output) != i) continue;
    const FrameRange span = existing(form.parts.span, states[i].frame_count());
    const auto ghost = ghost_poses(source, states[i], span);
    SentOutput sent{states[i],
                    names[i],
                    span,
                    form.block_path + std::to_string(i),
                    edit_graphs(source, states[i], ghost, span)};
    if (i < result.figures.size()) sent.figures = result.figures[i];
    outputs.push_back(output_json(sent));
    out.blocks.push_back({sent.block, edit_block(source, states[i], ghost, span)});
  }
  RenderedJson reports = RenderedJson::array();
  for (const edit::OpReport& report : result.rendered.reports) {
    reports.push_back(op_report_json(report));
  }
  RenderedJson json{{"type", form.asker == nullptr ? "rendered" : "preview"}};
  if (form.asker != nullptr) json["id"] = form.asker->id;
  json["revision"] = result.revision;
  json["scene"] = form.scene;
  if (form.asker != nullptr) json["skeletons"] = skeletons_of(form.own_scene);
  json["until"] = form.parts.until ? RenderedJson(*form.parts.until) : RenderedJson();
  json["outputs"] = std::move(outputs);
  json["reports"] = std::move(reports);
  json["findings"] = page_findings_json(result.findings);
  out.json = json.dump(-1, ' ', false, RenderedJson::error_handler_t::replace);
  return out;
}

}  // namespace marey::app
