// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "recordings/takes/take_file.h"
#include "tests/app/spoiled_session.h"

namespace marey::testing {

inline constexpr int kWalkFrames = 90;
inline constexpr double kWalkRate_hz = 30.0;

/// The sample's session, in which the walk is one to record, from cameras that drop
/// frames and whose clocks jitter.
class RecordedWalk {
 public:
  /// The recording that the constructor makes.
  enum class Made {
    kTake,    ///< Videos and times, as `marey record` would have made them.
    kNothing  ///< The test makes the recording.
  };

  explicit RecordedWalk(Made made = Made::kTake);

  [[nodiscard]] static const std::vector<std::string>& cameras();
  /// Frames that each camera dropped: single ones, a burst, the beginning, one in nine.
  [[nodiscard]] static bool is_dropped(std::size_t camera, int k);
  /// When each camera took each frame of the sample's videos.
  [[nodiscard]] static std::vector<std::vector<Timestamp>> times();

  [[nodiscard]] std::filesystem::path folder() const {
    return session_.file().parent_path() / "walk";
  }
  [[nodiscard]] std::filesystem::path take() const {
    return folder() / recordings::kTakeFile;
  }
  [[nodiscard]] SpoiledSession& session() { return session_; }
  [[nodiscard]] const SpoiledSession& session() const { return session_; }

  /// Changes the take's file by SQL.
  void spoil_take(const std::string& statements) const;

 private:
  void make_video(std::size_t camera) const;
  void make_take() const;

  SpoiledSession session_;
};

/// Median distance of the walk's joints, those of the limbs, to their truth. [mm]
[[nodiscard]] double median_error_mm(const SpoiledSession& session);

}  // namespace marey::testing
