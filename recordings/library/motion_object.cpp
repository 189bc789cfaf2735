// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/motion_object.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/base/input_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/motion/npz_arrays.h"
#include "recordings/motion/npz_head.h"

namespace marey::recordings {
namespace {

constexpr std::int64_t kObjectLayout = 2;
constexpr std::size_t kFootPartCount = 4;

void append_float(std::string& bytes, double value) {
  append(bytes, static_cast<float>(value));
}

/// Adds the skeleton. Returns false if its rest pose has rotations.
bool add_object_skeleton(NpzArrays& arrays, const Skeleton& skeleton) {
  constexpr double kIdentity = 1e-9;
  std::vector<std::string> names;
  std::vector<std::string> bones;
  std::string parents;
  std::string places;
  for (const Joint& joint : skeleton.joints) {
    const glm::dquat& turn = joint.parent_from_joint.rotation;
    if (1.0 - std::abs(turn.w) > kIdentity) return false;
    names.push_back(joint.name);
    bones.emplace_back(joint.bone ? name(*joint.bone) : "");
    append(parents, joint.parent ? static_cast<std::int32_t>(index(*joint.parent)) : -1);
    for (int k = 0; k < 3; ++k) {
      append_float(places, joint.parent_from_joint.translation[k]);
    }
  }
  arrays.add_texts("joint_names", names);
  arrays.add_texts("human_bones", bones);
  arrays.add("parents", "<i4", {names.size()}, parents);
  arrays.add("rest_translations_m", "<f4", {names.size(), 3}, places);
  return true;
}

void add_object_poses(NpzArrays& arrays, const Motion& motion) {
  const std::size_t joints = motion.skeleton.joints.size();
  std::vector<glm::dquat> last(joints, glm::dquat(1.0, 0.0, 0.0, 0.0));
  std::string roots;
  std::string turns;
  for (const Pose& pose : motion.poses) {
    MAREY_ASSERT(pose.parent_from_joint.size() == joints);
    for (int k = 0; k < 3; ++k) append_float(roots, pose.root_in_world[k]);
    for (std::size_t j = 0; j < joints; ++j) {
      const glm::dquat unit = glm::normalize(pose.parent_from_joint[j]);
      last[j] = glm::dot(unit, last[j]) < 0.0 ? -unit : unit;
      for (const double part : {last[j].w, last[j].x, last[j].y, last[j].z}) {
        append_float(turns, part);
      }
    }
  }
  const std::size_t frames = motion.poses.size();
  arrays.add("root_m", "<f4", {frames, 3}, roots);
  arrays.add("rotations_wxyz", "<f4", {frames, joints, 4}, turns);
}

void add_object_uncertainty(NpzArrays& arrays, const LibraryMotion& motion) {
  std::string sigmas;
  std::string sources;
  for (const std::vector<JointUncertainty>& frame : motion.uncertainty) {
    for (const JointUncertainty& joint : frame) {
      append_float(sigmas, joint.sigma_m);
      append(sources, static_cast<std::uint8_t>(joint.source));
    }
  }
  const NpyShape shape{motion.uncertainty.size(), motion.motion.skeleton.joints.size()};
  arrays.add("sigma_m", "<f4", shape, sigmas);
  arrays.add("source", "|u1", shape, sources);
}

/// Reads the arrays of one object.
class ObjectReader {
 public:
  explicit ObjectReader(std::string file)
      : in_(std::move(file), "build the library again: marey library build") {}

  Result<LibraryMotion> read(std::optional<ZipReader> zip) {
    if (Status ok = in_.open(std::move(zip)); !ok) return ok.error();
    for (const auto step : {&ObjectReader::read_head,
                            &ObjectReader::read_skeleton,
                            &ObjectReader::read_poses,
                            &ObjectReader::read_contacts,
                            &ObjectReader::read_uncertainty}) {
      if (Status ok = (this->*step)(); !ok) return ok.error();
    }
    return std::move(out_);
  }

 private:
  Status read_head() {
    if (!in_.has("format")) return in_.fail("it is no motion of a library");
    const auto layout = in_.number<std::int64_t>("format", "<i8");
    if (!layout) return layout.error();
    if (*layout != kObjectLayout) {
      return in_.fail("it is of layout " + std::to_string(*layout) +
                      ", a library needs 2");
    }
    return read_npz_rate(in_, out_.motion);
  }

  Status read_skeleton() {
    std::vector<Joint>& joints = out_.motion.skeleton.joints;
    if (Status ok = read_npz_joints(in_, out_.motion.skeleton); !ok) return ok;
    joints_ = joints.size();
    const auto places = in_.floats("rest_translations_m", {joints_, 3});
    if (!places) return places.error();
    for (std::size_t i = 0; i < joints_; ++i) {
      glm::dvec3& place = joints[i].parent_from_joint.translation;
      place = point(*places, i);
      if (!(glm::length(place) <= kMaxDistance_m)) {
        return in_.fail("rest_translations_m", "a joint lies further than 10 km away");
      }
    }
    return Done{};
  }

  static glm::dvec3 point(const std::vector<float>& xyz, std::size_t i) {
    return {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  }

  Status read_poses() {
    const auto shape = in_.shape("root_m");
    if (!shape) return shape.error();
    frames_ = shape->empty() ? 0 : shape->front();
    const auto roots = in_.floats("root_m", {frames_, 3});
    const auto turns = in_.floats("rotations_wxyz", {frames_, joints_, 4});
    if (!roots) return roots.error();
    if (!turns) return turns.error();
    out_.motion.poses.resize(frames_);
    for (std::size_t f = 0; f < frames_; ++f) {
      Pose& pose = out_.motion.poses[f];
      pose.root_in_world = point(*roots, f);
      if (!(glm::length(pose.root_in_world) <= kMaxDistance_m)) {
        return in_.fail("root_m", "the body goes further than 10 km");
      }
      pose.parent_from_joint.resize(joints_);
      for (std::size_t j = 0; j < joints_; ++j) {
        const float* wxyz = turns->data() + 4 * (f * joints_ + j);
        const glm::dquat q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
        if (!(std::abs(glm::length(q) - 1.0) <= 1e-3)) {
          return in_.fail(
              "rotations_wxyz",
              "frame " + std::to_string(f) + " holds no quaternion of length 1");
        }
        pose.parent_from_joint[j] = glm::normalize(q);
      }
    }
    return Done{};
  }

  Status read_contacts() {
    const auto bears = in_.array("contacts", "|u1", {frames_, kFootPartCount});
    if (!bears) return bears.error();
    out_.contacts.resize(frames_);
    for (std::size_t f = 0; f < frames_; ++f) {
      for (std::size_t k = 0; k < kFootPartCount; ++k) {
        const auto value = bears->at<std::uint8_t>(kFootPartCount * f + k);
        if (value > 1)
          return in_.fail("contacts", "it holds another number than 0 and 1");
        out_.contacts[f][k] = value;
      }
    }
    return Done{};
  }

  Status read_uncertainty() {
    if (!in_.has("sigma_m") && !in_.has("source")) return Done{};
    const auto sigmas = in_.floats("sigma_m", {frames_, joints_});
    const auto sources = in_.array("source", "|u1", {frames_, joints_});
    if (!sigmas) return sigmas.error();
    if (!sources) return sources.error();
    for (std::size_t f = 0; f < frames_; ++f) {
      std::vector<JointUncertainty>& frame = out_.uncertainty.emplace_back(joints_);
      for (std::size_t j = 0; j < joints_; ++j) {
        const auto source = sources->at<std::uint8_t>(f * joints_ + j);
        frame[j].sigma_m = (*sigmas)[f * joints_ + j];
        if (source > 2 || frame[j].sigma_m < 0.0) {
          return in_.fail("source",
                          "frame " + std::to_string(f) + " holds no source or sigma");
        }
        frame[j].source = static_cast<Source>(source);
      }
    }
    return Done{};
  }

  NpzInput in_;
  LibraryMotion out_;
  std::size_t joints_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace

Result<std::string> motion_object_bytes(const LibraryMotion& motion) {
  const std::size_t frames = motion.motion.poses.size();
  MAREY_ASSERT(!motion.motion.skeleton.joints.empty());
  MAREY_ASSERT(motion.contacts.size() == frames);
  NpzArrays arrays;
  arrays.add_integer("format", kObjectLayout);
  arrays.add_number("rate_hz", motion.motion.rate.hz);
  arrays.add_integer("first_frame", motion.motion.first_frame);
  if (!add_object_skeleton(arrays, motion.motion.skeleton)) {
    return bad_input("", "the rest pose has rotations", "report it with the file");
  }
  add_object_poses(arrays, motion.motion);
  std::string bears;
  for (const FootParts& parts : motion.contacts) {
    for (const std::uint8_t part : parts) bears += part != 0 ? '\1' : '\0';
  }
  arrays.add("contacts", "|u1", {frames, kFootPartCount}, bears);
  if (!motion.uncertainty.empty()) {
    MAREY_ASSERT(motion.uncertainty.size() == frames);
    add_object_uncertainty(arrays, motion);
  }
  if (auto bytes = arrays.finish()) return *std::move(bytes);
  return bad_input("", "the motion takes more than 4 GiB", "divide it");
}

Result<LibraryMotion> parse_motion_object(std::string_view bytes,
                                          const std::string& file) {
  return ObjectReader(file).read(ZipReader::open(bytes));
}

Result<LibraryMotion> read_motion_object(const std::filesystem::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  return ObjectReader(path.string()).read(ZipReader::open_file(path));
}

}  // namespace marey::recordings
