// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tag_pattern.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include <opencv2/aruco.hpp>

#include "capture/tag_families.h"
#include "core/assert.h"

namespace marey::capture {
namespace {

namespace aruco = cv::aruco;

struct Dictionary {
  std::string_view name;
  aruco::PREDEFINED_DICTIONARY_NAME code;
};

constexpr std::array<Dictionary, 21> kDictionaries{{
    {"DICT_4X4_50", aruco::DICT_4X4_50},
    {"DICT_4X4_100", aruco::DICT_4X4_100},
    {"DICT_4X4_250", aruco::DICT_4X4_250},
    {"DICT_4X4_1000", aruco::DICT_4X4_1000},
    {"DICT_5X5_50", aruco::DICT_5X5_50},
    {"DICT_5X5_100", aruco::DICT_5X5_100},
    {"DICT_5X5_250", aruco::DICT_5X5_250},
    {"DICT_5X5_1000", aruco::DICT_5X5_1000},
    {"DICT_6X6_50", aruco::DICT_6X6_50},
    {"DICT_6X6_100", aruco::DICT_6X6_100},
    {"DICT_6X6_250", aruco::DICT_6X6_250},
    {"DICT_6X6_1000", aruco::DICT_6X6_1000},
    {"DICT_7X7_50", aruco::DICT_7X7_50},
    {"DICT_7X7_100", aruco::DICT_7X7_100},
    {"DICT_7X7_250", aruco::DICT_7X7_250},
    {"DICT_7X7_1000", aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", aruco::DICT_APRILTAG_36h11},
}};

Error unknown_dictionary(std::string_view name) {
  std::string known;
  for (const Dictionary& dictionary : kDictionaries) {
    known.append(known.empty() ? "" : ", ").append(dictionary.name);
  }
  return bad_input("dictionary",
                   std::string("\"").append(name).append("\" is not one of OpenCV's"),
                   "use one of " + known);
}

using OwnedFamily = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

TagFamilyShape shape_of(const FamilyMaker& maker, const apriltag_family_t& family) {
  return {std::string(maker.name),
          static_cast<int>(family.ncodes),
          family.total_width,
          family.width_at_border,
          family.reversed_border};
}

}  // namespace

Result<TagFamilyShape> tag_family_shape(std::string_view name) {
  const FamilyMaker* maker = find_family(name);
  if (maker == nullptr) return unknown_family(name);
  const OwnedFamily family(maker->create(), maker->destroy);
  return shape_of(*maker, *family);
}

Result<std::vector<TagPattern>> tag_patterns(std::string_view name,
                                             std::span<const TagId> ids) {
  const FamilyMaker* maker = find_family(name);
  if (maker == nullptr) return unknown_family(name);
  const OwnedFamily family(maker->create(), maker->destroy);
  const int last = static_cast<int>(family->ncodes) - 1;
  std::vector<TagPattern> patterns;
  for (const TagId id : ids) {
    if (number(id) < 0 || number(id) > last) {
      return bad_input(
          "tag " + std::to_string(number(id)),
          std::string(name) + " ends at id " + std::to_string(last),
          "choose ids from 0 to " + std::to_string(last) + ", or a family with more");
    }
    patterns.push_back(pattern_of(family.get(), id));
  }
  return patterns;
}

Result<std::vector<TagPattern>> aruco_patterns(std::string_view dictionary, int count) {
  MAREY_ASSERT(count >= 0);
  const auto known = std::find_if(kDictionaries.begin(),
                                  kDictionaries.end(),
                                  [&](const auto& d) { return d.name == dictionary; });
  if (known == kDictionaries.end()) return unknown_dictionary(dictionary);
  const auto codes = aruco::getPredefinedDictionary(known->code);
  if (count > codes->bytesList.rows) {
    return bad_input("dictionary",
                     std::string(dictionary) + " has " +
                         std::to_string(codes->bytesList.rows) + " markers, of which " +
                         std::to_string(count) + " are needed",
                     "use a larger dictionary, or fewer squares");
  }
  std::vector<TagPattern> patterns;
  for (int id = 0; id < count; ++id) {
    TagPattern pattern;
    pattern.cells = codes->markerSize + 2;
    cv::Mat picture;
    codes->drawMarker(id, pattern.cells, picture);
    for (int y = 0; y < pattern.cells; ++y) {
      for (int x = 0; x < pattern.cells; ++x) {
        pattern.white.push_back(picture.at<std::uint8_t>(y, x) != 0 ? 1 : 0);
      }
    }
    patterns.push_back(std::move(pattern));
  }
  return patterns;
}

}  // namespace marey::capture
