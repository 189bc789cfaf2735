// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/retarget/measure_spines.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "retarget/body/body_map.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/retarget_motion.h"

namespace marey {
namespace {

using B = HumanBone;

constexpr int kMaxCount = 6;

std::vector<JointIndex> vertebrae_of(const retarget::BodyMap& map) {
  std::vector<JointIndex> out;
  for (const retarget::SpineSection* section : {&map.abdomen, &map.torso}) {
    const auto* first = section->joints.data();
    out.insert(out.end(), first, first + section->count);
  }
  return out;
}

// `count` places at equal steps along these, from the first; the last is one step away.
std::vector<glm::dvec3> along(const std::vector<glm::dvec3>& way, int count) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    length += glm::distance(way[i - 1], way[i]);
  std::vector<glm::dvec3> out;
  for (int k = 0; k < count; ++k) {
    double left = length * k / count;
    std::size_t i = 1;
    while (i + 1 < way.size() && left > glm::distance(way[i - 1], way[i])) {
      left -= glm::distance(way[i - 1], way[i]);
      ++i;
    }
    out.push_back(way[i - 1] + left * glm::normalize(way[i] - way[i - 1]));
  }
  return out;
}

// The body with `count` vertebrae in place of its own.
Skeleton with_count(const Skeleton& body, const retarget::BodyMap& map, int count) {
  const auto rest = world_from_joints(body, rest_pose(body));
  const std::vector<JointIndex> old = vertebrae_of(map);
  std::vector<glm::dvec3> way;
  for (const JointIndex joint : old) way.push_back(rest[index(joint)].translation);
  way.push_back(rest[index(*body.find(B::kNeck))].translation);

  Skeleton out;
  std::vector<RigidTransform> frames;
  std::vector<JointIndex> place(body.joints.size());
  const auto add = [&](Joint joint, const RigidTransform& frame) {
    joint.parent_from_joint =
        joint.parent ? inverse(frames[index(*joint.parent)]) * frame : frame;
    out.joints.push_back(std::move(joint));
    frames.push_back(frame);
    return JointIndex{static_cast<int>(out.joints.size()) - 1};
  };
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    const JointIndex self{static_cast<int>(i)};
    if (self == old.front()) {
      JointIndex below = place[index(map.hips())];
      for (const glm::dvec3& where : along(way, count)) {
        Joint vertebra;
        vertebra.name = "vertebra" + std::to_string(out.joints.size());
        vertebra.parent = below;
        below = add(vertebra, {{1, 0, 0, 0}, where});
      }
      for (const JointIndex joint : old) place[index(joint)] = below;
    }
    if (std::find(old.begin(), old.end(), self) != old.end()) continue;
    Joint joint = body.joints[i];
    if (joint.parent) joint.parent = place[index(*joint.parent)];
    place[i] = add(std::move(joint), rest[i]);
  }
  return out;
}

/// Worst and mean. [mm]
struct Off {
  double worst = 0.0;
  double sum = 0.0;
  int count = 0;

  void add(double m) {
    worst = std::max(worst, 1e3 * m);
    sum += 1e3 * m;
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0.0; }
};

struct SpineOffs {
  Off neck;
  Off shoulders;
  Off wrists;
  double one_bone_mm = 0.0;
};

SpineOffs compare(const Motion& source, const Motion& motion, int count) {
  SpineOffs out;
  const auto hips = *motion.skeleton.find(B::kHips);
  const std::size_t first = index(hips) + 1;
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    const auto from = world_from_joints(source.skeleton, source.poses[t]);
    const auto to = world_from_joints(motion.skeleton, motion.poses[t]);
    const auto add = [&](B bone, Off& off) {
      const auto a = source.skeleton.find(bone);
      const auto b = motion.skeleton.find(bone);
      if (!a || !b) return;
      off.add(glm::distance(from[index(*a)].translation, to[index(*b)].translation));
    };
    add(B::kNeck, out.neck);
    for (const B bone : {B::kLeftUpperArm, B::kRightUpperArm}) add(bone, out.shoulders);
    for (const B bone : {B::kLeftHand, B::kRightHand}) add(bone, out.wrists);
    if (count > 1) continue;
    std::size_t vertebra = first;
    while (!motion.skeleton.joints[vertebra].name.starts_with("vertebra")) ++vertebra;
    const glm::dvec3 low = to[vertebra].translation;
    const double wanted =
        glm::distance(low, from[index(*source.skeleton.find(B::kNeck))].translation);
    const double bone =
        glm::distance(low, to[index(*motion.skeleton.find(B::kNeck))].translation);
    out.one_bone_mm = std::max(out.one_bone_mm, 1e3 * std::abs(wanted - bone));
  }
  return out;
}

}  // namespace

Result<ResultTable> measure_spines(std::span<const CapturedClip> clips) {
  ResultTable table{"spines",
                    "The same body with other bones in its spine",
                    {{"clip"},
                     {"bones"},
                     {"neck worst mm", 2},
                     {"mean", 2},
                     {"one bone's length mm", 2},
                     {"shoulders worst mm", 2},
                     {"mean", 2},
                     {"wrists worst mm", 2},
                     {"mean", 2},
                     {"jerk / source's", 3}},
                    {},
                    {}};
  retarget::RetargetOptions options;
  options.adapt_ground = false;
  for (const CapturedClip& clip : clips) {
    const Motion source{clip.character.skeleton, {clip.rate_hz}, 0, clip.poses};
    const auto map = retarget::map_body(source.skeleton);
    if (!map) return map.error();
    for (int count = 1; count <= kMaxCount; ++count) {
      const Skeleton body = with_count(source.skeleton, *map, count);
      const auto whole = retarget::retarget_motion(source, body, options);
      if (!whole) return whole.error();
      const SpineOffs off = compare(source, whole->motion, count);
      table.rows.push_back(
          {clip.name,
           std::to_string(count) + " for " + std::to_string(vertebrae_of(*map).size()),
           off.neck.worst,
           off.neck.mean(),
           off.one_bone_mm,
           off.shoulders.worst,
           off.shoulders.mean(),
           off.wrists.worst,
           off.wrists.mean(),
           retarget::mean_jerk(whole->motion) / retarget::mean_jerk(source)});
    }
  }
  return table;
}

}  // namespace marey
