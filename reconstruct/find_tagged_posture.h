// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the posture of a frame of which nothing is known but tags.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/initial_posture.h"
#include "reconstruct/locate_rigid.h"
#include "reconstruct/tag_model.h"

namespace marey::reconstruct {

/// Finds postures from nothing: each bone by its own tags, the body laid out between
/// them, then moved to fit; limbs that do not are tried by every reading of their tags.
/// Allocates when it is made, not when it finds. Borrows the model.
class TaggedPostureFinder {
 public:
  explicit TaggedPostureFinder(const TagModel& model);

  /// nullopt where neither hips nor chest show unmistakably, or what is found does not
  /// explain most of what is seen. Some 10 ms with 30 sightings.
  [[nodiscard]] std::optional<Posture> find(std::span<const SeenTag> seen);

  /// Starts a limb of `posture` anew from every reading of its tags; keeps what costs
  /// least. True where that is another attitude. With a `beside.prior` the limb is looked
  /// for not far from where it is expected while the rest of the body stands still: some
  /// 0.3 ms a sighting; without, the whole body moves.
  [[nodiscard]] bool retry_limb(std::size_t limb,
                                std::span<const SeenTag> seen,
                                const TagFrameSolver::Beside& beside,
                                const TagLimits& limits,
                                Posture& posture);

  /// Whether a tag of the limb is too far from its model to be noise. `fits` as of
  /// TagFrameSolver::fit().
  [[nodiscard]] bool limb_misfits(std::size_t limb,
                                  std::span<const SeenTag> seen,
                                  std::span<const TagFit> fits) const;

 private:
  void leash(std::size_t limb, const Posture& start, const PosturePrior& prior);
  void locate(std::span<const SeenTag> seen);
  [[nodiscard]] std::optional<RigidTransform> locate_bone(HumanBone bone,
                                                          std::span<const SeenTag> seen);

  const TagModel* model_;
  TagFrameSolver solver_;
  FoundSegments found_;
  std::vector<RigidPointView> views_;
  std::vector<RigidTransform> starts_;
  std::vector<TagFit> fits_;
  std::vector<SeenTag> own_;  ///< Of one limb.
  PosturePrior leash_;
};

/// Corners further than this from where they should be, root mean square, are not
/// explained by noise or blur. [px]
inline constexpr double kLostPx = 3.0;

}  // namespace marey::reconstruct
