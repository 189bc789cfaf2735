// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/rig_model.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "calib/model/spline_pose.h"
#include "core/base/assert.h"

namespace marey::calib {

Sighting sighting_of(const TagDetection& tag) {
  Sighting sighting;
  for (std::size_t i = 0; i < 4; ++i) {
    sighting.corners[i] = {
        corner_in_tag(static_cast<int>(i), 1.0), tag.corners_px[i], tag.sigma_px};
  }
  return sighting;
}

std::array<double, 3> board_warp(const RigidTarget& target,
                                 const glm::dvec3& p_in_target) {
  const double x = (p_in_target.x - target.middle_in_target.x) / target.half_extent_m.x;
  const double y = (p_in_target.y - target.middle_in_target.y) / target.half_extent_m.y;
  return {x * x, y * y, x * y};
}

glm::dvec3 corner_in_target(const RigidTarget& target,
                            const Sighting& sighting,
                            int corner) {
  MAREY_ASSERT(corner >= 0 && corner < sighting.count);
  glm::dvec3 p = sighting.corners[static_cast<std::size_t>(corner)].p_in_board;
  if (target.bends) {
    const auto bend = board_warp(target, p);
    for (std::size_t k = 0; k < 3; ++k) p.z += bend[k] * target.warp_m[k];
  }
  if (target.pieces.empty()) return p;
  const Piece& piece = target.pieces[sighting.piece];
  return piece.target_from_piece * (piece.size_m * p);
}

std::optional<RigidTransform> world_from_target(const RigModel& model,
                                                const Sighting& sighting) {
  const RigidTarget& target = model.targets[sighting.target];
  if (target.knot_spacing_s <= 0.0) {
    const auto found = target.world_from_target.find(sighting.instant);
    if (found == target.world_from_target.end()) return std::nullopt;
    return found->second;
  }
  const RigCamera& camera = model.cameras[sighting.camera];
  double row = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sighting.count); ++i) {
    row += sighting.corners[i].pixel_px.y / sighting.count;
  }
  const double time_s =
      sighting.time_s * (1.0 + camera.drift) + camera.offset_s +
      camera.line_delay_s * (row - 0.5 * (camera.intrinsics.height_px - 1));
  const double place = time_s / target.knot_spacing_s;
  const int second = static_cast<int>(std::floor(place));
  std::array<PoseBlock, 4> blocks{};
  std::array<const double*, 4> knots{};
  for (int k = 0; k < 4; ++k) {
    const auto knot = target.world_from_target.find(second - 1 + k);
    if (knot == target.world_from_target.end()) return std::nullopt;
    const RigidTransform& t = knot->second;
    auto& block = blocks[static_cast<std::size_t>(k)];
    block = {t.rotation.x,
             t.rotation.y,
             t.rotation.z,
             t.rotation.w,
             t.translation.x,
             t.translation.y,
             t.translation.z};
    knots[static_cast<std::size_t>(k)] = block.data();
  }
  const SplinePose pose = spline_pose(knots, place - second);
  const Eigen::Quaterniond q(pose.rotation);
  return RigidTransform{
      {q.w(), q.x(), q.y(), q.z()},
      {pose.translation.x(), pose.translation.y(), pose.translation.z()}};
}

Camera camera_of(const RigCamera& camera, std::string name) {
  return {std::move(name),
          camera.intrinsics,
          inverse(camera.world_from_camera),
          camera.shrinkage};
}

std::vector<double> errors_px(const RigModel& model, const Sighting& sighting) {
  const RigidTarget& target = model.targets[sighting.target];
  const auto pose = world_from_target(model, sighting);
  if (!pose || (!target.pieces.empty() && !target.pieces[sighting.piece].is_placed)) {
    return {};
  }
  const Camera camera = camera_of(model.cameras[sighting.camera]);
  std::array<glm::dvec2, 4> seen{};
  for (std::size_t i = 0; i < 4; ++i) seen[i] = sighting.corners[i].pixel_px;
  if (sighting.count == 4) seen = unshrunk(seen, camera.tag_shrinkage);
  std::vector<double> errors;
  for (int i = 0; i < sighting.count; ++i) {
    const auto pixel = project(camera, *pose * corner_in_target(target, sighting, i));
    errors.push_back(pixel ? glm::distance(*pixel, seen[static_cast<std::size_t>(i)])
                           : camera.intrinsics.width_px);
  }
  return errors;
}

}  // namespace marey::calib
