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
  kTracked,  ///< All is well: every camera streams, every segment with tags is seen.
  kPartly,   ///< Tracked, but a camera or a segment is not well: PageStatus::warnings.
  kBehind,   ///< Poses do not keep up with the cameras.
  kStopped,  ///< No pose has come out for a while.
  kLost,
};

/// How long something takes: half the time no longer than p50, nearly always than p95.
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
  int tags = 0;  ///< In the newest picture.
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

/// How things stand while live, told about twice a second.
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
  std::string overload = "none";  ///< Or the policy that is in force, in words.
  std::vector<PageCameraStatus> cameras{};
  std::vector<PageOutput> outputs{};
  std::optional<PageRecording> recording{};
  std::size_t clients = 0;
  std::vector<std::string> messages{};
};

/// As scene_json().
[[nodiscard]] std::string status_json(const PageStatus& status);

/// The answer to a message that was not understood, or asks for what cannot be. `about`
/// is the type of that message where the page says it beside what was asked; else empty.
[[nodiscard]] std::string error_json(const std::string& text,
                                     const std::string& about = {});

}  // namespace marey::live
