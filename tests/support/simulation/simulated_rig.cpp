// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/simulation/simulated_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace marey::testing {
namespace {

/// Least height that a picture covers at the place of a person of 2 m. [m]
constexpr double kVisible_m = 2.15;

Intrinsics draw_intrinsics(Dice& dice, bool is_full_hd, double focal_px) {
  Intrinsics k;
  k.width_px = is_full_hd ? 1920 : 1280;
  k.height_px = is_full_hd ? 1080 : 720;
  k.focal_px = glm::dvec2(focal_px) * (1.0 + dice.noise(0.003));
  k.centre_px = {0.5 * k.width_px + dice.noise(8.0), 0.5 * k.height_px + dice.noise(8.0)};
  const double wide = 900.0 / focal_px * k.width_px / 1280.0;
  k.distortion = {-0.12 * wide * dice.between(0.0, 1.0),
                  0.02 * wide,
                  dice.noise(4e-4),
                  dice.noise(4e-4)};
  return k;
}

Camera camera_at(const std::string& name,
                 const Intrinsics& intrinsics,
                 const glm::dvec3& place,
                 const glm::dvec3& target,
                 double roll_rad) {
  const glm::dvec3 forward = glm::normalize(target - place);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  const glm::dvec3 down = glm::cross(forward, right);
  const glm::dquat world_from_camera = glm::quat_cast(glm::dmat3(right, down, forward)) *
                                       rotation_from_vector({0.0, 0.0, roll_rad});
  return {name, intrinsics, inverse({glm::normalize(world_from_camera), place}), {}};
}

/// Directions of the cameras from the middle.
std::vector<double> draw_azimuths(Dice& dice, int count, bool is_arc) {
  const double start = dice.between(-std::numbers::pi, std::numbers::pi);
  std::vector<double> azimuths;
  if (!is_arc) {
    for (int i = 0; i < count; ++i) {
      azimuths.push_back(start + 2.0 * std::numbers::pi * i / count +
                         dice.between(-0.3, 0.3));
    }
    return azimuths;
  }
  const double width =
      glm::radians(count == 2 ? dice.between(40.0, 100.0) : dice.between(80.0, 120.0));
  for (int i = 0; i < count; ++i) {
    azimuths.push_back(start + width * i / (count - 1) + dice.between(-0.08, 0.08));
  }
  return azimuths;
}

Camera draw_camera(
    Dice& dice, int number, double azimuth, bool is_full_hd, double focal) {
  const Intrinsics intrinsics = draw_intrinsics(dice, is_full_hd, focal);
  // Near enough for the tags, far enough for the whole person.
  const double nearest_m =
      std::max(2.5, kVisible_m * intrinsics.focal_px.y / intrinsics.height_px);
  const double distance_m =
      std::min(5.0, nearest_m * (1.0 + 0.25 * dice.between(0.0, 1.0)));
  const double height_m = dice.between(0.5, 2.6);
  const glm::dvec3 place(
      distance_m * std::sin(azimuth), height_m, distance_m * std::cos(azimuth));
  const glm::dvec3 target(dice.noise(0.08), 0.95 + dice.noise(0.06), dice.noise(0.08));
  return camera_at(
      "cam" + std::to_string(number), intrinsics, place, target, dice.noise(0.03));
}

/// Points of the volume that a board was waved through.
std::vector<glm::dvec3> volume() {
  std::vector<glm::dvec3> points;
  for (const double x : {-0.8, 0.0, 0.8}) {
    for (const double y : {0.2, 1.0, 1.8}) {
      for (const double z : {-0.8, 0.0, 0.8}) points.emplace_back(x, y, z);
    }
  }
  return points;
}

/// Turns a camera so that points of the volume are seen where `truth` sees them, as far
/// as a rotation can: Gauss-Newton with directions, each weighing alike.
void turn_to_fit(Camera& camera, const Camera& truth) {
  for (int step = 0; step < 3; ++step) {
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (const glm::dvec3& point : volume()) {
      const glm::dvec3 is = glm::normalize(camera.camera_from_world * point);
      const glm::dvec3 wanted = glm::normalize(truth.camera_from_world * point);
      // A turn by w moves a direction by w x is.
      normal += glm::dmat3(1.0) - glm::outerProduct(is, is);
      right += glm::cross(is, wanted - is);
    }
    const glm::dvec3 turn = glm::inverse(normal) * right;
    const glm::dvec3 centre = centre_in_world(camera);
    camera.camera_from_world.rotation =
        glm::normalize(rotation_from_vector(turn) * camera.camera_from_world.rotation);
    camera.camera_from_world.translation = -(camera.camera_from_world.rotation * centre);
  }
}

Camera calibrated(const Camera& truth, double sigma_m, Dice& dice) {
  Camera camera = truth;
  glm::dvec3 centre = centre_in_world(truth);
  const glm::dvec3 axis =
      glm::conjugate(truth.camera_from_world.rotation) * glm::dvec3(0, 0, 1);
  const double distance_m = glm::length(centre - glm::dvec3(0, 1, 0));
  // A longer lens from farther away: the picture of the middle is the same.
  const double longer = std::clamp(dice.noise(5e-4), -1e-3, 1e-3);
  glm::dvec3 off(dice.noise(sigma_m), dice.noise(sigma_m), dice.noise(sigma_m));
  off -= glm::dot(off, axis) * axis;
  off -= (longer * distance_m + dice.noise(0.3 * sigma_m)) * axis;
  centre += off;
  camera.intrinsics.focal_px *= 1.0 + longer;
  camera.camera_from_world.translation = -(camera.camera_from_world.rotation * centre);
  turn_to_fit(camera, truth);
  // Residual of the compensation: hundredths of a pixel at the picture's middle.
  const glm::dquat rest =
      rotation_from_vector({dice.noise(5e-5), dice.noise(5e-5), dice.noise(5e-5)});
  camera.camera_from_world.rotation =
      glm::normalize(rest * camera.camera_from_world.rotation);
  camera.camera_from_world.translation = -(camera.camera_from_world.rotation * centre);
  return camera;
}

}  // namespace

SimulatedRig draw_rig(Dice& dice) {
  SimulatedRig rig;
  const double some = dice.between(0.0, 1.0);
  const int count = some < 0.15   ? 2
                    : some < 0.4  ? 3
                    : some < 0.7  ? 4
                    : some < 0.85 ? 5
                                  : 6;
  const double arc_chance = count == 2 ? 1.0 : count == 3 ? 0.5 : 0.25;
  const bool is_arc = dice.between(0.0, 1.0) < arc_chance;
  rig.layout = is_arc ? "arc" : "ring";
  const bool is_full_hd = dice.between(0.0, 1.0) < 0.5;
  const double focal_px =
      is_full_hd ? dice.between(1000.0, 1400.0) : dice.between(700.0, 1000.0);
  const std::vector<double> azimuths = draw_azimuths(dice, count, is_arc);
  const double error_m = dice.between(0.0006, 0.0017);
  for (int c = 0; c < count; ++c) {
    const double azimuth = azimuths[static_cast<std::size_t>(c)];
    rig.cameras.push_back(draw_camera(dice, c, azimuth, is_full_hd, focal_px));
    rig.calibrated.push_back(calibrated(rig.cameras.back(), error_m, dice));
    rig.centre_sigma_m.push_back(error_m);
  }
  rig.heading_rad =
      is_arc ? 0.5 * (azimuths.front() + azimuths.back()) + dice.between(-0.4, 0.4)
             : dice.between(-std::numbers::pi, std::numbers::pi);
  return rig;
}

}  // namespace marey::testing
