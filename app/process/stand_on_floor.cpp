// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/stand_on_floor.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "calib/rig/estimate_world_up.h"
#include "core/humanoid.h"

namespace marey::app {
namespace {

using recordings::TrialKind;

std::string trial_of(const recordings::Session& session, TrialKind kind) {
  const recordings::Trial* trial = session.find(kind);
  return trial ? "trial " + trial->name : std::string();
}

std::map<TagId, double> sizes_of(const std::vector<TagOnSegment>& tags) {
  std::map<TagId, double> sizes_m;
  for (const TagOnSegment& tag : tags) sizes_m[tag.id] = tag.size_m;
  return sizes_m;
}

enum class Part { kUpper, kLower, kOther };

Part part_of(HumanBone bone) {
  switch (bone) {
    case HumanBone::kHead:
    case HumanBone::kNeck:
    case HumanBone::kUpperChest:
    case HumanBone::kChest:
      return Part::kUpper;
    case HumanBone::kLeftLowerLeg:
    case HumanBone::kRightLowerLeg:
    case HumanBone::kLeftFoot:
    case HumanBone::kRightFoot:
    case HumanBone::kLeftToes:
    case HumanBone::kRightToes:
      return Part::kLower;
    default:
      return Part::kOther;
  }
}

/// Vector from the lower legs and feet to chest and head [m], and height of the lowest
/// tag.
struct Stance {
  glm::dvec3 up{0.0};
  double lowest_m = 0.0;
};

std::optional<Stance> stance_of(const std::vector<TagOnSegment>& tags,
                                const std::map<TagId, glm::dvec3>& places) {
  std::array<glm::dvec3, 2> sum{glm::dvec3(0.0), glm::dvec3(0.0)};
  std::array<int, 2> count{};
  Stance stance{glm::dvec3(0.0), 1e9};
  for (const TagOnSegment& tag : tags) {
    const auto place = places.find(tag.id);
    const Part part = part_of(tag.segment);
    if (place == places.end()) continue;
    stance.lowest_m = std::min(stance.lowest_m, place->second.y);
    if (part == Part::kOther) continue;
    const std::size_t at = part == Part::kUpper ? 0 : 1;
    sum[at] += place->second;
    ++count[at];
  }
  if (count[0] == 0 || count[1] == 0) return std::nullopt;
  stance.up =
      sum[0] / static_cast<double>(count[0]) - sum[1] / static_cast<double>(count[1]);
  return stance;
}

std::string text(const char* pattern, double value) {
  std::array<char, 160> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, value);
  return buffer.data();
}

}  // namespace

Result<std::string> stand_on_floor(const recordings::Session& session,
                                   const std::vector<CameraDetections>& floor,
                                   const std::vector<CameraDetections>& standing,
                                   calib::CalibratedRig& rig) {
  if (!floor.empty()) {
    const auto moved = calib::up_from_floor_tags(rig.cameras, floor);
    if (!moved) {
      return bad_input("",
                       trial_of(session, TrialKind::kFloor) +
                           " does not show the floor: two cameras must see at least two "
                           "tags that lie flat on it, and no other tags; all cameras "
                           "must be above the tags, the first one not straight above",
                       "lay tags on the floor, apart from each other, where the cameras "
                       "see them, and not below the first camera; or remove the trial");
    }
    calib::move_world(*moved, rig);
    return "the floor is where the tags of " + trial_of(session, TrialKind::kFloor) +
           " lie";
  }
  if (standing.empty()) {
    return std::string(
        "no trial shows the floor: the world's origin is the first camera");
  }
  const std::string trial = trial_of(session, TrialKind::kStatic);
  auto moved = calib::up_from_tags(rig.cameras, standing, sizes_of(session.tags));
  if (!moved) {
    return bad_input("",
                     trial +
                         " does not show where the floor is: cameras on different sides "
                         "must see at least three tags of the subject and be above the "
                         "lowest of them, the first camera not straight above",
                     "record a trial of kind \"floor\", with the board on the floor");
  }
  moved->translation.y += session.calibration.lowest_corner_m;
  calib::move_world(*moved, rig);
  return "the floor is taken to be " +
         text("%.0f mm", 1e3 * session.calibration.lowest_corner_m) +
         " below the lowest corner of a tag in " + trial +
         ", and the cameras are taken to be level: a floor trial is more exact";
}

Status check_upright(const recordings::Session& session,
                     std::span<const Camera> cameras,
                     const std::vector<CameraDetections>& standing) {
  if (standing.empty()) return Done{};
  const auto stance = stance_of(
      session.tags, calib::tags_at_rest(cameras, standing, sizes_of(session.tags)));
  if (!stance || glm::length(stance->up) < 1e-3) return Done{};
  const std::string trial = trial_of(session, TrialKind::kStatic);
  const char* next =
      "check that the board lay on the floor with its printed face up in the floor "
      "trial, "
      "and that no video is mirrored or turned";
  // A standing person is upright to within some degrees; a board on a wall gives 90
  // degrees.
  constexpr double kMaxTilt_deg = 45.0;
  const double tilt_deg =
      glm::degrees(glm::acos(glm::clamp(glm::normalize(stance->up).y, -1.0, 1.0)));
  if (tilt_deg > kMaxTilt_deg) {
    return bad_input("",
                     "the subject of " + trial + " stands " +
                         text(tilt_deg > 135.0 ? "upside down (%.0f degrees from upright)"
                                               : "%.0f degrees away from upright",
                              tilt_deg) +
                         ": the floor of the calibration is wrong",
                     next);
  }
  // No tag is below the floor; a board on a chair gives 0.4 m.
  constexpr double kMaxDepth_m = 0.15;
  if (stance->lowest_m < -kMaxDepth_m) {
    return bad_input("",
                     "the lowest tag of " + trial + " is " +
                         text("%.2f m below the floor", -stance->lowest_m),
                     next);
  }
  return Done{};
}

}  // namespace marey::app
