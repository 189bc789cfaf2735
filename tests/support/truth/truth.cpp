// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/truth.h"

#include <cmath>
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

const std::map<std::string, HumanBone>& tagged_segments() {
  static const std::map<std::string, HumanBone> segments{
      {"pelvis", B::kHips},
      {"chest", B::kUpperChest},
      {"head", B::kHead},
      {"upperarm_l", B::kLeftUpperArm},
      {"forearm_l", B::kLeftLowerArm},
      {"hand_l", B::kLeftHand},
      {"thigh_l", B::kLeftUpperLeg},
      {"shank_l", B::kLeftLowerLeg},
      {"foot_l", B::kLeftFoot},
      {"upperarm_r", B::kRightUpperArm},
      {"forearm_r", B::kRightLowerArm},
      {"hand_r", B::kRightHand},
      {"thigh_r", B::kRightUpperLeg},
      {"shank_r", B::kRightLowerLeg},
      {"foot_r", B::kRightFoot},
  };
  return segments;
}

glm::dvec3 y_up(double x, double y, double z) {
  return {x, z, -y};
}

/// The rows of a table below `header`, by cell; nullopt under another header.
std::optional<std::vector<std::vector<std::string>>> table(
    const std::filesystem::path& csv, const std::string& header) {
  std::ifstream file(csv);
  std::string line;
  if (!std::getline(file, line) || line != header) return std::nullopt;
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    rows.emplace_back();
    for (std::string cell; std::getline(row, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

}  // namespace

std::optional<TruthJoints> truth_joints(const std::filesystem::path& csv) try {
  const auto rows = table(csv, "frame,t,joint,x,y,z");
  if (!rows) return std::nullopt;
  TruthJoints truth;
  for (const std::vector<std::string>& cells : *rows) {
    const auto joint = limb_joints().find(cells.at(2));
    if (joint == limb_joints().end()) continue;
    truth[{std::stoi(cells[0]), joint->second}] =
        y_up(std::stod(cells.at(3)), std::stod(cells.at(4)), std::stod(cells.at(5)));
  }
  return truth;
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<TruthRotations> truth_rotations(const std::filesystem::path& csv) try {
  const auto rows = table(csv, "frame,t,segment,px,py,pz,qw,qx,qy,qz");
  if (!rows) return std::nullopt;
  const double half = std::sqrt(0.5);
  const glm::dquat y_up_from_z_up(half, -half, 0.0, 0.0);
  TruthRotations truth;
  for (const std::vector<std::string>& cells : *rows) {
    const auto segment = tagged_segments().find(cells.at(2));
    if (segment == tagged_segments().end()) continue;
    const glm::dquat z_up_from_segment(std::stod(cells.at(6)),
                                       std::stod(cells.at(7)),
                                       std::stod(cells.at(8)),
                                       std::stod(cells.at(9)));
    truth[{std::stoi(cells[0]), segment->second}] =
        glm::normalize(y_up_from_z_up * z_up_from_segment);
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
