// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/live_chain/live_flow.h"
#include "app/live_chain/live_outputs.h"
#include "capture/feeds/frame_feed.h"
#include "core/base/latency_histogram.h"
#include "core/base/result.h"
#include "reconstruct/tags/track_body.h"

namespace marey::app {

/// Latency of the stages of a frame, and of the whole frame.
struct LiveTimes {
  std::vector<LatencyHistogram> decode;  ///< By camera.
  std::vector<LatencyHistogram> detect;  ///< By camera.
  /// From the tags of the last camera until processing of the instant starts.
  LatencyHistogram wait;
  LatencyHistogram solve;
  LatencyHistogram retarget;
  LatencyHistogram encode;
  LatencyHistogram send;
  /// From the time of the earliest picture of the instant to the last packet.
  LatencyHistogram frame_to_packet;

  explicit LiveTimes(std::size_t cameras) : decode(cameras), detect(cameras) {}
};

/// Counts of one camera.
struct LiveCameraFigures {
  std::string name;
  long pictures = 0;  ///< Received.
  long dropped = 0;   ///< Lost before reception, by the driver's count.
  long stale = 0;     ///< Skipped because they were too old.
  long broken = 0;    ///< Could not be used.
  long unused = 0;    ///< Late for their instant, or replaced by newer ones.
  long missing = 0;   ///< Instants without a picture of this camera.
  capture::FeedHealth health{};
};

/// Figures of one minute of a run, to monitor long runs.
struct LiveMinute {
  long frames = 0;
  double p50_s = 0.0;
  double p95_s = 0.0;
  double resident_mb = 0.0;  ///< Memory of the process.
};

/// State of the current recording.
struct LiveRecording {
  std::string folder{};   ///< Empty: it is being created.
  double seconds = 0.0;   ///< Duration that can be replayed.
  std::string trouble{};  ///< Reason why it ended early; empty: none.
};

/// Figures of a live run.
struct LiveStatistics {
  long frames = 0;          ///< Solved instants.
  long tracked = 0;         ///< Solved instants with the body tracked.
  long lost = 0;            ///< Solved instants with the body lost.
  int relocalizations = 0;  ///< Number of relocalizations of a lost body.
  double seconds = 0.0;
  LiveTimes times;
  std::vector<LiveCameraFigures> cameras;
  std::vector<OutputCounts> outputs;
  std::vector<LiveMinute> minutes;
  bool has_unmatched_tags = false;         ///< Current state of UnmatchedTagsDetector.
  Flow flow = Flow::kSteady;               ///< Current state.
  std::string flow_text{};                 ///< LiveFlow::text().
  double behind_s = 0.0;                   ///< Total time in which poses did not keep up.
  std::optional<LiveRecording> recording;  ///< Current one.
  std::vector<std::string> takes;          ///< Folders of completed takes.
  std::optional<Error> recording_trouble;

  explicit LiveStatistics(std::size_t camera_count) : times(camera_count) {}
};

/// Returns the figures as indented JSON (docs/formats/README.md) with a final newline.
[[nodiscard]] std::string live_json_text(const LiveStatistics& figures);

/// Returns the resident memory of this process [MB], or 0 if the system does not report
/// it.
[[nodiscard]] double resident_mb();

}  // namespace marey::app
