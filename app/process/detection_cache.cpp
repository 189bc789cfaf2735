// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/detection_cache.h"

#include <utility>
#include <variant>
#include <vector>

#include "app/check/match_times.h"
#include "recordings/base/content_key.h"
#include "recordings/session/detections_file.h"

namespace marey::app {

using recordings::Trial;
using recordings::TrialVideo;

namespace {

/// Returns all parameters that the detection of points depends on, for the cache key.
std::string cache_words(const CalibrationTarget& target) {
  std::string words;
  if (const auto* board = std::get_if<CharucoBoard>(&target)) {
    words.append(" charuco-2 ").append(board->dictionary);
    if (board->is_legacy) words.append(" legacy");
    if (board->is_inverted) words.append(" inverted");
    if (board->is_two_sided) words.append(" two-sided");
    words.append(" ").append(std::to_string(board->marker_size_m / board->square_size_m));
    words.append(" ").append(std::to_string(board->columns));
    words.append("x").append(std::to_string(board->rows));
  } else if (const auto* chess = std::get_if<Chessboard>(&target)) {
    words.append(" chessboard-1 ").append(std::to_string(chess->columns));
    words.append("x").append(std::to_string(chess->rows));
  }
  return words;
}

std::string cache_words(const std::vector<TagFamilyUse>& families) {
  std::string words;
  for (const TagFamilyUse& use : families) {
    words.append(" ").append(use.name);
    for (const TagId id : use.ids) words.append(",").append(std::to_string(number(id)));
  }
  return words;
}

/// Returns a key of everything that a cached detection depends on.
Result<std::string> cache_key(const TrialVideo& video,
                              const Trial& trial,
                              const ContentToDetect& wanted) {
  const auto content = recordings::content_key(video.path);
  if (!content) return content.error();
  // Increase the number if the detector finds other corners in the same picture.
  std::string key = *content;
  if (!wanted.families.empty()) key += " tracker-2" + cache_words(wanted.families);
  if (wanted.target) key += cache_words(*wanted.target);
  if (trial.frames && !has_times_file(trial)) {
    key += " frames " + std::to_string(trial.frames->first) + "-" +
           std::to_string(trial.frames->last);
  }
  if (trial.rate) key += " fps " + std::to_string(trial.rate->hz);
  return key;
}

}  // namespace

DetectionCache::DetectionCache(std::filesystem::path file, std::string key)
    : file_(std::move(file)), key_(std::move(key)) {}

Result<DetectionCache> DetectionCache::open(const recordings::Session& session,
                                            const Trial& trial,
                                            const TrialVideo& video,
                                            const ContentToDetect& wanted,
                                            const std::filesystem::path& out) {
  auto key = cache_key(video, trial, wanted);
  if (!key) return key.error();
  return DetectionCache(
      out / trial.name / "detections" / (session.cameras[index(video.camera)] + ".csv"),
      std::move(*key));
}

std::optional<CameraDetections> DetectionCache::read() const {
  auto cached = recordings::read_detections(file_, key_);
  if (!cached) return std::nullopt;
  return std::move(*cached);
}

Status DetectionCache::write(const CameraDetections& camera) const {
  return recordings::write_detections(file_, camera, key_);
}

}  // namespace marey::app
