// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/humanoid.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/motion/npz.h"
#include "recordings/motion/npz_arrays.h"

namespace marey::recordings {
namespace {

class Reader {
 public:
  explicit Reader(const std::string& file)
      : in_(file, "give a .npz that marey wrote, without changes of its arrays") {}

  Result<NpzMotion> read(std::string_view bytes) {
    if (Status ok = in_.open(bytes); !ok) return ok.error();
    for (const auto step : {&Reader::head,
                            &Reader::skeleton,
                            &Reader::poses,
                            &Reader::uncertainty,
                            &Reader::contacts}) {
      if (Status ok = (this->*step)(); !ok) return ok.error();
    }
    return std::move(out_);
  }

 private:
  Status head() {
    if (!in_.has("format") || !in_.has("joint_names") || !in_.has("rotations_wxyz")) {
      return in_.fail("it is a .npz archive, but not of a motion");
    }
    const auto format = in_.number<std::int64_t>("format", "<i8");
    if (!format) return format.error();
    if (*format != 1) {
      return in_.fail("it is of layout " + std::to_string(*format) + ", marey reads 1");
    }
    const auto rate = in_.number<double>("rate_hz", "<f8");
    if (!rate) return rate.error();
    if (!(*rate >= kMinRateHz && *rate <= kMaxRateHz)) {
      return in_.fail("rate_hz", "the rate is not between 0.1 and 2000 Hz");
    }
    const auto first = in_.number<std::int64_t>("first_frame", "<i8");
    if (!first) return first.error();
    constexpr std::int64_t kMaxFirstFrame = 1'000'000'000;
    if (*first < -kMaxFirstFrame || *first > kMaxFirstFrame) {
      return in_.fail("first_frame", "the number is not that of a frame");
    }
    out_.motion.rate = FrameRate{*rate};
    out_.motion.first_frame = static_cast<int>(*first);
    return Done{};
  }

  Status skeleton() {
    const auto count = in_.length("joint_names");
    if (!count) return count.error();
    joints_ = *count;
    if (joints_ == 0 || joints_ > kMaxJoints) {
      return in_.fail("joint_names", "there are no joints, or too many");
    }
    const auto names = in_.texts("joint_names", joints_);
    const auto bones = in_.texts("human_bones", joints_);
    const auto parents = in_.array("parents", "<i4", {joints_});
    const auto places = in_.reals("rest_translations", {joints_, 3});
    const auto turns = in_.reals("rest_rotations_wxyz", {joints_, 4});
    if (!names) return names.error();
    if (!bones) return bones.error();
    if (!parents) return parents.error();
    if (!places) return places.error();
    if (!turns) return turns.error();
    std::vector<std::size_t> level(joints_, 1);
    for (std::size_t i = 0; i < joints_; ++i) {
      Joint joint;
      joint.name = (*names)[i];
      joint.bone = human_bone((*bones)[i]);
      const auto parent = parents->at<std::int32_t>(i);
      if (i == 0 ? parent != -1 : parent < 0 || std::cmp_greater_equal(parent, i)) {
        return in_.fail("parents",
                        "joint " + std::to_string(i) + " has no parent before it");
      }
      if (i > 0) {
        joint.parent = JointIndex{parent};
        level[i] = level[static_cast<std::size_t>(parent)] + 1;
      }
      if (level[i] > kMaxSkeletonDepth) {
        return in_.fail("parents", "joints are nested too deeply");
      }
      if (Status ok = transform(*places, *turns, i, joint.parent_from_joint); !ok) {
        return ok;
      }
      out_.motion.skeleton.joints.push_back(std::move(joint));
    }
    return Done{};
  }

  Status transform(const std::vector<double>& places,
                   const std::vector<double>& turns,
                   std::size_t i,
                   RigidTransform& out) const {
    out.translation = {places[3 * i], places[3 * i + 1], places[3 * i + 2]};
    if (!(glm::length(out.translation) <= kMaxDistance_m)) {
      return in_.fail("a joint lies further than 10 km away");
    }
    const auto turn = rotation(turns, i);
    if (!turn) return in_.fail("a rotation is not a quaternion of length 1");
    out.rotation = *turn;
    return Done{};
  }

  static std::optional<glm::dquat> rotation(const std::vector<double>& wxyz,
                                            std::size_t i) {
    const glm::dquat q(wxyz[4 * i], wxyz[4 * i + 1], wxyz[4 * i + 2], wxyz[4 * i + 3]);
    if (!(std::abs(glm::length(q) - 1.0) <= 1e-3)) return std::nullopt;
    return glm::normalize(q);
  }

  Status poses() {
    const auto count = in_.length("time_s");
    if (!count) return count.error();
    frames_ = *count;
    const auto times = in_.reals("time_s", {frames_});
    const auto places = in_.reals("positions", {frames_, joints_, 3});
    const auto turns = in_.reals("rotations_wxyz", {frames_, joints_, 4});
    if (!times) return times.error();
    if (!places) return places.error();
    if (!turns) return turns.error();
    if (frames_ > 0) out_.start_s = times->front();
    for (std::size_t f = 0; f < frames_; ++f) {
      Pose pose;
      for (std::size_t j = 0; j < joints_; ++j) {
        const auto turn = rotation(*turns, f * joints_ + j);
        if (!turn) {
          return in_.fail(
              "rotations_wxyz",
              "frame " + std::to_string(f) + " holds no quaternion of length 1");
        }
        pose.parent_from_joint.push_back(*turn);
      }
      const double* root = places->data() + 3 * f * joints_;
      pose.root_in_world = {root[0], root[1], root[2]};
      if (!(glm::length(pose.root_in_world) <= kMaxDistance_m)) {
        return in_.fail("positions", "the body goes further than 10 km");
      }
      out_.motion.poses.push_back(std::move(pose));
    }
    return Done{};
  }

  Status uncertainty() {
    if (!in_.has("sigma_m") || !in_.has("source")) return Done{};
    const auto sigmas = in_.reals("sigma_m", {frames_, joints_});
    const auto sources = in_.array("source", "|u1", {frames_, joints_});
    if (!sigmas) return sigmas.error();
    if (!sources) return sources.error();
    for (std::size_t f = 0; f < frames_; ++f) {
      auto& frame = out_.uncertainty.emplace_back(joints_);
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

  Status contacts() {
    if (!in_.has("contact_names") || !in_.has("contacts")) return Done{};
    const auto count = in_.length("contact_names");
    if (!count) return count.error();
    auto names = in_.texts("contact_names", *count);
    const auto bears = in_.array("contacts", "|b1", {frames_, *count});
    if (!names) return names.error();
    if (!bears) return bears.error();
    out_.contacts.names = *std::move(names);
    out_.contacts.bears.assign(bears->data.begin(), bears->data.end());
    return Done{};
  }

  NpzInput in_;
  NpzMotion out_;
  std::size_t joints_ = 0;
  std::size_t frames_ = 0;
};

}  // namespace

Result<NpzMotion> parse_npz(std::string_view bytes, const std::string& file) {
  return Reader(file).read(bytes);
}

Result<NpzMotion> read_npz(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  return parse_npz(*bytes, path.string());
}

}  // namespace marey::recordings
