// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a flat tag that one camera sees has two readings, and a posture
// that starts in the wrong one stays there.

#include <optional>
#include <span>

#include "reconstruct/tag_model.h"

namespace marey::reconstruct {

/// Head, hands and feet: bones that turn freely at the end of a chain.
struct ChainEnd {
  HumanBone bone;
  Slot slot;
};
inline constexpr std::array<ChainEnd, 5> kChainEnds{
    {{HumanBone::kHead, Slot::kHead},
     {HumanBone::kLeftHand, Slot::kLeftHand},
     {HumanBone::kRightHand, Slot::kRightHand},
     {HumanBone::kLeftFoot, Slot::kLeftFoot},
     {HumanBone::kRightFoot, Slot::kRightFoot}}};

/// Tries both readings of the tags of chain ends. No allocation once it is made. Borrows
/// the model.
class TagReadings {
 public:
  explicit TagReadings(const TagModel& model);

  /// Turns the end to the reading that costs less, habits and `before` considered (its
  /// rotation one frame earlier, from which it turns by no more than some tenths of a
  /// radian); true where that is not the reading it is in. Ends that show two tags or two
  /// cameras have one reading only and are left alone. Some 0.2 ms where there are two.
  [[nodiscard]] bool reconsider(const ChainEnd& end,
                                std::span<const SeenTag> seen,
                                const TagFrameSolver::Beside& beside,
                                const glm::dquat& before,
                                Posture& posture);

 private:
  [[nodiscard]] double refine(const ChainEnd& end,
                              const TagFrameSolver::Beside& beside,
                              const glm::dquat& before,
                              Posture& posture);

  const TagModel* model_;
  TagFrameSolver solver_;
  std::vector<SeenTag> own_;
};

}  // namespace marey::reconstruct
