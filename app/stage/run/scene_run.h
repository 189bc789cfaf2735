// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/stage/run/stage_record.h"
#include "core/base/result.h"
#include "core/engine/throw_trials.h"
#include "core/pose.h"

namespace marey::app {

/// Input of a run besides the scene's file.
struct SceneRunInput {
  Scene scene{};
  Floor floor{};
  std::shared_ptr<const engine::MotionBase> base{};
  std::vector<StageBody> bodies{};  ///< One for each of scene_bodies(), in its order.
  std::map<std::string, TrialList> trials{};  ///< By SceneThrow::trials.
  int threads = 1;
  bool records = true;  ///< Keep all steps for record().
};

/// A scene that runs step by step (docs/formats/scene.md): script, targets, bodies.
///
///     auto run = SceneRun::make(std::move(input));
///     while (!run->is_over()) run->advance();
///
/// Same input and same calls of set_target() between the same steps: same postures, to
/// the bit. Bodies whose targets are points of other bodies are solved after those.
class SceneRun {
 public:
  /// Errors (bad input, naming body or action): those of Engine::add(); an unknown clip,
  /// with the nearest name; an action that its body or clip does not permit; no idle
  /// clip.
  [[nodiscard]] static Result<SceneRun> make(SceneRunInput input);
  SceneRun(SceneRun&&) noexcept;
  SceneRun& operator=(SceneRun&&) noexcept;
  ~SceneRun();

  /// Moves on by one step. An action that cannot begin then (a reach of a hand that the
  /// body lost, for example) is left out and becomes a finding.
  void advance();
  [[nodiscard]] double time_s() const;
  /// True if the scene's duration has passed. advance() may go on.
  [[nodiscard]] bool is_over() const;

  [[nodiscard]] std::size_t size() const;  ///< Bodies.
  /// Precondition (also of the functions below): the body or target exists.
  [[nodiscard]] const StageBody& body(std::size_t i) const;
  [[nodiscard]] const Pose& pose(std::size_t body) const;

  [[nodiscard]] const Scene& scene() const;
  /// Position of a target for a body that uses it, in the last step; before the first
  /// step at time 0.
  [[nodiscard]] glm::dvec3 target_in_world(std::size_t target, std::size_t user) const;
  /// Holds a target at a point of the world for all users, or for one; nullopt: back to
  /// its path. Takes effect with the next step. False: the target is not to be dragged
  /// (SceneTarget::drag), or the point is not finite.
  bool set_target(std::size_t target,
                  const std::optional<glm::dvec3>& p_in_world,
                  std::optional<std::size_t> user = {});

  /// The run so far. Precondition: SceneRunInput::records.
  [[nodiscard]] const StageRecord& record() const;
  /// Empties the record, which begins again with the next step: a run without an end must
  /// not fill the memory. The record's figures are then limited to its steps.
  /// Precondition: SceneRunInput::records.
  void forget_steps();
  /// Time of the scene at which the record begins.
  [[nodiscard]] double recorded_from_s() const;
  /// Actions that could not begin, in the order of their times.
  [[nodiscard]] const std::vector<Error>& problems() const;

 private:
  struct State;
  explicit SceneRun(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace marey::app
