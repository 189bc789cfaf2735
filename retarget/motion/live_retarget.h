// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "core/base/result.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/find_soles.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/skin.h"
#include "retarget/feet/live_foot.h"
#include "retarget/feet/live_stance.h"
#include "retarget/hands/live_hands.h"

namespace marey::retarget {

struct LiveRetargetOptions {
  RootNormalization root = RootNormalization::kLegLength;
  Soles soles;  ///< Soles of the avatar, if its skin is known.
  /// The avatar's skin, raised out of the floor while feet are held
  /// (retarget/feet/live_skin.h); empty: unknown.
  Skin skin;
  bool hold_feet = true;  ///< Feet that stand in the source stand still on the avatar.
  LiveStanceOptions stance;
  LiveFootOptions foot;
  double rise_s = 0.3;  ///< Time constant of the hips' rise after they had to sink.
  /// Options for keeping hand contacts and moving arms out of the body; nullopt: arms
  /// keep the normalized posture.
  std::optional<LiveHandsOptions> hands = LiveHandsOptions{};
};

/// Retargets one performer's motion to one avatar, posture by posture, without future
/// frames: the live counterpart of retarget_motion(). A foot that comes to rest in the
/// source stays at its position on the avatar, to the micrometre, until it leaves. Hips
/// sink immediately where a standing leg would not reach, and rise again slowly. Hands
/// near the body stay as near on the avatar, and arms outside of it
/// (retarget/hands/live_hands.h). Skin in the floor is raised out of it, together with
/// standing feet.
///
/// Deterministic to the bit for the same postures and time steps. The source's floor is Y
/// = 0. Costs some ten microseconds per posture; allocates nothing after make().
class LiveRetarget {
 public:
  /// Creates a retargeter. Errors: those of map_bodies().
  [[nodiscard]] static Result<LiveRetarget> make(const Skeleton& source,
                                                 const Skeleton& avatar,
                                                 const LiveRetargetOptions& options = {});
  LiveRetarget(LiveRetarget&&) noexcept;
  LiveRetarget& operator=(LiveRetarget&&) noexcept;
  ~LiveRetarget();

  /// Retargets one posture. `since_last_s`: time since the previous posture (ignored for
  /// the first one). Preconditions: a finite posture of the source; since_last_s > 0;
  /// `out` is resized once.
  void step(const Pose& source, double since_last_s, Pose& out);
  /// Resets the state: the next posture is treated as the first one, after the performer
  /// was lost or jumped.
  void reset();

  /// Returns the standing feet, left and right, detected in the source by the last
  /// step().
  [[nodiscard]] const std::array<StandingFoot, 2>& standing() const;
  /// Returns the avatar's joints in the world after the last step().
  [[nodiscard]] std::span<const RigidTransform> world_from_joint() const;

 private:
  struct State;
  explicit LiveRetarget(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace marey::retarget
