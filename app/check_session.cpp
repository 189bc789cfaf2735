// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check_session.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/humanoid.h"

namespace marey::app {

using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;

Status check_worn_segments(const Session& session) {
  std::vector<HumanBone> needed{HumanBone::kHips, HumanBone::kUpperChest};
  for (const HumanLimb& limb : human_limbs()) {
    needed.push_back(limb.upper);
    needed.push_back(limb.lower);
  }
  for (const HumanBone bone : needed) {
    if (std::any_of(session.tags.begin(), session.tags.end(), [&](const auto& tag) {
          return tag.segment == bone;
        })) {
      continue;
    }
    return bad_input(session.file.string(),
                     "no [[tags.tag]] is on segment \"" + std::string(name(bone)) + "\"",
                     "glue a tag to that segment and list it, or correct the `segment` "
                     "of a listed tag; hips, upperChest and the upper and lower arms and "
                     "legs of both sides need at least one tag each");
  }
  return Done{};
}

Status check_calibrated_cameras(const Session& session) {
  const Trial* trial = session.find(TrialKind::kCalibration);
  if (!trial || trial->is_recorded) return Done{};
  for (std::size_t c = 0; c < session.cameras.size(); ++c) {
    if (std::any_of(trial->videos.begin(), trial->videos.end(), [&](const auto& video) {
          return index(video.camera) == c;
        })) {
      continue;
    }
    return bad_input(session.file.string() + ":" + std::to_string(trial->line),
                     "camera \"" + session.cameras[c] + "\" has no video in trial \"" +
                         trial->name + "\"",
                     "every camera must see the calibration target: add its video, or "
                     "remove the camera from the session");
  }
  return Done{};
}

}  // namespace marey::app
