// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/tags/aruco_dictionary.h"

#include <map>
#include <string_view>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>

namespace marey::capture {
namespace {

const std::map<std::string_view, int> kOpenCvs{
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11}};

TEST(ArucoDictionary, EveryMarkerIsOpenCvs) {
  ASSERT_EQ(aruco_dictionaries().size(), kOpenCvs.size());
  for (const ArucoDictionary& dictionary : aruco_dictionaries()) {
    SCOPED_TRACE(dictionary.name);
    const auto theirs = cv::aruco::getPredefinedDictionary(kOpenCvs.at(dictionary.name));
    ASSERT_EQ(dictionary.count, theirs->bytesList.rows);
    const auto ours = aruco_dictionary(dictionary.name, dictionary.count);
    ASSERT_TRUE(ours);
    for (int id = 0; id < dictionary.count; ++id) {
      const TagPattern pattern = marker_pattern(*ours, id);
      cv::Mat drawn;
      theirs->drawMarker(id, pattern.cells, drawn);
      ASSERT_EQ(static_cast<std::size_t>(drawn.total()), pattern.white.size());
      for (std::size_t i = 0; i < pattern.white.size(); ++i) {
        ASSERT_EQ(pattern.white[i] != 0, drawn.data[i] != 0) << id;
      }
    }
  }
}

}  // namespace
}  // namespace marey::capture
