// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/edit/body_group.h"

namespace marey {

enum class SceneHand { kLeft, kRight };

enum class SceneTransition { kAuto, kCrossfade, kInertial, kExtrapolate };

/// Plays a clip.
struct ScenePlay {
  std::string clip{};
  bool loops = false;           ///< Without an end.
  std::optional<int> cycles{};  ///< Number of cycles; excludes `loops`. nullopt: once.
  double rate = 1.0;            ///< Seconds of the clip per second: 0.25 to 4.
  double from_s = 0.0;          ///< Time in the clip at which it is entered.
  SceneTransition transition = SceneTransition::kAuto;
};

/// Stops actions of the body.
struct SceneStop {
  std::string action{};        ///< Id of the action; empty: all of the layers.
  std::optional<int> layer{};  ///< Only this layer, if `action` is empty.
};

/// Moves a hand to a target (Kulpa 2005, figure 7.6).
struct SceneReach {
  std::string clip{};
  std::string target{};
  SceneHand hand = SceneHand::kRight;
  /// Point of the hand that arrives, from the wrist. [m]
  glm::dvec3 offset_in_t_pose{0.0};
  /// Direction of the hand's motion at arrival, in the world; unit length. nullopt: the
  /// clip's.
  std::optional<glm::dvec3> approach_in_world{};
  std::optional<glm::dquat> world_from_t_pose{};  ///< For the hand at arrival.
  double arrival_speed_m_s = 0.0;
  std::optional<double> arrive_s{};  ///< Time from start to arrival; nullopt: the clip's.
  bool holds = false;  ///< Stays on the target without an end, instead of returning.
};

/// Throws a ball (Kulpa 2005, figure 7.7). A value that is absent is the captured one.
struct SceneThrow {
  std::string clip{};
  SceneHand hand = SceneHand::kRight;
  /// Wrist at release, in the heading frame of the hips: left, up, forward. [m]
  std::array<std::optional<double>, 3> place_m{};
  std::optional<double> azimuth_rad{};  ///< For the ball; 0 ahead, positive to the left.
  std::optional<double> elevation_rad{};
  std::optional<double> speed_m_s{};
  std::optional<double> release_s{};  ///< Time from start to release.
  /// Target through which the ball flies; it replaces azimuth and elevation. Empty: none.
  std::string aim{};
  /// Drag: deceleration divided by the speed squared. [1/m]
  double drag_1_m = 0.0;
  /// File of trials (docs/formats/trials.md): the throw is repeated for each, with its
  /// parameter. Empty: once.
  std::string trials{};
  double every_s = 0.0;  ///< Time from one trial to the next.
};

/// Turns and lengthens the steps of a clip so that it arrives (Kulpa 2005, figure 7.8).
struct SceneSteer {
  std::string clip{};
  std::string target{};
  std::string stop_clip{};  ///< Plays at the arrival; empty: the idle clip.
  double max_turn_rad = 0.6108652381980153;     ///< A step: 35 degrees.
  double max_turn_rad_s = 2.0943951023931953;   ///< 120 degrees/s.
  std::array<double, 2> step_length{0.7, 1.3};  ///< Factors of the step length.
  double arrive_within_m = 0.3;
  /// The scene continues to steer when the target moves after an arrival; then the action
  /// has no end.
  bool keeps = false;
};

/// Changes the jump of a clip (docs/jumps.md). At most one of the two apex values;
/// length_m and target exclude each other.
struct SceneJump {
  std::string clip{};
  std::optional<double> apex_m{};     ///< Above the floor of the take-off.
  std::optional<double> apex_by_m{};  ///< Added to the captured apex.
  std::optional<double> airtime_s{};
  std::optional<double> length_m{};
  std::optional<double> box_m{};  ///< Height of the landing above the take-off.
  std::string target{};           ///< Landing; empty: none.
};

/// A point of the body follows a target at once, without a clip: a performer's hand.
struct SceneFollow {
  std::string target{};
  BodyPoint point{};
  double max_speed_m_s = 10.0;
};

/// Carries a mass in a hand.
struct SceneCarry {
  SceneHand hand = SceneHand::kRight;
  double mass_kg = 0.0;
  glm::dvec3 offset_in_t_pose{0.0};  ///< From the wrist. [m]
};

enum class SceneConstraintType {
  kPoint,     ///< DistanceToPoint.
  kInside,    ///< AllowedSpace: a box about the target.
  kOutside,   ///< ForbiddenSpace: a box about the target.
  kOriented,  ///< SegmentOrientation.
};

/// Holds a constraint whose place is a target.
struct SceneConstrain {
  SceneConstraintType type = SceneConstraintType::kPoint;
  std::string target{};  ///< Empty for kOriented only.
  BodyPoint point{};
  double distance_m = 0.0;  ///< For kPoint.
  glm::dvec3 size_m{0.0};   ///< For boxes: edges along the world's axes.
  std::optional<glm::dquat> world_from_t_pose{};  ///< For kOriented.
  std::optional<int> range{};                     ///< Constraint::range.
  double importance = 1.0;
  double precision_m = 0.001;
};

using SceneDeed = std::variant<ScenePlay,
                               SceneStop,
                               SceneReach,
                               SceneThrow,
                               SceneSteer,
                               SceneJump,
                               SceneFollow,
                               SceneCarry,
                               SceneConstrain>;

/// Words of the alternatives of SceneDeed, in their order.
inline constexpr std::array<std::string_view, std::variant_size_v<SceneDeed>> kSceneDeeds{
    "play", "stop", "reach", "throw", "steer", "jump", "follow", "carry", "constrain"};

/// One line of the script. An action on a group is one action of each member.
struct SceneAction {
  std::string id{};    ///< Different for all actions; may be empty.
  std::string body{};  ///< Id of a body, of a group or of a member.
  SceneDeed deed{};
  double time_s = 0.0;  ///< Start, in the scene; with `after`: the earliest one.
  /// Id of an action of the same bodies: starts when it ends, or at its `event`. Empty:
  /// starts at time_s.
  std::string after{};
  std::string event{};            ///< Annotation of that action's clip; empty: its end.
  std::optional<double> for_s{};  ///< Ends this long after its start.
  int layer = 0;                  ///< 0 to 7; higher layers cover lower ones.
  double priority = 1.0;
  /// Priorities of groups of the body; nullopt: `priority`.
  std::array<std::optional<double>, kEditGroups.size()> group_priority{};
  std::optional<double> fade_in_s{};  ///< nullopt: the engine's.
  std::optional<double> fade_out_s{};
  int line = 0;  ///< In the scene's file; 0: unknown.
};

/// Returns the id of the target that an action uses; empty: none.
[[nodiscard]] const std::string& target_of(const SceneAction& action);

/// Returns whether an action ends only when it is stopped.
[[nodiscard]] bool is_endless(const SceneAction& action);

}  // namespace marey
