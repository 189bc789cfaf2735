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

/// Current state of a handle.
struct HandleState {
  std::string_view id;
  JointIndex joint{};
  bool active = false;
  /// Target of its joint; for an inactive handle, the joint's position at the last
  /// step().
  glm::dvec3 p_in_world{0.0};
};

/// Adapts a moving avatar to handles at head, hands, feet and hips that users drag. The
/// handles are constraints of a running adapter (Kulpa 2005, 7.1). A dragged joint moves
/// to its target, the adapter computes the rest of the body, and supporting feet keep
/// their position. A released handle keeps its target until it is stopped.
///
/// The same poses, time steps and requests give bit-identical results. Allocates nothing
/// after make(). Cost: one Adapter::adapt() per step while a handle is active, else none.
class LiveHandles {
 public:
  static constexpr double kFade_s = 0.2;         ///< Fade of handles, in and out.
  static constexpr double kSupportFade_s = 0.1;  ///< Fade of supporting feet.
  /// Time constant of the filter from requests, which come in steps, to the target.
  static constexpr double kFollow_s = 0.03;

  /// Errors: those of map_body() and make_character().
  [[nodiscard]] static Result<LiveHandles> make(const std::string& name,
                                                const Skeleton& avatar);

  /// Starts, moves, releases or stops a handle. Ignores unknown handles.
  void ask(const HandleRequest& request);

  /// Adapts the avatar's next pose to the active handles. If no handle is active and all
  /// have faded out, `posture` is bit-identical to its input. Preconditions: `posture` is
  /// a pose of the avatar, `world_from_joint` belongs to it, and since_last_s > 0.
  void step(std::span<const RigidTransform> world_from_joint,
            const std::array<retarget::StandingFoot, 2>& standing,
            double since_last_s,
            Pose& posture);

  /// Returns true if at the last step() a handle was active or fading out.
  [[nodiscard]] bool is_busy() const { return busy_; }
  /// Returns the handles in the order of body_handles(). Valid until the next call.
  [[nodiscard]] std::span<const HandleState> handles() const { return states_; }

 private:
  struct Held {
    retarget::Adapter::Handle handle;
    glm::dvec3 target_in_world{0.0};
    bool has_target = false;  ///< The filter of the target is initialized.
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
  void update_states();

  retarget::Adapter adapter_;
  std::vector<Held> held_;  ///< By handle.
  std::vector<HandleState> states_;
  std::vector<Foot> feet_;
  Pose adapted_;
  double time_s_ = 0.0;  ///< Sum of the time steps.
  bool busy_ = false;
};

}  // namespace marey::app
