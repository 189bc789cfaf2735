// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "app/live/live_guide.h"
#include "app/live/live_session.h"
#include "app/live/live_takes.h"
#include "app/live_chain/live_chain.h"
#include "app/live_chain/live_figures.h"
#include "app/live_chain/live_outputs.h"
#include "app/shell/console.h"

namespace marey::app {

/// Who watches a run: is told of it between two frames, and must not take long.
class LiveWatcher {
 public:
  virtual ~LiveWatcher() = default;
  /// Cameras' small pictures are wanted.
  [[nodiscard]] virtual bool wants_thumbnails() const { return false; }
  /// Adds what was asked for since the last call.
  virtual void take_requests(LiveRequests& /*requests*/) {}
  /// From now on results are this body's.
  virtual void on_body(const Body& /*body*/, const Skeleton& /*performer*/) {}
  /// What was asked for last, if anything was since the last call: to record, or not to.
  virtual std::optional<bool> record_request() { return std::nullopt; }
  virtual void on_frame(const LiveInstant& instant, const LiveResult& result) = 0;
  /// `picture` as DetectedPicture::thumbnail.
  virtual void on_thumbnail(std::size_t camera,
                            std::span<const std::byte> pixels,
                            int width_px,
                            int height_px,
                            std::span<const TagDetection> tags) = 0;
  /// Twice a second, and when it ends.
  virtual void on_status(const LiveFigures& figures,
                         const LiveTimes& recent,
                         reconstruct::TrackState state) = 0;
};

struct LiveRunOptions {
  std::optional<double> seconds;  ///< nullopt: until stopped, or all videos have ended.
  std::chrono::nanoseconds longest_wait = std::chrono::milliseconds(50);
};

/// Runs until `stop` says so: a thread for each camera finds its tags; this one takes the
/// newest instant that is whole, or has been waited for long enough, and has the chain
/// make packets of it, which go out before anything else is done about the instant.
///
/// When there is more to do than time, what is newest wins: a picture older than
/// LiveCameraOptions::stale_after_s is passed over, instants that were not taken up are
/// skipped for a newer one, and all of it is counted. Without a chain nobody is followed
/// and nothing sent, until the guide has a body. `guide` (of the same `live`), `takes`
/// (likewise) and `watcher` may be null.
/// Errors: of the detectors.
[[nodiscard]] Result<LiveFigures> run_live(OpenedLive& live,
                                           std::optional<LiveChain>& chain,
                                           LiveOutputs& outputs,
                                           LiveGuide* guide,
                                           LiveTakes* takes,
                                           LiveWatcher* watcher,
                                           const LiveRunOptions& options,
                                           const std::function<bool()>& stop,
                                           Console& console);

}  // namespace marey::app
