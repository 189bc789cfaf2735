// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/explain_missing_board.h"

#include <string>
#include <variant>

#include "app/check/match_times.h"
#include "capture/search/find_board_elsewhere.h"
#include "core/base/frame_range.h"

namespace marey::app {

std::optional<Error> explain_missing_board(const recordings::Session& session,
                                           const recordings::Trial& trial,
                                           const CameraDetections& camera) {
  std::optional<FrameRange> searched;
  std::string frames = "any of its " + std::to_string(camera.frames.size()) + " frames";
  if (trial.frames && !has_times_file(trial)) {
    searched = trial.frames;
    frames = "frames " + std::to_string(searched->first) + " to " +
             std::to_string(searched->last);
  }
  const auto* grid = std::get_if<AprilGrid>(&session.target);
  const auto seen = capture::find_board_elsewhere(
      camera.source,
      session.target,
      grid ? session.family_of(TagId{grid->first_id}) : std::string(),
      searched);
  if (!seen) return std::nullopt;
  return bad_input(camera.source,
                   "camera \"" + session.cameras[index(camera.camera)] +
                       "\" does not see the " + name_of(session.target) + " in " +
                       frames + ", but " + seen->what,
                   seen->remedy);
}

}  // namespace marey::app
