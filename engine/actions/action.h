// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "engine/blend/posture_groups.h"
#include "engine/sync/phase_warp.h"

namespace marey::engine {

/// Number of an action of one engine: ascends with each request.
enum class ActionId : std::int64_t {};

[[nodiscard]] constexpr std::int64_t number(ActionId id) {
  return static_cast<std::int64_t>(id);
}

/// When a requested action begins.
struct ActionStart {
  enum class Kind {
    kNow,      ///< With the next step.
    kAtTime,   ///< At `time_s` of the engine.
    kAfter,    ///< When `action` begins to fade out.
    kAtEvent,  ///< When `action` next passes the event `event` of its clip.
  };
  Kind kind = Kind::kNow;
  double time_s = 0.0;
  ActionId action{};
  std::string event;
};

/// Transition from the actions that a new one replaces.
enum class TransitionKind {
  /// Synchronised if a plan with less than 0.05 s of incompatible supports exists, else
  /// inertial.
  kAuto,
  kCrossfade,     ///< Both are played, at any phase.
  kSynchronised,  ///< Both are played, the supports matched as well as possible.
  kInertial,      ///< The old ones end at once; their difference decays.
  kCut,           ///< The old ones end at once.
};

/// Returns the priorities of one group alone.
[[nodiscard]] constexpr PerGroup only(EditGroup group) {
  PerGroup out{};
  out[static_cast<std::size_t>(group)] = 1.0F;
  return out;
}
/// Returns the same priority for the whole body.
[[nodiscard]] constexpr PerGroup whole_body(float priority = 1.0F) {
  PerGroup out{};
  for (float& p : out) p = priority;
  return out;
}

/// A request to play a clip.
struct ActionWish {
  std::string clip;
  PerGroup priority = whole_body();  ///< By group of the body; 0: leaves it alone.
  double weight = 1.0;
  /// Actions of a higher layer cover those of lower ones. nullopt: 0 for actions of the
  /// legs, else 1.
  std::optional<int> layer{};
  double fade_in_s = 0.3;
  double fade_out_s = 0.3;
  double rate = 1.0;  ///< Clip seconds per second.
  /// The clip is repeated without end. nullopt: if the clip is a loop.
  std::optional<bool> loops{};
  ActionStart start;
  TransitionKind transition = TransitionKind::kAuto;
  /// Time in the clip at which it begins. nullopt: its start, or anywhere in a loop.
  std::optional<double> entry_s{};
  /// Synchronised and inertial transitions may begin this much earlier or later in the
  /// clip. 0: exactly there.
  double entry_search_s = 0.5;
  /// Ends the actions of its layer that move a group that it moves.
  bool replaces = true;
};

/// State of an action.
enum class ActionPhase { kQueued, kFadingIn, kHolding, kFadingOut, kDone };

/// The warp of an action: one of the few that its character keeps for actions that play.
/// Preconditions of the functions that call it: the action is alive.
class ActionWarp {
 public:
  [[nodiscard]] PhaseWarp* get() const { return at_; }
  void place(PhaseWarp* at) { at_ = at; }
  void start(double now_s, double source_s, double rate) const {
    at_->start(now_s, source_s, rate);
  }
  bool replan(double now_s,
              std::span<const WarpKnot> knots,
              double end_rate,
              double keep_s = 0.1) const {
    return at_->replan(now_s, knots, end_rate, keep_s);
  }
  [[nodiscard]] double source_s(double time_s) const { return at_->source_s(time_s); }
  [[nodiscard]] double rate(double time_s) const { return at_->rate(time_s); }

 private:
  PhaseWarp* at_ = nullptr;
};

/// An action of a character.
struct Action {
  ActionId id{};
  std::size_t clip = 0;  ///< Not used by a live source.
  bool is_live = false;  ///< Plays a live source, not a clip.
  int layer = 0;
  PerGroup priority{};
  PerGroup source_share =
      whole_body();  ///< Factor on the priority; a live source sets it.
  float weight = 1.0F;
  double fade_in_s = 0.0;
  double fade_out_s = 0.0;
  double rate = 1.0;
  bool loops = false;
  bool replaces = true;
  ActionStart::Kind start = ActionStart::Kind::kNow;
  double start_s =
      0.0;  ///< For kAtTime; for kAtEvent the time of the event in the other clip.
  ActionId after{};
  TransitionKind transition = TransitionKind::kAuto;
  std::optional<double> entry_s{};
  double entry_search_s = 0.0;

  ActionPhase phase = ActionPhase::kQueued;
  double started_s = 0.0;
  double stopped_s = std::numeric_limits<double>::infinity();
  ActionWarp warp;

  [[nodiscard]] bool is_alive() const {
    return phase != ActionPhase::kQueued && phase != ActionPhase::kDone;
  }
  /// Greatest priority on a leg, times the weight.
  [[nodiscard]] float leg_priority() const;
  /// Share of the fades at a time of the engine, 0 to 1; C2.
  [[nodiscard]] double fade(double time_s) const;
};

/// Maximum number of actions that a character blends; a further one ends the least
/// important one, whose difference decays.
inline constexpr std::size_t kMaxAlive = 4;
/// Maximum number of actions of a character, with the waiting ones.
inline constexpr std::size_t kMaxActions = 16;

}  // namespace marey::engine
