// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/survey_frames.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/boards/board_search.h"
#include "capture/tags/aruco_dictionary.h"
#include "capture/tags/detect_tags.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

// Fewer markers than this in an image may be false detections.
constexpr std::size_t kMinMarkers = 4;

/// A preprocessing of an image of markers.
struct Look {
  bool inverted = false;
  bool mirrored = false;
};

/// Returns a copy, or the frame itself if nothing changes.
cv::Mat looked_at(const cv::Mat& gray, const Look& look) {
  if (!look.inverted && !look.mirrored) return gray;
  cv::Mat picture = gray.clone();
  if (look.inverted) cv::bitwise_not(picture, picture);
  if (look.mirrored) cv::flip(picture, picture, /*flipCode=*/1);
  return picture;
}

/// Tags of the bodies in view, by OpenCV's name of their family.
using WornIds = std::map<std::string, std::set<int>, std::less<>>;

WornIds ids_of(std::span<const TagFamilyUse> worn) {
  WornIds ids;
  for (const TagFamilyUse& use : worn) {
    constexpr std::string_view kTag = "tag";
    if (!use.name.starts_with(kTag)) continue;
    auto& of_family = ids["DICT_APRILTAG_" + use.name.substr(kTag.size())];
    for (const TagId id : use.ids) of_family.insert(number(id));
  }
  return ids;
}

/// Returns the ids of the markers in the frame with the most of them; none if all show
/// too few. `worn` ids are excluded.
std::set<int> best_ids(const std::vector<cv::Mat>& frames,
                       std::string_view dictionary,
                       const Look& look,
                       const WornIds& worn = {}) {
  std::set<int> best;
  const auto on_body = worn.find(dictionary);
  const auto codes = aruco_dictionary(dictionary, 0);
  MAREY_ASSERT(codes);
  MarkerReader reader(*codes);
  for (const cv::Mat& frame : frames) {
    std::set<int> ids;
    for (const ReadMarker& marker : reader.read(looked_at(frame, look))) {
      const bool is_worn = on_body != worn.end() && on_body->second.contains(marker.id);
      if (!is_worn) ids.insert(marker.id);
    }
    if (ids.size() > best.size()) best = std::move(ids);
  }
  if (best.size() < kMinMarkers) best.clear();
  return best;
}

std::string range_of(const std::set<int>& ids) {
  return "markers " + std::to_string(*ids.begin()) + " to " +
         std::to_string(*ids.rbegin());
}

/// Searches for the declared dictionary with another appearance.
std::optional<AlternativeTarget> survey_own_board(const std::vector<cv::Mat>& frames,
                                                  const CharucoBoard& board) {
  const Look own{board.is_inverted, false};
  if (const auto ids = best_ids(frames, board.dictionary, own); !ids.empty()) {
    return AlternativeTarget{
        AlternativeKind::kMarkers,
        board.dictionary,
        false,
        range_of(ids) + " of " + board.dictionary + " are, in other places than on it",
        "correct rows and columns, which count squares, or legacy; marker_size_m is that "
        "of a marker's black square"};
  }
  const Look other{!board.is_inverted, false};
  if (const auto ids = best_ids(frames, board.dictionary, other); !ids.empty()) {
    return AlternativeTarget{
        AlternativeKind::kMarkers,
        board.dictionary,
        false,
        range_of(ids) + " of " + board.dictionary +
            " are, with black and white exchanged",
        board.is_inverted ? "leave out inverted = true" : "write inverted = true"};
  }
  const Look mirror{board.is_inverted, true};
  if (const auto ids = best_ids(frames, board.dictionary, mirror); !ids.empty()) {
    return AlternativeTarget{
        AlternativeKind::kMarkers,
        board.dictionary,
        true,
        range_of(ids) + " of " + board.dictionary + " are, mirrored",
        "record without mirroring; where the back of a board shows it "
        "mirrored, write two_sided = true"};
  }
  return std::nullopt;
}

/// Returns the smallest dictionary with the same markers that has all of `ids`.
std::string smallest_with(std::string_view dictionary, const std::set<int>& ids) {
  const std::string_view kind = dictionary.substr(0, dictionary.find_last_of('_'));
  for (const ArucoDictionary& known : aruco_dictionaries()) {
    const bool alike = known.name.substr(0, known.name.find_last_of('_')) == kind &&
                       (kind != "DICT_APRILTAG" || known.name == dictionary);
    if (alike && aruco_dictionary(known.name, *ids.rbegin() + 1)) {
      return std::string(known.name);
    }
  }
  return std::string(dictionary);
}

/// Returns true for consecutive ids, as on a board. Noise and tags of other codes give
/// false detections from all over a dictionary of a thousand.
bool are_of_a_board(const std::set<int>& ids) {
  constexpr std::size_t kMaxApart = 4;
  return !ids.empty() &&
         static_cast<std::size_t>(*ids.rbegin() - *ids.begin()) < kMaxApart * ids.size();
}

/// Searches for markers of any other dictionary; returns the one with the most markers in
/// one frame.
std::optional<AlternativeTarget> survey_markers(const std::vector<cv::Mat>& frames,
                                                const WornIds& worn) {
  // This number of markers of one dictionary in an image is reliable; other dictionaries
  // are not tested any more.
  constexpr std::size_t kSufficientMarkers = 12;
  std::set<int> best;
  std::string_view dictionary;
  Look best_look;
  for (const std::string_view name : {"DICT_APRILTAG_36h11",
                                      "DICT_4X4_1000",
                                      "DICT_5X5_1000",
                                      "DICT_6X6_1000",
                                      "DICT_7X7_1000",
                                      "DICT_ARUCO_ORIGINAL",
                                      "DICT_APRILTAG_36h10",
                                      "DICT_APRILTAG_25h9",
                                      "DICT_APRILTAG_16h5"}) {
    for (const bool inverted : {false, true}) {
      if (best.size() >= kSufficientMarkers) break;
      std::set<int> ids = best_ids(frames, name, {inverted, false}, worn);
      if (ids.size() <= best.size() || !are_of_a_board(ids)) continue;
      best = std::move(ids);
      dictionary = name;
      best_look.inverted = inverted;
    }
  }
  if (best.empty()) return std::nullopt;
  const std::string name = smallest_with(dictionary, best);
  std::string remedy = "write type = \"charuco\" and dictionary = \"" + name + "\"";
  if (best_look.inverted) remedy += " and inverted = true";
  if (dictionary == "DICT_APRILTAG_36h11") {
    remedy =
        "for an AprilGrid write type = \"aprilgrid\"; for a ChArUco board "
        "dictionary = \"DICT_APRILTAG_36h11\"";
  }
  return AlternativeTarget{AlternativeKind::kMarkers,
                           name,
                           false,
                           range_of(best) + " of " + name + " are",
                           std::move(remedy)};
}

/// Searches for tags seen from behind: a mirrored image or print.
std::optional<AlternativeTarget> survey_mirrored_tags(
    const std::vector<cv::Mat>& frames) {
  for (const std::string_view name : {"DICT_APRILTAG_36h11", "DICT_APRILTAG_25h9"}) {
    const auto ids = best_ids(frames, name, {false, true});
    if (ids.empty()) continue;
    return AlternativeTarget{
        AlternativeKind::kMarkers,
        std::string(name),
        true,
        range_of(ids) + " of " + std::string(name) + " are, mirrored",
        "record without mirroring, and print the board as it is"};
  }
  return std::nullopt;
}

/// Searches for Kalibr's tags, which have a frame of two cells and are in no dictionary.
std::optional<AlternativeTarget> survey_kalibr(const std::vector<cv::Mat>& frames) {
  auto detector = TagDetector::create({.families = {{"tag36h11b2", {}}}});
  MAREY_ASSERT(detector);
  for (const cv::Mat& frame : frames) {
    const GrayFrame view{
        frame.data, frame.cols, frame.rows, static_cast<int>(frame.step[0]), 0};
    if (detector->detect(view).size() < kMinMarkers) continue;
    return AlternativeTarget{
        AlternativeKind::kAprilGrid,
        "tag36h11b2",
        false,
        "an AprilGrid of tag36h11b2 is",
        "write type = \"aprilgrid\", family = \"tag36h11b2\" and its sizes"};
  }
  return std::nullopt;
}

/// Searches for a chessboard of any size; returns its squares if two frames agree,
/// otherwise those of the first frame that shows one.
std::optional<cv::Size> chess_squares(const std::vector<cv::Mat>& frames) {
  constexpr double kSide = 900.0;
  std::vector<cv::Size> seen;
  for (const cv::Mat& frame : frames) {
    const double scale = std::min(1.0, kSide / std::max(frame.cols, frame.rows));
    cv::Mat small;
    cv::resize(frame, small, {}, scale, scale, cv::INTER_AREA);
    std::vector<cv::Point2f> corners;
    cv::Mat layout;
    const bool found = cv::findChessboardCornersSB(
        small,
        {3, 3},
        corners,
        cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER | cv::CALIB_CB_EXHAUSTIVE,
        layout);
    if (!found) continue;
    const cv::Size squares(layout.cols + 1, layout.rows + 1);
    // A part of a board is detected as a whole board, and its orientation is arbitrary.
    const cv::Size turned(squares.height, squares.width);
    for (const cv::Size& earlier : seen) {
      if (earlier == squares || earlier == turned) return earlier;
    }
    seen.push_back(squares);
  }
  if (seen.empty()) return std::nullopt;
  return seen.front();
}

std::optional<AlternativeTarget> survey_chessboard(const std::vector<cv::Mat>& frames) {
  const auto squares = chess_squares(frames);
  if (!squares) return std::nullopt;
  const std::string columns = std::to_string(squares->width);
  const std::string rows = std::to_string(squares->height);
  return AlternativeTarget{
      AlternativeKind::kChessboard,
      "",
      false,
      "a chessboard of " + columns + " x " + rows + " squares is",
      "if all of it was seen, write type = \"chessboard\", columns = " + columns +
          " and rows = " + rows + ": squares are counted, not their corners"};
}

}  // namespace

std::optional<AlternativeTarget> survey_frames(const std::vector<cv::Mat>& frames,
                                               const CalibrationTarget& target,
                                               std::span<const TagFamilyUse> worn) {
  try {
    if (const auto* charuco = std::get_if<CharucoBoard>(&target)) {
      if (auto seen = survey_own_board(frames, *charuco)) return seen;
    }
    if (auto seen = survey_markers(frames, ids_of(worn))) return seen;
    if (auto seen = survey_kalibr(frames)) return seen;
    if (auto seen = survey_mirrored_tags(frames)) return seen;
    return survey_chessboard(frames);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
}

}  // namespace marey::capture
