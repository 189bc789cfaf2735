// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a body and its tags in the form that the solvers use.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/transform.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

struct BodyModel {
  Lengths lengths{};
  BodyConstants body;
  std::vector<TagOnSegment> tags;
  /// Place of each tag, by position in `tags`; a tag without a place is not used.
  std::map<std::size_t, RigidTransform> segment_from_tag;

  /// Returns the place of a tag; nullptr if it has none.
  [[nodiscard]] const RigidTransform* place(std::size_t tag) const;
  [[nodiscard]] HumanBone bone(std::size_t tag) const {
    return solved_segment(tags[tag].segment);
  }
};

/// Converts a body to a model, without toes and tips.
[[nodiscard]] BodyModel to_model(const Body& body);

/// Computes where the sighting's corners are expected in its image; nullopt behind the
/// camera or for a tag without a place. [px]
[[nodiscard]] std::optional<std::array<glm::dvec2, 4>> predicted_corners_px(
    const BodyModel& model,
    const TagSighting& sighting,
    std::span<const Camera> cameras,
    const Posture& posture);

/// Computes the distances of a sighting's four corners to their expected positions. [px];
/// 1000 behind the camera.
[[nodiscard]] std::array<double, 4> corner_errors_px(const BodyModel& model,
                                                     const TagSighting& sighting,
                                                     std::span<const Camera> cameras,
                                                     const Posture& posture);

}  // namespace marey::reconstruct
