// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "app/live_chain/live_settings.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/adapt/adapter.h"
#include "retarget/motion/live_retarget.h"

namespace marey::app {

/// A handle as it is now.
struct HandleState {
  std::string_view id;
  JointIndex joint{};
  bool active = false;
  /// Where its joint is wanted, or, of one that is not active, was when step() last ran.
  glm::dvec3 p_in_world{0.0};
};

/// One avatar with handles at head, hands, feet and hips that people drag while it moves:
/// the constraints of a running adapter (Kulpa 2005, 7.1). What is dragged goes there, the
/// rest of the body as the adapter finds it; feet that stand stay where they are. A handle
/// that was let go of keeps its place until it is stopped.
///
/// Same postures, time steps and requests, same answers, to the bit. Allocates nothing
/// after make(). Costs nothing while nothing is held, else an Adapter::adapt().
class LiveHandles {
 public:
  static constexpr double kFade_s = 0.2;         ///< Of handles, in and out.
  static constexpr double kSupportFade_s = 0.1;  ///< Of feet that begin or cease to stand.
  /// Time constant with which a target follows what is dragged: requests come in steps.
  static constexpr double kFollow_s = 0.03;

  /// Errors: map_body()'s, make_character()'s.
  [[nodiscard]] static Result<LiveHandles> make(const std::string& name,
                                                const Skeleton& avatar);

  /// Takes hold of a handle, moves it, leaves or stops it. Handles that there are not are
  /// passed over.
  void ask(const HandleRequest& request);

  /// Brings the avatar's next posture to what is held. While nothing is, and has faded
  /// out, `posture` is left as it is, to the bit.
  /// Preconditions: `world_from_joint` is of `posture`, which is of the avatar;
  /// since_last_s > 0.
  void step(std::span<const RigidTransform> world_from_joint,
            const std::array<retarget::StandingFoot, 2>& standing,
            double since_last_s,
            Pose& posture);

  /// Since the last step() something is held, or fades out.
  [[nodiscard]] bool is_busy() const { return busy_; }
  /// In the order of body_handles(). Valid until the next call.
  [[nodiscard]] std::span<const HandleState> handles() const { return states_; }

 private:
  struct Held {
    retarget::Adapter::Handle handle;
    glm::dvec3 target_in_world{0.0};
    bool has_target = false;  ///< The target was somewhere: it follows from there.
  };
  struct Foot {
    retarget::Adapter::Handle support;
    JointIndex joint{};
    std::size_t side = 0;
    bool stands = false;
  };

  explicit LiveHandles(retarget::Adapter adapter) : adapter_(std::move(adapter)) {}
  [[nodiscard]] bool any_active() const;
  [[nodiscard]] bool is_dragged(JointIndex joint) const;
  void follow(double since_last_s);
  void stand(std::span<const RigidTransform> world_from_joint,
             const std::array<retarget::StandingFoot, 2>& standing);
  void look();

  retarget::Adapter adapter_;
  std::vector<Held> held_;  ///< By handle.
  std::vector<HandleState> states_;
  std::vector<Foot> feet_;
  Pose adapted_;
  double time_s_ = 0.0;  ///< Of the steps that were made.
  bool busy_ = false;
};

}  // namespace marey::app
