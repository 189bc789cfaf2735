// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::live {

/// What a page asks for.
struct HelloRequest {
  int version = 1;
};
/// It has drawn the frame that was sent then.
struct ShownRequest {
  double sent_s = 0.0;
};
enum class DragPhase { kBegin, kMove, kEnd };
struct DragRequest {
  std::string id{};  ///< Of the constraint.
  glm::dvec3 p_in_world{0.0};
  DragPhase phase = DragPhase::kMove;
  std::optional<int> frame{};  ///< Of a recording.
};
struct ConstraintRequest {
  std::string id{};
  bool active = true;
};
enum class WizardAction { kStart, kNext, kCancel, kAccept };
struct WizardRequest {
  WizardAction action = WizardAction::kStart;
};
struct RecordRequest {
  bool on = false;
};
/// Another trial of the results.
struct TrialRequest {
  std::string name{};
};
struct ThumbnailsRequest {
  bool on = false;
};

using PageRequest = std::variant<HelloRequest,
                                 ShownRequest,
                                 DragRequest,
                                 ConstraintRequest,
                                 WizardRequest,
                                 RecordRequest,
                                 ThumbnailsRequest,
                                 TrialRequest>;

/// Reads one message of a page. Members that are not known are ignored.
///
/// Errors (kBadInput), for error_json(): not JSON, another type, a member that is
/// missing, of another kind or out of bounds: ids and names of 1 to 200 bytes, places
/// within 10 km, frames not negative, version 1, at most 16 kB in all.
[[nodiscard]] Result<PageRequest> read_page_request(std::string_view text);

}  // namespace marey::live
