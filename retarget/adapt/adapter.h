// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/adapt/adapter_options.h"

namespace marey::retarget {

struct AdapterState;

/// Adapts postures of one character to constraints that may move while it runs.
///
///     auto adapter = Adapter::make(character, constraints, {});
///     adapter->constraint("ctrParade")->set_target(ankle_in_world);
///     adapter->adapt(reference, time_s, posture);
///
/// Each posture depends only on its own reference, the constraints and the time; the same
/// inputs give the same result to the bit. (Exception: a support without a footprint
/// keeps the position that the reference had when the support began.) Costs and accuracy:
/// docs/accuracy/README.md. No function allocates after make(), unless its comment states
/// it.
class Adapter {
 public:
  /// A constraint of a running adapter. Valid for the lifetime of the adapter.
  class Handle {
   public:
    /// Sets the point of a DistanceToPoint, or the footprint of a Support. The posture
    /// moves continuously if the target does. Precondition: finite, and the goal has such
    /// a point.
    void set_target(const glm::dvec3& p_in_world);
    /// Sets the target orientation. Precondition: the goal is a SegmentOrientation or a
    /// Support; unit quaternion.
    void set_orientation(const glm::dquat& world_from_t_pose);
    /// Sets the box of the space. Precondition: the goal is an AllowedSpace or a
    /// ForbiddenSpace; finite, min <= max.
    void set_space(const glm::dvec3& min_in_world, const glm::dvec3& max_in_world);
    /// Moves the constrained point on its segment. A move from or to an offset of zero
    /// (the joint itself) plans again: it is slow, allocates, and is not permitted for a
    /// member of a crowd. Precondition: finite.
    void set_offset(const glm::dvec3& offset_in_t_pose);
    /// Starts or stops the constraint at `time_s`, with its own fade durations.
    void start(double time_s);
    void stop(double time_s);
    /// Multiplies the activation by a share that the caller moves. Precondition: 0 to 1.
    void set_share(double share);
    /// Outcome of the last adapt().
    [[nodiscard]] const ConstraintOutcome& outcome() const;

   private:
    friend class Adapter;
    Handle(AdapterState& state, std::size_t constraint)
        : state_(&state), constraint_(constraint) {}
    AdapterState* state_;
    std::size_t constraint_;
  };

  /// Creates an adapter. Errors (bad input, naming the element): all errors of
  /// check_character() and check_constraints(); options out of range.
  [[nodiscard]] static Result<Adapter> make(const Character& character,
                                            const ConstraintSet& constraints,
                                            const AdaptOptions& options);
  Adapter(Adapter&&) noexcept;
  Adapter& operator=(Adapter&&) noexcept;
  ~Adapter();

  /// Returns the handle of a constraint; nullopt if the id is unknown.
  [[nodiscard]] std::optional<Handle> constraint(std::string_view id);

  /// Sets the target of the centre of mass. nullopt: the position in the reference
  /// posture of the body's centre of mass without loads.
  void set_balance_target(const std::optional<glm::dvec3>& com_in_world);
  /// Picks up or puts down a load of the character. No load is carried initially. Returns
  /// false if the character has no load of this name.
  bool carry(std::string_view load, bool carried);
  /// Replaces the options; permitted between any two postures. A change of `control`
  /// starts at the time of the next posture and fades. A change that is reverted during
  /// the fade returns from the blend of the last posture. Switching balance on or off
  /// allocates. Precondition: in range; the adapter is not a member of a crowd.
  void set_options(const AdaptOptions& options);

  /// Switches balance off, or on again with the mode of the options that the adapter was
  /// made or last set with. Keeps the plan, and so allocates nothing; permitted for
  /// members of a crowd. Precondition: the options have balance.
  void use_balance(bool balance);

  /// Adapts one posture. Precondition: `reference` is a posture of the character's
  /// skeleton, finite, with unit rotations. `out` is resized to the number of joints, so
  /// it allocates at most once.
  AdaptReport adapt(const Pose& reference, double time_s, Pose& out);

  /// Returns the world transforms of the joints after the last adapt(), one per joint.
  [[nodiscard]] std::span<const RigidTransform> world_from_joint() const;
  /// Returns the centre of mass [m] of the posture of the last adapt(), for any value of
  /// `balance`, with the loads that are carried now. Linear in the number of masses.
  /// Precondition: adapt() was called.
  [[nodiscard]] glm::dvec3 centre_of_mass_in_world() const;

 private:
  friend class Crowd;
  explicit Adapter(std::unique_ptr<AdapterState> state);
  std::unique_ptr<AdapterState> state_;
};

}  // namespace marey::retarget
