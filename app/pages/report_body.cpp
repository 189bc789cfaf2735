// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/pages/report_body.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "app/pages/base64.h"
#include "app/pages/report_json.h"

namespace marey::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInt16Max = std::numeric_limits<std::int16_t>::max();

/// Drawn part of a skeleton.
struct Drawn {
  std::vector<std::size_t> joints;  ///< Indices in the skeleton, ascending.
  std::vector<int> parents;         ///< Index in `joints` of the nearest drawn ancestor.
  std::vector<std::size_t> tips;    ///< Indices in the skeleton: joints with a drawn tip.
  std::vector<int> tip_parents;     ///< Index in `joints`.
};

bool is_hand(const Joint& joint) {
  return joint.bone == HumanBone::kLeftHand || joint.bone == HumanBone::kRightHand;
}

std::vector<bool> choose_joints(const Skeleton& skeleton) {
  const auto& joints = skeleton.joints;
  const bool has_no_bones = std::none_of(
      joints.begin(), joints.end(), [](const Joint& j) { return j.bone.has_value(); });
  std::vector<bool> chosen(joints.size(), has_no_bones);
  std::vector<bool> on_hand(joints.size(), false);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    on_hand[j] =
        is_hand(joints[j]) || (joints[j].parent && on_hand[index(*joints[j].parent)]);
    if (on_hand[j] || joints[j].bone) chosen[j] = true;
  }
  return chosen;
}

Drawn choose(const Skeleton& skeleton) {
  const std::vector<bool> chosen = choose_joints(skeleton);
  Drawn drawn;
  // Per joint: index in drawn.joints of the joint itself or of its nearest drawn
  // ancestor.
  std::vector<int> place(skeleton.joints.size(), -1);
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const int above = joint.parent ? place[index(*joint.parent)] : -1;
    place[j] = above;
    if (!chosen[j]) continue;
    place[j] = static_cast<int>(drawn.joints.size());
    drawn.joints.push_back(j);
    drawn.parents.push_back(above);
    if (!joint.tip_in_joint) continue;
    drawn.tips.push_back(j);
    drawn.tip_parents.push_back(place[j]);
  }
  return drawn;
}

Json describe_points(const Skeleton& skeleton, const Drawn& drawn) {
  Json points = Json::array();
  for (std::size_t i = 0; i < drawn.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[drawn.joints[i]];
    points.push_back({{"name", joint.name},
                      {"parent", drawn.parents[i]},
                      {"bone", joint.bone ? Json(name(*joint.bone)) : Json(nullptr)}});
  }
  for (const int parent : drawn.tip_parents) {
    points.push_back({{"name", "tip"}, {"parent", parent}, {"bone", nullptr}});
  }
  return points;
}

/// Returns numbers as little-endian bytes, on any machine.
class Bytes {
 public:
  void add16(double value) {
    const auto bits = static_cast<std::uint16_t>(
        static_cast<std::int32_t>(std::lround(value)) & 0xffff);
    text_ += static_cast<char>(bits & 0xffU);
    text_ += static_cast<char>(bits >> 8);
  }
  void add8(int value) { text_ += static_cast<char>(value); }
  [[nodiscard]] std::string text() const { return base64(text_); }

 private:
  std::string text_;
};

struct Track {
  std::vector<glm::dvec3> points_in_world;  ///< Joints, then tips, frame by frame.
  Bytes turns;
};

Track follow(const Motion& motion, const Drawn& drawn) {
  const Skeleton& skeleton = motion.skeleton;
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  std::vector<RigidTransform> world(skeleton.joints.size());
  Track track;
  for (const Pose& pose : motion.poses) {
    world_from_joints(skeleton, pose, world);
    for (const std::size_t j : drawn.joints) {
      track.points_in_world.push_back(world[j].translation);
      const glm::dquat turn =
          glm::normalize(world[j].rotation * glm::conjugate(rest[j].rotation));
      for (const double part : {turn.x, turn.y, turn.z, turn.w}) {
        track.turns.add16(std::clamp(part, -1.0, 1.0) * kInt16Max);
      }
    }
    for (const std::size_t j : drawn.tips) {
      track.points_in_world.push_back(world[j] * *skeleton.joints[j].tip_in_joint);
    }
  }
  return track;
}

/// Writes points relative to the middle of their range, in millimetres if they fit.
void add_points(const std::vector<glm::dvec3>& points, Json& out) {
  glm::dvec3 low(0.0);
  glm::dvec3 high(0.0);
  if (!points.empty()) low = high = points.front();
  for (const glm::dvec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  // Rounded to a millimetre, so that the written origin equals the one used here.
  const glm::dvec3 middle = 0.5 * (low + high);
  const glm::dvec3 origin(
      rounded(middle.x, 3), rounded(middle.y, 3), rounded(middle.z, 3));
  const glm::dvec3 size = high - low;
  const double unit_m =
      std::max(0.001, 0.51 * std::max({size.x, size.y, size.z}) / kInt16Max);
  Bytes xyz;
  for (const glm::dvec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) xyz.add16((p[axis] - origin[axis]) / unit_m);
  }
  out["unit_m"] = unit_m;
  out["origin_m"] = {origin.x, origin.y, origin.z};
  out["xyz"] = xyz.text();
}

void add_uncertainty(const ReportBody& body, const Drawn& drawn, Json& out) {
  if (body.uncertainty.empty()) return;
  constexpr double kTenthsPerMetre = 10000.0;
  constexpr double kUint16Max = std::numeric_limits<std::uint16_t>::max();
  Bytes source;
  Bytes sigma;
  for (const auto& frame : body.uncertainty) {
    for (const std::size_t j : drawn.joints) {
      source.add8(static_cast<int>(frame[j].source));
      sigma.add16(std::min(kUint16Max, kTenthsPerMetre * frame[j].sigma_m));
    }
  }
  out["source"] = source.text();
  out["sigma"] = sigma.text();
}

}  // namespace

Json page_body(const ReportBody& body) {
  const Drawn drawn = choose(body.motion.skeleton);
  const Track track = follow(body.motion, drawn);
  Json out{{"name", body.name},
           {"frames", body.motion.poses.size()},
           {"joints", drawn.joints.size()},
           {"points", describe_points(body.motion.skeleton, drawn)}};
  add_points(track.points_in_world, out);
  out["turns"] = track.turns.text();
  add_uncertainty(body, drawn, out);
  return out;
}

}  // namespace marey::app
