// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/actions/action.h"
#include "engine/clips/motion_base.h"
#include "engine/models/clip_travel.h"
#include "engine/models/steer_plan.h"
#include "engine/step/character_player.h"
#include "engine/step/choose_family.h"
#include "engine/step/jump_wish.h"

#include "core/base/result.h"

namespace marey::engine {

/// Position of a character in its engine.
enum class CharacterId : int {};

struct EngineOptions {
  double step_hz = 60.0;
  /// Threads of advance(); more than one are started in each call. The results do not
  /// depend on it.
  int threads = 1;
};

/// Plays motions on characters in fixed steps (Kulpa 2005, figures 2.2 and 7.1).
///
///     auto base = engine::MotionBase::make(*recordings::read_moves("moves.marey"));
///     auto engine = engine::Engine::make(*base, {.step_hz = 60});
///     CharacterId ann = *engine->add(spec);
///     ActionId walk = *engine->play(ann, {.clip = "walk"});
///     engine->advance(60);
///     show(engine->pose(ann));
///
/// Same requests between the same steps, same postures, to the bit. Requests are checked
/// when they are made; a step never fails. advance() allocates nothing with one thread.
class Engine {
 public:
  /// Errors (bad input): no base; a rate that is not in [1, 1000] Hz; less than one
  /// thread.
  [[nodiscard]] static Result<Engine> make(std::shared_ptr<const MotionBase> base,
                                           const EngineOptions& options = {});
  Engine(Engine&&) noexcept = default;
  Engine& operator=(Engine&&) noexcept = default;

  /// Adds a character; it is in its rest pose until it plays something. Errors: those of
  /// CharacterPlayer::make(); a start that is not finite.
  [[nodiscard]] Result<CharacterId> add(CharacterSpec spec);

  /// Requests an action. Errors (bad input, naming the value): no such character or clip
  /// (with the nearest name); a priority, weight, fade, rate or time that is not finite
  /// or negative; no priority above 0; a rate outside of [0.25, 4]; a group that the body
  /// does not have; an entry outside of the clip; an action to wait for that does not
  /// exist, is over, or has no end; an event that its clip does not have; more than
  /// kMaxActions actions.
  [[nodiscard]] Result<ActionId> play(CharacterId character, const ActionWish& wish);
  /// Requests to play what a performer does; it begins with the second posture. It
  /// replaces an earlier live source. Errors: those of an action without a clip, and of
  /// check_live_options().
  [[nodiscard]] Result<ActionId> play(CharacterId character, const LiveWish& wish);
  /// Gives the live source the performer's posture at one instant. Allocates nothing.
  /// Errors: there is no live source; those of LiveSource::push(); a time later than that
  /// of the next step by more than 0.1 s.
  [[nodiscard]] Status push(CharacterId character, const LivePosture& posture);
  /// Requests a walk to a goal. It replaces an earlier one. Errors: those of an action
  /// and of SteerPlayer::make().
  [[nodiscard]] Result<ActionId> play(CharacterId character, const SteerWish& wish);
  /// Moves the goal of the walk. Errors: nothing is steered; not finite.
  [[nodiscard]] Status aim(CharacterId character, glm::dvec2 goal_xz_m);
  /// Requests a reach. It replaces an earlier one of that hand. Errors: those of an
  /// action and of ReachPlayer::make(); a character without CharacterSpec::reaches.
  [[nodiscard]] Result<ActionId> play(CharacterId character, const ReachWish& wish);
  /// Moves the target of a hand. Errors: the hand does not reach; check_target()'s.
  [[nodiscard]] Status aim(CharacterId character, int side, const ReachTarget& target);
  /// Answers whether a reach can succeed from the present place, without playing it.
  /// Errors: those of play().
  [[nodiscard]] Result<ReachFeasibility> ask(CharacterId character,
                                             const ReachWish& wish) const;
  /// Requests a throw. It replaces an earlier throw of that hand. CharacterPlayer::
  /// throwing() has the result after the release. Errors: those of an action and of
  /// ThrowPlayer::make(); a character without CharacterSpec::reaches.
  [[nodiscard]] Result<ActionId> play(CharacterId character, const ThrowWish& wish);
  /// Moves the point that the ball of a hand is to meet. Errors: the hand does not throw;
  /// ThrowPlayer::aim()'s.
  [[nodiscard]] Status aim_ball(CharacterId character,
                                int side,
                                const glm::dvec3& p_in_world);
  /// Answers whether a throw can succeed, without playing it. Errors: those of play().
  [[nodiscard]] Result<ThrowFeasibility> ask(CharacterId character,
                                             const ThrowWish& wish) const;
  /// Requests that a point of the body follows a target at once, without a clip. It
  /// replaces an earlier follow of that point, and reach and throw of that hand. Errors:
  /// CharacterPlayer::make_follow()'s.
  [[nodiscard]] Result<ActionId> play(CharacterId character, const FollowWish& wish);
  /// Moves the target of a follow. Errors: no such follow; not finite.
  [[nodiscard]] Status aim(CharacterId character,
                           ActionId follow,
                           const glm::dvec3& target_in_world);
  /// Answers how far a target is and how long the point needs to it. Errors: those of
  /// play().
  [[nodiscard]] Result<FollowFeasibility> ask(CharacterId character,
                                              const FollowWish& wish) const;
  /// Answers when and in how many landings a walk that begins at the start of its cycle
  /// arrives at its goal. Errors: those of play().
  [[nodiscard]] Result<SteerAnswer> ask(CharacterId character,
                                        const SteerWish& wish) const;
  /// Requests a jump with another apex, airtime or landing. Plans it now: some
  /// milliseconds for the first jump of a clip, less for others; allocates. Errors: those
  /// of an action, of JumpBody::make() and of dynamics::plan_jump().
  [[nodiscard]] Result<ActionId> play(CharacterId character, const JumpWish& wish);
  /// Answers whether a jump is possible. The first question about a clip costs some
  /// milliseconds. Errors: those of play(), except those of the plan.
  [[nodiscard]] Result<JumpFeasibility> ask(CharacterId character, const JumpWish& wish);
  /// Fades an action out, or takes a waiting one back. Error: it is over or unknown.
  [[nodiscard]] Status stop(CharacterId character, ActionId action);
  /// Fades out all actions of a layer; nullopt means all layers.
  [[nodiscard]] Status stop_all(CharacterId character, std::optional<int> layer = {});

  /// Moves all characters on by this many steps. Precondition: steps >= 0.
  void advance(int steps = 1);

  /// Moves all characters on by one step, one after another, with the caller between
  /// them: a character whose targets are points of another body of the same step is
  /// stepped after that body. end_step() steps the characters that were not stepped, in
  /// the order of their ids. The results equal those of advance() if the caller changes
  /// nothing in between. Requests that are made between begin_step() and step() of their
  /// character begin with this step. All in one thread; allocates nothing.
  /// Preconditions: begin_step() and end_step() alternate, without advance() or add()
  /// between them; a character is stepped once. time_s() is that of the step from
  /// begin_step() on.
  void begin_step();
  void step(CharacterId character);
  void end_step();

  [[nodiscard]] double time_s() const;
  [[nodiscard]] double step_s() const { return 1.0 / options_.step_hz; }
  [[nodiscard]] double step_hz() const { return options_.step_hz; }
  /// Number of steps, with the one that is under way.
  [[nodiscard]] std::int64_t steps() const { return steps_; }
  /// Number of steps before the one with which a request to this character would begin
  /// now. Precondition: the character exists.
  [[nodiscard]] std::int64_t steps_before(CharacterId character) const;
  [[nodiscard]] std::size_t size() const { return characters_.size(); }
  /// Precondition (also of the functions below): the character exists.
  [[nodiscard]] const Pose& pose(CharacterId character) const;
  [[nodiscard]] CharacterPlayer& player(CharacterId character);
  [[nodiscard]] const CharacterPlayer& player(CharacterId character) const;
  /// State of an action; kDone for one that is over or was never requested.
  [[nodiscard]] ActionPhase phase(CharacterId character, ActionId action) const;
  [[nodiscard]] const MotionBase& base() const { return *base_; }

 private:
  Engine(std::shared_ptr<const MotionBase> base, const EngineOptions& options);
  [[nodiscard]] Status check_character(CharacterId character) const;
  [[nodiscard]] Result<Action> checked(CharacterId character,
                                       const ActionWish& wish) const;
  [[nodiscard]] Result<ReachPlayer> made_reach(CharacterId character,
                                               const Action& action,
                                               const ReachWish& wish) const;
  [[nodiscard]] Status check_hand(CharacterId character,
                                  const std::string& clip,
                                  int side) const;
  [[nodiscard]] Result<ThrowPlayer> made_throw(CharacterId character,
                                               Action action,
                                               const ThrowWish& wish) const;
  [[nodiscard]] Result<std::vector<FamilyAction>> chosen_family(
      CharacterId character, const ReachWish& wish) const;
  [[nodiscard]] Result<ActionId> play_family(CharacterId character,
                                             Action action,
                                             const ReachWish& wish);
  [[nodiscard]] Status join_crowd(CharacterPlayer& player);
  void step_block(std::size_t first, std::size_t end);
  ActionId add_action(CharacterId character, Action action);

  std::shared_ptr<const MotionBase> base_;
  EngineOptions options_;
  /// By clip; nullptr: it cannot be steered.
  std::vector<std::shared_ptr<const ClipTravel>> travels_;
  std::vector<std::unique_ptr<CharacterPlayer>> characters_;
  /// Characters of like bodies and constraints are members of one crowd.
  std::vector<std::unique_ptr<retarget::Crowd>> crowds_;
  std::vector<std::size_t> crowd_of_;  ///< By character.
  std::vector<std::vector<retarget::CrowdJob>>
      jobs_;                           ///< The jobs of the current block, by crowd.
  std::vector<char> adapts_;           ///< By character, in this step.
  std::vector<std::int64_t> stepped_;  ///< By character: number of its last step.
  bool is_stepping_ = false;           ///< Between begin_step() and end_step().
  std::int64_t steps_ = 0;
  std::int64_t next_action_ = 1;
};

}  // namespace marey::engine
