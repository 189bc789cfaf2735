// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/picture_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "core/transform.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"

namespace marey {
namespace {

constexpr int kSegments = 20;
constexpr std::size_t kBodyParts = 3;

/// The parts of a scene's mesh: the mannequin's, then one per Paint.
std::vector<recordings::MeshPart> scene_parts() {
  const recordings::MannequinStyle style;
  const std::array<recordings::MeshMaterial, 10> materials{{
      {"body", style.body_colour, 0.55},
      {"joints", style.joint_colour, 0.45},
      {"front", style.mark_colour, 0.5},
      {"target", {0.80, 0.05, 0.03}, 0.5},
      {"other target", {0.03, 0.16, 0.70}, 0.5},
      {"within: centre of mass", {0.80, 0.05, 0.03}, 0.5},
      {"within: wanted centre of mass", {0.03, 0.42, 0.10}, 0.5},
      {"ground", {0.62, 0.63, 0.65}, 0.9},
      {"path", {0.03, 0.16, 0.70}, 0.5},
      {"load", {0.10, 0.10, 0.11}, 0.5},
  }};
  std::vector<recordings::MeshPart> parts;
  for (const auto& material : materials) parts.push_back({material, {}});
  return parts;
}

std::size_t part_of(Paint paint) {
  return kBodyParts + static_cast<std::size_t>(paint);
}

std::uint32_t number(std::size_t i) {
  return static_cast<std::uint32_t>(i);
}

/// Any unit vector perpendicular to the unit `axis`.
glm::dvec3 across(const glm::dvec3& axis) {
  const glm::dvec3 other =
      std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return glm::normalize(glm::cross(axis, other));
}

/// As posed_vertices() does for places.
std::vector<glm::dvec3> posed_normals(const recordings::SkinnedMesh& mesh,
                                      const Skeleton& skeleton,
                                      const Pose& pose) {
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  const auto posed = world_from_joints(skeleton, pose);
  std::vector<glm::dvec3> normals;
  normals.reserve(mesh.normal_in_world.size());
  for (std::size_t v = 0; v < mesh.normal_in_world.size(); ++v) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t j = index(mesh.skin[v].joints[k]);
      sum += mesh.skin[v].weights[k] *
             (posed[j].rotation *
              (glm::conjugate(rest[j].rotation) * mesh.normal_in_world[v]));
    }
    const double length = glm::length(sum);
    normals.push_back(length > 1e-6 ? sum / length : mesh.normal_in_world[v]);
  }
  return normals;
}

}  // namespace

PictureScene::PictureScene(std::string name, PictureView view)
    : name_(std::move(name)), view_(view) {
  mesh_.parts = scene_parts();
}

glm::dvec3 PictureScene::to_the_right(double way_m) const {
  const double azimuth_rad = view_.azimuth_deg * std::numbers::pi / 180.0;
  return way_m * glm::dvec3(std::cos(azimuth_rad), 0.0, -std::sin(azimuth_rad));
}

void PictureScene::add_vertex(const glm::dvec3& p_in_world,
                              const glm::dvec3& normal_in_world) {
  mesh_.p_in_world.push_back(p_in_world);
  mesh_.normal_in_world.push_back(normal_in_world);
  recordings::SkinWeights still;
  still.weights[0] = 1.0;
  mesh_.skin.push_back(still);
}

void PictureScene::add_body(const Skeleton& skeleton,
                            const Pose& pose,
                            const glm::dvec3& shift_m) {
  const auto body = recordings::make_mannequin_mesh(proportions_of(skeleton));
  const auto places = recordings::posed_vertices(body, skeleton, pose);
  const auto normals = posed_normals(body, skeleton, pose);
  const std::size_t first = mesh_.p_in_world.size();
  for (std::size_t v = 0; v < places.size(); ++v) {
    add_vertex(places[v] + shift_m, normals[v]);
  }
  for (std::size_t part = 0; part < body.parts.size(); ++part) {
    for (const std::uint32_t corner : body.parts[part].triangles) {
      mesh_.parts[part].triangles.push_back(number(first) + corner);
    }
  }
}

void PictureScene::add_turned(const glm::dvec3& from_in_world,
                              const glm::dvec3& axis,
                              const std::vector<ProfilePoint>& profile,
                              Paint paint) {
  const glm::dvec3 x = across(axis);
  const glm::dvec3 y = glm::cross(axis, x);
  const std::size_t first = mesh_.p_in_world.size();
  for (const ProfilePoint& p : profile) {
    for (int k = 0; k < kSegments; ++k) {
      const double angle_rad = 2.0 * std::numbers::pi * k / kSegments;
      const glm::dvec3 out = std::cos(angle_rad) * x + std::sin(angle_rad) * y;
      const double slope_out = std::sqrt(1.0 - p.slope_along * p.slope_along);
      add_vertex(from_in_world + p.along_m * axis + p.radius_m * out,
                 slope_out * out + p.slope_along * axis);
    }
  }
  auto& triangles = mesh_.parts[part_of(paint)].triangles;
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (int k = 0; k < kSegments; ++k) {
      const auto corner = [&](std::size_t r, int turn) {
        return number(first + r * kSegments + static_cast<std::size_t>(turn % kSegments));
      };
      for (const std::uint32_t c : {corner(ring, k),
                                    corner(ring, k + 1),
                                    corner(ring + 1, k + 1),
                                    corner(ring, k),
                                    corner(ring + 1, k + 1),
                                    corner(ring + 1, k)}) {
        triangles.push_back(c);
      }
    }
  }
}

void PictureScene::add_ball(const glm::dvec3& centre_in_world,
                            double radius_m,
                            Paint paint) {
  constexpr int kRings = 10;
  std::vector<ProfilePoint> profile;
  for (int k = 0; k <= kRings; ++k) {
    const double angle_rad = std::numbers::pi * k / kRings;
    const double slope = -std::cos(angle_rad);
    profile.push_back({radius_m * slope, radius_m * std::sin(angle_rad), slope});
  }
  add_turned(centre_in_world, {0, 1, 0}, profile, paint);
}

void PictureScene::add_rod(const glm::dvec3& from_in_world,
                           const glm::dvec3& to_in_world,
                           double radius_m,
                           Paint paint) {
  const double length_m = glm::distance(from_in_world, to_in_world);
  add_turned(from_in_world,
             (to_in_world - from_in_world) / length_m,
             {{0.0, 0.0, -1.0},
              {0.0, radius_m, -1.0},
              {0.0, radius_m, 0.0},
              {length_m, radius_m, 0.0},
              {length_m, radius_m, 1.0},
              {length_m, 0.0, 1.0}},
             paint);
}

void PictureScene::add_box(const glm::dvec3& min_in_world,
                           const glm::dvec3& max_in_world,
                           Paint paint) {
  auto& triangles = mesh_.parts[part_of(paint)].triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_far : {false, true}) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      glm::dvec3 normal(0.0);
      normal[axis] = is_far ? 1.0 : -1.0;
      const std::uint32_t first = number(mesh_.p_in_world.size());
      for (const auto& [at_u, at_v] : std::array<std::pair<bool, bool>, 4>{
               {{false, false}, {true, false}, {true, true}, {false, true}}}) {
        glm::dvec3 p = is_far ? max_in_world : min_in_world;
        p[u] = (at_u ? max_in_world : min_in_world)[u];
        p[v] = (at_v ? max_in_world : min_in_world)[v];
        add_vertex(p, normal);
      }
      for (const std::uint32_t c : is_far
                                       ? std::array<std::uint32_t, 6>{0, 1, 2, 0, 2, 3}
                                       : std::array<std::uint32_t, 6>{0, 2, 1, 0, 3, 2})
        triangles.push_back(first + c);
    }
  }
}

void PictureScene::add_label(std::string text, const glm::dvec3& p_in_world) {
  labels_.push_back({std::move(text), p_in_world});
}

Status PictureScene::write(const std::filesystem::path& folder) const {
  Skeleton still;
  still.joints.push_back({"scene", std::nullopt, {}, std::nullopt, std::nullopt});
  recordings::SkinnedMesh mesh = mesh_;
  std::erase_if(mesh.parts, [](const auto& part) { return part.triangles.empty(); });
  const Status written =
      recordings::write_character(folder / (name_ + ".glb"), still, mesh);
  if (!written) return written;
  nlohmann::ordered_json page;
  page["azimuth_deg"] = view_.azimuth_deg;
  page["elevation_deg"] = view_.elevation_deg;
  page["labels"] = nlohmann::ordered_json::array();
  for (const Label& label : labels_) {
    const glm::dvec3& p = label.p_in_world;
    page["labels"].push_back({{"text", label.text}, {"at", {p.x, p.y, p.z}}});
  }
  const std::filesystem::path path = folder / (name_ + ".json");
  std::ofstream file(path);
  file << page.dump(2) << "\n";
  if (!file.good()) {
    return bad_input(path.string(), "cannot be written", "give a folder that exists");
  }
  return Done{};
}

}  // namespace marey
