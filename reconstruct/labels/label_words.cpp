// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/label_words.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/base/assert.h"
#include "core/base/lower_case.h"

namespace marey::reconstruct {
namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

struct SegmentWord {
  std::string_view word;
  std::string_view landmark;  ///< Without its side.
  bool numbered;              ///< Too short to be valid without a number.
};

// clang-format off
constexpr std::array kSided{
    SegmentWord{"upperarm", "upper_arm", false}, SegmentWord{"uparm", "upper_arm", false},
    SegmentWord{"uarm", "upper_arm", false}, SegmentWord{"humerus", "upper_arm", false},
    SegmentWord{"bicep", "upper_arm", false}, SegmentWord{"biceps", "upper_arm", false},
    SegmentWord{"forearm", "forearm", false}, SegmentWord{"lowerarm", "forearm", false},
    SegmentWord{"farm", "forearm", false}, SegmentWord{"hand", "hand", false},
    SegmentWord{"thigh", "thigh", false}, SegmentWord{"femur", "thigh", false},
    SegmentWord{"upleg", "thigh", false}, SegmentWord{"upperleg", "thigh", false},
    SegmentWord{"shank", "shank", false}, SegmentWord{"shin", "shank", false},
    SegmentWord{"tibia", "shank", false}, SegmentWord{"lowerleg", "shank", false},
    SegmentWord{"calf", "shank", false}, SegmentWord{"leg", "shank", false},
    SegmentWord{"foot", "foot", false}, SegmentWord{"scapula", "scapula", false},
    SegmentWord{"ua", "upper_arm", true}, SegmentWord{"upa", "upper_arm", true},
    SegmentWord{"arm", "upper_arm", true}, SegmentWord{"hum", "upper_arm", true},
    SegmentWord{"la", "forearm", true}, SegmentWord{"fa", "forearm", true},
    SegmentWord{"fra", "forearm", true}, SegmentWord{"frm", "forearm", true},
    SegmentWord{"hnd", "hand", true}, SegmentWord{"ha", "hand", true},
    SegmentWord{"th", "thigh", true}, SegmentWord{"thi", "thigh", true},
    SegmentWord{"tg", "thigh", true}, SegmentWord{"fem", "thigh", true},
    SegmentWord{"tb", "shank", true}, SegmentWord{"tib", "shank", true},
    SegmentWord{"sk", "shank", true}, SegmentWord{"sh", "shank", true},
    SegmentWord{"sha", "shank", true}, SegmentWord{"shk", "shank", true},
    SegmentWord{"shn", "shank", true}, SegmentWord{"sn", "shank", true},
    SegmentWord{"ft", "foot", true}, SegmentWord{"fo", "foot", true},
};

constexpr std::array kUnsided{
    SegmentWord{"pelvis", "hips", false}, SegmentWord{"pelvic", "hips", false},
    SegmentWord{"hips", "hips", false}, SegmentWord{"thorax", "upper_chest", false},
    SegmentWord{"trunk", "upper_chest", false}, SegmentWord{"torso", "upper_chest", false},
    SegmentWord{"head", "head", false}, SegmentWord{"pel", "hips", true},
    SegmentWord{"pv", "hips", true}, SegmentWord{"hd", "head", true},
    SegmentWord{"hed", "head", true}, SegmentWord{"sac", "hips", true},
    SegmentWord{"trk", "upper_chest", true}, SegmentWord{"tho", "upper_chest", true},
};
// clang-format on

/// Words that may follow a segment's word: numbers, and places on the segment. Longest
/// first.
constexpr std::array<std::string_view, 27> kPlaces{
    "posterior", "proximal", "anterior", "superior", "inferior", "lateral", "cluster",
    "medial",    "middle",   "bottom",   "distal",   "upper",    "lower",   "front",
    "back",      "rear",     "side",     "prox",     "dist",     "post",    "high",
    "ant",       "lat",      "med",      "sup",      "inf",      "mid"};

/// Returns true if `rest` consists of numbers and places alone; `numbers` is the number
/// of digits.
bool is_place(std::string_view rest, std::size_t& numbers) {
  while (!rest.empty()) {
    if (is_digit(rest[0])) {
      ++numbers;
      rest.remove_prefix(1);
      continue;
    }
    const auto* const place = std::find_if(
        kPlaces.begin(), kPlaces.end(), [&](auto p) { return rest.starts_with(p); });
    if (place == kPlaces.end()) return false;
    rest.remove_prefix(place->size());
  }
  return true;
}

/// Returns the landmark of the word that `stem` begins with, if only places follow.
std::string_view landmark_of(std::string_view stem, std::span<const SegmentWord> words) {
  for (const SegmentWord& word : words) {
    if (!stem.starts_with(word.word)) continue;
    std::size_t numbers = 0;
    if (!is_place(stem.substr(word.word.size()), numbers)) continue;
    // Two digits number a cluster; more are an identity.
    if (numbers > 2 || (word.numbered && numbers == 0)) continue;
    return word.landmark;
  }
  return {};
}

}  // namespace

std::string plain_label(std::string_view label) {
  std::string plain;
  for (const char c : label) {
    if (is_letter(c) || is_digit(c)) {
      plain += lower_case(c);
    }
  }
  return plain;
}

std::vector<SidedLabel> sides_of(std::string_view label) {
  const std::string plain = plain_label(label);
  struct Word {
    std::string_view text;
    BodySide side;
  };
  constexpr std::array kWords{Word{"left", BodySide::kLeft},
                              Word{"right", BodySide::kRight},
                              Word{"l", BodySide::kLeft},
                              Word{"r", BodySide::kRight}};
  std::vector<SidedLabel> found;
  for (const Word& word : kWords) {
    if (plain.size() > word.text.size() && plain.starts_with(word.text)) {
      found.push_back({word.side, plain.substr(word.text.size()), false});
    }
  }
  const bool is_parted = label.size() >= 2 && !is_letter(label[label.size() - 2]) &&
                         !is_digit(label[label.size() - 2]);
  for (const Word& word : kWords) {
    if (plain.size() > word.text.size() && plain.ends_with(word.text)) {
      found.push_back({word.side,
                       plain.substr(0, plain.size() - word.text.size()),
                       word.text.size() == 1 && !is_parted});
    }
  }
  return found;
}

const Landmark* segment_of_words(std::string_view label) {
  const std::string_view middle = landmark_of(plain_label(label), kUnsided);
  if (!middle.empty()) return find_landmark(middle);
  for (const SidedLabel& sided : sides_of(label)) {
    if (sided.needs_other_side) continue;
    const std::string_view place = landmark_of(sided.stem, kSided);
    if (place.empty()) continue;
    std::string name = sided.side == BodySide::kLeft ? "left_" : "right_";
    return find_landmark(name.append(place));
  }
  return nullptr;
}

}  // namespace marey::reconstruct
