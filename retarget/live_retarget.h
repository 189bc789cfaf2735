// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "core/pose.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/find_soles.h"
#include "retarget/live_hands.h"
#include "retarget/live_stance.h"
#include "retarget/normalized_skeleton.h"
#include "retarget/skin.h"

namespace marey::retarget {

struct LiveRetargetOptions {
  RootNormalization root = RootNormalization::kLegLength;
  Soles soles;            ///< Of the avatar, where its skin is known.
  /// The avatar's skin, which is raised out of the floor while feet are held
  /// (retarget/live_skin.h); empty: unknown.
  Skin skin;
  bool hold_feet = true;  ///< Feet that stand in the source stand still on the avatar.
  LiveStanceOptions stance;
  double land_s = 0.08;     ///< A landing foot takes this long to lie flat.
  double release_s = 0.25;  ///< A leaving foot takes this long to its own way again.
  double rise_s = 0.3;      ///< Time constant of hips rising after they had to sink.
  /// A foot that would have to stay further than this behind the source's slips. [legs]
  double slip_legs = 0.3;
  /// What hands do to the body is kept, arms stay out of it; nullopt: arms stay where the
  /// normalized posture has them.
  std::optional<LiveHandsOptions> hands = LiveHandsOptions{};
};

/// Puts one performer's motion on one avatar, posture by posture, knowing nothing of the
/// future: what retarget_motion() is for whole motions. A foot that comes to rest in the
/// source stands where it is on the avatar, to the micrometre, until it leaves; hips sink
/// at once where a standing leg would not reach, and rise again slowly. Hands that are near
/// the body stay as near on the avatar, arms out of it (retarget/live_hands.h). Skin that
/// would be in the floor is raised out of it, feet that stand with it.
///
/// Same postures and time steps, same answers, to the bit. The source's floor is Y = 0.
/// Costs some ten microseconds a posture; allocates nothing after make().
class LiveRetarget {
 public:
  /// Errors: map_bodies()'s.
  [[nodiscard]] static Result<LiveRetarget> make(const Skeleton& source,
                                                 const Skeleton& avatar,
                                                 const LiveRetargetOptions& options = {});
  LiveRetarget(LiveRetarget&&) noexcept;
  LiveRetarget& operator=(LiveRetarget&&) noexcept;
  ~LiveRetarget();

  /// `since_last_s`: since the posture before (of the first one it says nothing).
  /// Preconditions: a finite posture of the source; since_last_s > 0; `out` is resized
  /// once.
  void step(const Pose& source, double since_last_s, Pose& out);
  /// The next posture is taken as a first one: the performer was lost, or jumped.
  void forget();

  /// As judged in the source by the last step(). Left, right.
  [[nodiscard]] const std::array<StandingFoot, 2>& standing() const;
  /// The avatar's joints in the world after the last step().
  [[nodiscard]] std::span<const RigidTransform> world_from_joint() const;

 private:
  struct State;
  explicit LiveRetarget(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace marey::retarget
