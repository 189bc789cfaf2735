// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/aruco_dictionary.h"

#include <algorithm>
#include <array>
#include <string>

namespace marey::capture {
namespace {

namespace aruco = cv::aruco;

constexpr std::array<ArucoDictionary, 21> kDictionaries{{
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
  for (const ArucoDictionary& dictionary : kDictionaries) {
    known.append(known.empty() ? "" : ", ").append(dictionary.name);
  }
  return bad_input("dictionary",
                   std::string("\"").append(name).append("\" is not one of OpenCV's "
                                                         "dictionaries"),
                   "use one of " + known);
}

}  // namespace

std::span<const ArucoDictionary> aruco_dictionaries() {
  return kDictionaries;
}

Result<cv::Ptr<aruco::Dictionary>> aruco_dictionary(std::string_view name, int count) {
  const auto known = std::find_if(kDictionaries.begin(),
                                  kDictionaries.end(),
                                  [&](const auto& d) { return d.name == name; });
  if (known == kDictionaries.end()) return unknown_dictionary(name);
  auto dictionary = aruco::getPredefinedDictionary(known->code);
  if (count <= dictionary->bytesList.rows) return dictionary;
  return bad_input("dictionary",
                   std::string(name) + " has " +
                       std::to_string(dictionary->bytesList.rows) +
                       " markers, of which " + std::to_string(count) + " are needed",
                   "use a larger dictionary, or fewer squares");
}

}  // namespace marey::capture
