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

/// How long the stages of a frame took, and the whole of it.
struct LiveTimes {
  std::vector<LatencyHistogram> decode;  ///< By camera.
  std::vector<LatencyHistogram> detect;  ///< By camera.
  /// From the last camera's tags until the instant was taken up.
  LatencyHistogram wait;
  LatencyHistogram solve;
  LatencyHistogram retarget;
  LatencyHistogram encode;
  LatencyHistogram send;
  /// From the instant of the earliest picture in it to the last packet.
  LatencyHistogram frame_to_packet;

  explicit LiveTimes(std::size_t cameras) : decode(cameras), detect(cameras) {}
};

/// How one camera fared.
struct LiveCameraFigures {
  std::string name;
  long pictures = 0;  ///< That came.
  long dropped = 0;   ///< Lost before they came, by the driver's count.
  long stale = 0;     ///< Passed over, too old.
  long broken = 0;    ///< Could not be used.
  long unused = 0;    ///< Late for their instant, or displaced by newer ones.
  long missing = 0;   ///< Instants that had to do without it.
  capture::FeedHealth health{};
};

/// A minute of a run, for those who watch it for hours.
struct LiveMinute {
  long frames = 0;
  double p50_s = 0.0;
  double p95_s = 0.0;
  double resident_mb = 0.0;  ///< Memory of the process.
};

/// What is being recorded.
struct LiveRecording {
  std::string folder{};   ///< Empty: it is being made.
  double seconds = 0.0;   ///< That can be replayed.
  std::string trouble{};  ///< Why it ended; empty: none.
};

/// What a live run did.
struct LiveFigures {
  long frames = 0;     ///< Instants that were solved.
  long tracked = 0;    ///< Of these, with the body tracked.
  long lost = 0;       ///< Of these, with the body lost.
  int found_anew = 0;  ///< Times that a lost body came back.
  double seconds = 0.0;
  LiveTimes times;
  std::vector<LiveCameraFigures> cameras;
  std::vector<OutputCounts> outputs;
  std::vector<LiveMinute> minutes;
  bool has_unmatched_tags = false;  ///< Now: UnmatchedTagsDetector.
  Flow flow = Flow::kSteady;  ///< Now.
  std::string flow_text{};    ///< LiveFlow::text().
  double behind_s = 0.0;      ///< For how long poses did not keep up with pictures.
  std::optional<LiveRecording> recording;  ///< Under way.
  std::vector<std::string> takes;          ///< Folders of those that are whole.
  std::optional<Error> recording_trouble;

  explicit LiveFigures(std::size_t camera_count) : times(camera_count) {}
};

/// The figures as JSON (docs/formats/README.md), indented, with an end of line.
[[nodiscard]] std::string live_figures_text(const LiveFigures& figures);

/// Memory of this process that is in use. [MB]; 0 where the system does not tell.
[[nodiscard]] double resident_mb();

}  // namespace marey::app
