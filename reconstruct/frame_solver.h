// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the posture of one frame, and of a trial frame by frame.

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "reconstruct/body_model.h"
#include "reconstruct/tag_clusters.h"

namespace marey::reconstruct {

/// Finds the posture of single frames of a known body. Borrows the model and the cameras.
class FrameSolver {
 public:
  FrameSolver(const BodyModel& model, std::span<const Camera> cameras);

  /// world_from_segment of every segment whose own tags tell it.
  [[nodiscard]] std::map<HumanBone, RigidTransform> locate(
      std::span<const TagSighting> frame) const;

  /// The frame's posture, from its tags and from `before` and `earlier`, the postures one
  /// and two frames back (null where there are none).
  [[nodiscard]] Posture track(std::span<const TagSighting> frame,
                              const Posture* before,
                              const Posture* earlier) const;

  /// The frame's posture from what is known later, `after` being that of the next frame
  /// and `later` of the one beyond (or null): replaces `posture` where it fits better. A
  /// lone tag at the start of a trial or after a gap may have been read the wrong way
  /// round, and only the future tells.
  void track_back(std::span<const TagSighting> frame,
                  const Posture& after,
                  const Posture* later,
                  Posture& posture) const;

 private:
  [[nodiscard]] double refine(std::span<const TagSighting> frame,
                              const Posture* predicted,
                              Posture& posture) const;
  [[nodiscard]] double misfit_px(const TagSighting& sighting,
                                 const Posture& posture) const;
  [[nodiscard]] double median_misfit_px(std::span<const TagSighting> frame,
                                        const Posture& posture) const;
  void retry_limbs(std::span<const TagSighting> frame,
                   const std::map<HumanBone, RigidTransform>& found,
                   const Posture* predicted,
                   Posture& posture) const;

  const BodyModel* model_;
  std::span<const Camera> cameras_;
  std::vector<TagCluster> clusters_;
};

/// Every frame on its own, forward and back. nullopt when the hips are never found.
/// `progress` counts frames of the forward pass.
[[nodiscard]] std::optional<std::vector<Posture>> track_postures(
    const FrameSolver& solver, const Sightings& sightings, const Progress& progress);

}  // namespace marey::reconstruct
