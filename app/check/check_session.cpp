// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_session.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/humanoid.h"

namespace marey::app {

using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;

namespace {

std::vector<int> ids_on(const Session& session, HumanBone bone) {
  std::vector<int> ids;
  for (const TagOnSegment& tag : session.tags) {
    if (tag.segment == bone) ids.push_back(number(tag.id));
  }
  return ids;
}

/// Returns the number of tags on a segment minus the number on its other side.
int surplus(const Session& session, HumanBone bone) {
  return static_cast<int>(ids_on(session, bone).size()) -
         static_cast<int>(ids_on(session, mirrored(bone)).size());
}

std::string quoted_name(HumanBone bone) {
  return '"' + std::string(name(bone)) + '"';
}

}  // namespace

std::optional<Finding> assess_sides(const Session& session) {
  for (const HumanLimb& limb : human_limbs()) {
    const std::array<std::pair<HumanBone, HumanBone>, 2> neighbours{
        {{limb.upper, limb.lower}, {limb.lower, limb.end}}};
    for (auto [more, fewer] : neighbours) {
      if (surplus(session, more) < 0) std::swap(more, fewer);
      if (surplus(session, more) <= 0 || surplus(session, fewer) >= 0) continue;
      std::string ids;
      for (const int id : ids_on(session, more)) {
        ids += (ids.empty() ? "" : ", ") + std::to_string(id);
      }
      return fair_finding(
          "sides",
          session.file.string() + ": [[tags.tag]]",
          "segment " + quoted_name(fewer) + " has fewer tags than the other side, and " +
              quoted_name(more) + " more",
          "check which of the tags " + ids + " are worn on " + quoted_name(more) +
              "; correct the `segment` of one that is worn on " + quoted_name(fewer));
    }
  }
  return std::nullopt;
}

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
