// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/rendered_truth.h"

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <nlohmann/json.hpp>

#include "core/board.h"

namespace marey::tests {
namespace {

Camera camera_of(const nlohmann::json& json) {
  Camera camera;
  Intrinsics& k = camera.intrinsics;
  k.focal_px = {json["K"][0][0], json["K"][1][1]};
  k.centre_px = {json["K"][0][2], json["K"][1][2]};
  const auto& distortion = json["distortion"];
  for (std::size_t i = 0; i < 5 && i < distortion.size(); ++i) {
    k.distortion[i] = distortion[i];
  }
  const auto& m = json["world_from_camera"];
  glm::dmat3 rotation(1.0);
  RigidTransform world_from_camera;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) rotation[col][row] = m[row][col];
    world_from_camera.translation[row] = m[row][3];
  }
  world_from_camera.rotation = glm::quat_cast(rotation);
  camera.camera_from_world = inverse(world_from_camera);
  return camera;
}

/// The rows of a CSV file after its header, as text.
std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

void load_body(RenderedTruth& truth) {
  for (const auto& row : rows_of(truth.folder / "truth/tags_world.csv")) {
    auto& corners = truth.corners_in_world[{std::stoi(row[0]), std::stoi(row[2])}];
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t i = 0; i < 3; ++i) {
        corners[c][static_cast<int>(i)] = std::stod(row[11 + 3 * c + i]);
      }
    }
  }
}

void load_board(RenderedTruth& truth) {
  const AprilGrid board;  // The data set's own sizes.
  for (const auto& row : rows_of(truth.folder / "truth/board_pose.csv")) {
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < 7; ++i) v[i] = std::stod(row[2 + i]);
    const RigidTransform world_from_board{{v[3], v[4], v[5], v[6]}, {v[0], v[1], v[2]}};
    for (int id = 0; id < board.tag_count(); ++id) {
      auto& corners = truth.corners_in_world[{std::stoi(row[0]), id}];
      for (int c = 0; c < 4; ++c) {
        corners[static_cast<std::size_t>(c)] =
            world_from_board * board.corner_in_board(TagId{id}, c).value();
      }
    }
  }
}

std::optional<std::array<glm::dvec2, 4>> see(const Camera& camera,
                                             const std::array<glm::dvec3, 4>& in_world) {
  std::array<glm::dvec2, 4> pixels{};
  for (std::size_t c = 0; c < 4; ++c) {
    const auto pixel = project(camera, in_world[c]);
    if (!pixel) return std::nullopt;
    pixels[c] = *pixel;
  }
  return pixels;
}

/// The tag's corners `late` frames after a frame, within one frame, by the cubic through
/// the four frames around: a step lasts ten frames, so it is right to a hundredth of the
/// way between two. nullopt at the ends.
std::optional<std::array<glm::dvec3, 4>> corners_at(const RenderedTruth& truth,
                                                    int frame,
                                                    double late,
                                                    int tag) {
  const auto here = truth.corners_in_world.find({frame, tag});
  if (here == truth.corners_in_world.end()) return std::nullopt;
  if (late == 0.0) return here->second;
  const int first = frame + (late > 0.0 ? -1 : -2);
  const double t = late + frame - first;
  std::array<glm::dvec3, 4> corners{};
  for (int i = 0; i < 4; ++i) {
    const auto knot = truth.corners_in_world.find({first + i, tag});
    if (knot == truth.corners_in_world.end()) return std::nullopt;
    double weight = 1.0;
    for (int j = 0; j < 4; ++j) {
      if (j != i) weight *= (t - j) / (i - j);
    }
    for (std::size_t c = 0; c < 4; ++c) corners[c] += weight * knot->second[c];
  }
  return corners;
}

}  // namespace

RenderedTruth load_rendered_truth(const std::filesystem::path& folder) {
  RenderedTruth truth;
  truth.folder = folder;
  std::ifstream in(folder / "truth/cameras.json");
  const auto json = nlohmann::json::parse(in);
  for (const auto& camera : json["cameras"]) {
    truth.cameras.push_back(camera_of(camera));
    const double fps = json["fps"];
    const double offset_s = camera.value("time_offset_s", 0.0);
    truth.late_frames.push_back(fps * offset_s);
  }
  if (std::filesystem::exists(folder / "truth/board_pose.csv")) {
    load_board(truth);
  } else {
    load_body(truth);
  }
  return truth;
}

std::vector<CornerResidual> residuals(const RenderedTruth& truth,
                                      std::size_t camera,
                                      const CameraDetections& found) {
  std::vector<CornerResidual> all;
  for (const FrameDetections& frame : found.frames) {
    for (const TagDetection& tag : frame.tags) {
      const auto known =
          corners_at(truth, frame.frame, truth.late_frames[camera], number(tag.id));
      if (!known) continue;
      const auto pixels = see(truth.cameras[camera], *known);
      if (!pixels) continue;
      const auto& p = *pixels;
      const glm::dvec2 centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
      double side_px = 0.0;
      for (std::size_t c = 0; c < 4; ++c) {
        side_px += 0.25 * glm::distance(p[c], p[(c + 1) % 4]);
      }
      for (std::size_t c = 0; c < 4; ++c) {
        all.push_back({frame.frame,
                       number(tag.id),
                       static_cast<int>(c),
                       side_px,
                       tag.sigma_px,
                       tag.corners_px[c] - p[c],
                       glm::normalize(p[c] - centre)});
      }
    }
  }
  return all;
}

}  // namespace marey::tests
