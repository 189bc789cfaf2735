// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/input_file.h"
#include "core/humanoid.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/zip_archive.h"
#include "recordings/motion/npz.h"
#include "recordings/motion/npz_arrays.h"
#include "recordings/motion/npz_head.h"

namespace marey::recordings {
namespace {

class Reader {
 public:
  explicit Reader(std::string file)
      : in_(std::move(file),
            "give a .npz that marey wrote, without changes of its arrays") {}

  Result<NpzMotion> read(std::optional<ZipReader> zip) {
    if (Status ok = in_.open(std::move(zip)); !ok) return ok.error();
    for (const auto step : {&Reader::head,
                            &Reader::skeleton,
                            &Reader::poses,
                            &Reader::uncertainty,
                            &Reader::contacts}) {
      if (Status ok = (this->*step)(); !ok) return ok.error();
    }
    return std::move(out_);
  }

  /// Reads the uncertainty alone.
  Result<std::vector<std::vector<JointUncertainty>>> read_uncertainty(
      std::optional<ZipReader> zip) {
    if (Status ok = in_.open(std::move(zip)); !ok) return ok.error();
    if (Status ok = head(); !ok) return ok.error();
    const auto joints = in_.length("joint_names");
    if (!joints) return joints.error();
    const auto frames = in_.length("time_s");
    if (!frames) return frames.error();
    joints_ = *joints;
    frames_ = *frames;
    if (Status ok = uncertainty(); !ok) return ok.error();
    return std::move(out_.uncertainty);
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
    return read_npz_rate(in_, out_.motion);
  }

  Status skeleton() {
    std::vector<Joint>& joints = out_.motion.skeleton.joints;
    if (Status ok = read_npz_joints(in_, out_.motion.skeleton); !ok) return ok;
    joints_ = joints.size();
    const auto places = in_.reals("rest_translations", {joints_, 3});
    const auto turns = in_.reals("rest_rotations_wxyz", {joints_, 4});
    if (!places) return places.error();
    if (!turns) return turns.error();
    for (std::size_t i = 0; i < joints_; ++i) {
      if (Status ok = transform(*places, *turns, i, joints[i].parent_from_joint); !ok) {
        return ok;
      }
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
    const auto turn =
        rotation({turns[4 * i], turns[4 * i + 1], turns[4 * i + 2], turns[4 * i + 3]});
    if (!turn) return in_.fail("a rotation is not a quaternion of length 1");
    out.rotation = *turn;
    return Done{};
  }

  static std::optional<glm::dquat> rotation(const glm::dquat& q) {
    if (!(std::abs(glm::length(q) - 1.0) <= 1e-3)) return std::nullopt;
    return glm::normalize(q);
  }

  Status poses() {
    const auto count = in_.length("time_s");
    if (!count) return count.error();
    frames_ = *count;
    const auto times = in_.real_array("time_s", {frames_});
    if (!times) return times.error();
    if (frames_ > 0) out_.start_s = times->at<double>(0);
    const auto places = in_.real_array("positions", {frames_, joints_, 3});
    if (!places) return places.error();
    out_.motion.poses.resize(frames_);
    for (std::size_t f = 0; f < frames_; ++f) {
      glm::dvec3& root = out_.motion.poses[f].root_in_world;
      for (int axis = 0; axis < 3; ++axis) {
        root[axis] = places->at<double>(3 * f * joints_ + static_cast<std::size_t>(axis));
      }
      if (!(glm::length(root) <= kMaxDistance_m)) {
        return in_.fail("positions", "the body goes further than 10 km");
      }
    }
    in_.drop("positions");
    const auto turns = in_.real_array("rotations_wxyz", {frames_, joints_, 4});
    if (!turns) return turns.error();
    for (std::size_t f = 0; f < frames_; ++f) {
      std::vector<glm::dquat>& pose = out_.motion.poses[f].parent_from_joint;
      pose.reserve(joints_);
      for (std::size_t j = 0; j < joints_; ++j) {
        const std::size_t at = 4 * (f * joints_ + j);
        const auto turn = rotation({turns->at<double>(at),
                                    turns->at<double>(at + 1),
                                    turns->at<double>(at + 2),
                                    turns->at<double>(at + 3)});
        if (!turn) {
          return in_.fail(
              "rotations_wxyz",
              "frame " + std::to_string(f) + " holds no quaternion of length 1");
        }
        pose.push_back(*turn);
      }
    }
    in_.drop("rotations_wxyz");
    return Done{};
  }

  Status uncertainty() {
    if (!in_.has("sigma_m") || !in_.has("source")) return Done{};
    const auto sigmas = in_.real_array("sigma_m", {frames_, joints_});
    const auto sources = in_.array("source", "|u1", {frames_, joints_});
    if (!sigmas) return sigmas.error();
    if (!sources) return sources.error();
    for (std::size_t f = 0; f < frames_; ++f) {
      auto& frame = out_.uncertainty.emplace_back(joints_);
      for (std::size_t j = 0; j < joints_; ++j) {
        const auto source = sources->at<std::uint8_t>(f * joints_ + j);
        frame[j].sigma_m = sigmas->at<double>(f * joints_ + j);
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

Status check_npz_file(const std::filesystem::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok;
  errno = 0;
  const std::ifstream stream(path, std::ios::binary);
  if (stream) return Done{};
  return bad_input(path.string(),
                   "the file cannot be read: " + std::generic_category().message(errno),
                   "check its permissions");
}

}  // namespace

Result<NpzMotion> parse_npz(std::string_view bytes, const std::string& file) {
  return Reader(file).read(ZipReader::open(bytes));
}

Result<NpzMotion> read_npz(const std::filesystem::path& path) {
  if (const Status ok = check_npz_file(path); !ok) return ok.error();
  return Reader(path.string()).read(ZipReader::open_file(path));
}

std::optional<int> npz_layout(const std::filesystem::path& path) {
  NpzInput in(path.string(), "");
  if (!in.open(ZipReader::open_file(path))) return std::nullopt;
  if (!in.has("rotations_wxyz")) return std::nullopt;
  const auto layout = in.number<std::int64_t>("format", "<i8");
  if (!layout || *layout < 1 || *layout > 1000) return std::nullopt;
  return static_cast<int>(*layout);
}

Result<std::vector<std::vector<JointUncertainty>>> read_npz_uncertainty(
    const std::filesystem::path& path) {
  if (const Status ok = check_npz_file(path); !ok) return ok.error();
  return Reader(path.string()).read_uncertainty(ZipReader::open_file(path));
}

}  // namespace marey::recordings
