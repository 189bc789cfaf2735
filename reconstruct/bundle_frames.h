// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the postures of single frames of a subject's bundle, while the
// subject is held.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/subject_bundle.h"

namespace marey::reconstruct {

/// Solves the posture of one frame of a bundle. Borrows the bundle and the cameras.
class BundleFrameSolver {
 public:
  /// With `limb` only that limb's unknowns move, since its sightings do not determine the
  /// trunk. Precondition: limbs are then settled for this limb only.
  BundleFrameSolver(const SubjectBundle& bundle,
                    std::span<const Camera> cameras,
                    std::optional<std::size_t> limb = std::nullopt);

  /// Moves `posture` to the least cost nearby; returns that cost. Some 0.5 ms.
  double descend(const BundleFrame& frame, Posture& posture) const;

  /// Largest squared misfit of a sighting of the bones of `limb` (all bones without);
  /// 8 is expected.
  [[nodiscard]] double worst_misfit(const BundleFrame& frame,
                                    const Posture& posture,
                                    std::optional<std::size_t> limb) const;

  /// Where a limb's tags do not fit, starts the limb again from every reading of each of
  /// its tags (a flat tag that one camera sees has two), and keeps what costs least.
  /// Returns whether the posture changed.
  bool settle(BundleFrame& frame) const;
  bool settle_limb(std::size_t limb, BundleFrame& frame) const;

  /// Turns the extremity of a limb to the reading of its tags that costs least.
  void settle_extremity(std::size_t limb, BundleFrame& frame) const;

 private:
  struct Start {
    HumanBone bone{};
    RigidTransform world_from_bone;
  };
  /// world_from_bone by each reading of each tag of these bones.
  [[nodiscard]] std::vector<Start> readings(const BundleFrame& frame,
                                            std::span<const HumanBone> bones) const;
  [[nodiscard]] double cost(const BundleFrame& frame, const Posture& posture) const;
  void evaluate(const BundleFrame& frame,
                const Posture& posture,
                PostureEquations& out) const;

  const SubjectBundle* bundle_;
  std::span<const Camera> cameras_;
  SubjectSight sight_;
  std::optional<std::size_t> limb_;
  std::vector<int> held_;  ///< Columns of the posture.
};

}  // namespace marey::reconstruct
