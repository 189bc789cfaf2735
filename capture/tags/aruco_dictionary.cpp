// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/aruco_dictionary.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "capture/tags/aruco_codes.h"
#include "capture/tags/tag_families.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

constexpr std::string_view kAprilTags = "DICT_APRILTAG_";

constexpr std::array<ArucoDictionary, 21> kDictionaries{{
    {"DICT_4X4_50", 4, 50},           {"DICT_4X4_100", 4, 100},
    {"DICT_4X4_250", 4, 250},         {"DICT_4X4_1000", 4, 1000},
    {"DICT_5X5_50", 5, 50},           {"DICT_5X5_100", 5, 100},
    {"DICT_5X5_250", 5, 250},         {"DICT_5X5_1000", 5, 1000},
    {"DICT_6X6_50", 6, 50},           {"DICT_6X6_100", 6, 100},
    {"DICT_6X6_250", 6, 250},         {"DICT_6X6_1000", 6, 1000},
    {"DICT_7X7_50", 7, 50},           {"DICT_7X7_100", 7, 100},
    {"DICT_7X7_250", 7, 250},         {"DICT_7X7_1000", 7, 1000},
    {"DICT_ARUCO_ORIGINAL", 5, 1024}, {"DICT_APRILTAG_16h5", 4, 30},
    {"DICT_APRILTAG_25h9", 5, 35},    {"DICT_APRILTAG_36h10", 6, 2320},
    {"DICT_APRILTAG_36h11", 6, 587},
}};

Error unknown_dictionary(std::string_view name) {
  std::string known;
  for (const ArucoDictionary& dictionary : kDictionaries) {
    known.append(known.empty() ? "" : ", ").append(dictionary.name);
  }
  return bad_input("dictionary",
                   std::string("\"").append(name).append("\" is not one of OpenCV's "
                                                         "dictionaries"),
                   "use one of " + known);
}

/// Returns a marker of the first ArUco library: each row holds two bits of the id, as one
/// of four words (Garrido-Jurado et al. 2014, section 3).
std::uint64_t original_code(int id) {
  constexpr std::array<std::uint64_t, 4> kWords{0b10000, 0b10111, 0b01001, 0b01110};
  std::uint64_t code = 0;
  for (int shift = 8; shift >= 0; shift -= 2) {
    code = code << 5U | kWords[static_cast<std::size_t>(id >> shift & 3)];
  }
  return code;
}

/// Returns the codes of libapriltag's family; OpenCV's markers are upside down.
std::vector<std::uint64_t> apriltag_codes(const std::string& family_name, int count) {
  const FamilyMaker* maker = find_family(family_name);
  MAREY_ASSERT(maker != nullptr);
  apriltag_family_t* family = maker->create();
  std::vector<std::uint64_t> codes;
  for (int id = 0; id < count; ++id) {
    const TagPattern pattern = pattern_of(family, TagId{id});
    const int first = pattern.margin_cells + 1;
    std::uint64_t code = 0;
    for (int y = pattern.cells - 1 - first; y >= first; --y) {
      for (int x = pattern.cells - 1 - first; x >= first; --x) {
        code =
            code << 1U | pattern.white[static_cast<std::size_t>(y * pattern.cells + x)];
      }
    }
    codes.push_back(code);
  }
  maker->destroy(family);
  return codes;
}

template <class Table>
std::vector<std::uint64_t> first_of(const Table& table, int count) {
  return {table.begin(), table.begin() + count};
}

std::vector<std::uint64_t> codes_of(const ArucoDictionary& dictionary) {
  if (dictionary.name.starts_with(kAprilTags)) {
    const std::string_view kind = dictionary.name.substr(kAprilTags.size());
    return apriltag_codes("tag" + std::string(kind), dictionary.count);
  }
  if (dictionary.name == "DICT_ARUCO_ORIGINAL") {
    std::vector<std::uint64_t> codes;
    for (int id = 0; id < dictionary.count; ++id) codes.push_back(original_code(id));
    return codes;
  }
  switch (dictionary.side) {
    case 4:
      return first_of(kCodes4x4, dictionary.count);
    case 5:
      return first_of(kCodes5x5, dictionary.count);
    case 6:
      return first_of(kCodes6x6, dictionary.count);
    default:
      return first_of(kCodes7x7, dictionary.count);
  }
}

/// Markers of one dictionary differ in more cells, the more cells they have.
int correctable_bits(const ArucoDictionary& dictionary) {
  constexpr int kMaxBits = 2;
  const bool is_generated = dictionary.name.find('X') != std::string_view::npos;
  return is_generated ? std::min(dictionary.side - 4, kMaxBits) : 0;
}

}  // namespace

std::span<const ArucoDictionary> aruco_dictionaries() {
  return kDictionaries;
}

Result<MarkerCodes> aruco_dictionary(std::string_view name, int count) {
  const auto known = std::find_if(kDictionaries.begin(),
                                  kDictionaries.end(),
                                  [&](const auto& d) { return d.name == name; });
  if (known == kDictionaries.end()) return unknown_dictionary(name);
  if (count <= known->count) {
    return MarkerCodes{known->side, codes_of(*known), correctable_bits(*known)};
  }
  return bad_input("dictionary",
                   std::string(name) + " has " + std::to_string(known->count) +
                       " markers, of which " + std::to_string(count) + " are needed",
                   "use a larger dictionary, or fewer squares");
}

TagPattern marker_pattern(const MarkerCodes& markers, int id) {
  const std::uint64_t code = markers.codes.at(static_cast<std::size_t>(id));
  TagPattern pattern;
  pattern.cells = markers.side + 2;
  for (int y = -1; y <= markers.side; ++y) {
    for (int x = -1; x <= markers.side; ++x) {
      const bool inside = std::min(x, y) >= 0 && std::max(x, y) < markers.side;
      const int bit = markers.side * markers.side - 1 - (y * markers.side + x);
      const bool white = inside && (code >> static_cast<unsigned>(bit) & 1U) != 0;
      pattern.white.push_back(static_cast<std::uint8_t>(white));
    }
  }
  return pattern;
}

}  // namespace marey::capture
