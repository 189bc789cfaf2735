// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/skin.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/pose.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

SkinPart part_of(HumanBone bone) {
  switch (bone) {
    case B::kHead:
      return SkinPart::kHead;
    case B::kLeftUpperArm:
      return SkinPart::kLeftUpperArm;
    case B::kLeftLowerArm:
      return SkinPart::kLeftForearm;
    case B::kLeftHand:
      return SkinPart::kLeftHand;
    case B::kRightUpperArm:
      return SkinPart::kRightUpperArm;
    case B::kRightLowerArm:
      return SkinPart::kRightForearm;
    case B::kRightHand:
      return SkinPart::kRightHand;
    case B::kLeftUpperLeg:
      return SkinPart::kLeftThigh;
    case B::kLeftLowerLeg:
      return SkinPart::kLeftShank;
    case B::kLeftFoot:
    case B::kLeftToes:
      return SkinPart::kLeftFoot;
    case B::kRightUpperLeg:
      return SkinPart::kRightThigh;
    case B::kRightLowerLeg:
      return SkinPart::kRightShank;
    case B::kRightFoot:
    case B::kRightToes:
      return SkinPart::kRightFoot;
    default:
      return SkinPart::kTrunk;
  }
}

std::size_t main_carrier(const SkinVertex& vertex) {
  const auto heaviest = std::ranges::max_element(vertex.weights);
  return index(
      vertex.joints[static_cast<std::size_t>(heaviest - vertex.weights.begin())]);
}

// Returns the Y row of a joint's frame: its product with (place, 1) is the place's
// height.
glm::dvec4 height_row(const RigidTransform& world_from_joint) {
  const glm::dvec3 up =
      glm::conjugate(world_from_joint.rotation) * glm::dvec3(0.0, 1.0, 0.0);
  return {up, world_from_joint.translation.y};
}

}  // namespace

std::string_view name(SkinPart part) {
  constexpr std::array<std::string_view, kSkinPartCount> kNames{"head",
                                                                "trunk",
                                                                "hair or clothes",
                                                                "left upper arm",
                                                                "left forearm",
                                                                "left hand",
                                                                "left thigh",
                                                                "left shank",
                                                                "left foot",
                                                                "right upper arm",
                                                                "right forearm",
                                                                "right hand",
                                                                "right thigh",
                                                                "right shank",
                                                                "right foot"};
  return kNames[index(part)];
}

std::vector<SkinPart> skin_parts(const Skeleton& skeleton, const BodyMap& map) {
  constexpr int kNearBody = 2;
  const std::size_t count = skeleton.joints.size();
  MAREY_ASSERT(map.joints.size() == count);
  std::vector<char> carries_body(count, 0);
  for (std::size_t j = count; j-- > 0;) {
    if (map.joints[j].role != JointRole::kFree) carries_body[j] = 1;
    const auto parent = skeleton.joints[j].parent;
    if (carries_body[j] != 0 && parent) carries_body[index(*parent)] = 1;
  }
  std::vector<SkinPart> parts(count, SkinPart::kTrunk);
  std::vector<int> links(count, 0);  // From the joint of the body above it.
  for (std::size_t j = 0; j < count; ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.bone) {
      parts[j] = part_of(*joint.bone);
      continue;
    }
    if (!joint.parent) continue;
    const std::size_t parent = index(*joint.parent);
    parts[j] = parts[parent];
    if (carries_body[j] != 0) continue;
    links[j] = links[parent] + 1;
    const bool on_body = parts[j] == SkinPart::kHead || parts[j] == SkinPart::kTrunk;
    if (on_body && links[j] > kNearBody) parts[j] = SkinPart::kWorn;
  }
  return parts;
}

Skin::Skin(const Skeleton& skeleton,
           const BodyMap& map,
           std::span<const SkinVertex> vertices) {
  const std::vector<SkinPart> parts = skin_parts(skeleton, map);
  std::vector<RigidTransform> joint_from_world =
      world_from_joints(skeleton, rest_pose(skeleton));
  for (RigidTransform& frame : joint_from_world) frame = inverse(frame);
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(
      order, {}, [&](std::uint32_t v) { return main_carrier(vertices[v]); });
  std::optional<std::size_t> carrier;
  for (const std::uint32_t v : order) {
    const SkinVertex& vertex = vertices[v];
    const auto at = static_cast<std::uint32_t>(first_.size());
    if (carrier != main_carrier(vertex)) {
      carrier = main_carrier(vertex);
      groups_.push_back({parts[*carrier], at, at, 0, 0});
    }
    groups_.back().last = at + 1;
    first_.push_back(static_cast<std::uint32_t>(influences_.size()));
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = vertex.weights[k];
      if (weight <= 0.0) continue;
      const std::size_t joint = index(vertex.joints[k]);
      influences_.push_back(
          {static_cast<std::uint32_t>(joint),
           weight * glm::dvec4(joint_from_world[joint] * vertex.p_in_world, 1.0)});
    }
  }
  for (Group& group : groups_) add_bounds(group);
}

void Skin::add_bounds(Group& group) {
  const auto end_of = [&](std::uint32_t v) {
    return v + 1 < first_.size() ? first_[v + 1]
                                 : static_cast<std::uint32_t>(influences_.size());
  };
  const std::span<const Influence> all(influences_.data() + first_[group.first],
                                       influences_.data() + end_of(group.last - 1));
  group.first_bound = static_cast<std::uint32_t>(bounds_.size());
  std::vector<std::uint32_t> joints;
  for (const Influence& one : all) joints.push_back(one.joint);
  std::ranges::sort(joints);
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  for (const std::uint32_t joint : joints) {
    glm::dvec3 low(1e9);
    glm::dvec3 high(-1e9);
    for (const Influence& one : all) {
      if (one.joint != joint) continue;
      const glm::dvec3 p = glm::dvec3(one.weighted) / one.weighted.w;
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    bounds_.push_back(
        {joint, glm::dvec4(0.5 * (low + high), 1.0), 0.5 * glm::length(high - low)});
  }
  group.last_bound = static_cast<std::uint32_t>(bounds_.size());
}

void Skin::lows(std::span<const RigidTransform> world_from_joint,
                double ceiling_m,
                std::span<glm::dvec4> rows,
                SkinLows& out) const {
  MAREY_ASSERT(rows.size() == world_from_joint.size());
  for (std::size_t j = 0; j < rows.size(); ++j) {
    rows[j] = height_row(world_from_joint[j]);
  }
  out.fill(kNoSkin_m);
  for (const Group& group : groups_) {
    double& lowest_m = out[index(group.part)];
    // A vertex is no lower than the lowest position that one of its joints gives it.
    double bound_m = kNoSkin_m;
    for (std::uint32_t b = group.first_bound; b < group.last_bound; ++b) {
      const Bound& bound = bounds_[b];
      bound_m =
          std::min(bound_m, glm::dot(rows[bound.joint], bound.centre) - bound.radius_m);
    }
    if (bound_m >= std::min(lowest_m, ceiling_m)) continue;
    for (std::uint32_t v = group.first; v < group.last; ++v) {
      const std::size_t end = v + 1 < first_.size() ? first_[v + 1] : influences_.size();
      double y_m = 0.0;
      for (std::size_t k = first_[v]; k < end; ++k) {
        y_m += glm::dot(rows[influences_[k].joint], influences_[k].weighted);
      }
      lowest_m = std::min(lowest_m, y_m);
    }
  }
}

}  // namespace marey::retarget
