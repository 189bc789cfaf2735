// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <system_error>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/base/extension.h"
#include "core/base/lower_case.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"
#include "recordings/motion/asf.h"
#include "recordings/motion/bake_root_motion.h"

namespace marey::recordings {
namespace {

constexpr double kUsualRateHz = 120.0;

class AmcParser {
 public:
  AmcParser(std::string_view text, const std::string& file, const AsfSkeleton& skeleton)
      : reader_(text, file), asf_(skeleton), in_degrees_(skeleton.in_degrees) {
    const auto& joints = skeleton.skeleton.joints;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joint_of_.emplace(joints[i].name, i);
      rest_.push_back(joints[i].parent_from_joint);
    }
    rest_[0].translation = skeleton.root_place;
    result_.motion.skeleton = skeleton.skeleton;
  }

  Result<AmcMotion> parse(const AmcReadOptions& options) {
    for (;;) {
      reader_.skip_blank();
      if (reader_.at_end()) break;
      if (Status s = line(); !s) return s.error();
      (void)reader_.rest_of_line();
    }
    if (Status s = end_frame(); !s) return s.error();
    if (result_.motion.poses.empty()) return fail("the file has no frames");
    result_.rate_is_guessed = !options.rate && !rate_;
    result_.motion.rate = options.rate.value_or(rate_.value_or(FrameRate{kUsualRateHz}));
    return std::move(result_);
  }

 private:
  [[nodiscard]] Error fail(std::string cause) const {
    return bad_input(reader_.where(),
                     std::move(cause),
                     "export the file again, or correct that line in a text editor");
  }

  Status line() {
    const std::string_view first = reader_.word_on_line();
    if (first[0] == '#') return Done{};
    if (first[0] == ':') return keyword(lower_case(first));
    if (const auto number = to_integer(first)) return begin_frame(*number);
    return bone(first);
  }

  Status keyword(const std::string& word) {
    if (word == ":degrees") in_degrees_ = true;
    if (word == ":radians") in_degrees_ = false;
    if (word == ":samples-per-second") {
      const auto hz = to_number(reader_.word_on_line());
      if (!hz || *hz < kMinRateHz || *hz > kMaxRateHz) {
        return fail("a rate must be 0.1 to 2000 frames per second");
      }
      rate_ = FrameRate{*hz};
    }
    return Done{};
  }

  Status begin_frame(int number) {
    if (Status s = end_frame(); !s) return s;
    if (number_ && (*number_ == INT32_MAX || number != *number_ + 1)) {
      return fail("frame " + std::to_string(number) + " follows frame " +
                  std::to_string(*number_));
    }
    if (number < 0) return fail("a frame has a number below 0");
    if (!number_) result_.motion.first_frame = std::max(0, number - 1);
    number_ = number;
    local_ = rest_;
    is_given_.assign(rest_.size(), false);
    if (!too_many_rotations(
            rest_.size(), result_.motion.poses.size() + 1, numbers_ + rest_.size())) {
      return Done{};
    }
    return fail("so many frames of so many joints do not fit into memory");
  }

  Status bone(std::string_view name) {
    if (!number_) {
      return fail("expected the number of a frame, found " + quoted_start(name) +
                  ": this is not a .amc file");
    }
    const auto found = joint_of_.find(name);
    if (found == joint_of_.end()) {
      return fail("the skeleton has no bone " + quoted_start(name));
    }
    const std::size_t joint = found->second;
    if (is_given_[joint]) {
      return fail("frame " + std::to_string(*number_) + " has the bone " +
                  quoted_start(name) + " twice");
    }
    is_given_[joint] = true;
    return values(joint);
  }

  Status values(std::size_t joint) {
    glm::dquat turned(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 moved(0.0);
    std::size_t found = 0;
    const auto& channels = asf_.channels[joint];
    for (auto word = reader_.word_on_line(); !word.empty();
         word = reader_.word_on_line(), ++found) {
      const auto value = to_number(word);
      if (!value) return fail(quoted_start(word) + " is not a number");
      if (found >= channels.size()) continue;
      const auto [kind, place] = channels[found];
      glm::dvec3 axis(0.0);
      axis[place] = 1.0;
      if (kind == AsfChannel::Kind::kTurn) {
        const double angle_rad = *value * (in_degrees_ ? kRadiansPerDegree : 1.0);
        if (!(std::abs(angle_rad) <= kMaxTurned_deg * kRadiansPerDegree)) {
          return fail("a rotation of " + quoted_start(word) + " is more than 1000 turns");
        }
        turned = glm::angleAxis(angle_rad, axis) * turned;
      } else if (kind == AsfChannel::Kind::kMove) {
        moved[place] += *value * asf_.unit_m;
        if (!(std::abs(moved[place]) <= kMaxDistance_m)) {
          return fail("a position of " + quoted_start(word) + " goes further than 10 km");
        }
      }
    }
    if (found != channels.size()) {
      return fail(quoted_start(asf_.skeleton.joints[joint].name) + " has " +
                  std::to_string(channels.size()) + " degrees of freedom, found " +
                  std::to_string(found) + " values");
    }
    numbers_ += found;
    const glm::dquat& axes = asf_.world_from_axes[joint];
    local_[joint].rotation =
        glm::normalize(axes * turned * glm::conjugate(axes) * local_[joint].rotation);
    local_[joint].translation += moved;
    return Done{};
  }

  Status end_frame() {
    if (!number_) return Done{};
    for (std::size_t i = 0; i < is_given_.size(); ++i) {
      if (is_given_[i] || asf_.channels[i].empty()) continue;
      return fail("frame " + std::to_string(*number_) + " ends without the bone " +
                  quoted_start(asf_.skeleton.joints[i].name));
    }
    PosedBones posed = bake_root_motion(result_.motion.skeleton, local_);
    result_.motion.poses.push_back(std::move(posed.pose));
    result_.ignored_translation_m =
        std::max(result_.ignored_translation_m, posed.ignored_translation_m);
    return Done{};
  }

  TextReader reader_;
  const AsfSkeleton& asf_;
  AmcMotion result_;
  std::map<std::string, std::size_t, std::less<>> joint_of_;
  std::vector<RigidTransform> rest_;
  std::vector<RigidTransform> local_;  ///< Transforms of the current frame.
  std::vector<bool> is_given_;         ///< Bones given in the current frame.
  std::optional<int> number_;          ///< Number of the current frame.
  std::size_t numbers_ = 0;            ///< Numbers read, in all frames.
  std::optional<FrameRate> rate_;
  bool in_degrees_;
};

}  // namespace

Result<AmcMotion> parse_amc(std::string_view text,
                            const std::string& file,
                            const AsfSkeleton& skeleton,
                            const AmcReadOptions& options) {
  MAREY_ASSERT(skeleton.channels.size() == skeleton.skeleton.joints.size());
  MAREY_ASSERT(skeleton.world_from_axes.size() == skeleton.skeleton.joints.size());
  MAREY_ASSERT(!options.rate || options.rate->hz > 0.0);
  return AmcParser(text, file, skeleton).parse(options);
}

Result<AmcMotion> read_amc(const std::filesystem::path& path,
                           const AsfSkeleton& skeleton,
                           const AmcReadOptions& options) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_amc(*text, path.string(), skeleton, options);
}

std::optional<std::filesystem::path> find_skeleton_file(
    const std::filesystem::path& amc) {
  std::error_code problem;
  const auto folder = amc.has_parent_path() ? amc.parent_path() : ".";
  const std::string motion = amc.stem().string();
  std::vector<std::filesystem::path> all;
  std::optional<std::filesystem::path> best;
  for (auto it = std::filesystem::directory_iterator(folder, problem);
       !problem && it != std::filesystem::directory_iterator();
       it.increment(problem)) {
    if (kind_by_extension(it->path()) != ".asf") continue;
    all.push_back(it->path());
    const std::string stem = it->path().stem().string();
    const bool fits = motion == stem || motion.starts_with(stem + "_");
    if (fits && (!best || stem.size() > best->stem().string().size())) best = it->path();
  }
  if (best) return best;
  if (all.size() == 1) return all[0];
  return std::nullopt;
}

}  // namespace marey::recordings
