// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/constraint.h"

namespace marey {

/// A figure that a scene measures, for stage.json.
enum class SceneFigureKind {
  kWristError,    ///< Distance of a point from a target, in steps where it is reachable.
  kFeetSlide,     ///< Displacement of a bearing foot on its floor since it began to bear.
  kComError,      ///< Distance of the centre of mass, with loads, from its vertical.
  kPelvisBack,    ///< Displacement of the hips backwards from the unloaded posture.
  kParry,         ///< Distance of a point from a target at an event of an action.
  kClearance,     ///< Smallest distance of a point from a target.
  kArrival,       ///< Distance of the hips from the target of a steer at its end.
  kTwist,         ///< Turn of a bearing foot about the vertical.
  kSwaySpectrum,  ///< Deviation of the spectrum of the lateral sway from a clip's.
  kJerkRatio,     ///< Mean jerk of all joints divided by that of the clips.
  kThrowPlace,    ///< Wrist at release against the asked or the captured place.
  kThrowDirection,  ///< Direction of the ball against the asked or the captured one.
  kThrowSpeed,      ///< Speed of the ball against the asked or the captured one.
  kReleaseTime,     ///< Release against the asked or the captured time.
  kStepTime,        ///< Mean time of one step of all bodies, by the clock.
};

/// Keys that a kind of figure needs, and its unit in names of keys.
struct SceneFigureRule {
  SceneFigureKind kind{};
  std::string_view word;  ///< "wrist_error".
  std::string_view unit;  ///< "mm", as in "max_mm"; empty: a ratio.
  bool needs_body = true;
  bool needs_point = false;  ///< A segment.
  bool needs_target = false;
  bool needs_action = false;
  bool needs_event = false;
  bool needs_clip = false;
};

inline constexpr std::array<SceneFigureRule, 15> kSceneFigureRules{{
    {SceneFigureKind::kWristError, "wrist_error", "mm", true, true, true},
    {SceneFigureKind::kFeetSlide, "feet_slide", "mm"},
    {SceneFigureKind::kComError, "com_error", "mm"},
    {SceneFigureKind::kPelvisBack, "pelvis_back", "mm"},
    {SceneFigureKind::kParry, "parry", "mm", true, true, true, true, true},
    {SceneFigureKind::kClearance, "clearance", "mm", true, true, true},
    {SceneFigureKind::kArrival, "arrival", "m", true, false, false, true},
    {SceneFigureKind::kTwist, "twist", "deg"},
    {SceneFigureKind::kSwaySpectrum,
     "sway_spectrum",
     "percent",
     true,
     false,
     false,
     false,
     false,
     true},
    {SceneFigureKind::kJerkRatio, "jerk_ratio", ""},
    {SceneFigureKind::kThrowPlace, "throw_place", "mm", true, false, false, true},
    {SceneFigureKind::kThrowDirection,
     "throw_direction",
     "deg",
     true,
     false,
     false,
     true},
    {SceneFigureKind::kThrowSpeed, "throw_speed", "percent", true, false, false, true},
    {SceneFigureKind::kReleaseTime, "release_time", "ms", true, false, false, true},
    {SceneFigureKind::kStepTime, "step_time", "ms", false},
}};

[[nodiscard]] constexpr const SceneFigureRule& rule_of(SceneFigureKind kind) {
  return kSceneFigureRules[static_cast<std::size_t>(kind)];
}

/// A figure with its bounds. The worst value of all bodies and steps counts.
struct SceneFigure {
  SceneFigureKind kind = SceneFigureKind::kWristError;
  /// Ids of bodies, groups or members.
  std::vector<std::string> bodies{};
  BodyPoint point{};
  std::string target{};
  std::string action{};
  std::string event{};
  std::string clip{};
  std::optional<double> min{};  ///< Smallest allowed value, in the unit of the kind.
  std::optional<double> max{};  ///< Largest allowed value.
  /// The value of each body must exceed that of the body before it.
  bool ascending = false;
  double from_s = 0.0;           ///< Time of the scene from which it is measured.
  std::optional<double> to_s{};  ///< nullopt: to the end.
  int line = 0;                  ///< In the scene's file; 0: unknown.
};

/// A picture of all bodies.
struct ScenePicture {
  double time_s = 0.0;
  glm::dvec3 camera_in_world{0.0};
  glm::dvec3 looks_at_in_world{0.0};
  int width_px = 1280;
  int height_px = 720;
};

/// A body that is sent by VMC, live.
struct SceneVmc {
  std::string body{};  ///< Id of a body or of a member.
  int port = 0;
};

/// Results of a scene.
struct SceneOutputs {
  bool glb = true;            ///< One file with all bodies.
  double glb_rate_hz = 30.0;  ///< Frames a second in it.
  std::vector<ScenePicture> pictures{};
  std::vector<SceneVmc> vmc{};
};

}  // namespace marey
