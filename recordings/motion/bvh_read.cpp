// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/base/lower_case.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/other_kind.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"
#include "recordings/body/floor_height.h"
#include "recordings/motion/bake_root_motion.h"
#include "recordings/motion/bvh.h"
#include "recordings/takes/nominal_rate.h"

namespace marey::recordings {
namespace {

struct Channel {
  bool is_rotation = false;
  int axis = 0;  ///< 0 X, 1 Y, 2 Z.
};

/// A joint's channels, in the order of its values in each frame.
struct JointChannels {
  std::vector<Channel> list;
  std::size_t first_value = 0;  ///< Index of the first value in a frame.
  bool announced = false;
};

/// Skeleton, channels of each joint, and frames, in the file's units.
struct BvhFile {
  Skeleton skeleton;
  std::vector<JointChannels> channels;
  std::size_t values_per_frame = 0;
  double frame_time_s = 0.0;
  std::vector<double> values;  ///< Frame after frame.
};

class BvhParser {
 public:
  BvhParser(std::string_view text, const std::string& file, double unit_m)
      : reader_(text, file), furthest_(kMaxDistance_m / unit_m) {}

  Result<BvhFile> parse() {
    for (const auto step :
         {&BvhParser::hierarchy, &BvhParser::motion_head, &BvhParser::frames}) {
      if (const Status done = (this->*step)(); !done) return done.error();
    }
    return std::move(file_);
  }

 private:
  [[nodiscard]] Error fail(std::string cause) const {
    return bad_input(reader_.where(),
                     std::move(cause),
                     "export the file again, or correct that line in a text editor");
  }

  Status expect(std::string_view keyword) {
    const std::string_view found = reader_.word();
    if (lower_case(found) == lower_case(keyword)) return Done{};
    if (found.empty()) {
      return fail("the file ends where " + quoted_start(keyword) + " should be");
    }
    return fail("expected " + quoted_start(keyword) + ", found " + quoted_start(found));
  }

  Result<double> number(std::string_view what) {
    const std::string_view found = reader_.word_on_line();
    const auto value = to_number(found);
    if (value) return *value;
    return fail("expected a number for " + std::string(what) + ", found " +
                quoted_start(found));
  }

  /// Reads a length in the file's unit.
  Result<double> length(std::string_view what) {
    const auto value = number(what);
    if (!value || std::abs(*value) <= furthest_) return value;
    return too_far(std::string(what));
  }

  [[nodiscard]] Error too_far(std::string what) const {
    return fail(std::move(what) + " goes further than 10 km");
  }

  Result<glm::dvec3> offset() {
    if (Status s = expect("OFFSET"); !s) return s.error();
    glm::dvec3 value(0.0);
    for (int i = 0; i < 3; ++i) {
      const auto coordinate = length("OFFSET");
      if (!coordinate) return coordinate.error();
      value[i] = *coordinate;
    }
    return value;
  }

  Status channels(JointIndex joint) {
    JointChannels& channels = file_.channels[index(joint)];
    if (channels.announced) {
      return fail("the joint " + quoted_start(file_.skeleton.joints[index(joint)].name) +
                  " has its CHANNELS twice");
    }
    const auto count = to_integer(reader_.word_on_line());
    if (!count || *count < 0 || *count > 6) {
      return fail("expected 0 to 6 channels");
    }
    channels.announced = true;
    channels.first_value = file_.values_per_frame;
    for (int i = 0; i < *count; ++i) {
      const std::string word = lower_case(reader_.word_on_line());
      const bool is_rotation = word.size() == 9 && word.ends_with("rotation");
      const bool is_position = word.size() == 9 && word.ends_with("position");
      if ((!is_rotation && !is_position) || word[0] < 'x' || word[0] > 'z') {
        return fail("unknown channel " + quoted_start(word));
      }
      channels.list.push_back({is_rotation, word[0] - 'x'});
      is_length_.push_back(is_position);
    }
    if (!reader_.rest_of_line().empty()) {
      return fail("there are more channels than the declared " + std::to_string(*count));
    }
    file_.values_per_frame += channels.list.size();
    return Done{};
  }

  /// Reads a name, which may contain blanks and be followed by a brace.
  Result<std::string> name() {
    std::string text(reader_.rest_of_line());
    if (text.ends_with('{')) {
      text.pop_back();
      brace_read_ = true;
      while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) {
        text.pop_back();
      }
    }
    return text;
  }

  Status open_brace() {
    if (std::exchange(brace_read_, false)) return Done{};
    return expect("{");
  }

  Status begin_joint(std::optional<JointIndex> parent) {
    Joint joint;
    joint.parent = parent;
    const auto text = name();
    if (!text) return text.error();
    if (text->empty()) return fail("a joint has no name");
    joint.name = *text;
    joint.bone = human_bone(joint.name);
    if (joint.bone && file_.skeleton.find(*joint.bone)) {
      return fail("the joint " + quoted_start(joint.name) + " is given twice");
    }
    if (Status s = open_brace(); !s) return s;
    const auto from_parent = offset();
    if (!from_parent) return from_parent.error();
    joint.parent_from_joint.translation = *from_parent;
    file_.skeleton.joints.push_back(std::move(joint));
    file_.channels.emplace_back();
    return Done{};
  }

  Status end_site(JointIndex joint) {
    (void)name();  // "Site", sometimes followed by a brace or a name.
    if (Status s = open_brace(); !s) return s;
    if (lower_case(reader_.peek()) == "offset") {
      const auto tip = offset();
      if (!tip) return tip.error();
      file_.skeleton.joints[index(joint)].tip_in_joint = *tip;
    }
    if (lower_case(reader_.peek()) == "channels") {
      (void)reader_.word();
      if (to_integer(reader_.word_on_line()) != 0) {
        return fail("an End Site has channels");
      }
    }
    return expect("}");
  }

  Status hierarchy() {
    if (Status s = expect("HIERARCHY"); !s) return s;
    if (Status s = expect("ROOT"); !s) return s;
    if (Status s = begin_joint(std::nullopt); !s) return s;
    std::vector<JointIndex> open{JointIndex{0}};
    while (!open.empty()) {
      const std::string_view word = reader_.word();
      const std::string keyword = lower_case(word);
      Status done = Done{};
      if (keyword == "joint" && open.size() >= kMaxSkeletonDepth) {
        done = fail("joints are nested more than " + std::to_string(kMaxSkeletonDepth) +
                    " levels deep");
      } else if (keyword == "joint" && file_.skeleton.joints.size() >= kMaxJoints) {
        done = fail("there are more than " + std::to_string(kMaxJoints) + " joints");
      } else if (keyword == "joint") {
        done = begin_joint(open.back());
        open.push_back(JointIndex{static_cast<int>(file_.skeleton.joints.size()) - 1});
      } else if (keyword == "channels") {
        done = channels(open.back());
      } else if (keyword == "end") {
        done = end_site(open.back());
      } else if (keyword == "}") {
        open.pop_back();
      } else if (keyword.empty()) {
        done = fail("the file ends inside the HIERARCHY");
      } else {
        done = fail("expected JOINT, CHANNELS, End Site or '}', found " +
                    quoted_start(word));
      }
      if (!done) return done;
    }
    return Done{};
  }

  /// Returns the rest of a line after its label and a colon, with or without blanks.
  Result<std::string_view> labelled(std::string_view label) {
    reader_.skip_blank();
    std::string_view line = reader_.rest_of_line();
    for (std::string_view rest = label; !rest.empty();) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(word.size() + 1, rest.size()));
      if (lower_case(line.substr(0, word.size())) != lower_case(word)) line = {};
      line.remove_prefix(std::min(word.size(), line.size()));
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    }
    if (!line.starts_with(':')) {
      return fail("expected " + quoted_start(std::string(label) + ":"));
    }
    line.remove_prefix(1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line;
  }

  Status motion_head() {
    if (lower_case(reader_.peek()) == "root") {
      (void)reader_.word();
      return fail("the file holds a second ROOT; marey reads one body per file");
    }
    if (Status s = expect("MOTION"); !s) return s;
    const auto frames_text = labelled("Frames");
    if (!frames_text) return frames_text.error();
    const auto count = to_integer(*frames_text);
    if (!count || *count < 0) return fail("expected the number of frames");
    frame_count_ = *count;
    const auto frames = static_cast<std::size_t>(*count);
    if (too_many_rotations(
            file_.skeleton.joints.size(), frames, frames * file_.values_per_frame)) {
      return fail("so many frames of so many joints do not fit into memory");
    }
    const auto time_text = labelled("Frame Time");
    if (!time_text) return time_text.error();
    const auto time = to_number(*time_text);
    if (!time) {
      return fail("expected a number for Frame Time, found " + quoted_start(*time_text));
    }
    if (!(*time >= 1.0 / kMaxRateHz && *time <= 1.0 / kMinRateHz)) {
      return fail("Frame Time must be 0.0005 to 10 seconds");
    }
    file_.frame_time_s = *time;
    return Done{};
  }

  Status frames() {
    for (int frame = 0; frame < frame_count_; ++frame) {
      reader_.skip_blank();
      if (reader_.at_end()) {
        return fail("expected " + std::to_string(frame_count_) + " frames, found " +
                    std::to_string(frame));
      }
      if (Status s = frame_values(); !s) return s;
    }
    reader_.skip_blank();
    if (reader_.at_end()) return Done{};
    return fail("there are more values than the declared " +
                std::to_string(frame_count_) + " frames have");
  }

  Status frame_values() {
    std::size_t found = 0;
    for (auto word = reader_.word_on_line(); !word.empty();
         word = reader_.word_on_line(), ++found) {
      const auto value = to_number(word);
      if (!value) {
        return fail(quoted_start(word) + " is not a number");
      }
      const bool is_known = found < is_length_.size();
      if (is_known && is_length_[found] && std::abs(*value) > furthest_) {
        return too_far("a position of " + quoted_start(word));
      }
      if (is_known && !is_length_[found] && std::abs(*value) > kMaxTurned_deg) {
        return fail("a rotation of " + quoted_start(word) +
                    " degrees is more than 1000 turns");
      }
      file_.values.push_back(*value);
    }
    if (found == file_.values_per_frame) return Done{};
    return fail("expected " + std::to_string(file_.values_per_frame) + " values, found " +
                std::to_string(found));
  }

  TextReader reader_;
  BvhFile file_;
  double furthest_;              ///< In the file's unit.
  std::vector<bool> is_length_;  ///< Per value of a frame.
  int frame_count_ = 0;
  bool brace_read_ = false;
};

/// Returns a joint's transform in its parent from its channels.
RigidTransform local_transform(const Joint& joint,
                               const std::vector<Channel>& channels,
                               const double* values,
                               double unit_m) {
  RigidTransform local = joint.parent_from_joint;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto [is_rotation, axis] = channels[i];
    if (is_rotation) {
      glm::dvec3 direction(0.0);
      direction[axis] = 1.0;
      local.rotation =
          local.rotation * glm::angleAxis(values[i] * kRadiansPerDegree, direction);
    } else {
      local.translation[axis] = values[i] * unit_m;
    }
  }
  local.rotation = glm::normalize(local.rotation);
  return local;
}

void to_metres(Skeleton& skeleton, double unit_m) {
  for (Joint& joint : skeleton.joints) {
    joint.parent_from_joint.translation *= unit_m;
    if (joint.tip_in_joint) *joint.tip_in_joint *= unit_m;
  }
  glm::dvec3& root = skeleton.joints[0].parent_from_joint.translation;
  if (root == glm::dvec3(0.0)) root.y = standing_height(skeleton);
}

BvhMotion motion_of(BvhFile file, double unit_m) {
  BvhMotion result;
  to_metres(file.skeleton, unit_m);
  result.motion.skeleton = std::move(file.skeleton);
  result.motion.rate = FrameRate{nominal_rate(1.0 / file.frame_time_s, 1e-9)};
  const auto& joints = result.motion.skeleton.joints;
  std::vector<RigidTransform> local(joints.size());
  const std::size_t count =
      file.values_per_frame == 0 ? 0 : file.values.size() / file.values_per_frame;
  for (std::size_t frame = 0; frame < count; ++frame) {
    const double* values = file.values.data() + frame * file.values_per_frame;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto& [channels, first_value, announced] = file.channels[i];
      local[i] = local_transform(joints[i], channels, values + first_value, unit_m);
    }
    PosedBones posed = bake_root_motion(result.motion.skeleton, local);
    result.motion.poses.push_back(std::move(posed.pose));
    result.ignored_translation_m =
        std::max(result.ignored_translation_m, posed.ignored_translation_m);
  }
  return result;
}

}  // namespace

Result<BvhMotion> parse_bvh(std::string_view text,
                            const std::string& file,
                            const BvhReadOptions& options) {
  MAREY_ASSERT(options.unit_m > 0.0);
  if (const Status ok = check_kind(text, file, kBvhKind); !ok) return ok.error();
  Result<BvhFile> parsed = BvhParser(text, file, options.unit_m).parse();
  if (!parsed) return parsed.error();
  return motion_of(*std::move(parsed), options.unit_m);
}

Result<BvhMotion> read_bvh(const std::filesystem::path& path,
                           const BvhReadOptions& options) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_bvh(*text, path.string(), options);
}

}  // namespace marey::recordings
