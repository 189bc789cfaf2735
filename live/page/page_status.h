// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace marey::live {

enum class PageSubject {
  kWaiting,
  kTracked,  ///< No fault: every camera streams, every segment with tags is seen.
  kPartly,   ///< Tracked, but a camera or a segment has a fault: PageStatus::warnings.
  kBehind,   ///< Poses are slower than the cameras.
  kStopped,  ///< No pose was computed for a while.
  kLost,
};

/// Percentiles 50 and 95 of a duration.
struct PageSpread {
  double p50_ms = 0.0;
  double p95_ms = 0.0;
};

struct PageStage {
  std::string name{};
  PageSpread spread;
};

enum class PageCameraState { kStreaming, kSilent, kLost };

struct PageCameraStatus {
  std::string name{};
  PageCameraState state = PageCameraState::kSilent;
  std::uint64_t frames = 0;
  std::uint64_t dropped = 0;
  int tags = 0;  ///< Number of tags in the newest picture.
  std::string detail{};
};

struct PageOutput {
  std::string name{};
  std::uint64_t sent = 0;
  std::uint64_t failed = 0;
  std::string detail{};
};

struct PageRecording {
  std::string file{};
  double seconds = 0.0;
  std::string trouble{};
};

/// Status of a live session, sent about twice a second.
struct PageStatus {
  double clock_s = 0.0;
  PageSubject subject = PageSubject::kWaiting;
  /// Present faults, one text for each camera and segment; then warnings about the
  /// measured body.
  std::vector<std::string> warnings{};
  int frame = 0;
  double rate_hz = 0.0;
  PageSpread latency;
  std::vector<PageStage> stages{};
  std::string overload = "none";  ///< "none", or the active overload policy in words.
  std::vector<PageCameraStatus> cameras{};
  std::vector<PageOutput> outputs{};
  std::optional<PageRecording> recording{};
  std::size_t clients = 0;
  std::vector<std::string> messages{};
};

/// Returns the status message; encoding as in scene_json().
[[nodiscard]] std::string status_json(const PageStatus& status);

/// Returns the answer to an invalid or impossible request. `about` is the type of that
/// request if the page shows the error next to the control; otherwise empty.
[[nodiscard]] std::string error_json(const std::string& text,
                                     const std::string& about = {});

}  // namespace marey::live
