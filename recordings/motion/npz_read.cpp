// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cmath>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/input_file.h"
#include "core/humanoid.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/zip_archive.h"
#include "recordings/motion/npy_array.h"
#include "recordings/motion/npz.h"

namespace marey::recordings {
namespace {

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  Result<NpzMotion> read(std::optional<ZipReader> zip) {
    if (Status ok = open(std::move(zip)); !ok) return ok.error();
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
    if (Status ok = open(std::move(zip)); !ok) return ok.error();
    if (Status ok = head(); !ok) return ok.error();
    const auto joints = length("joint_names");
    if (!joints) return joints.error();
    const auto frames = length("time_s");
    if (!frames) return frames.error();
    joints_ = *joints;
    frames_ = *frames;
    if (Status ok = uncertainty(); !ok) return ok.error();
    return std::move(out_.uncertainty);
  }

 private:
  [[nodiscard]] Error fail(std::string cause) const {
    return bad_input(file_,
                     std::move(cause),
                     "give a .npz that marey wrote, without changes of its arrays");
  }
  [[nodiscard]] Error fail(std::string_view array, std::string cause) const {
    Error error = fail(std::move(cause));
    error.where += ": " + std::string(array);
    return error;
  }

  Status open(std::optional<ZipReader> zip) {
    zip_ = std::move(zip);
    if (!zip_) return fail("it is not a .npz archive, or it is damaged");
    if (!zip_->contains_ending(".npy")) {
      return fail("it is not a .npz archive: it holds no array");
    }
    return Done{};
  }

  static std::string file_of(std::string_view name) { return std::string(name) + ".npy"; }

  [[nodiscard]] bool has(std::string_view name) const {
    return zip_->contains(file_of(name));
  }

  /// Returns the bytes of an array's file, which stay valid; reads each file once.
  Result<std::string_view> bytes_of(std::string_view name) {
    const auto known = files_.find(name);
    if (known != files_.end()) return std::string_view(known->second);
    auto read = zip_->read(file_of(name));
    if (auto* bytes = std::get_if<std::string>(&read)) {
      return std::string_view(
          files_.emplace(std::string(name), std::move(*bytes)).first->second);
    }
    switch (std::get<ZipProblem>(read)) {
      case ZipProblem::kAbsent:
        return fail(name, "the array is missing");
      case ZipProblem::kCompressed:
        return bad_input(file_,
                         "its arrays are compressed",
                         "write them with numpy.savez instead of savez_compressed");
      case ZipProblem::kWrongChecksum:
        return fail(name, "its checksum is wrong");
      case ZipProblem::kDamaged:
        break;
    }
    return fail(name, "it is not an array of numpy, or it is damaged");
  }

  /// Returns an array, checked for its type ("<U" for text of any length) and shape.
  Result<NpyArray> array(std::string_view name,
                         std::string_view type,
                         const NpyShape& shape) {
    const auto bytes = bytes_of(name);
    if (!bytes) return bytes.error();
    const auto array = npy_array(*bytes);
    if (!array) return fail(name, "it is not an array of numpy, or it is damaged");
    const bool fits = type == "<U" ? array->type.starts_with(type) : array->type == type;
    if (!fits || array->shape != shape) {
      return fail(name, "the array has another type or shape than the motion needs");
    }
    return *array;
  }

  template <class T>
  Result<T> number(std::string_view name, std::string_view type) {
    const auto found = array(name, type, {});
    if (!found) return found.error();
    return found->at<T>(0);
  }

  /// Returns an array of checked numbers; its bytes stay until drop().
  Result<NpyArray> real_array(std::string_view name, const NpyShape& shape) {
    auto found = array(name, "<f8", shape);
    if (!found) return found.error();
    const std::size_t count = found->count();
    for (std::size_t i = 0; i < count; ++i) {
      if (!(std::abs(found->at<double>(i)) <= 1e12)) {
        return fail(name, "it holds a number that is not finite, or beyond all bounds");
      }
    }
    return found;
  }

  Result<std::vector<double>> reals(std::string_view name, const NpyShape& shape) {
    const auto found = real_array(name, shape);
    if (!found) return found.error();
    std::vector<double> values(found->count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = found->at<double>(i);
    return values;
  }

  /// Frees the bytes of an array: those of all frames are as large as the motion.
  void drop(std::string_view name) {
    const auto known = files_.find(name);
    if (known != files_.end()) files_.erase(known);
  }

  Result<std::vector<std::string>> texts(std::string_view name, std::size_t count) {
    const auto found = array(name, "<U", {count});
    if (!found) return found.error();
    const std::size_t letters = npy_item_bytes(found->type) / 4;
    std::vector<std::string> out(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < letters; ++k) {
        const auto point = found->at<std::uint32_t>(i * letters + k);
        if (point == 0) break;
        append_utf8(out[i], point);
      }
    }
    return out;
  }

  /// Returns the size of a list of any length.
  Result<std::size_t> length(std::string_view name) {
    const auto bytes = bytes_of(name);
    if (!bytes) return bytes.error();
    const auto array = npy_array(*bytes);
    if (!array || array->shape.size() != 1) {
      return fail(name, "it is not a list of numpy's");
    }
    return array->shape[0];
  }

  Status head() {
    if (!has("format") || !has("joint_names") || !has("rotations_wxyz")) {
      return fail("it is a .npz archive, but not of a motion");
    }
    const auto format = number<std::int64_t>("format", "<i8");
    if (!format) return format.error();
    if (*format != 1) {
      return fail("it is of layout " + std::to_string(*format) + ", marey reads 1");
    }
    const auto rate = number<double>("rate_hz", "<f8");
    if (!rate) return rate.error();
    if (!(*rate >= kMinRateHz && *rate <= kMaxRateHz)) {
      return fail("rate_hz", "the rate is not between 0.1 and 2000 Hz");
    }
    const auto first = number<std::int64_t>("first_frame", "<i8");
    if (!first) return first.error();
    constexpr std::int64_t kMaxFirstFrame = 1'000'000'000;
    if (*first < -kMaxFirstFrame || *first > kMaxFirstFrame) {
      return fail("first_frame", "the number is not that of a frame");
    }
    out_.motion.rate = FrameRate{*rate};
    out_.motion.first_frame = static_cast<int>(*first);
    return Done{};
  }

  Status skeleton() {
    const auto count = length("joint_names");
    if (!count) return count.error();
    joints_ = *count;
    if (joints_ == 0 || joints_ > kMaxJoints) {
      return fail("joint_names", "there are no joints, or too many");
    }
    const auto names = texts("joint_names", joints_);
    const auto bones = texts("human_bones", joints_);
    const auto parents = array("parents", "<i4", {joints_});
    const auto places = reals("rest_translations", {joints_, 3});
    const auto turns = reals("rest_rotations_wxyz", {joints_, 4});
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
        return fail("parents", "joint " + std::to_string(i) + " has no parent before it");
      }
      if (i > 0) {
        joint.parent = JointIndex{parent};
        level[i] = level[static_cast<std::size_t>(parent)] + 1;
      }
      if (level[i] > kMaxSkeletonDepth) {
        return fail("parents", "joints are nested too deeply");
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
      return fail("a joint lies further than 10 km away");
    }
    const auto turn =
        rotation({turns[4 * i], turns[4 * i + 1], turns[4 * i + 2], turns[4 * i + 3]});
    if (!turn) return fail("a rotation is not a quaternion of length 1");
    out.rotation = *turn;
    return Done{};
  }

  static std::optional<glm::dquat> rotation(const glm::dquat& q) {
    if (!(std::abs(glm::length(q) - 1.0) <= 1e-3)) return std::nullopt;
    return glm::normalize(q);
  }

  Status poses() {
    const auto count = length("time_s");
    if (!count) return count.error();
    frames_ = *count;
    const auto times = real_array("time_s", {frames_});
    if (!times) return times.error();
    if (frames_ > 0) out_.start_s = times->at<double>(0);
    const auto places = real_array("positions", {frames_, joints_, 3});
    if (!places) return places.error();
    out_.motion.poses.resize(frames_);
    for (std::size_t f = 0; f < frames_; ++f) {
      glm::dvec3& root = out_.motion.poses[f].root_in_world;
      for (int axis = 0; axis < 3; ++axis) {
        root[axis] = places->at<double>(3 * f * joints_ + static_cast<std::size_t>(axis));
      }
      if (!(glm::length(root) <= kMaxDistance_m)) {
        return fail("positions", "the body goes further than 10 km");
      }
    }
    drop("positions");
    const auto turns = real_array("rotations_wxyz", {frames_, joints_, 4});
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
          return fail("rotations_wxyz",
                      "frame " + std::to_string(f) + " holds no quaternion of length 1");
        }
        pose.push_back(*turn);
      }
    }
    drop("rotations_wxyz");
    return Done{};
  }

  Status uncertainty() {
    if (!has("sigma_m") || !has("source")) return Done{};
    const auto sigmas = real_array("sigma_m", {frames_, joints_});
    const auto sources = array("source", "|u1", {frames_, joints_});
    if (!sigmas) return sigmas.error();
    if (!sources) return sources.error();
    for (std::size_t f = 0; f < frames_; ++f) {
      auto& frame = out_.uncertainty.emplace_back(joints_);
      for (std::size_t j = 0; j < joints_; ++j) {
        const auto source = sources->at<std::uint8_t>(f * joints_ + j);
        frame[j].sigma_m = sigmas->at<double>(f * joints_ + j);
        if (source > 2 || frame[j].sigma_m < 0.0) {
          return fail("source",
                      "frame " + std::to_string(f) + " holds no source or sigma");
        }
        frame[j].source = static_cast<Source>(source);
      }
    }
    return Done{};
  }

  Status contacts() {
    if (!has("contact_names") || !has("contacts")) return Done{};
    const auto count = length("contact_names");
    if (!count) return count.error();
    auto names = texts("contact_names", *count);
    const auto bears = array("contacts", "|b1", {frames_, *count});
    if (!names) return names.error();
    if (!bears) return bears.error();
    out_.contacts.names = *std::move(names);
    out_.contacts.bears.assign(bears->data.begin(), bears->data.end());
    return Done{};
  }

  std::string file_;
  std::optional<ZipReader> zip_;
  std::map<std::string, std::string, std::less<>> files_;  ///< By name of the array.
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

Result<std::vector<std::vector<JointUncertainty>>> read_npz_uncertainty(
    const std::filesystem::path& path) {
  if (const Status ok = check_npz_file(path); !ok) return ok.error();
  return Reader(path.string()).read_uncertainty(ZipReader::open_file(path));
}

}  // namespace marey::recordings
