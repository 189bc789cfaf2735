// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/number_text.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/bvh_names.h"

namespace marey::recordings {
namespace {

constexpr std::array<char, 3> kAxisNames{'X', 'Y', 'Z'};

/// Axis numbers in the order of the channels.
using Axes = std::array<int, 3>;

Axes axes_of(BvhOrder order) {
  switch (order) {
    case BvhOrder::kZxy:
      return {2, 0, 1};
    case BvhOrder::kZyx:
      return {2, 1, 0};
    case BvhOrder::kXyz:
      return {0, 1, 2};
    case BvhOrder::kXzy:
      return {0, 2, 1};
    case BvhOrder::kYxz:
      return {1, 0, 2};
    case BvhOrder::kYzx:
      return {1, 2, 0};
  }
  MAREY_ASSERT(false);
  return {};
}

double nearest_turn(double angle_rad, double to_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle_rad + kTurn * std::round((to_rad - angle_rad) / kTurn);
}

glm::dvec3 near_to(const glm::dvec3& angles, const glm::dvec3& last) {
  return {nearest_turn(angles.x, last.x),
          nearest_turn(angles.y, last.y),
          nearest_turn(angles.z, last.z)};
}

/// Returns the angles (a, b, c) with rotation = R_i(a) R_j(b) R_k(c) for `axes` i, j, k.
/// There are two solutions and their full turns; the result is the one nearest to `last`.
/// [rad]
glm::dvec3 euler_angles(const glm::dquat& rotation,
                        const Axes& axes,
                        const glm::dvec3& last) {
  const glm::dmat3 columns = glm::mat3_cast(rotation);
  const auto m = [&](int row, int column) {
    return columns[axes[static_cast<std::size_t>(column)]]
                  [axes[static_cast<std::size_t>(row)]];
  };
  const double sign = (axes[1] - axes[0] + 3) % 3 == 1 ? 1.0 : -1.0;
  const double cos_b = std::hypot(m(0, 0), m(0, 1));
  const double b = std::atan2(sign * m(0, 2), cos_b);
  // With b at a right angle only a + c or a - c is determined: keep the last a.
  const double a = cos_b > 1e-9 ? std::atan2(-sign * m(1, 2), m(2, 2)) : last.x;
  // c is computed after R_i(a) is undone, which is exact near the right angle.
  const double sin_c = sign * (std::cos(a) * m(1, 0) + sign * std::sin(a) * m(2, 0));
  const double cos_c = std::cos(a) * m(1, 1) + sign * std::sin(a) * m(2, 1);
  const double c = std::atan2(sin_c, cos_c);

  constexpr double kPi = std::numbers::pi;
  const glm::dvec3 one = near_to({a, b, c}, last);
  const glm::dvec3 other = near_to({a + kPi, kPi - b, c + kPi}, last);
  return glm::distance(one, last) <= glm::distance(other, last) ? one : other;
}

void append_vector(std::string& text, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) {
    text += ' ';
    append_fixed(text, v[i]);
  }
}

/// A skeleton in BVH's form: joint axes parallel to the world's at rest.
struct BvhBody {
  const Skeleton& skeleton;
  std::vector<RigidTransform> world_from_rest_joint;
  std::vector<std::vector<std::size_t>> children;
  std::vector<std::string> names;

  BvhBody(const Skeleton& of, BvhNames as)
      : skeleton(of),
        world_from_rest_joint(world_from_joints(of, rest_pose(of))),
        children(of.joints.size()),
        names(bvh_names(of, as)) {
    for (std::size_t i = 1; i < of.joints.size(); ++i) {
      MAREY_ASSERT(of.joints[i].parent.has_value());
      children[index(*of.joints[i].parent)].push_back(i);
    }
  }

  [[nodiscard]] glm::dvec3 offset(std::size_t joint) const {
    const auto& parent = skeleton.joints[joint].parent;
    if (!parent) return glm::dvec3(0.0);
    return world_from_rest_joint[joint].translation -
           world_from_rest_joint[index(*parent)].translation;
  }

  /// Returns the end of the bone of a childless joint. Viewers need some length, so the
  /// bone of a joint without a tip has half the length of its parent bone.
  [[nodiscard]] glm::dvec3 end_offset(std::size_t joint) const {
    const auto& tip = skeleton.joints[joint].tip_in_joint;
    if (tip) return world_from_rest_joint[joint].rotation * *tip;
    if (joint == 0) return {0.0, 0.1, 0.0};
    return 0.5 * offset(joint);
  }
};

/// Appends joints depth first, as the format requires; `order` receives their file order.
void append_joint(std::string& text,
                  const BvhBody& body,
                  const BvhWriteOptions& options,
                  std::size_t joint,
                  std::size_t depth,
                  std::vector<std::size_t>& order) {
  order.push_back(joint);
  const std::string indent(depth, '\t');
  text += indent + (depth == 0 ? "ROOT " : "JOINT ") + body.names[joint] + "\n";
  text += indent + "{\n";
  text += indent + "\tOFFSET";
  append_vector(text, body.offset(joint) / options.unit_m);
  text += "\n" + indent + "\tCHANNELS ";
  text += depth == 0 ? "6 Xposition Yposition Zposition" : "3";
  for (const int axis : axes_of(options.order)) {
    text += std::string(" ") + kAxisNames[static_cast<std::size_t>(axis)] + "rotation";
  }
  text += "\n";
  for (const std::size_t child : body.children[joint]) {
    append_joint(text, body, options, child, depth + 1, order);
  }
  if (body.children[joint].empty()) {
    text += indent + "\tEnd Site\n" + indent + "\t{\n" + indent + "\t\tOFFSET";
    append_vector(text, body.end_offset(joint) / options.unit_m);
    text += "\n" + indent + "\t}\n";
  }
  text += indent + "}\n";
}

/// Returns rotations relative to the rest pose, in axes parallel to the world's.
std::vector<glm::dquat> rotations_since_rest(const BvhBody& body, const Pose& pose) {
  std::vector<RigidTransform> world_from_joint = world_from_joints(body.skeleton, pose);
  std::vector<glm::dquat> world_rotations;
  for (std::size_t i = 0; i < world_from_joint.size(); ++i) {
    world_rotations.push_back(
        glm::normalize(world_from_joint[i].rotation *
                       glm::conjugate(body.world_from_rest_joint[i].rotation)));
  }
  return pose_from_world(body.skeleton, pose.root_in_world, world_rotations)
      .parent_from_joint;
}

}  // namespace

BvhWriteOptions write_options(BvhDialect dialect) {
  switch (dialect) {
    case BvhDialect::kBlender:
      return {BvhOrder::kZyx, 1.0, BvhNames::kOwn};
    case BvhDialect::kMobu:
      return {BvhOrder::kZyx, 0.01, BvhNames::kHumanIk};
    case BvhDialect::kMaya:
      return {BvhOrder::kZyx, 0.01, BvhNames::kHumanIk};
    case BvhDialect::kUnity:
      return {BvhOrder::kYxz, 1.0, BvhNames::kUnity};
  }
  MAREY_ASSERT(false);
  return {};
}

std::string_view name(BvhDialect dialect) {
  constexpr std::array<std::string_view, 4> kNames{"blender", "mobu", "maya", "unity"};
  return kNames[static_cast<std::size_t>(dialect)];
}

std::optional<BvhDialect> bvh_dialect(std::string_view word) {
  for (const BvhDialect dialect :
       {BvhDialect::kBlender, BvhDialect::kMobu, BvhDialect::kMaya, BvhDialect::kUnity}) {
    if (word == name(dialect)) return dialect;
  }
  return std::nullopt;
}

std::string bvh_text(const Motion& motion, const BvhWriteOptions& options) {
  MAREY_ASSERT(!motion.skeleton.joints.empty());
  MAREY_ASSERT(options.unit_m > 0.0);
  MAREY_ASSERT(motion.rate.hz > 0.0);
  const BvhBody body(motion.skeleton, options.names);
  std::string text = "HIERARCHY\n";
  std::vector<std::size_t> order;
  append_joint(text, body, options, 0, 0, order);

  text += "MOTION\nFrames: " + std::to_string(motion.poses.size()) + "\nFrame Time: ";
  append_exact(text, 1.0 / motion.rate.hz);
  text += "\n";
  const Axes axes = axes_of(options.order);
  std::vector<glm::dvec3> last(order.size(), glm::dvec3(0.0));
  for (const Pose& pose : motion.poses) {
    const std::vector<glm::dquat> rotations = rotations_since_rest(body, pose);
    std::string line;
    append_vector(line, pose.root_in_world / options.unit_m);
    for (const std::size_t joint : order) {
      last[joint] = euler_angles(rotations[joint], axes, last[joint]);
      append_vector(line, last[joint] * kDegreesPerRadian);
    }
    text.append(line, 1);
    text += "\n";
  }
  return text;
}

Status write_bvh(const std::filesystem::path& path,
                 const Motion& motion,
                 const BvhWriteOptions& options) {
  return write_file(path, bvh_text(motion, options));
}

}  // namespace marey::recordings
