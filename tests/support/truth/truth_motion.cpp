// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/truth_motion.h"

#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"

namespace marey::testing {
namespace {

using B = HumanBone;

struct Segment {
  const char* name;
  B bone;
  int parent;
};

constexpr std::array<Segment, 21> kSegments{{
    {"pelvis", B::kHips, -1},
    {"abdomen", B::kSpine, 0},
    {"chest", B::kChest, 1},
    {"neck", B::kNeck, 2},
    {"head", B::kHead, 3},
    {"clavicle_l", B::kLeftShoulder, 2},
    {"upperarm_l", B::kLeftUpperArm, 5},
    {"forearm_l", B::kLeftLowerArm, 6},
    {"hand_l", B::kLeftHand, 7},
    {"clavicle_r", B::kRightShoulder, 2},
    {"upperarm_r", B::kRightUpperArm, 9},
    {"forearm_r", B::kRightLowerArm, 10},
    {"hand_r", B::kRightHand, 11},
    {"thigh_l", B::kLeftUpperLeg, 0},
    {"shank_l", B::kLeftLowerLeg, 13},
    {"foot_l", B::kLeftFoot, 14},
    {"toes_l", B::kLeftToes, 15},
    {"thigh_r", B::kRightUpperLeg, 0},
    {"shank_r", B::kRightLowerLeg, 17},
    {"foot_r", B::kRightFoot, 18},
    {"toes_r", B::kRightToes, 19},
}};

using Frame = std::array<RigidTransform, kSegments.size()>;

// A quarter turn about X: (x, y, z) -> (x, z, -y). The segments' own axes are already
// left, up, forward.
RigidTransform y_up_from_z_up(const RigidTransform& z_up_from_segment) {
  const glm::dquat y_up_from_z_up(0.70710678118654752, -0.70710678118654752, 0, 0);
  const glm::dvec3& p = z_up_from_segment.translation;
  return {y_up_from_z_up * z_up_from_segment.rotation, {p.x, p.z, -p.y}};
}

struct SegmentFrames {
  std::vector<Frame> frames;
  FrameRate rate;  // 30 Hz unless the table states times only.
};

std::vector<std::string> cells_of(const std::string& line) {
  std::istringstream row(line);
  std::vector<std::string> cells;
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  return cells;
}

// A row per frame: the time, then seven numbers of each segment, "pelvis_px" and so on.
SegmentFrames read_wide(std::istream& file, const std::vector<std::string>& columns) {
  std::map<std::string, std::size_t> column_of;
  for (std::size_t i = 0; i < columns.size(); ++i) column_of[columns[i]] = i;
  SegmentFrames out;
  std::vector<double> times_s;
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> cells = cells_of(line);
    Frame& frame = out.frames.emplace_back();
    times_s.push_back(std::stod(cells.at(0)));
    for (std::size_t i = 0; i < kSegments.size(); ++i) {
      const std::size_t first = column_of.at(std::string(kSegments[i].name) + "_px");
      const auto number = [&](std::size_t k) { return std::stod(cells.at(first + k)); };
      frame[i] = y_up_from_z_up(
          {glm::normalize(glm::dquat(number(3), number(4), number(5), number(6))),
           {number(0), number(1), number(2)}});
    }
  }
  if (times_s.size() > 1) {
    out.rate.hz =
        static_cast<double>(times_s.size() - 1) / (times_s.back() - times_s.front());
  }
  return out;
}

SegmentFrames read(std::istream& file) {
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < kSegments.size(); ++i) place[kSegments[i].name] = i;
  SegmentFrames out;
  std::vector<Frame>& frames = out.frames;
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> columns = cells_of(line);
  if (columns.size() > 2 && columns[2] != "segment") return read_wide(file, columns);
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cells_of(line);
    const auto frame = static_cast<std::size_t>(std::stoi(cells.at(0)));
    if (frame >= frames.size()) frames.resize(frame + 1);
    const auto number = [&](std::size_t k) { return std::stod(cells.at(k)); };
    frames[frame][place.at(cells.at(2))] = y_up_from_z_up(
        {glm::normalize(glm::dquat(number(6), number(7), number(8), number(9))),
         {number(3), number(4), number(5)}});
  }
  return out;
}

}  // namespace

std::optional<Motion> truth_motion(const std::string& segments_csv) {
  std::ifstream file(segments_csv);
  if (!file) return std::nullopt;
  const auto [frames, rate] = read(file);
  Motion motion;
  motion.rate = rate;
  for (std::size_t i = 0; i < kSegments.size(); ++i) {
    Joint joint;
    joint.name = std::string(name(kSegments[i].bone));
    joint.bone = kSegments[i].bone;
    if (kSegments[i].parent >= 0) {
      const auto parent = static_cast<std::size_t>(kSegments[i].parent);
      joint.parent = JointIndex{kSegments[i].parent};
      glm::dvec3 sum(0.0);
      for (const Frame& frame : frames)
        sum += inverse(frame[parent]) * frame[i].translation;
      joint.parent_from_joint.translation = sum / static_cast<double>(frames.size());
    }
    motion.skeleton.joints.push_back(std::move(joint));
  }
  for (const Frame& frame : frames) {
    std::vector<glm::dquat> world_from_joint;
    for (const RigidTransform& segment : frame)
      world_from_joint.push_back(segment.rotation);
    motion.poses.push_back(
        pose_from_world(motion.skeleton, frame[0].translation, world_from_joint));
  }
  return motion;
}

}  // namespace marey::testing
