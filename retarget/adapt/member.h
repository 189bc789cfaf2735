// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/adapt/adapter_options.h"
#include "retarget/adapt/member_block.h"
#include "retarget/adapt/shared_plan.h"
#include "retarget/constraints/activation.h"

namespace marey::retarget {

/// View of the block of memory that holds the state of one adapter: a MemberHead and
/// arrays (MemberLayout). A block is trivially copyable. Adapters own their blocks; a
/// crowd has those of its members next to each other.
class Member {
 public:
  Member() = default;
  Member(std::byte* block, const MemberLayout& layout) : at_(block), layout_(&layout) {}

  [[nodiscard]] std::byte* block() const { return at_; }
  /// Bytes at the beginning of the block that every posture needs.
  [[nodiscard]] std::size_t hot_bytes() const { return layout_->activations_at; }
  [[nodiscard]] MemberHead& head() const { return *reinterpret_cast<MemberHead*>(at_); }
  /// In the order of the constraint set.
  [[nodiscard]] std::span<MemberTarget> targets() const {
    return array<MemberTarget>(layout_->targets_at, layout_->constraints);
  }
  [[nodiscard]] std::span<LiveActivation> activations() const {
    return array<LiveActivation>(layout_->activations_at, layout_->constraints);
  }
  [[nodiscard]] std::span<ConstraintOutcome> outcomes() const {
    return array<ConstraintOutcome>(layout_->outcomes_at, layout_->constraints);
  }
  [[nodiscard]] std::span<RigidTransform> world_from_joint() const {
    return array<RigidTransform>(layout_->joints_at, layout_->joints);
  }
  /// Constants of the body (body_numbers()).
  [[nodiscard]] std::span<float> numbers() const {
    return array<float>(layout_->numbers_at, layout_->numbers);
  }
  /// In the order of Plan::masses.
  [[nodiscard]] std::span<MemberMass> masses() const {
    return array<MemberMass>(layout_->masses_at, layout_->masses);
  }
  [[nodiscard]] std::span<char> carried() const {
    return array<char>(layout_->carried_at, layout_->masses - layout_->own_masses);
  }

  /// Carries a load or puts it down.
  void carry(std::size_t load, bool carried) const;
  [[nodiscard]] glm::dvec3 centre_of_mass_in_world(const Plan& plan) const;
  /// Writes the packed result of a solve (store_result()) into `out` and into the block:
  /// transforms, outcomes and report.
  void write(const Plan& plan, const float* result, Pose& out) const;

 private:
  template <class T>
  [[nodiscard]] std::span<T> array(std::size_t at, std::size_t count) const {
    return {reinterpret_cast<T*>(at_ + at), count};
  }
  void update_report(const Plan& plan, const float* errors) const;

  std::byte* at_ = nullptr;
  const MemberLayout* layout_ = nullptr;
};

/// Aligned memory of one or more blocks.
class MemberMemory {
 public:
  MemberMemory() = default;
  explicit MemberMemory(std::size_t bytes);
  [[nodiscard]] std::byte* get() const { return bytes_.get(); }

 private:
  struct Free {
    void operator()(std::byte* bytes) const;
  };
  std::unique_ptr<std::byte, Free> bytes_;
};

/// Starts the block of a new adapter. Loads are not carried.
void begin_member(const SharedPlan& shared,
                  const Character& character,
                  const ConstraintSet& constraints,
                  const AdaptOptions& options,
                  const Member& member);

/// Computes what depends on the plan again, when the plan has changed.
void replan_member(const SharedPlan& shared,
                   const Character& character,
                   const Member& member);

/// Normalizes to double precision: one Newton step from single precision, without a
/// square root.
[[nodiscard]] inline glm::dquat unit_rotation(double w, double x, double y, double z) {
  const double s = 1.5 - 0.5 * (w * w + x * x + y * y + z * z);
  return {s * w, s * x, s * y, s * z};
}

}  // namespace marey::retarget
