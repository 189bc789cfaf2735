// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/clips/motion_base.h"
#include "engine/clips/sample_clip.h"
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/constraint.h"
#include "core/engine/scene.h"
#include "core/engine/throw_trials.h"
#include "core/floor.h"
#include "core/pose.h"
#include "retarget/body/body_map.h"

namespace marey::app {

/// A body of a scene: one entry of scene_bodies().
struct StageBody {
  std::string id{};
  Character character{};  ///< With the loads of the whole scene in its hands.
  retarget::BodyMap map{};
  engine::RootPlace start{};
  double stature_m = 0.0;
  ConstraintSet constraints{};  ///< That always apply.
};

/// One body in all steps; every vector has one entry per step.
struct StageTrack {
  std::vector<Pose> poses{};
  /// The postures before feet, constraints and balance, as the floor carries them.
  std::vector<Pose> references{};
  std::vector<std::array<bool, 2>> stands{};  ///< Left, right: held on the floor.
  /// Displacement of the floor under each foot since the start. [m]
  std::vector<std::array<glm::dvec3, 2>> floor_moved_m{};
};

/// Positions of a target for one body that uses it, by step.
struct StageTargetTrack {
  std::size_t target = 0;  ///< Position in Scene::targets.
  std::size_t body = 0;    ///< Position in StageRecord::bodies: the user.
  std::vector<glm::dvec3> p_in_world{};
};

/// An event of an action's clip.
struct StageEvent {
  std::string name{};
  double time_s = 0.0;
};

/// One action of the script on one body.
struct StageActionRun {
  std::size_t action = 0;  ///< Position in Scene::script.
  std::size_t body = 0;
  double start_s = 0.0;
  /// Begin of its end (fade out); infinity: it was active to the end.
  double end_s = std::numeric_limits<double>::infinity();
  std::vector<StageEvent> events{};
};

/// One throw: asked values and those of the posed body at the release.
struct StageThrow {
  std::size_t action = 0;
  std::size_t body = 0;
  std::optional<std::size_t> trial{};  ///< Position in the order of trials.
  double start_s = 0.0;
  /// By position: left, up, forward of the wrist [m], azimuth, elevation [rad], speed
  /// [m/s], release after the start [s].
  std::array<double, 7> asked{};  ///< Captured values where nothing was asked.
  std::array<double, 7> measured{};
  double release_s = 0.0;  ///< Time of the scene.
  /// Arrival of the ball in the plane of the target, or on the floor. [s]
  std::optional<double> arrival_s{};
};

/// Everything that figures, pictures and files of a scene need. All vectors by step have
/// one entry per step; step k is at time begin_s + (k + 1) / step_hz.
struct StageRecord {
  Scene scene{};
  Floor floor{};  ///< Without parts: level, at height 0.
  std::shared_ptr<const engine::MotionBase> base{};
  std::map<std::string, TrialList> trials{};  ///< By SceneThrow::trials.
  std::vector<StageBody> bodies{};
  std::vector<StageTrack> tracks{};  ///< One for each body.
  std::vector<StageTargetTrack> targets{};
  std::vector<StageActionRun> actions{};
  std::vector<StageThrow> throws{};
  double mean_step_ms = 0.0;  ///< By the clock.
  double begin_s = 0.0;       ///< Time of the scene; above 0 after forget_steps().

  [[nodiscard]] std::size_t step_count() const {
    return tracks.empty() ? 0 : tracks.front().poses.size();
  }
  [[nodiscard]] double time_s(std::size_t step) const {
    return begin_s + static_cast<double>(step + 1) / scene.step_hz;
  }
};

}  // namespace marey::app
