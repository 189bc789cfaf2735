// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/pose.h"
#include "retarget/adapt/kernel/lane_kernel.h"
#include "retarget/adapt/member.h"

namespace marey::retarget {

/// Inputs of one solve in packed form: all numbers of a lane except the body's own.
/// Bodies with the same plan may use one instance in turn, so that it stays in the L1
/// cache.
struct PackedProblem {
  std::vector<float> posture;
  std::vector<float> targets;
  std::array<float, kBalanceNumbers> balance{};
  std::vector<TargetNumbers> numbers;  ///< In the order of plan.points; `targets` are
                                       ///< computed from them.
  std::vector<double> activations;     ///< In the order of plan.points.
  double max_weight = 0.0;             ///< Largest weight of the active constraints.
  std::vector<double> ramps;           ///< Distinct activations below 1, descending.
  std::vector<float> firmness;         ///< Per target: fraction of the distance to close,
                                       ///< 0 to 1, while constraints fade.
  explicit PackedProblem(const Plan& plan);
};

/// Packs all inputs of a solve. Returns false if constraints or the control fade, so that
/// several solves are needed. Repeatable: the same inputs give the same result.
[[nodiscard]] bool prepare_member(const Plan& plan,
                                  const Member& member,
                                  const Pose& reference,
                                  double time_s,
                                  PackedProblem& problem);

/// Returns true if a constraint of the member fades at this time.
[[nodiscard]] bool is_fading(const Member& member, double time_s);

/// One of the solves whose results are blended while constraints fade
/// (kernel/fade_mean.h).
struct FadePass {
  Control control = Control::kPriority;
  double min_activation = 1.0;  ///< It has the targets with at least this activation.
  float share = 1.0F;           ///< Weight of its posture.
};

/// Returns the number of solves of a problem that fades.
[[nodiscard]] int fade_pass_count(const MemberHead& head, const PackedProblem& problem);
/// Returns one of them. Constraints of the old control come first.
[[nodiscard]] FadePass fade_pass(const MemberHead& head,
                                 const PackedProblem& problem,
                                 int number);

/// Packs the targets of one solve.
void pack_pass(const Plan& plan,
               const Member& member,
               const FadePass& pass,
               PackedProblem& problem);

/// Packs the targets that the blended posture is closed on, and their firmness.
void pack_mean(const Plan& plan, const Member& member, PackedProblem& problem);

/// Returns the inputs common to solves with these options.
[[nodiscard]] LaneTask task_of(const SharedPlan& shared,
                               const AdaptOptions& options,
                               Control control);

/// Prefetch the memory that prepare_member() and Member::write() need.
void prefetch_member(const Member& member);
void prefetch_pose(const Pose& pose);
/// Prefetches the memory of the posture itself, which holds an address.
void prefetch_address(const Pose& pose);

}  // namespace marey::retarget
