// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: re-acquisition of a posture from tags, without a prior.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/clusters/locate_rigid.h"
#include "reconstruct/posture/initial_posture.h"
#include "reconstruct/tags/tag_model.h"

namespace marey::reconstruct {

/// Finds postures without a prior: locates each bone by its own tags, places the body
/// between them, then minimizes the cost. Limbs that do not fit are started from every
/// planar pose of their tags. Allocates in the constructor, not in find(). Borrows the
/// model.
class TagPoseRelocalizer {
 public:
  explicit TagPoseRelocalizer(const TagModel& model);

  /// Finds a posture. nullopt if neither hips nor chest are located unambiguously, or if
  /// the posture does not explain most sightings. Some 10 ms with 30 sightings.
  [[nodiscard]] std::optional<Posture> find(std::span<const SeenTag> seen);

  /// Starts a limb of `posture` again from every planar pose of its tags and keeps the
  /// one with the least cost. Returns true if its attitude changed. With `inputs.prior`
  /// the search is limited to the neighbourhood of the expected pose and the rest of the
  /// body is held: some 0.3 ms per sighting. Without it the whole body is free.
  [[nodiscard]] bool retry_limb(std::size_t limb,
                                std::span<const SeenTag> seen,
                                const TagFrameSolver::SolveInputs& inputs,
                                const FrameLimits& limits,
                                Posture& posture);

  /// Returns true if a tag of the limb is further from its model than noise explains.
  /// `fits` as from TagFrameSolver::fit().
  [[nodiscard]] bool limb_misfits(std::size_t limb,
                                  std::span<const SeenTag> seen,
                                  std::span<const SightingFit> fits) const;

 private:
  void set_motion_prior(std::size_t limb,
                        const Posture& start,
                        const PosturePrior& prior);
  void locate(std::span<const SeenTag> seen);
  [[nodiscard]] std::optional<RigidTransform> locate_bone(HumanBone bone,
                                                          std::span<const SeenTag> seen);

  const TagModel* model_;
  TagFrameSolver solver_;
  FoundSegments found_;
  std::vector<RigidPointView> views_;
  std::vector<RigidTransform> starts_;
  std::vector<SightingFit> fits_;
  std::vector<SeenTag> own_;  ///< The sightings of one limb.
  PosturePrior motion_prior_;
};

/// Corners with a larger root mean square distance to their expected positions are not
/// explained by noise or blur. [px]
inline constexpr double kLostPx = 3.0;

}  // namespace marey::reconstruct
