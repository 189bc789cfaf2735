// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "live/page/page_request.h"

namespace marey::app {

/// A target as its page knows it.
struct StageHandle {
  std::string id{};
  bool draggable = false;
};

struct MoveTarget {
  std::size_t target = 0;  ///< Position in the list of handles.
  glm::dvec3 p_in_world{0.0};
};
/// The target stays at its present place.
struct HoldTarget {
  std::size_t target = 0;
};
/// The target returns to its path.
struct ReleaseTarget {
  std::size_t target = 0;
};

/// A request to a scene that runs live; monostate: a message without an effect.
using StageRequest =
    std::variant<std::monostate, live::RunAction, MoveTarget, HoldTarget, ReleaseTarget>;

/// Parses one message of a page. Errors (kBadInput): those of live::read_page_request();
/// a target that does not exist or that cannot be dragged; a request to another kind of
/// page.
[[nodiscard]] Result<StageRequest> read_stage_request(
    std::string_view text, std::span<const StageHandle> handles);

}  // namespace marey::app
