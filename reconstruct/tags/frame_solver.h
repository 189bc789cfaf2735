// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the posture of one frame, and of a trial frame by frame.

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "reconstruct/clusters/tag_clusters.h"
#include "reconstruct/tags/body_model.h"

namespace marey::reconstruct {

/// Finds the posture of single frames of a known body. Borrows the model and the cameras.
class FrameSolver {
 public:
  FrameSolver(const BodyModel& model, std::span<const Camera> cameras);

  /// Computes world_from_segment of every segment whose own tags determine it.
  [[nodiscard]] std::map<HumanBone, RigidTransform> locate(
      std::span<const TagSighting> frame) const;

  /// Computes the frame's posture from its tags and from `before` and `earlier`, the
  /// postures one and two frames earlier (null if there are none).
  [[nodiscard]] Posture track(std::span<const TagSighting> frame,
                              const Posture* before,
                              const Posture* earlier) const;

  /// Computes the frame's posture backward in time and replaces `posture` if the result
  /// fits better. `after` is the posture of the next frame, `later` that of the frame
  /// after it (or null). At the start of a trial or after a gap, the pose of a single tag
  /// can be the wrong planar candidate; only later frames resolve this.
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

/// Solves every frame alone, in a forward and a backward pass. nullopt if the hips are
/// never found. `progress` counts the frames of the forward pass.
[[nodiscard]] std::optional<std::vector<Posture>> track_postures(
    const FrameSolver& solver, const Sightings& sightings, const Progress& progress);

}  // namespace marey::reconstruct
