// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/scene/read_deed.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/in_quotes.h"
#include "recordings/edit/edit_rotation_keys.h"
#include "recordings/edit/edit_value_keys.h"
#include "recordings/scene/read_targets.h"
#include "recordings/scene/scene_limits.h"
#include "recordings/scene/scene_values.h"

namespace marey::recordings::stage {
namespace {

constexpr std::array<std::string_view, 4> kTransitionWords{
    "auto", "crossfade", "inertial", "extrapolate"};
constexpr std::array<std::string_view, 4> kConstraintWords{
    "point", "inside", "outside", "oriented"};

/// Keys of one throw, which a list of trials gives instead.
constexpr std::array<std::string_view, 8> kThrowParameters{"place_left_m",
                                                           "place_up_m",
                                                           "place_forward_m",
                                                           "azimuth_deg",
                                                           "elevation_deg",
                                                           "speed_m_s",
                                                           "release_s",
                                                           "aim"};

std::vector<std::string_view> throw_keys() {
  std::vector<std::string_view> keys{"clip", "hand", "drag_1_m", "trials", "every_s"};
  keys.insert(keys.begin() + 2, kThrowParameters.begin(), kThrowParameters.end());
  return keys;
}

/// Stores the mistake that two keys of different meanings cannot be given together.
void exclude(TomlReader& in, std::string_view first, std::string_view second) {
  if (!in.has(first) || !in.has(second)) return;
  in.fail(second,
          "both " + in_quotes(first) + " and " + in_quotes(second) + " are given",
          "remove one: they exclude each other");
}

ScenePlay read_play(TomlReader& in) {
  ScenePlay play;
  play.clip = recipe::read_line(in, "clip", kMaxNameBytes);
  read_boolean(in, "loops", play.loops);
  read_integer(in, "cycles", play.cycles, kCycles);
  if (play.loops) exclude(in, "loops", "cycles");
  read_number(in, "rate", play.rate, kClipRate);
  read_number(in, "from_s", play.from_s, kTime);
  read_word(in, "transition", play.transition, kTransitionWords);
  return play;
}

SceneStop read_stop(TomlReader& in) {
  SceneStop stop;
  read_text(in, "action", stop.action, kMaxIdBytes);
  if (in.has("layer")) stop.layer = in.integer("layer", kLayer);
  exclude(in, "action", "layer");
  return stop;
}

SceneReach read_reach(TomlReader& in, const Scene& scene) {
  SceneReach reach;
  reach.clip = recipe::read_line(in, "clip", kMaxNameBytes);
  reach.target = read_target_id(in, "target", scene);
  read_hand(in, "hand", reach.hand);
  read_vector(in, "offset_m", reach.offset_in_t_pose, kOffset);
  if (in.has("approach")) {
    glm::dvec3 approach{0.0};
    read_vector(in, "approach", approach, kPlace);
    const double length = glm::length(approach);
    if (in.ok() && !(length > 1e-6)) {
      in.fail("approach", "\"approach\" has no direction", "give a vector, as [0, 0, 1]");
    } else if (in.ok()) {
      reach.approach_in_world = approach / length;
    }
  }
  reach.world_from_t_pose = recipe::read_rotation(in, "orientation");
  read_number(in, "arrival_speed_m_s", reach.arrival_speed_m_s, kSpeed);
  read_number(in, "arrive_s", reach.arrive_s, kActionDuration);
  read_boolean(in, "holds", reach.holds);
  return reach;
}

SceneThrow read_throw(TomlReader& in, const Scene& scene) {
  SceneThrow deed;
  deed.clip = recipe::read_line(in, "clip", kMaxNameBytes);
  read_hand(in, "hand", deed.hand);
  read_number(in, "place_left_m", deed.place_m[0], kOffset);
  read_number(in, "place_up_m", deed.place_m[1], kOffset);
  read_number(in, "place_forward_m", deed.place_m[2], kOffset);
  read_degrees(in, "azimuth_deg", deed.azimuth_rad, kAzimuth);
  read_degrees(in, "elevation_deg", deed.elevation_rad, kElevation);
  read_number(in, "speed_m_s", deed.speed_m_s, kSpeed);
  read_number(in, "release_s", deed.release_s, kTime);
  if (in.has("aim")) deed.aim = read_target_id(in, "aim", scene);
  exclude(in, "aim", "azimuth_deg");
  exclude(in, "aim", "elevation_deg");
  read_number(in, "drag_1_m", deed.drag_1_m, kDrag);
  read_text(in, "trials", deed.trials, kMaxPathBytes);
  if (in.has("trials")) deed.every_s = in.number("every_s", kActionDuration);
  if (in.has("every_s") && !in.has("trials")) {
    in.fail("every_s", "\"every_s\" is given without \"trials\"", "add trials, a file");
  }
  for (const std::string_view key : kThrowParameters) exclude(in, "trials", key);
  return deed;
}

SceneSteer read_steer(TomlReader& in, const Scene& scene) {
  SceneSteer steer;
  steer.clip = recipe::read_line(in, "clip", kMaxNameBytes);
  steer.target = read_target_id(in, "target", scene);
  read_text(in, "stop_clip", steer.stop_clip, kMaxNameBytes);
  read_degrees(in, "max_turn_deg", steer.max_turn_rad, kTurn);
  read_degrees(in, "max_turn_deg_s", steer.max_turn_rad_s, kTurnSpeed);
  read_range(in, "step_length", steer.step_length, kStepFactor);
  read_number(in, "arrive_within_m", steer.arrive_within_m, kLength);
  read_boolean(in, "keeps", steer.keeps);
  return steer;
}

SceneJump read_jump(TomlReader& in, const Scene& scene) {
  SceneJump jump;
  jump.clip = recipe::read_line(in, "clip", kMaxNameBytes);
  read_number(in, "apex_m", jump.apex_m, kApex);
  read_number(in, "apex_by_m", jump.apex_by_m, kRaise);
  exclude(in, "apex_m", "apex_by_m");
  read_number(in, "airtime_s", jump.airtime_s, kAirtime);
  read_number(in, "length_m", jump.length_m, kJumpLength);
  read_number(in, "box_m", jump.box_m, kBox);
  if (in.has("target")) jump.target = read_target_id(in, "target", scene);
  exclude(in, "target", "length_m");
  exclude(in, "target", "box_m");
  return jump;
}

SceneFollow read_follow(TomlReader& in, const Scene& scene) {
  SceneFollow follow;
  follow.target = read_target_id(in, "target", scene);
  follow.point = read_point(in);
  read_number(in, "max_speed_m_s", follow.max_speed_m_s, kFollowSpeed);
  return follow;
}

SceneCarry read_carry(TomlReader& in) {
  SceneCarry carry;
  read_hand(in, "hand", carry.hand);
  carry.mass_kg = in.number("mass_kg", kLoad);
  read_vector(in, "offset_m", carry.offset_in_t_pose, kOffset);
  return carry;
}

/// Checks the keys that only some types of constraints have.
void check_constrain(TomlReader& in, const SceneConstrain& deed) {
  const bool is_oriented = deed.type == SceneConstraintType::kOriented;
  const bool is_box = deed.type == SceneConstraintType::kInside ||
                      deed.type == SceneConstraintType::kOutside;
  struct Rule {
    std::string_view key;
    bool is_allowed;
  };
  for (const Rule& rule : {Rule{"target", !is_oriented},
                           Rule{"offset_m", !is_oriented},
                           Rule{"distance_m", deed.type == SceneConstraintType::kPoint},
                           Rule{"size_m", is_box},
                           Rule{"orientation_deg", is_oriented},
                           Rule{"orientation_wxyz", is_oriented}}) {
    if (rule.is_allowed || !in.has(rule.key)) continue;
    in.fail(rule.key,
            "a constraint of the type " +
                in_quotes(kConstraintWords[static_cast<std::size_t>(deed.type)]) +
                " has no " + in_quotes(rule.key),
            "remove it, or choose another type");
  }
  if (is_oriented && !deed.world_from_t_pose) {
    in.fail("",
            "the key \"orientation_deg\" is missing in [[at]]",
            "add orientation_deg, or orientation_wxyz for a quaternion");
  }
}

SceneConstrain read_constrain(TomlReader& in, const Scene& scene) {
  SceneConstrain deed;
  read_word(in, "type", deed.type, kConstraintWords);
  deed.world_from_t_pose = recipe::read_rotation(in, "orientation");
  check_constrain(in, deed);
  const bool is_oriented = deed.type == SceneConstraintType::kOriented;
  if (!is_oriented) deed.target = read_target_id(in, "target", scene);
  deed.point = read_point(in);
  read_number(in, "distance_m", deed.distance_m, kLength);
  if (!is_oriented && deed.type != SceneConstraintType::kPoint) {
    const std::vector<double> size = recipe::read_numbers(in, "size_m", 3, kLength);
    deed.size_m = {size[0], size[1], size[2]};
  }
  read_integer(in, "range", deed.range, kSegmentRange);
  read_number(in, "importance", deed.importance, kConstraintImportance);
  read_number(in, "precision_m", deed.precision_m, kPrecision);
  return deed;
}

}  // namespace

const std::vector<std::string_view>& deed_keys(std::size_t deed) {
  using KeyList = std::vector<std::string_view>;
  static const std::array<KeyList, kSceneDeeds.size()> kKeys{
      KeyList{"clip", "loops", "cycles", "rate", "from_s", "transition"},
      KeyList{"action"},
      KeyList{"clip",
              "target",
              "hand",
              "offset_m",
              "approach",
              "orientation_deg",
              "orientation_wxyz",
              "arrival_speed_m_s",
              "arrive_s",
              "holds"},
      throw_keys(),
      KeyList{"clip",
              "target",
              "stop_clip",
              "max_turn_deg",
              "max_turn_deg_s",
              "step_length",
              "arrive_within_m",
              "keeps"},
      KeyList{"clip", "apex_m", "apex_by_m", "airtime_s", "length_m", "box_m", "target"},
      KeyList{"target", "segment", "offset_m", "max_speed_m_s"},
      KeyList{"hand", "mass_kg", "offset_m"},
      KeyList{"type",
              "target",
              "segment",
              "offset_m",
              "distance_m",
              "size_m",
              "orientation_deg",
              "orientation_wxyz",
              "range",
              "importance",
              "precision_m"}};
  MAREY_ASSERT(deed < kKeys.size());
  return kKeys[deed];
}

SceneDeed read_deed(TomlReader& in, std::size_t deed, const Scene& scene) {
  switch (deed) {
    case 0:
      return read_play(in);
    case 1:
      return read_stop(in);
    case 2:
      return read_reach(in, scene);
    case 3:
      return read_throw(in, scene);
    case 4:
      return read_steer(in, scene);
    case 5:
      return read_jump(in, scene);
    case 6:
      return read_follow(in, scene);
    case 7:
      return read_carry(in);
    default:
      return read_constrain(in, scene);
  }
}

}  // namespace marey::recordings::stage
