// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "engine/actions/action.h"
#include "engine/clips/motion_base.h"
#include "engine/sources/live_source.h"
#include "engine/sources/stride_phase.h"
#include "engine/sync/phase_lock.h"

#include "core/base/result.h"

namespace marey::engine {

/// A request to play what a performer does: an action without a clip. Postures are
/// pushed; it begins with the second one. Its layer is 1 if none is given, so that clips
/// of layer 0 take over where it gives way.
struct LiveWish {
  ActionWish action;
  LiveOptions options;
};

/// A live source of one character, and the clips that follow its steps.
class LivePlayer {
 public:
  LivePlayer(ActionId action, const LiveOptions& options)
      : action_(action), source_(options) {}

  [[nodiscard]] ActionId action() const { return action_; }
  [[nodiscard]] Status push(const LivePosture& posture) { return source_.push(posture); }
  [[nodiscard]] const LiveSource& source() const { return source_; }

  /// Moves the source on from time_s - step_s to time_s, sets the shares of its action,
  /// and the rates of the clips that move the legs and loop, so that they keep step.
  /// Allocates nothing.
  void step(double time_s,
            double step_s,
            const MotionBase& base,
            std::span<Action> actions);

  /// The performer's stride phase; nullopt: he does not walk, or the action does not move
  /// the legs.
  [[nodiscard]] std::optional<double> lead_phase(double time_s) const;

 private:
  struct Follower {
    ActionId id{};
    bool is_locked = false;  ///< Its rate is not yet its own again.
    bool is_led = false;     ///< The last step had a phase.
    double rate = 1.0;
    PhaseLock lock;
  };
  Follower* follower(const Action& action, std::span<const Action> actions);
  void follow(Follower& by,
              double time_s,
              double step_s,
              const MotionClip& clip,
              Action& action) const;

  ActionId action_{};
  LiveSource source_;
  LeadPhase phase_;
  double observed_s_ = 0.0;  ///< Time of the data that the phase has.
  bool has_observed_ = false;
  bool leads_ = false;
  std::array<Follower, kMaxAlive> followers_{};
};

}  // namespace marey::engine
