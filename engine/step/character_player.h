// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/feet/floor_level.h"
#include "engine/feet/floor_ride.h"
#include "engine/feet/foot_hold.h"
#include "engine/feet/root_pull.h"
#include "engine/models/jump_body.h"
#include "engine/step/blend_player.h"
#include "engine/step/clip_constraints.h"
#include "engine/step/follow_player.h"
#include "engine/step/reach_player.h"
#include "engine/step/rehearsal.h"
#include "engine/step/steer_player.h"
#include "engine/step/throw_player.h"
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/adapt/adapter.h"
#include "retarget/adapt/crowd.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

/// Work that is done for a character in each step.
enum class DetailLevel : std::uint8_t {
  kBlended,    ///< Sampled, blended, on its body.
  kKinematic,  ///< And feet that stand, and constraints.
  kKinetic,    ///< And balance.
};

/// A character to add to an engine.
struct CharacterSpec {
  Character character;
  retarget::BodyMap map;  ///< For the character's skeleton.
  RootPlace start;
  double importance = 1.0;
  DetailLevel level = DetailLevel::kKinematic;
  /// Constraints that may act on it. Activations begin as they state; the caller starts
  /// and moves them through constraint(). Supports of the feet are added.
  ConstraintSet constraints;
  /// May play reaches and throws: reserves constraints of both hands.
  bool reaches = false;
  /// Clips whose constraints act while they play: ClipConstraints.
  std::vector<std::string> constrained_clips;
  BlendPlayerOptions blend;
  FootHoldOptions feet;
  retarget::AdaptOptions adapt;
  /// The ground under the feet; nullptr: level, at height 0. It displaces the whole body,
  /// after blend and models: goals on the floor are on the level floor.
  std::shared_ptr<const Floor> floor{};
};

/// State of a character after a step.
struct CharacterReport {
  TransitionReport transition;
  retarget::AdaptReport adapt;   ///< For kKinematic and above.
  std::array<bool, 2> stands{};  ///< Left, right: the foot is held.
  /// Displacement of the floor under each foot since the start, while it stood. [m]
  std::array<glm::dvec3, 2> floor_moved_m{};
};

/// Plays actions on one body: blend, expansion, feet on the floor Y = 0, adaptation.
class CharacterPlayer {
 public:
  /// Errors (bad input): those of Adapter::make(); a body without arms; a constraint with
  /// an id of the supports ("support left", "support right").
  [[nodiscard]] static Result<CharacterPlayer> make(
      std::shared_ptr<const MotionBase> base, CharacterSpec spec);
  CharacterPlayer(CharacterPlayer&&) noexcept = default;
  CharacterPlayer& operator=(CharacterPlayer&&) noexcept = default;

  /// Computes the posture at time_s, step_s after the last one.
  void step(double time_s, double step_s);
  /// The parts of step(): prepares the posture and the targets of the constraints. True:
  /// the caller adapts adapt_job() at time_s next, and then calls finish_step(). False:
  /// the step is complete.
  [[nodiscard]] bool prepare_step(double time_s, double step_s);
  /// Precondition: the character is a member of a crowd.
  [[nodiscard]] retarget::CrowdJob adapt_job();
  void finish_step();

  /// Moves the adapter out, to become a member of a crowd; join() follows.
  [[nodiscard]] retarget::Adapter leave_adapter() { return std::move(*adapter_); }
  /// Uses this member of a crowd, which was the character's adapter, from now on. The
  /// crowd must outlive the character. Handles of constraints stay valid.
  void join(retarget::Crowd& crowd, std::size_t member);
  [[nodiscard]] retarget::Adapter& adapter() const {
    return crowd_ == nullptr ? *adapter_ : (*crowd_)[member_];
  }

  /// Leads an action to a goal, or a hand to a target, instead of an earlier one.
  void steer(SteerPlayer steer) {
    steer_ = std::make_unique<SteerPlayer>(std::move(steer));
  }
  void reach(ReachPlayer reach);
  [[nodiscard]] SteerPlayer* steering() { return steer_ ? &*steer_ : nullptr; }
  /// nullptr: that hand (0 left, 1 right) does not reach.
  [[nodiscard]] ReachPlayer* reaching(int side);
  /// Leads a hand through a throw, instead of an earlier throw or reach of that hand.
  void play_throw(ThrowPlayer made);
  /// The last throw of a hand, also after it is over, for its result; nullptr: none.
  [[nodiscard]] ThrowPlayer* throwing(int side);
  [[nodiscard]] const ThrowPlayer* throwing(int side) const;
  /// Returns a jump of a clip on this body; prepares it if it is the first of this clip.
  /// Errors: JumpBody::make()'s.
  [[nodiscard]] Result<std::shared_ptr<const JumpBody>> jump_body(std::size_t clip,
                                                                  int jump);
  /// Adds a clip of this character alone, in place of one that no action plays. Returns
  /// its position in the base of blend().
  [[nodiscard]] std::size_t add_clip(MotionClip clip);
  /// Errors: FollowPlayer::make()'s; no such constraint; its goal has no point, or a
  /// distance.
  [[nodiscard]] Result<FollowPlayer> make_follow(ActionId id,
                                                 const FollowWish& wish) const;
  /// Answers whether a point can follow to a target. Errors: those of make_follow().
  [[nodiscard]] Result<FollowFeasibility> ask_follow(const FollowWish& wish,
                                                     double step_s) const;
  /// Leads a point after a target, instead of an earlier one of that point.
  void follow(FollowPlayer made);
  /// nullptr: no follow of this id.
  [[nodiscard]] FollowPlayer* following(ActionId id);
  [[nodiscard]] const FollowPlayer* following(ActionId id) const;
  [[nodiscard]] std::span<FollowPlayer> follows() { return follows_; }
  [[nodiscard]] bool can_reach() const { return reach_handles_[0].has_value(); }

  [[nodiscard]] BlendPlayer& blend() { return blend_; }
  [[nodiscard]] const BlendPlayer& blend() const { return blend_; }
  [[nodiscard]] const Character& character() const { return *character_; }
  [[nodiscard]] const retarget::BodyMap& map() const { return *map_; }
  [[nodiscard]] const Pose& pose() const { return pose_; }
  /// Height by which the blend is lifted to the floor.
  [[nodiscard]] double lift_m() const { return floor_.lift_m(); }
  /// The posture before feet and constraints.
  [[nodiscard]] const Pose& reference() const { return reference_; }
  [[nodiscard]] std::span<const RigidTransform> world_from_joint() const;
  [[nodiscard]] const CharacterReport& report() const { return report_; }
  /// Returns the handle of a constraint of the spec; nullopt: the id is unknown.
  [[nodiscard]] std::optional<retarget::Adapter::Handle> constraint(std::string_view id) {
    return adapter().constraint(id);
  }
  /// Picks up or puts down a load of the character. No load is carried at first. False:
  /// it has no load of this name.
  bool carry(std::string_view load, bool carried) {
    return adapter().carry(load, carried);
  }
  /// Changes the level: over 0.2 s from and to kBlended. kKinetic needs a spec of
  /// kKinetic.
  void set_level(DetailLevel level) { level_ = level; }
  [[nodiscard]] DetailLevel level() const { return level_; }

 private:
  CharacterPlayer(std::shared_ptr<const MotionBase> base,
                  CharacterSpec spec,
                  std::vector<FollowPoint> points,
                  retarget::Adapter adapter);
  [[nodiscard]] FootReference foot_reference(std::size_t side, double time_s) const;
  void meet_floor(double step_s);
  void hold_feet(double time_s, double step_s);
  void ride_floor(double time_s, double step_s);
  void lead_feet(const std::array<FootHold::Place, 2>& places, double share);
  void steer_root(double time_s, double step_s);
  void move_throws(double time_s, double step_s);
  void move_hands(double time_s, double step_s);
  void move_follows(double time_s, double step_s);
  void drop_hand(std::size_t side);
  void keep_shown();
  void drop_follow(std::size_t side);

  std::shared_ptr<const Character> character_;
  std::shared_ptr<const retarget::BodyMap> map_;
  BlendPlayer blend_;
  FootHoldOptions foot_options_;
  DetailLevel level_ = DetailLevel::kKinematic;
  double activation_ = 1.0;                     ///< For supports, before smoothing.
  std::unique_ptr<retarget::Adapter> adapter_;  ///< nullptr: it is in the crowd.
  retarget::Crowd* crowd_ = nullptr;
  std::size_t member_ = 0;
  std::array<std::optional<retarget::Adapter::Handle>, 2> supports_{};
  /// By hand: the point, then the rotation.
  std::array<std::optional<retarget::Adapter::Handle>, 4> reach_handles_{};
  std::array<std::unique_ptr<ReachPlayer>, 2> reaches_{};
  std::array<std::unique_ptr<ThrowPlayer>, 2> throws_{};
  std::vector<FollowPoint> points_;  ///< Points that may follow.
  std::vector<FollowPlayer> follows_;
  ClipConstraints clip_constraints_;
  struct PreparedJump {
    std::size_t clip = 0;
    int jump = 0;
    std::shared_ptr<const JumpBody> body;
  };
  std::vector<PreparedJump> jumps_;
  std::unique_ptr<SteerPlayer> steer_;
  double steered_rad_ = 0.0;                  ///< In this step.
  BodyShift shift_;                           ///< After the last step.
  std::vector<RigidTransform> shown_joints_;  ///< After the last step, for follows.
  double time_s_ = 0.0;
  std::array<FootHold, 2> feet_{};
  FloorLevel floor_;
  std::shared_ptr<const Floor> ground_;
  FloorRide ride_;
  RootPull pull_;
  std::array<glm::dvec2, 2> ankle_xz_m_{};     ///< As the feet stood in the last step.
  std::array<std::array<bool, 2>, 2> bore_{};  ///< [foot][heel, ball], with hysteresis.
  std::vector<RigidTransform> world_from_joint_;
  Pose reference_;
  Pose pose_;
  bool is_adapted_ = false;  ///< The last pose is the adapter's.
  CharacterReport report_;
};

}  // namespace marey::engine
