// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/base/lower_case.h"
#include "core/humanoid.h"
#include "recordings/base/atomic_file.h"
#include "recordings/base/motion_limits.h"
#include "recordings/base/text_reader.h"
#include "recordings/base/word_text.h"
#include "recordings/body/floor_height.h"
#include "recordings/motion/asf.h"

namespace marey::recordings {
namespace {

constexpr double kInch_m = 0.0254;

/// "rx" rotates about x, "TX" translates along it, "l" stretches the bone.
std::optional<AsfChannel> channel_of(const std::string& word) {
  if (word == "l") return AsfChannel{AsfChannel::Kind::kStretch, 0};
  if (word.size() != 2 || word[1] < 'x' || word[1] > 'z') return std::nullopt;
  const int axis = word[1] - 'x';
  if (word[0] == 'r') return AsfChannel{AsfChannel::Kind::kTurn, axis};
  if (word[0] == 't') return AsfChannel{AsfChannel::Kind::kMove, axis};
  return std::nullopt;
}

/// Three rotation angles and their axes, the first one applied first.
struct Turns {
  glm::dvec3 angles{0.0};  ///< In the file's unit.
  std::array<int, 3> axes{0, 1, 2};

  [[nodiscard]] glm::dquat rotation(double radians_per_unit) const {
    glm::dquat turned(1.0, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 axis(0.0);
      axis[axes[static_cast<std::size_t>(i)]] = 1.0;
      turned = glm::angleAxis(angles[i] * radians_per_unit, axis) * turned;
    }
    return glm::normalize(turned);
  }
};

/// A bone as the file has it, in the file's units.
struct Bone {
  std::string name;
  glm::dvec3 direction{0.0};
  double length = 0.0;
  Turns turns;
  std::vector<AsfChannel> channels;
  std::optional<std::size_t> parent;
  std::vector<std::size_t> children;
};

struct AsfFile {
  std::vector<Bone> bones;  ///< The first is the root.
  glm::dvec3 root_place{0.0};
  double length_unit = 1.0;
  bool in_degrees = true;
};

class AsfParser {
 public:
  AsfParser(std::string_view text, const std::string& file) : reader_(text, file) {
    file_.bones.emplace_back().name = "root";
    place_of_["root"] = 0;
  }

  Result<AsfFile> parse() {
    while (next_line()) {
      if (Status s = line(); !s) return s.error();
      (void)reader_.rest_of_line();
    }
    if (in_bone_) return fail("the file ends inside a bone");
    if (file_.bones.size() == 1) {
      return fail("the file has no bones: it is not a .asf file");
    }
    if (!has_hierarchy_) return fail("the file ends before its :hierarchy");
    if (file_.bones.size() > kMaxJoints) {
      return fail("there are more than " + std::to_string(kMaxJoints) + " bones");
    }
    const std::vector<std::size_t> levels = levels_below_root();
    for (std::size_t i = 1; i < levels.size(); ++i) {
      if (levels[i] > kMaxSkeletonDepth) {
        return fail("bones are nested more than " + std::to_string(kMaxSkeletonDepth) +
                    " levels deep");
      }
      if (levels[i] > 0) continue;
      return fail("the bone " + quoted_start(file_.bones[i].name) +
                  " is not connected to the root in the :hierarchy");
    }
    return std::move(file_);
  }

 private:
  [[nodiscard]] Error fail(std::string cause) const {
    return bad_input(reader_.where(),
                     std::move(cause),
                     "export the file again, or correct that line in a text editor");
  }

  /// Reads the first word of the next line with content into first_. False at the end.
  bool next_line() {
    for (;; (void)reader_.rest_of_line()) {
      reader_.skip_blank();
      if (reader_.at_end()) return false;
      raw_ = reader_.word_on_line();
      first_ = lower_case(raw_);
      if (first_[0] != '#') return true;
    }
  }

  Status line() {
    if (first_[0] == ':') {
      section_ = first_;
      has_hierarchy_ = has_hierarchy_ || section_ == ":hierarchy";
      return Done{};
    }
    if (section_.empty()) {
      return fail("expected a section (\":root\"): this is not a .asf file");
    }
    if (section_ == ":units") return unit_line();
    if (section_ == ":root") return root_line();
    if (section_ == ":bonedata") return bone_line();
    if (section_ == ":hierarchy") return hierarchy_line();
    return Done{};
  }

  Result<double> number() {
    const std::string_view word = reader_.word_on_line();
    if (const auto value = to_number(word)) return *value;
    return fail("expected a number for " + first_ + ", found " + quoted_start(word));
  }

  Status vector(glm::dvec3& into) {
    for (int i = 0; i < 3; ++i) {
      const auto value = number();
      if (!value) return value.error();
      into[i] = *value;
    }
    return Done{};
  }

  Status unit_line() {
    if (first_ == "length") {
      const auto value = number();
      if (!value) return value.error();
      if (*value < 1e-6 || *value > 1e6) return fail("length is not a unit");
      file_.length_unit = *value;
    } else if (first_ == "angle") {
      const std::string word = lower_case(reader_.word_on_line());
      if (!word.starts_with("deg") && !word.starts_with("rad")) {
        return fail("angles are in " + quoted_start(word) + ", neither deg nor rad");
      }
      file_.in_degrees = word[0] == 'd';
    }
    return Done{};
  }

  Status order(std::array<int, 3>& into) {
    const std::string word = lower_case(reader_.word_on_line());
    if (word.empty()) return Done{};  // The default is XYZ.
    bool good = word.size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      good = word[i] >= 'x' && word[i] <= 'z';
      into[i] = word[i] - 'x';
    }
    if (good && into[0] != into[1] && into[1] != into[2] && into[0] != into[2]) {
      return Done{};
    }
    return fail(quoted_start(word) + " is not an order of the axes X, Y and Z");
  }

  Status channels(Bone& bone) {
    bone.channels.clear();
    for (std::string word = lower_case(reader_.word_on_line()); !word.empty();
         word = lower_case(reader_.word_on_line())) {
      const auto channel = channel_of(word);
      if (!channel) return fail("unknown degree of freedom " + quoted_start(word));
      if (bone.channels.size() == 7) {
        return fail("there are more than 7 degrees of freedom");
      }
      bone.channels.push_back(*channel);
    }
    return Done{};
  }

  Status root_line() {
    Bone& root = file_.bones[0];
    if (first_ == "order") return channels(root);
    if (first_ == "axis") return order(root.turns.axes);
    if (first_ == "position") return vector(file_.root_place);
    if (first_ == "orientation") return vector(root.turns.angles);
    return Done{};
  }

  Status begin_bone() {
    if (in_bone_) return fail("a bone begins inside another");
    in_bone_ = true;
    file_.bones.emplace_back();
    return Done{};
  }

  Status end_bone() {
    if (!in_bone_) return fail("\"end\" without a \"begin\"");
    in_bone_ = false;
    Bone& bone = file_.bones.back();
    if (bone.name.empty()) return fail("a bone has no name");
    const double along = glm::length(bone.direction);
    if (bone.length != 0.0 && !(along > 1e-9)) {
      return fail("the bone " + quoted_start(bone.name) + " has no direction");
    }
    if (along > 0.0) bone.direction /= along;
    return Done{};
  }

  Status bone_line() {
    if (first_ == "begin") return begin_bone();
    if (first_ == "end") return end_bone();
    if (!in_bone_) return fail("expected \"begin\", found " + quoted_start(raw_));
    Bone& bone = file_.bones.back();
    if (first_ == "name") {
      if (!bone.name.empty()) return fail("a bone has two names");
      bone.name = reader_.word_on_line();
      const auto [there, is_new] = place_of_.emplace(bone.name, file_.bones.size() - 1);
      if (!is_new) return fail("the bone " + quoted_start(bone.name) + " is given twice");
    } else if (first_ == "direction") {
      if (Status s = vector(bone.direction); !s) return s;
      if (glm::length(bone.direction) > kMaxDistance_m)
        return fail("this is not a direction");
    } else if (first_ == "length") {
      const auto value = number();
      if (!value) return value.error();
      bone.length = *value;
    } else if (first_ == "axis") {
      if (Status s = vector(bone.turns.angles); !s) return s;
      return order(bone.turns.axes);
    } else if (first_ == "dof") {
      return channels(bone);
    }
    return Done{};  // id, limits with their further lines, bodymass and similar keys.
  }

  Status hierarchy_line() {
    if (first_ == "begin" || first_ == "end") return Done{};
    const auto above = place_of_.find(raw_);
    if (above == place_of_.end()) return fail("there is no bone " + quoted_start(raw_));
    for (auto word = reader_.word_on_line(); !word.empty();
         word = reader_.word_on_line()) {
      const auto below = place_of_.find(word);
      if (below == place_of_.end() || below->second == 0) {
        return fail("no bone " + quoted_start(word) + " can have a parent");
      }
      Bone& child = file_.bones[below->second];
      if (child.parent) {
        return fail("the bone " + quoted_start(word) + " has two parents");
      }
      child.parent = above->second;
      file_.bones[above->second].children.push_back(below->second);
    }
    return Done{};
  }

  /// Returns the level of each bone, from 1 for the root; 0 for bones that are not
  /// connected to it, such as those of a cycle.
  [[nodiscard]] std::vector<std::size_t> levels_below_root() const {
    std::vector<std::size_t> levels(file_.bones.size(), 0);
    levels[0] = 1;
    std::vector<std::size_t> open{0};
    while (!open.empty()) {
      const std::size_t above = open.back();
      open.pop_back();
      for (const std::size_t child : file_.bones[above].children) {
        levels[child] = levels[above] + 1;
        open.push_back(child);
      }
    }
    return levels;
  }

  TextReader reader_;
  AsfFile file_;
  std::map<std::string, std::size_t, std::less<>> place_of_;
  std::string section_;
  std::string_view raw_;
  std::string first_;  ///< raw_ in lower case.
  bool in_bone_ = false;
  bool has_hierarchy_ = false;
};

/// Creates joints in the order of the hierarchy, depth first.
AsfSkeleton skeleton_of(const AsfFile& file, double unit_m) {
  AsfSkeleton out;
  out.unit_m = unit_m;
  out.in_degrees = file.in_degrees;
  out.root_place = file.root_place * unit_m;
  struct Open {
    std::size_t bone;
    std::optional<JointIndex> parent;
  };
  std::vector<Open> open{{0, std::nullopt}};
  while (!open.empty()) {
    const auto [place, parent] = open.back();
    open.pop_back();
    const Bone& bone = file.bones[place];
    Joint joint;
    joint.name = bone.name;
    joint.parent = parent;
    joint.bone = human_bone(bone.name);
    if (bone.parent) {
      const Bone& above = file.bones[*bone.parent];
      joint.parent_from_joint.translation = above.direction * (above.length * unit_m);
    }
    if (bone.children.empty()) {
      joint.tip_in_joint = bone.direction * (bone.length * unit_m);
    }
    const JointIndex self{static_cast<int>(out.skeleton.joints.size())};
    out.skeleton.joints.push_back(std::move(joint));
    out.channels.push_back(bone.channels);
    out.world_from_axes.push_back(
        bone.turns.rotation(file.in_degrees ? kRadiansPerDegree : 1.0));
    for (auto child = bone.children.rbegin(); child != bone.children.rend(); ++child) {
      open.push_back({*child, self});
    }
  }
  glm::dvec3& rest = out.skeleton.joints[0].parent_from_joint.translation;
  rest = out.root_place;
  if (rest == glm::dvec3(0.0)) rest.y = standing_height(out.skeleton);
  return out;
}

}  // namespace

Result<AsfSkeleton> parse_asf(std::string_view text,
                              const std::string& file,
                              const AsfReadOptions& options) {
  MAREY_ASSERT(!options.unit_m || *options.unit_m > 0.0);
  Result<AsfFile> parsed = AsfParser(text, file).parse();
  if (!parsed) return parsed.error();
  const double unit_m = options.unit_m.value_or(kInch_m / parsed->length_unit);
  for (const Bone& bone : parsed->bones) {
    if (std::abs(bone.length * unit_m) <= kMaxDistance_m) continue;
    return bad_input(file,
                     "the bone " + quoted_start(bone.name) + " is longer than 10 km",
                     "name the file's unit of length");
  }
  if (!(glm::length(parsed->root_place) * unit_m <= kMaxDistance_m)) {
    return bad_input(
        file, "the root lies further than 10 km away", "name the file's unit of length");
  }
  return skeleton_of(*parsed, unit_m);
}

Result<AsfSkeleton> read_asf(const std::filesystem::path& path,
                             const AsfReadOptions& options) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  return parse_asf(*text, path.string(), options);
}

}  // namespace marey::recordings
