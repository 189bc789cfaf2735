// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: planar ambiguity. A flat tag that one camera sees has two poses
// that fit; a solver that starts from the wrong one does not leave it.

#include <optional>
#include <span>

#include "reconstruct/tags/tag_model.h"

namespace marey::reconstruct {

/// Head, hands and feet: bones at the end of a chain that rotate freely.
struct ChainEnd {
  HumanBone bone;
  PoseParameter parameter;
};
inline constexpr std::array<ChainEnd, 5> kChainEnds{
    {{HumanBone::kHead, PoseParameter::kHead},
     {HumanBone::kLeftHand, PoseParameter::kLeftHand},
     {HumanBone::kRightHand, PoseParameter::kRightHand},
     {HumanBone::kLeftFoot, PoseParameter::kLeftFoot},
     {HumanBone::kRightFoot, PoseParameter::kRightFoot}}};

/// Tries both planar poses of the tags of chain ends. No allocation after construction.
/// Borrows the model.
class PlanarPoseAmbiguity {
 public:
  explicit PlanarPoseAmbiguity(const TagModel& model);

  /// Rotates the end to the planar pose with the lower cost, including pose priors and
  /// `before` (its rotation one frame earlier, from which it turns by at most some tenths
  /// of a radian). Returns true if the pose changed. Ends that show two tags, or are seen
  /// by two cameras, are not ambiguous and are not changed. Cost: some 0.2 ms if there
  /// are two poses.
  [[nodiscard]] bool reconsider(const ChainEnd& end,
                                std::span<const SeenTag> seen,
                                const TagFrameSolver::SolveInputs& inputs,
                                const glm::dquat& before,
                                Posture& posture);

 private:
  [[nodiscard]] double refine(const ChainEnd& end,
                              const TagFrameSolver::SolveInputs& inputs,
                              const glm::dquat& before,
                              Posture& posture);

  const TagModel* model_;
  TagFrameSolver solver_;
  std::vector<SeenTag> own_;
};

}  // namespace marey::reconstruct
