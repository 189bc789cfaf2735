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

/// First message of a page.
struct HelloRequest {
  int version = 1;
};
/// The page has drawn the frame that was sent at this time.
struct ShownRequest {
  double sent_s = 0.0;
};
enum class DragPhase { kBegin, kMove, kEnd };
struct DragRequest {
  std::string id{};  ///< Id of the constraint.
  glm::dvec3 p_in_world{0.0};
  DragPhase phase = DragPhase::kMove;
  std::optional<int> frame{};  ///< Frame of a recording.
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
/// Request for another trial of the results.
struct TrialRequest {
  std::string name{};
};
struct ThumbnailsRequest {
  bool on = false;
};

enum class RunAction { kPlay, kPause, kRestart };
/// Control of a scene that runs live.
struct RunRequest {
  RunAction action = RunAction::kPlay;
};

using PageRequest = std::variant<HelloRequest,
                                 ShownRequest,
                                 DragRequest,
                                 ConstraintRequest,
                                 WizardRequest,
                                 RecordRequest,
                                 ThumbnailsRequest,
                                 TrialRequest,
                                 RunRequest>;

/// Parses one message of a page. Unknown members are ignored.
///
/// Errors (kBadInput), for error_json(): not JSON, an unknown type, or a member that is
/// missing, of a wrong type or out of bounds. Bounds: ids and names of 1 to 200 bytes,
/// places within 10 km, frames not negative, version 1, at most 16 kB in total.
[[nodiscard]] Result<PageRequest> read_page_request(std::string_view text);

}  // namespace marey::live
