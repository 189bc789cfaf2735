// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string_view>

#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/motion/npz.h"
#include "recordings/motion/npz_arrays.h"

namespace marey::recordings {
namespace {

constexpr std::int64_t kFormat = 1;

void append_point(std::string& bytes, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) append(bytes, v[i]);
}

void append_wxyz(std::string& bytes, const glm::dquat& q) {
  for (const double part : {q.w, q.x, q.y, q.z}) append(bytes, part);
}

void add_skeleton(NpzArrays& arrays, const Skeleton& skeleton) {
  const std::size_t joints = skeleton.joints.size();
  std::vector<std::string> names;
  std::vector<std::string> bones;
  std::string parents;
  std::string places;
  std::string rotations;
  for (const Joint& joint : skeleton.joints) {
    names.push_back(joint.name);
    bones.emplace_back(joint.bone ? name(*joint.bone) : "");
    append(parents, joint.parent ? static_cast<std::int32_t>(index(*joint.parent)) : -1);
    append_point(places, joint.parent_from_joint.translation);
    append_wxyz(rotations, glm::normalize(joint.parent_from_joint.rotation));
  }
  arrays.add_texts("joint_names", names);
  arrays.add_texts("human_bones", bones);
  arrays.add("parents", "<i4", {joints}, parents);
  arrays.add("rest_translations", "<f8", {joints, 3}, places);
  arrays.add("rest_rotations_wxyz", "<f8", {joints, 4}, rotations);
}

/// Appends `rotation` with the sign nearest to `last`, and stores it there.
void append_near(std::string& bytes, const glm::dquat& rotation, glm::dquat& last) {
  const glm::dquat unit = glm::normalize(rotation);
  last = glm::dot(unit, last) < 0.0 ? -unit : unit;
  append_wxyz(bytes, last);
}

void add_poses(NpzArrays& arrays, const Motion& motion) {
  const std::size_t joints = motion.skeleton.joints.size();
  const std::size_t frames = motion.poses.size();
  const glm::dquat none(1.0, 0.0, 0.0, 0.0);
  std::vector<RigidTransform> world_from_joint(joints);
  std::vector<glm::dquat> last_local(joints, none);
  std::vector<glm::dquat> last_world(joints, none);
  std::string places;
  std::string local;
  std::string world;
  for (const Pose& pose : motion.poses) {
    MAREY_ASSERT(pose.parent_from_joint.size() == joints);
    world_from_joints(motion.skeleton, pose, world_from_joint);
    for (std::size_t i = 0; i < joints; ++i) {
      append_point(places, world_from_joint[i].translation);
      append_near(local, pose.parent_from_joint[i], last_local[i]);
      append_near(world, world_from_joint[i].rotation, last_world[i]);
    }
  }
  arrays.add("positions", "<f8", {frames, joints, 3}, places);
  arrays.add("rotations_wxyz", "<f8", {frames, joints, 4}, local);
  arrays.add("world_rotations_wxyz", "<f8", {frames, joints, 4}, world);
}

void add_uncertainty(NpzArrays& arrays,
                     std::span<const std::vector<JointUncertainty>> uncertainty,
                     std::size_t joints) {
  std::string sigmas;
  std::string sources;
  std::string valid;
  for (const std::vector<JointUncertainty>& frame : uncertainty) {
    MAREY_ASSERT(frame.size() == joints);
    for (const JointUncertainty& joint : frame) {
      append(sigmas, joint.sigma_m);
      append(sources, static_cast<std::uint8_t>(joint.source));
      append(valid, static_cast<std::uint8_t>(joint.source != Source::kInferred));
    }
  }
  const NpyShape shape{uncertainty.size(), joints};
  arrays.add("sigma_m", "<f8", shape, sigmas);
  arrays.add("source", "|u1", shape, sources);
  std::vector<std::string> names;
  for (const Source source : {Source::kMeasured, Source::kRepaired, Source::kInferred}) {
    MAREY_ASSERT(static_cast<std::size_t>(source) == names.size());
    names.emplace_back(name(source));
  }
  arrays.add_texts("source_names", names);
  arrays.add("valid", "|b1", shape, valid);
}

void add_clip(NpzArrays& arrays, const ClipRecord& clip) {
  arrays.add_text("clip_id", clip.clip_id);
  arrays.add_text("licence", clip.provenance.licence);
  std::vector<std::string> texts;
  std::vector<std::string> authors;
  std::string times;
  for (const ClipLabel& label : clip.labels) {
    texts.push_back(label.text);
    authors.push_back(label.by);
    append(times, label.start_s);
    append(times, label.end_s);
  }
  arrays.add_texts("labels", texts);
  arrays.add_texts("label_by", authors);
  arrays.add("label_times_s", "<f8", {texts.size(), 2}, times);
}

}  // namespace

Result<std::string> npz_bytes(const Motion& motion, const NpzExtras& extras) {
  const std::size_t frames = motion.poses.size();
  MAREY_ASSERT(!motion.skeleton.joints.empty());
  NpzArrays arrays;
  arrays.add_integer("format", kFormat);
  arrays.add_number("rate_hz", motion.rate.hz);
  arrays.add_integer("first_frame", motion.first_frame);
  const double start_s = extras.start_s.value_or(motion.first_frame / motion.rate.hz);
  std::string times;
  for (std::size_t i = 0; i < frames; ++i) {
    append(times, start_s + static_cast<double>(i) / motion.rate.hz);
  }
  arrays.add("time_s", "<f8", {frames}, times);
  add_skeleton(arrays, motion.skeleton);
  add_poses(arrays, motion);
  if (!extras.uncertainty.empty()) {
    MAREY_ASSERT(extras.uncertainty.size() == frames);
    add_uncertainty(arrays, extras.uncertainty, motion.skeleton.joints.size());
  }
  if (const auto& [names, bears] = extras.contacts; !names.empty()) {
    MAREY_ASSERT(bears.size() == frames * names.size());
    std::string data;
    for (const std::uint8_t one : bears) data += one != 0 ? '\1' : '\0';
    arrays.add_texts("contact_names", names);
    arrays.add("contacts", "|b1", {frames, names.size()}, data);
  }
  if (extras.clip != nullptr) add_clip(arrays, *extras.clip);
  if (auto bytes = arrays.finish()) return *std::move(bytes);
  return bad_input("", "the motion takes more than 4 GiB", "write fewer frames");
}

Status write_npz(const std::filesystem::path& path,
                 const Motion& motion,
                 const NpzExtras& extras) {
  Result<std::string> bytes = npz_bytes(motion, extras);
  if (bytes) return write_file(path, *bytes);
  Error error = bytes.error();
  error.where = path.string();
  return error;
}

}  // namespace marey::recordings
