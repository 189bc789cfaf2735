// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a body and its tags as the solvers see them.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <ceres/ceres.h>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/posture.h"
#include "reconstruct/sightings.h"

namespace marey::reconstruct {

struct BodyModel {
  Lengths lengths{};
  BodyFrame body;
  std::vector<TagOnSegment> tags;
  /// By position in `tags`; a tag without a place is not used.
  std::map<std::size_t, RigidTransform> segment_from_tag;

  /// nullptr when the tag has no place.
  [[nodiscard]] const RigidTransform* place(std::size_t tag) const;
  [[nodiscard]] HumanBone bone(std::size_t tag) const {
    return solved_segment(tags[tag].segment);
  }
};

/// The body as a model; toes and tips are not part of it.
[[nodiscard]] BodyModel to_model(const Body& body);

/// Robust loss of a tag's eight residuals, whose norm is near 2.8 when all is well.
[[nodiscard]] ceres::LossFunction* tag_loss();

/// Adds the reprojection of one sighting to a problem in which the body is known.
void add_sighting(const BodyModel& model,
                  const TagSighting& sighting,
                  std::span<const Camera> cameras,
                  Posture& posture,
                  ceres::Problem& problem);

struct TagSlip;  // tag_slip.h

/// The same of a camera that is late by the block `offset_s`, while the corners move at
/// `velocity_px_s`, and of a tag that slips. Precondition: the tag has a place.
ceres::ResidualBlockId add_late_sighting(const BodyModel& model,
                                         const TagSighting& sighting,
                                         std::span<const Camera> cameras,
                                         Posture& posture,
                                         ceres::Problem& problem,
                                         double* offset_s,
                                         const std::array<glm::dvec2, 4>& velocity_px_s,
                                         const TagSlip& slip);

/// Where the sighting's corners should be in its image; nullopt behind the camera or for
/// a tag without a place. [px]
[[nodiscard]] std::optional<std::array<glm::dvec2, 4>> predicted_corners_px(
    const BodyModel& model,
    const TagSighting& sighting,
    std::span<const Camera> cameras,
    const Posture& posture);

/// Distances of a sighting's four corners to their model. [px]; 1000 behind the camera.
[[nodiscard]] std::array<double, 4> corner_errors_px(const BodyModel& model,
                                                     const TagSighting& sighting,
                                                     std::span<const Camera> cameras,
                                                     const Posture& posture);

/// A flat tag that one camera sees has two readings, and a posture that starts in the
/// wrong one stays there. Tries both for head, hands and feet, against `before` (the
/// posture one frame earlier, or null) for continuity, and keeps the better. Returns how
/// many changed.
int reconsider_extremities(const BodyModel& model,
                           std::span<const TagSighting> sightings,
                           std::span<const Camera> cameras,
                           const Posture* before,
                           Posture& posture);

}  // namespace marey::reconstruct
