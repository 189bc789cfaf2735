// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: postures of single frames of a subject's bundle, with the
// subject held.

#include <optional>
#include <span>
#include <vector>

#include "reconstruct/bundle/subject_bundle.h"

namespace marey::reconstruct {

/// Solves the posture of one frame of a bundle. Borrows the bundle and the cameras.
class BundleFrameSolver {
 public:
  /// With `limb` only that limb's unknowns are free, since its sightings do not determine
  /// the trunk. Precondition: settle() is then called for this limb only.
  BundleFrameSolver(const SubjectBundle& bundle,
                    std::span<const Camera> cameras,
                    std::optional<std::size_t> limb = std::nullopt);

  /// Moves `posture` to the nearest minimum of the cost; returns that cost. Some 0.5 ms.
  double descend(const BundleFrame& frame, Posture& posture) const;

  /// Returns the largest squared misfit of a sighting of the bones of `limb` (all bones
  /// without it); 8 is expected.
  [[nodiscard]] double worst_misfit(const BundleFrame& frame,
                                    const Posture& posture,
                                    std::optional<std::size_t> limb) const;

  /// Starts limbs whose tags do not fit again from every planar pose of each of their
  /// tags (a flat tag that one camera sees has two), and keeps the one with the least
  /// cost. Returns whether the posture changed.
  bool settle(BundleFrame& frame) const;
  bool settle_limb(std::size_t limb, BundleFrame& frame) const;

  /// Rotates the extremity of a limb to the planar pose of its tags with the least cost.
  void settle_extremity(std::size_t limb, BundleFrame& frame) const;

 private:
  struct Start {
    HumanBone bone{};
    RigidTransform world_from_bone;
  };
  /// Returns world_from_bone by each planar pose of each tag of these bones.
  [[nodiscard]] std::vector<Start> candidate_starts(
      const BundleFrame& frame, std::span<const HumanBone> bones) const;
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
