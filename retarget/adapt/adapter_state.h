// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "retarget/adapt/adapter_options.h"
#include "retarget/adapt/kernel/lane_kernel.h"
#include "retarget/adapt/member.h"
#include "retarget/adapt/prepare_member.h"
#include "retarget/adapt/shared_plan.h"

namespace marey::retarget {

/// Work arrays for one posture at a time.
struct AdapterWork {
  std::unique_ptr<LaneKernel> kernel;  ///< One lane.
  PackedProblem problem;
  explicit AdapterWork(const Plan& plan);
};

/// Adapts one posture of one member.
void adapt_member(const SharedPlan& shared,
                  const Member& member,
                  const Pose& reference,
                  double time_s,
                  Pose& out,
                  AdapterWork& work);

/// Parts of an adapter that a crowd holds for all its members.
struct MembersStore {
  std::vector<std::byte*> blocks;  ///< One per member.
  /// For postures that a member adapts by itself, one member at a time.
  AdapterWork work;
  std::mutex work_is_used;
  explicit MembersStore(const SharedPlan& shared);
  /// Makes place for more members. Blocks stay where they are.
  void grow(std::size_t count);

 private:
  std::size_t block_bytes_;
  std::vector<MemberMemory> chunks_;
};

/// Parts of an adapter that a member of a crowd does not need: inputs of its plan, and
/// its own memory.
struct AdapterOwn {
  Character character;
  ConstraintSet constraints;
  MemberMemory block;
  AdapterWork work;
};

/// An adapter: its block of memory and the shared plan.
struct AdapterState {
  std::shared_ptr<const SharedPlan> shared;
  std::shared_ptr<const AdapterNames> names;
  Member member;
  std::unique_ptr<AdapterOwn> own;      ///< nullptr for a member of a crowd.
  std::shared_ptr<MembersStore> store;  ///< For a member of a crowd.

  AdapterState(const Character& character,
               const ConstraintSet& constraints,
               const AdaptOptions& options);

  [[nodiscard]] bool is_member() const { return own == nullptr; }
  /// Called before `to` becomes the options. Starts a fade to the other control, or
  /// reverses the running fade from the blend of the last posture.
  void turn_passage(const AdaptOptions& to);
  /// Rebuilds the plan after its inputs changed. Allocates. Precondition: no member of a
  /// crowd.
  void replan();
  AdaptReport adapt(const Pose& reference, double time_s, Pose& out);
  /// Moves the block to `place` in `all`, takes the plan and equal names of `first`, and
  /// frees the rest. Precondition: the plan equals that of `first`.
  void join(const AdapterState& first,
            const std::shared_ptr<MembersStore>& all,
            std::size_t place);
};

}  // namespace marey::retarget
