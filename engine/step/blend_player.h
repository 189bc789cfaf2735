// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/actions/action.h"
#include "engine/blend/blend_postures.h"
#include "engine/clips/motion_base.h"
#include "engine/clips/rig.h"
#include "engine/clips/sample_clip.h"
#include "engine/feet/root_anchor.h"
#include "engine/step/live_player.h"
#include "engine/transition/inertial_offset.h"

namespace marey::engine {

/// Outcome of the last transition of the legs.
struct TransitionReport {
  bool is_synchronised = false;
  bool is_inertial = false;
  /// Incompatible supports within the next 1.2 s, of the plan that was used or rejected.
  double incompatible_s = 0.0;
};

struct BlendPlayerOptions {
  double half_life_s = 0.1;  ///< For inertial offsets.
  double max_incompatible_s = 0.10;
  double anchor_fade_s = 0.05;
  /// A fade may begin later if it has 0.9 of its weight within this time.
  double settle_s = 0.35;
  bool anchors_root = true;
};

/// Actions of one character, their synchronisation, and the posture that is their blend,
/// on no body in particular. One step costs a few microseconds and allocates nothing.
class BlendPlayer {
 public:
  BlendPlayer(std::shared_ptr<const MotionBase> base,
              const Rig& rig,
              const RootPlace& start,
              const BlendPlayerOptions& options = {});

  /// Adds an action; it begins in the next step at the earliest.
  /// Precondition: there is room; its clip exists; the id is above all others.
  void add(const Action& action);
  [[nodiscard]] bool has_room() const { return count_ < kMaxActions; }
  /// Begins to fade an action out, or forgets one that waits. False: it is over.
  bool stop(ActionId id);
  void stop_layer(std::optional<int> layer);
  [[nodiscard]] const Action* find(ActionId id) const;
  [[nodiscard]] std::span<const Action> actions() const {
    return {actions_.data(), count_};
  }

  /// Adds the action of a live source, instead of an earlier one.
  /// Precondition: that of add().
  void add_live(const Action& action, const LiveOptions& options);
  /// The live source; nullptr: none was added, or its action is over.
  [[nodiscard]] LivePlayer* live();
  [[nodiscard]] const LivePlayer* live() const;

  /// Moves on from time_s - step_s to time_s. False: nothing was ever played, and there
  /// is no posture.
  bool step(double time_s, double step_s);

  [[nodiscard]] const BlendPosture& posture() const { return shown_; }
  [[nodiscard]] const RootPlace& root() const { return root_; }
  /// Lifts predicted postures, not posture(). [m]
  void set_lift(double lift_m) { lift_m_ = lift_m; }
  [[nodiscard]] double lift_m() const { return lift_m_; }
  /// Predicts posture and root at a later time if nothing changes: from the clips at
  /// their present warps and the offsets as they decay. False: nothing plays. Allocates
  /// nothing.
  [[nodiscard]] bool predict(double now_s,
                             double time_s,
                             BlendPosture& posture,
                             RootPlace& root) const;
  /// Predicts the share with which each part of the feet will bear.
  [[nodiscard]] PerFootPart predict_bears(double time_s) const;
  /// The warp of an action that plays; nullptr: it does not.
  [[nodiscard]] PhaseWarp* warp(ActionId id);

  /// Moves the character, for example to its start.
  void place(const RootPlace& root) { root_ = root; }
  /// Turns the root about a point of the floor, in addition to the clips.
  void turn_about(double x_m, double z_m, double turn_rad);
  /// Share with which each part of the feet bears: not filtered.
  [[nodiscard]] const PerFootPart& bears() const { return bears_; }
  [[nodiscard]] const TransitionReport& report() const { return report_; }

  /// Share with which feet, and not the blend alone, move the root: 1 in transitions of
  /// the legs, 0 without.
  [[nodiscard]] double anchored() const;
  /// True if feet will move the root at a time.
  [[nodiscard]] bool anchors_at(double time_s) const {
    return options_.anchors_root && time_s <= transition_end_s_;
  }

  /// The action with the greatest weight on the legs; nullptr: none, or a live source,
  /// which has no clip.
  [[nodiscard]] const Action* lead() const;
  /// Weight of each action on each group in the last step, in the order of actions().
  [[nodiscard]] const PerGroup& weights(std::size_t action) const {
    return weights_[action];
  }
  [[nodiscard]] const MotionBase& base() const { return *base_; }
  /// Replaces the base by one with the same clips, and others that no action plays.
  void set_base(std::shared_ptr<const MotionBase> base) { base_ = std::move(base); }
  [[nodiscard]] const Rig& rig() const { return rig_; }

 private:
  struct Blend;
  [[nodiscard]] Action* find_mutable(ActionId id);
  void begin_waiting(double time_s, double step_s);
  void step_live(double time_s, double step_s);
  [[nodiscard]] bool enter_in_step(Action& action, double time_s) const;
  /// Samples an action; returns its root's step from `from_s` on. [legs]
  RootPlace sample(const Action& action,
                   double time_s,
                   double from_s,
                   BlendPosture& out) const;
  [[nodiscard]] unsigned bearing_bits(const Action& action, double time_s) const;
  [[nodiscard]] bool may_begin(const Action& action, double time_s, double step_s) const;
  void begin(Action& action, double time_s);
  void retire_replaced(const Action& by, double time_s, bool at_once);
  [[nodiscard]] bool synchronise(Action& action, double time_s, bool always);
  /// Times of a clip at which an action may enter: the middle and half of the width.
  struct EntryRange {
    double middle_s = 0.0;
    double half_s = 0.0;
  };
  [[nodiscard]] static EntryRange entry_range(const Action& action,
                                              const MotionClip& clip);
  void choose_landing(const Action& lead_action,
                      Action& action,
                      const EntryRange& range,
                      double time_s);
  void begin_inertial(Action& action, double time_s);
  void limit_alive(double time_s);
  void place_warp(Action& action, double time_s);
  void end_finished(double time_s);
  [[nodiscard]] std::size_t alive(std::span<const Action*> out) const;
  [[nodiscard]] bool blend_at(double time_s,
                              double from_s,
                              BlendSides& sides,
                              std::array<PerGroup, kMaxActions>& weights,
                              Blend& out) const;
  [[nodiscard]] bool evaluate(double time_s, double step_s, Blend& out);
  void move_root(const Blend& blend, double time_s, double step_s);

  std::shared_ptr<const MotionBase> base_;
  Rig rig_;
  BlendPlayerOptions options_;
  std::array<Action, kMaxActions> actions_{};  ///< Ascending by layer, then by id.
  std::size_t count_ = 0;
  /// For actions that are alive, and one that begins.
  using Warps = std::array<PhaseWarp, kMaxAlive + 1>;
  std::unique_ptr<Warps> warps_ = std::make_unique<Warps>();
  std::array<PerGroup, kMaxActions> weights_{};

  bool is_known_ = false;   ///< There is a posture.
  bool is_broken_ = false;  ///< The blend of this step does not continue the last one.
  bool cuts_ = false;       ///< The break is to be seen.
  BlendSides sides_;
  InertialOffset offset_;
  BlendPosture shown_;
  PostureRates rates_;
  FootPlaces feet_;
  RootPlace root_;
  RootPlace root_rate_;    ///< For the last step, in its heading frame. [1/s]
  RootPlace root_offset_;  ///< Decaying velocity that remains of a break.
  RootPlace root_offset_rate_;
  RootAnchor anchor_;
  double lift_m_ = 0.0;
  double delay_s_ = 0.0;          ///< Until the fade of the action that begins.
  double anchor_strength_ = 0.0;  ///< 0 to 1, before smoothing.
  double transition_end_s_ = -1.0;
  PerFootPart bears_{};
  TransitionReport report_;
  std::unique_ptr<LivePlayer> live_;
};

}  // namespace marey::engine
