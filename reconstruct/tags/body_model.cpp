// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/body_model.h"

#include <glm/geometric.hpp>

namespace marey::reconstruct {

const RigidTransform* BodyModel::place(std::size_t tag) const {
  const auto found = segment_from_tag.find(tag);
  return found == segment_from_tag.end() ? nullptr : &found->second;
}

BodyModel to_model(const Body& body) {
  BodyModel model;
  model.lengths = lengths_of(body.proportions);
  model.body = body_constants(body);
  for (const PlacedTag& placed : body.tags) {
    model.segment_from_tag[model.tags.size()] = placed.segment_from_tag;
    model.tags.push_back(placed.tag);
  }
  return model;
}

std::optional<std::array<glm::dvec2, 4>> predicted_corners_px(
    const BodyModel& model,
    const TagSighting& sighting,
    std::span<const Camera> cameras,
    const Posture& posture) {
  const RigidTransform* segment_from_tag = model.place(sighting.tag);
  if (!segment_from_tag) return std::nullopt;
  const RigidTransform world_from_tag =
      world_from_bone(model.bone(sighting.tag), posture, model.lengths, model.body) *
      *segment_from_tag;
  std::array<glm::dvec2, 4> corners{};
  for (int c = 0; c < 4; ++c) {
    const auto pixel =
        project(cameras[index(sighting.camera)],
                world_from_tag * corner_in_tag(c, model.tags[sighting.tag].size_m));
    if (!pixel) return std::nullopt;
    corners[static_cast<std::size_t>(c)] = *pixel;
  }
  return corners;
}

std::array<double, 4> corner_errors_px(const BodyModel& model,
                                       const TagSighting& sighting,
                                       std::span<const Camera> cameras,
                                       const Posture& posture) {
  constexpr double kBehind = 1e3;
  std::array<double, 4> errors{kBehind, kBehind, kBehind, kBehind};
  const auto predicted = predicted_corners_px(model, sighting, cameras, posture);
  if (!predicted) return errors;
  for (std::size_t i = 0; i < 4; ++i) {
    errors[i] = glm::distance((*predicted)[i], sighting.detection->corners_px[i]);
  }
  return errors;
}

}  // namespace marey::reconstruct
