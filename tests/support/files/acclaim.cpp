// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/acclaim.h"

#include <array>
#include <cctype>
#include <sstream>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/angle.h"

namespace marey::testing {
namespace {

constexpr double kInchM = 0.0254;

/// Lines that hold something, as words. Comments are left out.
struct Lines {
  Lines(const std::string& all, std::string name) : text(all), file(std::move(name)) {}

  std::istringstream text;
  std::string file;
  int number = 0;
  std::vector<std::string> words;

  bool next() {
    std::string line;
    while (std::getline(text, line)) {
      ++number;
      words.clear();
      std::istringstream in(line);
      for (std::string word; in >> word;) words.push_back(word);
      if (!words.empty() && words[0][0] != '#') return true;
    }
    return false;
  }
  [[nodiscard]] Error error(const std::string& cause) const {
    return bad_input(file + ":" + std::to_string(number), cause, "check the file");
  }
  /// 0 where there is no such word, or it is no number.
  [[nodiscard]] double value(std::size_t word) const {
    if (word >= words.size()) return 0.0;
    double out = 0.0;
    std::istringstream(words[word]) >> out;
    return out;
  }
};

glm::dvec3 axis(char letter) {
  glm::dvec3 out(0.0);
  out[std::tolower(letter) - 'x'] = 1.0;
  return out;
}

/// Turned about x, then y, then z, axes that stay where they are.
glm::dquat turned_xyz(const glm::dvec3& angles_rad) {
  return glm::angleAxis(angles_rad.z, axis('z')) *
         glm::angleAxis(angles_rad.y, axis('y')) *
         glm::angleAxis(angles_rad.x, axis('x'));
}

/// "rx" is 'x', "TX" is 'X'; 0 for another word.
char channel(const std::string& word) {
  if (word.size() != 2) return 0;
  const char kind = static_cast<char>(std::tolower(word[0]));
  const char letter = static_cast<char>(std::tolower(word[1]));
  if (letter < 'x' || letter > 'z') return 0;
  if (kind == 'r') return letter;
  return kind == 't' ? static_cast<char>(std::toupper(letter)) : '\0';
}

bool add_channels(const Lines& lines, AcclaimBone& bone) {
  for (std::size_t i = 1; i < lines.words.size(); ++i) {
    const char one = channel(lines.words[i]);
    if (one == 0) return false;
    bone.channels.push_back(one);
  }
  return true;
}

/// One line of a bone; lines of no use here are passed by.
std::optional<Error> read_bone_line(const Lines& lines,
                                    double unit_m,
                                    AcclaimBone& bone) {
  const std::string& key = lines.words[0];
  if (key == "name" && lines.words.size() == 2) bone.name = lines.words[1];
  if (key == "direction") {
    bone.span_in_root = {lines.value(1), lines.value(2), lines.value(3)};
    if (glm::length(bone.span_in_root) == 0.0)
      return lines.error("a bone points nowhere");
    bone.span_in_root = glm::normalize(bone.span_in_root);
  }
  if (key == "length") bone.span_in_root *= unit_m * lines.value(1);
  if (key == "axis") {
    if (lines.words.back() != "XYZ") return lines.error("axes are not turned XYZ");
    bone.root_from_axes = turned_xyz(
        kRadiansPerDegree * glm::dvec3(lines.value(1), lines.value(2), lines.value(3)));
  }
  if (key == "dof" && !add_channels(lines, bone)) {
    return lines.error("a degree of freedom is not known");
  }
  return std::nullopt;
}

/// "parent child child": the children come into the order of the bones.
std::optional<Error> read_children(const Lines& lines,
                                   const std::vector<AcclaimBone>& loose,
                                   AcclaimSkeleton& skeleton) {
  const auto parent = skeleton.find(lines.words[0]);
  if (!parent) return lines.error(lines.words[0] + " has no parent");
  for (std::size_t i = 1; i < lines.words.size(); ++i) {
    bool found = false;
    for (const AcclaimBone& bone : loose) {
      if (bone.name != lines.words[i]) continue;
      skeleton.bones.push_back(bone);
      skeleton.bones.back().parent = parent;
      found = true;
    }
    if (!found) return lines.error("there is no bone " + lines.words[i]);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> AcclaimSkeleton::find(std::string_view bone) const {
  for (std::size_t i = 0; i < bones.size(); ++i) {
    if (bones[i].name == bone) return i;
  }
  return std::nullopt;
}

Result<AcclaimSkeleton> parse_asf(const std::string& text, const std::string& file) {
  AcclaimSkeleton skeleton;
  skeleton.bones.emplace_back().name = "root";
  std::vector<AcclaimBone> loose;
  Lines lines(text, file);
  std::string section;
  while (lines.next()) {
    const std::string& key = lines.words[0];
    if (key[0] == ':') {
      section = key;
    } else if (section == ":units" && key == "length") {
      if (lines.value(1) <= 0.0) return lines.error("no unit of length");
      skeleton.unit_m = kInchM / lines.value(1);
    } else if (section == ":units" && key == "angle" && lines.words.back() != "deg") {
      return lines.error("angles are not in degrees");
    } else if (section == ":root" && key == "order") {
      if (!add_channels(lines, skeleton.bones[0])) return lines.error("the root's order");
    } else if (section == ":bonedata" && key == "begin") {
      loose.emplace_back();
    } else if (section == ":bonedata" && !loose.empty()) {
      if (auto error = read_bone_line(lines, skeleton.unit_m, loose.back())) {
        return *std::move(error);
      }
    } else if (section == ":hierarchy" && key != "begin" && key != "end") {
      if (auto error = read_children(lines, loose, skeleton)) return *std::move(error);
    }
  }
  if (skeleton.bones.size() == 1 || skeleton.unit_m == 0.0) {
    return lines.error("no bones, or no unit of length");
  }
  return skeleton;
}

Result<std::vector<std::vector<double>>> parse_amc(const AcclaimSkeleton& skeleton,
                                                   const std::string& text,
                                                   const std::string& file) {
  std::vector<std::size_t> first;
  std::size_t channels = 0;
  for (const AcclaimBone& bone : skeleton.bones) {
    first.push_back(channels);
    channels += bone.channels.size();
  }
  std::vector<std::vector<double>> frames;
  Lines lines(text, file);
  while (lines.next()) {
    if (lines.words[0][0] == ':') continue;
    if (lines.words.size() == 1) {
      frames.emplace_back(channels, 0.0);
      continue;
    }
    const auto bone = skeleton.find(lines.words[0]);
    if (!bone || frames.empty()) return lines.error("no bone, or no frame");
    const std::string& kinds = skeleton.bones[*bone].channels;
    if (lines.words.size() != kinds.size() + 1) {
      return lines.error(lines.words[0] + " has " +
                         std::to_string(lines.words.size() - 1) + " numbers, not " +
                         std::to_string(kinds.size()));
    }
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const double unit =
          std::isupper(kinds[i]) != 0 ? skeleton.unit_m : kRadiansPerDegree;
      frames.back()[first[*bone] + i] = unit * lines.value(i + 1);
    }
  }
  return frames;
}

std::vector<RigidTransform> file_from_bones(const AcclaimSkeleton& skeleton,
                                            const std::vector<double>& frame) {
  std::vector<RigidTransform> out;
  std::size_t at = 0;
  for (const AcclaimBone& bone : skeleton.bones) {
    glm::dquat turn(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 moved(0.0);
    for (const char kind : bone.channels) {
      const double value = frame[at++];
      if (std::isupper(kind) != 0) {
        moved += value * axis(kind);
      } else {
        turn = glm::angleAxis(value, axis(kind)) * turn;
      }
    }
    const RigidTransform local{
        bone.root_from_axes * turn * glm::conjugate(bone.root_from_axes), moved};
    if (!bone.parent) {
      out.push_back(local);
      continue;
    }
    const RigidTransform parent = out[*bone.parent];
    const glm::dvec3 start = parent * skeleton.bones[*bone.parent].span_in_root;
    out.push_back(
        {parent.rotation * local.rotation, start + parent.rotation * local.translation});
  }
  return out;
}

}  // namespace marey::testing
