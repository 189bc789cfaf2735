// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::engine {

inline constexpr std::size_t kMaxFamilyShares = 4;

/// A captured reach of a family.
struct FamilyMember {
  std::size_t clip = 0;  ///< Index for the caller.
  /// Place of the hand at arrival, in the heading frame of the hips when the reach
  /// starts, from the hips' place on the floor, on the body that plays it. [m]
  glm::dvec3 arrival_in_heading_m{0.0};
  double arrive_s = 0.0;    ///< Time of the event "arrive" since the clip's start; > 0.
  double duration_s = 0.0;  ///< For the clip; at least arrive_s.
};

struct FamilyShare {
  std::size_t clip = 0;
  double weight = 0.0;
  /// Constant rate at which this clip plays, so that all arrive together: clip time is
  /// rate * time since the start.
  double rate = 1.0;
};

/// A blend of members.
struct FamilyBlend {
  std::array<FamilyShare, kMaxFamilyShares> shares{};  ///< Greatest weight first.
  std::size_t count = 0;
  double arrive_s = 0.0;    ///< Common time of arrival since the start.
  double duration_s = 0.0;  ///< Until the first of them ends.
  /// Mean of the arrival places with these weights.
  glm::dvec3 arrival_in_heading_m{0.0};
  [[nodiscard]] double missing_m(const glm::dvec3& target_in_heading_m) const;
};

/// Captured reaches to different places, which are blended to reach places between them
/// (Rose, Cohen & Bodenheimer 1998; Kovar & Gleicher 2004). One member is a family, too.
class ReachFamily {
 public:
  /// Errors (bad input): no member; numbers that are not finite; arrive_s <= 0 or beyond
  /// the duration. Members at one place (within 1 mm) are permitted.
  [[nodiscard]] static Result<ReachFamily> make(std::vector<FamilyMember> members);

  [[nodiscard]] std::span<const FamilyMember> members() const { return members_; }

  /// Chooses up to `max_shares` members nearest to the target, weighs them by the inverse
  /// of their distance, and refines these weights as little as possible so that the mean
  /// of the arrival places is nearest to the target. Weights are at least 0 and their sum
  /// is 1. A target at a member's place gives that member alone. Ties by order. Linear in
  /// members; no allocation.
  /// `correction_m`: the mean of places is only near the arrival of the blended posture;
  /// a caller that knows the latter passes (mean - place of the blend) of an earlier
  /// answer. Precondition: the target is finite; max_shares >= 1.
  [[nodiscard]] FamilyBlend blend(const glm::dvec3& target_in_heading_m,
                                  std::size_t max_shares = kMaxFamilyShares,
                                  const glm::dvec3& correction_m = glm::dvec3(0.0)) const;

 private:
  std::vector<FamilyMember> members_;
};

}  // namespace marey::engine
