// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/synthetic_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace marey::testing {
namespace {

/// Returns true when a tag's normal is within `widest_rad` of the line to the camera.
bool is_legible(const Camera& camera,
                const RigidTransform& world_from_tag,
                double widest_rad) {
  const glm::dvec3 into_tag = world_from_tag.rotation * glm::dvec3(0, 0, 1);
  const glm::dvec3 sight =
      glm::normalize(world_from_tag.translation - centre_in_world(camera));
  return glm::dot(into_tag, sight) > std::cos(widest_rad);
}

/// Centre of a board's tag; its z goes into the board, its y down the rows.
RigidTransform board_from_tag(const AprilGrid& board, TagId id) {
  const glm::dvec3 centre =
      0.5 * (*board.corner_in_board(id, 0) + *board.corner_in_board(id, 2));
  return {rotation_from_vector({std::numbers::pi, 0.0, 0.0}), centre};
}

void add_board_views(const std::vector<Camera>& cameras,
                     const AprilGrid& board,
                     const RigidTransform& world_from_board,
                     std::size_t frame,
                     const Disturbance& disturbance,
                     Dice& dice,
                     std::vector<CameraDetections>& out) {
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    for (int i = 0; i < board.tag_count(); ++i) {
      const TagId id{board.first_id + i};
      const auto tag = see_tag(
          cameras[c], world_from_board * board_from_tag(board, id), id, board.tag_size_m);
      if (!tag) continue;
      out[c].frames[frame].tags.push_back(disturbed(*tag, disturbance, dice));
    }
  }
}

/// The board's place at `share` (0 to 1) of the wave: two rounds of the volume, its face
/// towards where the cameras are, tilting quicker than it travels.
RigidTransform waved(const AprilGrid& board, double share) {
  const double round = 4.0 * std::numbers::pi * share;
  const double heading = round;
  const glm::dvec3 middle(0.35 * std::sin(0.6 + 1.5 * round),
                          1.1 + 0.35 * std::sin(2.7 * round),
                          0.35 * std::cos(1.5 * round));
  const glm::dquat world_from_face =
      rotation_from_vector({0.0, heading, 0.0}) *
      rotation_from_vector({0.55 * std::sin(7.3 * round) - 0.25, 0.0, 0.0}) *
      rotation_from_vector({0.0, 0.5 * std::sin(5.1 * round), 0.0}) *
      rotation_from_vector({0.0, 0.0, 0.6 * std::sin(3.2 * round)});
  const glm::dvec3 face_from_board =
      0.5 * (*board.corner_in_board(TagId{board.first_id}, 0) +
             *board.corner_in_board(TagId{board.first_id + board.tag_count() - 1}, 2));
  return {world_from_face, middle - world_from_face * face_from_board};
}

}  // namespace

Intrinsics webcam() {
  Intrinsics k;
  k.width_px = 1280;
  k.height_px = 720;
  k.focal_px = {900.0, 900.0};
  k.centre_px = {642.0, 357.0};
  k.distortion = {-0.1, 0.01, 0.0004, -0.0003, 0.0};
  return k;
}

Camera webcam_at(std::string name,
                 const glm::dvec3& place_in_world,
                 const glm::dvec3& target_in_world) {
  const glm::dvec3 forward = glm::normalize(target_in_world - place_in_world);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  const glm::dvec3 down = glm::cross(forward, right);
  const RigidTransform world_from_camera{
      glm::normalize(glm::quat_cast(glm::dmat3(right, down, forward))), place_in_world};
  return {std::move(name), webcam(), inverse(world_from_camera), {}};
}

std::vector<Camera> ring_of_cameras() {
  const glm::dvec3 middle(0.0, 0.95, 0.0);
  std::vector<Camera> cameras{webcam_at("cam0", {0.4, 2.1, 3.2}, middle),
                              webcam_at("cam1", {3.1, 2.4, 0.3}, middle),
                              webcam_at("cam2", {-0.3, 1.9, -3.4}, middle),
                              webcam_at("cam3", {-3.0, 2.6, 0.5}, middle)};
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    cameras[c].intrinsics.focal_px *= 1.0 + 0.01 * static_cast<double>(c);
  }
  return cameras;
}

std::vector<std::string> names_of(const std::vector<Camera>& cameras) {
  std::vector<std::string> names;
  for (const Camera& camera : cameras) names.push_back(camera.name);
  return names;
}

std::optional<TagDetection> see_tag(const Camera& camera,
                                    const RigidTransform& world_from_tag,
                                    TagId id,
                                    double size_m,
                                    double widest_rad) {
  if (!is_legible(camera, world_from_tag, widest_rad)) return std::nullopt;
  TagDetection tag;
  tag.id = id;
  tag.decision_margin = 80.0;
  for (int i = 0; i < 4; ++i) {
    const auto pixel_px = project(camera, world_from_tag * corner_in_tag(i, size_m));
    if (!pixel_px) return std::nullopt;
    const bool inside = pixel_px->x > 2.0 && pixel_px->y > 2.0 &&
                        pixel_px->x < camera.intrinsics.width_px - 3.0 &&
                        pixel_px->y < camera.intrinsics.height_px - 3.0;
    if (!inside) return std::nullopt;
    tag.corners_px[static_cast<std::size_t>(i)] = *pixel_px;
  }
  return tag;
}

TagDetection disturbed(TagDetection tag, const Disturbance& disturbance, Dice& dice) {
  tag.sigma_px = disturbance.declared_px;
  std::array<std::array<double, 2>, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = {tag.corners_px[i].x, tag.corners_px[i].y};
  }
  move_edges(corners, [&](double apart_px) {
    return apart_px - disturbance.shrinkage.offset_px -
           disturbance.shrinkage.slope * apart_px;
  });
  glm::dvec2 wrong_px(0.0);
  if (disturbance.wrong_share > 0.0 && dice.between(0.0, 1.0) < disturbance.wrong_share) {
    const double angle_rad = dice.between(0.0, 2.0 * std::numbers::pi);
    wrong_px = 20.0 * glm::dvec2(std::cos(angle_rad), std::sin(angle_rad));
  }
  for (std::size_t i = 0; i < 4; ++i) {
    tag.corners_px[i] =
        glm::dvec2(corners[i][0], corners[i][1]) + wrong_px +
        glm::dvec2(dice.noise(disturbance.noise_px), dice.noise(disturbance.noise_px));
  }
  return tag;
}

std::vector<CameraDetections> unseeing(const std::vector<Camera>& cameras,
                                       int frames,
                                       double hz,
                                       const std::string& trial) {
  std::vector<CameraDetections> out(cameras.size());
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    out[c].source = trial + "/" + cameras[c].name + ".mp4";
    out[c].camera = CameraId{static_cast<int>(c)};
    out[c].width_px = cameras[c].intrinsics.width_px;
    out[c].height_px = cameras[c].intrinsics.height_px;
    out[c].rate.hz = hz;
    out[c].frames.resize(static_cast<std::size_t>(frames));
    for (int f = 0; f < frames; ++f) {
      out[c].frames[static_cast<std::size_t>(f)].frame = f;
    }
  }
  return out;
}

BoardRecording wave_board(const std::vector<Camera>& cameras,
                          const AprilGrid& board,
                          int frames,
                          const Disturbance& disturbance) {
  constexpr int kFloorFrames = 5;
  Dice dice(77);
  BoardRecording out{unseeing(cameras, frames, 10.0, "calibration"),
                     unseeing(cameras, kFloorFrames, 10.0, "floor")};
  for (int f = 0; f < frames; ++f) {
    add_board_views(cameras,
                    board,
                    waved(board, f / static_cast<double>(frames)),
                    static_cast<std::size_t>(f),
                    disturbance,
                    dice,
                    out.waved);
  }
  // Face up, its x along the world's X, its y along -Z.
  const RigidTransform on_floor{rotation_from_vector({-0.5 * std::numbers::pi, 0.0, 0.0}),
                                {0.0, board.thickness_m, 0.0}};
  for (std::size_t f = 0; f < kFloorFrames; ++f) {
    add_board_views(cameras, board, on_floor, f, disturbance, dice, out.floor);
  }
  return out;
}

}  // namespace marey::testing
