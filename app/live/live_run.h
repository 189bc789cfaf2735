// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "app/live/live_session.h"
#include "app/live/live_takes.h"
#include "app/live/live_wizard.h"
#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_outputs.h"
#include "app/live_chain/live_statistics.h"
#include "app/shell/console.h"
#include "capture/sync/group_frames.h"

namespace marey::app {

/// Observer of a run. Its functions are called between two frames and must return
/// quickly.
class LiveWatcher {
 public:
  virtual ~LiveWatcher() = default;
  /// Returns true if thumbnails of the cameras are needed.
  [[nodiscard]] virtual bool wants_thumbnails() const { return false; }
  /// Adds the requests received since the last call.
  virtual void take_requests(LiveRequests& /*requests*/) {}
  /// Reports that all later results are of this body.
  virtual void on_body(const Body& /*body*/, const Skeleton& /*performer*/) {}
  /// Returns the latest recording request since the last call (true: start, false: stop),
  /// or nullopt.
  virtual std::optional<bool> record_request() { return std::nullopt; }
  virtual void on_frame(const LiveInstant& instant, const LiveResult& result) = 0;
  /// Receives a thumbnail, in the format of DetectedPicture::thumbnail, and its tags.
  virtual void on_thumbnail(std::size_t camera,
                            std::span<const std::byte> pixels,
                            int width_px,
                            int height_px,
                            std::span<const TagDetection> tags) = 0;
  /// Receives the figures twice a second and at the end of the run.
  virtual void on_status(const LiveStatistics& figures,
                         const LiveTimes& recent,
                         reconstruct::TrackState state) = 0;
};

struct LiveRunOptions {
  std::optional<double> seconds;  ///< nullopt: until stopped or the videos end.
  std::chrono::nanoseconds max_wait = capture::kMaxGroupWait;
};

/// Runs until `stop` returns true. One thread per camera detects its tags. The calling
/// thread takes the newest instant that is complete or has waited for `max_wait`,
/// computes its packets with the chain and sends them before any other work on the
/// instant.
///
/// Under overload the newest data has priority: a picture older than
/// LiveCameraOptions::stale_after_s is skipped, and so are waiting instants once a newer
/// one is ready. All skipped data is counted. Without a chain nothing is tracked or sent
/// until the wizard provides a body. `wizard`, `takes` and `watcher` may be null;
/// `wizard` and `takes` must belong to `live`. Errors: those of the detectors.
[[nodiscard]] Result<LiveStatistics> run_live(OpenedLive& live,
                                              std::optional<LiveChain>& chain,
                                              LiveOutputs& outputs,
                                              LiveWizard* wizard,
                                              LiveTakes* takes,
                                              LiveWatcher* watcher,
                                              const LiveRunOptions& options,
                                              const std::function<bool()>& stop,
                                              Console& console);

}  // namespace marey::app
