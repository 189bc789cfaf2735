// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth.h"

#include <exception>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

namespace marey::testing {
namespace {

using B = HumanBone;

const std::map<std::string, HumanBone>& limb_joints() {
  static const std::map<std::string, HumanBone> joints{
      {"shoulder_l", B::kLeftUpperArm},
      {"elbow_l", B::kLeftLowerArm},
      {"wrist_l", B::kLeftHand},
      {"hip_l", B::kLeftUpperLeg},
      {"knee_l", B::kLeftLowerLeg},
      {"ankle_l", B::kLeftFoot},
      {"shoulder_r", B::kRightUpperArm},
      {"elbow_r", B::kRightLowerArm},
      {"wrist_r", B::kRightHand},
      {"hip_r", B::kRightUpperLeg},
      {"knee_r", B::kRightLowerLeg},
      {"ankle_r", B::kRightFoot},
  };
  return joints;
}

glm::dvec3 y_up(double x, double y, double z) {
  return {x, z, -y};
}

}  // namespace

std::optional<TruthJoints> truth_joints(const std::filesystem::path& csv) try {
  std::ifstream file(csv);
  std::string line;
  if (!std::getline(file, line) || line != "frame,t,joint,x,y,z") return std::nullopt;
  TruthJoints truth;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    const auto joint = limb_joints().find(cells.at(2));
    if (joint == limb_joints().end()) continue;
    truth[{std::stoi(cells[0]), joint->second}] =
        y_up(std::stod(cells.at(3)), std::stod(cells.at(4)), std::stod(cells.at(5)));
  }
  return truth;
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<std::vector<TruthCamera>> truth_cameras(
    const std::filesystem::path& json) try {
  std::ifstream file(json);
  std::vector<TruthCamera> cameras;
  const auto truth = nlohmann::json::parse(file);
  for (const auto& camera : truth.at("cameras")) {
    const auto& k = camera.at("K");
    const auto& pose = camera.at("world_from_camera");
    const auto along = [&](std::size_t axis) {
      return pose.at(axis).at(3).get<double>();
    };
    cameras.push_back({camera.at("name").get<std::string>(),
                       {k.at(0).at(0).get<double>(), k.at(1).at(1).get<double>()},
                       y_up(along(0), along(1), along(2)),
                       camera.at("time_offset_s").get<double>()});
  }
  return cameras;
} catch (const std::exception&) {
  return std::nullopt;
}

}  // namespace marey::testing
