// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/joint_words.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "core/base/lower_case.h"

namespace marey::retarget {
namespace {

enum class Letter { kLower, kUpper, kDigit, kOther };

Letter kind_of(char c) {
  if (c >= 'a' && c <= 'z') return Letter::kLower;
  if (c >= 'A' && c <= 'Z') return Letter::kUpper;
  if (c >= '0' && c <= '9') return Letter::kDigit;
  // Bytes of other alphabets are letters of a word that marey does not know.
  return static_cast<unsigned char>(c) >= 0x80 ? Letter::kLower : Letter::kOther;
}

using Words = std::vector<std::string>;

/// Splits names: "LHipJoint" is L, Hip and Joint; "thigh_l.001" is thigh, l and 1.
Words split(std::string_view name) {
  // "Model::", "mixamorig:", "Armature|".
  if (const auto at = name.find_last_of(":|/"); at != std::string_view::npos) {
    name.remove_prefix(at + 1);
  }
  Words words;
  Letter before = Letter::kOther;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const Letter kind = kind_of(name[i]);
    const bool ends_capitals = kind == Letter::kUpper && before == Letter::kUpper &&
                               i + 1 < name.size() &&
                               kind_of(name[i + 1]) == Letter::kLower;
    const bool begins = before == Letter::kOther || ends_capitals ||
                        (kind == Letter::kUpper && before == Letter::kLower) ||
                        (kind == Letter::kDigit) != (before == Letter::kDigit);
    before = kind;
    if (kind == Letter::kOther) continue;
    if (begins) words.emplace_back();
    words.back() += lower_case(name[i]);
  }
  for (std::string& word : words) {
    if (kind_of(word[0]) != Letter::kDigit) continue;
    word.erase(0, std::min(word.find_first_not_of('0'), word.size() - 1));
  }
  return words;
}

bool is_number(std::string_view word) {
  return kind_of(word[0]) == Letter::kDigit;
}

template <std::size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N>& list) {
  return std::ranges::find(list, word) != list.end();
}

NameSide side_of(std::string_view word) {
  constexpr std::array<std::string_view, 4> kLeft{"left", "l", "lft", "lt"};
  constexpr std::array<std::string_view, 4> kRight{"right", "r", "rgt", "rt"};
  if (is_one_of(word, kLeft)) return NameSide::kLeft;
  return is_one_of(word, kRight) ? NameSide::kRight : NameSide::kNone;
}

/// Returns true for words that programs put before or after the bone's own.
bool is_decoration(std::string_view word) {
  constexpr std::array<std::string_view, 24> kBefore{
      "mixamorig", "bip", "biped",     "valve", "def",   "org",   "joint", "jnt",
      "bone",      "b",   "j",         "bn",    "skel",  "sk",    "cc",    "base",
      "armature",  "rig", "character", "c",     "human", "hanim", "bvh",   "avatar"};
  return is_one_of(word, kBefore);
}
bool is_decoration_behind(std::string_view word) {
  constexpr std::array<std::string_view, 5> kBehind{"jnt", "jt", "bone", "bind", "skin"};
  return is_one_of(word, kBehind);
}

/// Removes decorations while a word remains: "bip 1 l thigh" becomes "l thigh".
void strip_decorations(Words& words) {
  std::size_t first = 0;
  while (first + 1 < words.size() && is_decoration(words[first])) {
    ++first;
    while (first + 1 < words.size() && is_number(words[first])) ++first;
  }
  words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(first));
  while (words.size() > 1 && is_decoration_behind(words.back())) words.pop_back();
}

/// Returns the first word of most names, if it is no side: the character's own name.
std::string common_word(const std::vector<Words>& names) {
  std::map<std::string, std::size_t> counts;
  for (const Words& words : names) {
    if (words.size() > 1) ++counts[words.front()];
  }
  for (const auto& [word, count] : counts) {
    const bool is_common = count > 4 && 10 * count >= 8 * names.size();
    if (is_common && side_of(word) == NameSide::kNone) return word;
  }
  return {};
}

/// Splits left and right off a word without a capital between: "lfemur", "leftupleg",
/// "thighl".
void split_side(Words& words) {
  constexpr std::array<std::string_view, 22> kStuck{
      "femur",    "tibia",    "foot",  "toes", "toe",   "humerus", "radius", "wrist",
      "hand",     "clavicle", "thigh", "shin", "calf",  "shldr",   "collar", "forearm",
      "hipjoint", "shoulder", "elbow", "knee", "ankle", "hip"};
  for (const Words::iterator word : {words.begin(), words.end() - 1}) {
    for (const auto& [side, length] :
         {std::pair<std::string, std::size_t>{"left", 4}, {"right", 5}}) {
      if (word->size() <= length + 1) continue;
      if (word->starts_with(side)) {
        *word = word->substr(length);
        words.insert(words.begin(), side);
        return;
      }
      if (word->ends_with(side)) {
        word->resize(word->size() - length);
        words.push_back(side);
        return;
      }
    }
    const char first = word->front();
    const bool is_stuck = (first == 'l' || first == 'r') &&
                          is_one_of(std::string_view(*word).substr(1), kStuck);
    if (!is_stuck) continue;
    word->erase(0, 1);
    words.insert(words.begin(), std::string(1, first));
    return;
  }
}

JointWord joined(Words words) {
  JointWord result;
  const bool has_side = std::ranges::any_of(
      words, [](const std::string& word) { return side_of(word) != NameSide::kNone; });
  if (!has_side && !words.empty()) split_side(words);
  for (const std::string& word : words) {
    const NameSide side = side_of(word);
    if (side != NameSide::kNone && result.side == NameSide::kNone && words.size() > 1) {
      result.side = side;
    } else {
      result.word += word;
    }
  }
  return result;
}

}  // namespace

std::vector<JointWord> joint_words(const Skeleton& skeleton) {
  std::vector<Words> names;
  names.reserve(skeleton.joints.size());
  for (const Joint& joint : skeleton.joints) names.push_back(split(joint.name));
  for (std::string common = common_word(names); !common.empty();
       common = common_word(names)) {
    for (Words& words : names) {
      if (words.size() > 1 && words.front() == common) words.erase(words.begin());
    }
  }
  std::vector<JointWord> result;
  result.reserve(names.size());
  for (Words& words : names) {
    strip_decorations(words);
    result.push_back(joined(std::move(words)));
  }
  return result;
}

bool is_spine_word(std::string_view word) {
  constexpr std::array<std::string_view, 12> kWords{"spine",
                                                    "chest",
                                                    "upperchest",
                                                    "lowerback",
                                                    "upperback",
                                                    "thorax",
                                                    "abdomen",
                                                    "torso",
                                                    "waist",
                                                    "back",
                                                    "ribs",
                                                    "ribcage"};
  constexpr std::array<std::string_view, 2> kVertebrae{"vl", "vt"};
  while (!word.empty() && is_number(word.substr(word.size() - 1))) word.remove_suffix(1);
  if (is_one_of(word, kVertebrae)) return true;
  return std::ranges::any_of(
      kWords, [&](std::string_view known) { return word.starts_with(known); });
}

}  // namespace marey::retarget
