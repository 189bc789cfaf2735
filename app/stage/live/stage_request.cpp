// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_request.h"

#include <utility>

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

Error refused_request(std::string cause, std::string next) {
  return bad_input("message from the page", std::move(cause), std::move(next));
}

Result<std::size_t> find_handle(const std::string& id,
                                std::span<const StageHandle> handles) {
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (handles[i].id != id) continue;
    if (handles[i].draggable) return i;
    return refused_request("the target " + in_quotes(id) + " cannot be dragged",
                           "set drag = true in the scene's file");
  }
  return refused_request("there is no target " + in_quotes(id), "reload the page");
}

}  // namespace

Result<StageRequest> read_stage_request(std::string_view text,
                                        std::span<const StageHandle> handles) {
  const auto request = live::read_page_request(text);
  if (!request) return request.error();
  if (const auto* run = std::get_if<live::RunRequest>(&*request)) {
    return StageRequest(run->action);
  }
  if (const auto* drag = std::get_if<live::DragRequest>(&*request)) {
    const auto target = find_handle(drag->id, handles);
    if (!target) return target.error();
    return StageRequest(MoveTarget{*target, drag->p_in_world});
  }
  if (const auto* hold = std::get_if<live::ConstraintRequest>(&*request)) {
    const auto target = find_handle(hold->id, handles);
    if (!target) return target.error();
    if (hold->active) return StageRequest(HoldTarget{*target});
    return StageRequest(ReleaseTarget{*target});
  }
  const bool is_harmless = std::holds_alternative<live::HelloRequest>(*request) ||
                           std::holds_alternative<live::ShownRequest>(*request) ||
                           std::holds_alternative<live::ThumbnailsRequest>(*request);
  if (is_harmless) return StageRequest();
  return refused_request("this page shows a scene", "reload the page");
}

}  // namespace marey::app
