// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/check_ids.h"

#include <algorithm>
#include <set>
#include <variant>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"

namespace marey::app {
namespace {

using recordings::Session;
using recordings::Trial;
using recordings::TrialKind;

// Limit of the share of pictures that show a tag. Misread tags and tags of passers-by
// stay below it.
constexpr double kOftenShare = 0.05;
// Limit of the share among the pictures that show a board, for tags printed on it.
constexpr double kBoardTagShare = 0.2;

/// Number of pictures that show each tag, and number of all pictures, in the trials of a
/// body.
struct Seen {
  std::map<TagId, int> pictures;
  std::set<TagId> moving;  ///< Tags that travel by more than their own side.
  int of = 0;
};

/// Returns true if the tag's centre moves by more than its side in the pictures of one
/// camera, between the 10 % and 90 % quantiles of x or y. Tags on walls do not.
bool travels(const std::vector<glm::dvec2>& centres_px, double side_px) {
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> places_px;
    for (const glm::dvec2& centre_px : centres_px) places_px.push_back(centre_px[axis]);
    const double left_px = quantile(places_px, 0.1);
    if (quantile(std::move(places_px), 0.9) - left_px > side_px) return true;
  }
  return false;
}

void add_moving(const CameraDetections& camera, std::set<TagId>& moving) {
  std::map<TagId, std::vector<glm::dvec2>> centres_px;
  std::map<TagId, double> side_px;
  for (const FrameDetections& frame : camera.frames) {
    for (const TagDetection& tag : frame.tags) {
      const auto& p = tag.corners_px;
      centres_px[tag.id].push_back(0.25 * (p[0] + p[1] + p[2] + p[3]));
      side_px[tag.id] = std::max(side_px[tag.id], glm::distance(p[0], p[1]));
    }
  }
  for (const auto& [id, centres] : centres_px) {
    if (travels(centres, side_px[id])) moving.insert(id);
  }
}

Seen count_seen(const Session& session,
                const std::map<std::string, std::vector<CameraDetections>>& found) {
  Seen seen;
  for (const Trial& trial : session.trials) {
    const auto cameras = found.find(trial.name);
    if (trial.kind == TrialKind::kCalibration || trial.kind == TrialKind::kFloor ||
        cameras == found.end()) {
      continue;
    }
    for (const CameraDetections& camera : cameras->second) {
      seen.of += static_cast<int>(camera.frames.size());
      add_moving(camera, seen.moving);
      for (const FrameDetections& frame : camera.frames) {
        for (const TagDetection& tag : frame.tags) ++seen.pictures[tag.id];
      }
    }
  }
  return seen;
}

/// Returns true if the session lists the tag, on the body or on the calibration target.
bool is_listed(const Session& session, TagId id) {
  return std::any_of(
      session.families.begin(), session.families.end(), [&](const TagFamilyUse& use) {
        return std::find(use.ids.begin(), use.ids.end(), id) != use.ids.end();
      });
}

std::string in_words(const std::vector<TagId>& ids) {
  std::string words = ids.size() == 1 ? "tag " : "tags ";
  for (std::size_t i = 0; i < ids.size(); ++i) {
    words += (i == 0 ? "" : ", ") + std::to_string(number(ids[i]));
  }
  return words;
}

/// Warns of tags that move with an AprilGrid and do not belong to it: the printed board
/// has more rows or columns than the declared one. The calibration is correct without
/// these tags.
void warn_of_board_tags(const Session& session,
                        const std::map<std::string, std::vector<CameraDetections>>& found,
                        std::vector<Finding>& findings) {
  const Trial* waved = session.find(TrialKind::kCalibration);
  if (!waved || !found.contains(waved->name) || session.families.size() != 1 ||
      !std::holds_alternative<AprilGrid>(session.target)) {
    return;
  }
  std::map<TagId, int> pictures;
  std::set<TagId> moving;
  int with_board = 0;
  for (const CameraDetections& camera : found.at(waved->name)) {
    add_moving(camera, moving);
    for (const FrameDetections& frame : camera.frames) {
      with_board += frame.tags.empty() ? 0 : 1;
      for (const TagDetection& tag : frame.tags) ++pictures[tag.id];
    }
  }
  std::vector<TagId> unlisted;
  for (const auto& [id, count] : pictures) {
    if (count > kBoardTagShare * with_board && moving.contains(id) &&
        !is_listed(session, id)) {
      unlisted.push_back(id);
    }
  }
  if (unlisted.empty()) return;
  findings.push_back(fair_finding(
      "board-tags",
      session.file.string() + ": [board]",
      in_words(unlisted) + (unlisted.size() == 1 ? " moves" : " move") +
          " with the board in trial \"" + waved->name + "\" but " +
          (unlisted.size() == 1 ? "is" : "are") + " not part of it, and not used",
      "correct `rows`, `columns` and `first_id` to match the printed board"));
}

}  // namespace

Status check_ids(const Session& session,
                 const std::map<std::string, std::vector<CameraDetections>>& found,
                 std::vector<Finding>& findings) {
  warn_of_board_tags(session, found, findings);
  const Trial* moving = session.find(TrialKind::kRangeOfMotion);
  // A standing body may hide a tag in all frames; a moving body shows all tags.
  if (session.tags.empty() || session.families.size() != 1 || !moving ||
      !found.contains(moving->name)) {
    return Done{};
  }
  const Seen seen = count_seen(session, found);
  if (seen.of == 0) return Done{};
  std::vector<TagId> never;
  for (const TagOnSegment& tag : session.tags) {
    if (!seen.pictures.contains(tag.id)) never.push_back(tag.id);
  }
  std::vector<TagId> unlisted;
  for (const auto& [id, pictures] : seen.pictures) {
    if (pictures > kOftenShare * seen.of && seen.moving.contains(id) &&
        !is_listed(session, id)) {
      unlisted.push_back(id);
    }
  }
  if (unlisted.empty()) return Done{};
  const char* one = unlisted.size() == 1 ? " is" : " are";
  if (never.empty()) {
    const std::string them = unlisted.size() == 1 ? "it" : "them";
    findings.push_back(fair_finding(
        "unlisted",
        session.file.string() + ": [[tags.tag]]",
        in_words(unlisted) + one + " often seen but not listed, and therefore not used",
        "list " + them + " if the subject wears " + them));
    return Done{};
  }
  return bad_input(session.file.string() + ": [[tags.tag]]",
                   in_words(never) + (never.size() == 1 ? " is" : " are") +
                       " listed but never seen; " + in_words(unlisted) + one +
                       " often seen but not listed",
                   "correct the `id` of the listed tags to the number printed on the "
                   "tags of that segment, or remove the entries of tags that are not "
                   "worn");
}

}  // namespace marey::app
