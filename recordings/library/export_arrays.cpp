// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/export_arrays.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/library/joint_names.h"
#include "core/pose.h"
#include "recordings/motion/npz_arrays.h"

namespace marey::recordings {
namespace {

constexpr std::size_t kSmplHJoints = 52;
constexpr std::size_t kBetas = 16;
constexpr std::size_t kDmpls = 8;

using SmplPlaces = std::array<std::size_t, kHumanBoneCount>;

/// Finds the joint of each of SMPL's 22.
Result<SmplPlaces> find_smpl_joints(const Skeleton& skeleton) {
  SmplPlaces out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const HumanBone bone = kSmplJoints[i].bone;
    const auto joint = skeleton.find(bone);
    if (!joint) {
      return bad_input(
          "",
          "the body has no bone " + in_quotes(bone) + ", which SMPL's 22 joints need",
          "export with --skeleton smpl22");
    }
    out[i] = index(*joint);
  }
  return out;
}

/// Returns axis times angle, with the angle in [0, pi].
glm::dvec3 rotation_vector(glm::dquat q) {
  if (q.w < 0.0) q = -q;
  const glm::dvec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return 2.0 * axis;
  return axis * (2.0 * std::atan2(sine, q.w) / sine);
}

void append_vector(std::string& bytes, const glm::dvec3& v) {
  for (int k = 0; k < 3; ++k) append(bytes, v[k]);
}

std::string zeros(std::size_t numbers) {
  return std::string(numbers * sizeof(double), '\0');
}

Result<std::string> finished(NpzArrays& arrays) {
  if (auto bytes = arrays.finish()) return *std::move(bytes);
  return bad_input("", "the result takes more than 4 GiB", "export fewer clips");
}

template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  std::string out;
  out.reserve(values.size() * sizeof(T));
  for (const T value : values) append(out, value);
  return out;
}

}  // namespace

Result<std::string> amass_bytes(const Motion& motion) {
  const auto joints = find_smpl_joints(motion.skeleton);
  if (!joints) return joints.error();
  const std::size_t frames = motion.poses.size();
  // A quarter turn about X: Y up becomes Z up.
  const glm::dquat zup_from_yup(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::string poses;
  std::string places;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    for (std::size_t i = 0; i < joints->size(); ++i) {
      const glm::dquat& own = world[(*joints)[i]].rotation;
      glm::dquat local = zup_from_yup * own;
      // Joints without a bone may lie between a bone and its parent.
      if (const auto above = parent(kSmplJoints[i].bone)) {
        const auto joint = motion.skeleton.find(*above);
        MAREY_ASSERT(joint.has_value());
        local = glm::conjugate(world[index(*joint)].rotation) * own;
      }
      append_vector(poses, rotation_vector(glm::normalize(local)));
    }
    poses += zeros(3 * (kSmplHJoints - joints->size()));
    const glm::dvec3& hips = world[joints->front()].translation;
    append_vector(places, {hips.x, -hips.z, hips.y});
  }
  NpzArrays arrays;
  arrays.add("poses", "<f8", {frames, 3 * kSmplHJoints}, poses);
  arrays.add("trans", "<f8", {frames, 3}, places);
  arrays.add("betas", "<f8", {kBetas}, zeros(kBetas));
  arrays.add("dmpls", "<f8", {frames, kDmpls}, zeros(frames * kDmpls));
  arrays.add_text("gender", "neutral");
  arrays.add_number("mocap_framerate", motion.rate.hz);
  arrays.add_number("mocap_frame_rate", motion.rate.hz);
  return finished(arrays);
}

Result<std::string> joints22_bytes(const Motion& motion) {
  const auto joints = find_smpl_joints(motion.skeleton);
  if (!joints) return joints.error();
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::string places;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    for (const std::size_t joint : *joints) {
      for (int k = 0; k < 3; ++k) {
        append(places, static_cast<float>(world[joint].translation[k]));
      }
    }
  }
  return npy_bytes("<f4", {motion.poses.size(), joints->size(), 3}, places);
}

Result<std::string> matching_bytes(const MatchingDatabase& database) {
  const std::size_t columns = database.columns.size();
  const std::size_t clips = database.clip_ids.size();
  MAREY_ASSERT(columns > 0 && database.features.size() % columns == 0);
  MAREY_ASSERT(database.offset.size() == columns && database.scale.size() == columns);
  MAREY_ASSERT(database.starts.size() == clips && database.stops.size() == clips);
  NpzArrays arrays;
  arrays.add("features",
             "<f4",
             {database.features.size() / columns, columns},
             raw_bytes(database.features));
  arrays.add("features_offset", "<f4", {columns}, raw_bytes(database.offset));
  arrays.add("features_scale", "<f4", {columns}, raw_bytes(database.scale));
  arrays.add_texts("feature_names", database.columns);
  arrays.add("range_starts", "<i4", {clips}, raw_bytes(database.starts));
  arrays.add("range_stops", "<i4", {clips}, raw_bytes(database.stops));
  arrays.add("rate_hz", "<f8", {clips}, raw_bytes(database.rates_hz));
  arrays.add_texts("clip_ids", database.clip_ids);
  return finished(arrays);
}

}  // namespace marey::recordings
