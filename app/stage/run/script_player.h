// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/models/follow_course.h"

#include "app/stage/run/stage_record.h"
#include "app/stage/run/target_places.h"
#include "core/base/result.h"
#include "core/engine/throw_trials.h"
#include "retarget/adapt/adapter.h"

namespace marey::app {

/// Starts, aims and ends the actions of a script on the bodies of an engine.
class ScriptPlayer {
 public:
  /// Borrows `scene` and `bodies`. Trials by their file, as in SceneThrow::trials.
  /// Errors: those of check_action(); a list of trials that is not given.
  [[nodiscard]] static Result<ScriptPlayer> make(
      const Scene& scene,
      std::span<const StageBody> bodies,
      const engine::MotionBase& base,
      const std::map<std::string, TrialList>& trials);

  /// Starts and ends actions before the step at `time_s`. An action that the engine
  /// refuses becomes a problem.
  void begin_step(double time_s,
                  double step_s,
                  const TargetPlaces& places,
                  engine::Engine& engine);
  /// Moves the targets of a body's actions, just before the body is stepped.
  void aim(std::size_t body,
           double time_s,
           double step_s,
           const TargetPlaces& places,
           engine::Engine& engine);
  /// Notes events, throws and ends after the step.
  void end_step(double time_s, const engine::Engine& engine);

  [[nodiscard]] const std::vector<StageActionRun>& runs() const { return runs_; }
  [[nodiscard]] const std::vector<StageThrow>& throws() const { return throws_; }
  [[nodiscard]] const std::vector<Error>& problems() const { return problems_; }

 private:
  enum class Phase { kWaiting, kActive, kEnded };
  /// One action on one body.
  struct Instance {
    std::size_t action = 0;
    std::size_t body = 0;
    std::optional<TargetUse> use{};
    std::optional<std::size_t> after{};  ///< Position of another instance.
    Phase phase = Phase::kWaiting;
    double start_s = 0.0;
    double stop_s = 0.0;  ///< Time at which the script ends it; infinity: never.
    std::optional<engine::ActionId> id{};
    std::size_t run = 0;             ///< Position in runs_, while active or ended.
    std::optional<double> clip_s{};  ///< Time in the clip after the last step.
    glm::dvec3 last_target{0.0};
    bool has_target = false;
    engine::FollowCourse follow{};
    bool follows = false;
    std::vector<PlannedTrial> order{};
    std::size_t next_trial = 0;
    bool has_result = false;  ///< The result of the last throw was noted.
  };

  ScriptPlayer(const Scene& scene,
               std::span<const StageBody> bodies,
               const engine::MotionBase& base)
      : scene_(&scene), bodies_(bodies), base_(&base) {}
  void add_instances(std::size_t action, const std::map<std::string, TrialList>& trials);
  void link_waiting();
  [[nodiscard]] bool may_start(const Instance& instance, double time_s) const;
  void start(Instance& instance,
             double time_s,
             double step_s,
             const TargetPlaces& places,
             engine::Engine& engine);
  [[nodiscard]] Result<std::optional<engine::ActionId>> request(Instance& instance,
                                                                double step_s,
                                                                const glm::dvec3& target,
                                                                engine::Engine& engine);
  [[nodiscard]] Result<std::optional<engine::ActionId>> request_throw(
      Instance& instance, const glm::dvec3& target, engine::Engine& engine);
  void stop_others(const Instance& by, double time_s, engine::Engine& engine);
  void end(Instance& instance, double time_s, engine::Engine& engine);
  void steer_again(Instance& instance,
                   double step_s,
                   const glm::dvec3& target,
                   engine::Engine& engine);
  void throw_again(Instance& instance,
                   double time_s,
                   double step_s,
                   const TargetPlaces& places,
                   engine::Engine& engine);
  void note_events(Instance& instance, double time_s, const engine::Engine& engine);
  void note_throw(Instance& instance, const engine::Engine& engine);
  [[nodiscard]] const SceneAction& action_of(const Instance& instance) const {
    return scene_->script[instance.action];
  }

  const Scene* scene_;
  std::span<const StageBody> bodies_;
  const engine::MotionBase* base_;
  std::map<std::string, TrialList> trials_;
  std::vector<Instance> instances_;
  std::vector<StageActionRun> runs_;
  std::vector<StageThrow> throws_;
  std::vector<Error> problems_;
};

}  // namespace marey::app
