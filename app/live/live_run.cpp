// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_run.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "app/live/live_watchdog.h"
#include "app/live_chain/live_health.h"
#include "capture/feeds/live_camera.h"
#include "capture/feeds/live_groups.h"
#include "core/base/monotonic_clock.h"
#include "core/base/stopwatch.h"

namespace marey::app {
namespace {

using reconstruct::TrackState;
using std::chrono::milliseconds;

constexpr double kStatusEvery_s = 0.5;
constexpr double kMinute_s = 60.0;
/// Time for all threads to start before the first picture of a video.
constexpr milliseconds kHeadStart{200};

using Cameras = std::vector<std::unique_ptr<capture::LiveCamera>>;
using Groups = capture::LiveGroups<capture::DetectedPicture>;

Result<Cameras> make_cameras(OpenedLive& live, const LiveRunOptions& run) {
  Cameras cameras;
  for (std::size_t c = 0; c < live.feeds.size(); ++c) {
    const Camera& camera = live.calibration.cameras[c];
    capture::LiveCameraOptions options;
    options.name = camera.name;
    // A shorter wait must not drop pictures that are late at the source.
    options.stale_after_s = std::max(options.stale_after_s, seconds(run.max_wait));
    auto one =
        capture::LiveCamera::create(options, camera, *live.feeds[c], live.detector);
    if (!one) return one.error();
    cameras.push_back(*std::move(one));
  }
  return cameras;
}

/// Returns the maximum over the cameras of their pictures, including lost ones.
long max_pictures(const Cameras& cameras) {
  long out = 0;
  for (const auto& camera : cameras) {
    out = std::max(out, camera->counts().pictures + camera->counts().dropped);
  }
  return out;
}

void take_in(const capture::LiveGroup<capture::DetectedPicture>& group,
             LiveInstant& out) {
  out.number = group.number;
  out.time = group.time;
  out.views.resize(group.frames.size());
  for (std::size_t f = 0; f < group.frames.size(); ++f) {
    out.views[f].camera = group.frames[f].camera;
    out.views[f].time = group.frames[f].time;
    out.views[f].tags.assign(group.frames[f].made->tags.begin(),
                             group.frames[f].made->tags.end());
  }
}

/// Accumulates the figures of a run, for the whole run and since the last status.
class Counting {
 public:
  explicit Counting(std::size_t cameras)
      : figures_(cameras), recent_(cameras), minute_begin_(monotonic_now()) {}

  void add_cameras(const capture::LiveGroup<capture::DetectedPicture>& group) {
    for (LiveTimes* times : {&figures_.times, &recent_}) {
      for (const auto& frame : group.frames) {
        const std::size_t c = index(frame.camera);
        times->decode[c].add(frame.made->decode_s);
        times->detect[c].add(frame.made->detect_s);
      }
    }
  }

  void add(const capture::LiveGroup<capture::DetectedPicture>& group,
           const LiveResult& result,
           Timestamp taken_up,
           double send_s) {
    const Timestamp sent = monotonic_now();
    Timestamp earliest{std::numeric_limits<std::int64_t>::max()};
    Timestamp done{0};
    for (const auto& frame : group.frames) {
      earliest = std::min(earliest, frame.time);
      done = std::max(done, frame.made->done);
    }
    for (LiveTimes* times : {&figures_.times, &recent_}) {
      times->wait.add(seconds(taken_up - done));
      times->solve.add(result.solve_s);
      times->retarget.add(result.retarget_s);
      times->encode.add(result.encode_s);
      times->send.add(send_s);
      times->frame_to_packet.add(seconds(sent - earliest));
    }
    minute_.add(seconds(sent - earliest));
    ++figures_.frames;
    if (result.track.state == TrackState::kTracked) ++figures_.tracked;
    if (result.track.state == TrackState::kLost) ++figures_.lost;
    if (was_lost_ && result.track.state == TrackState::kTracked)
      ++figures_.relocalizations;
    was_lost_ = result.track.state == TrackState::kLost;
  }

  void end_minute(bool is_end) {
    const double lasted_s = seconds(monotonic_now() - minute_begin_);
    if (minute_.count() == 0 || (lasted_s < kMinute_s && !is_end)) return;
    figures_.minutes.push_back({static_cast<long>(minute_.count()),
                                minute_.quantile_s(0.5),
                                minute_.quantile_s(0.95),
                                resident_mb()});
    minute_.clear();
    minute_begin_ = monotonic_now();
  }

  void count_cameras(const Cameras& cameras, const Groups& groups) {
    figures_.cameras.clear();
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const capture::LiveCameraCounts& counts = cameras[c]->counts();
      const capture::GroupingCounts grouped =
          groups.counts(CameraId{static_cast<int>(c)});
      figures_.cameras.push_back({cameras[c]->name(),
                                  counts.pictures,
                                  counts.dropped,
                                  counts.stale,
                                  counts.broken,
                                  grouped.late + grouped.displaced + grouped.surplus,
                                  grouped.missing,
                                  cameras[c]->health()});
    }
  }

  [[nodiscard]] LiveStatistics& figures() { return figures_; }
  [[nodiscard]] const LiveTimes& recent() const { return recent_; }
  void reset_recent() { recent_ = LiveTimes(recent_.detect.size()); }

 private:
  LiveStatistics figures_;
  LiveTimes recent_;
  LatencyHistogram minute_;
  Timestamp minute_begin_;
  bool was_lost_ = false;
};

/// Reports a change of the tracking state on the console.
void report_state(TrackState before, TrackState now, Console& console) {
  if (before == now) return;
  if (now == TrackState::kTracked) {
    console.say(before == TrackState::kLost ? "the body is back" : "the body is found");
  }
  if (now == TrackState::kLost) console.say("the body is lost: too few tags are visible");
}

/// The part of a run on the thread that solves and sends.
class Loop {
 public:
  Loop(OpenedLive& live,
       std::optional<LiveChain>& chain,
       LiveOutputs& outputs,
       LiveWizard* wizard,
       LiveTakes* takes,
       LiveWatcher* watcher,
       Console& console)
      : live_(live),
        chain_(chain),
        outputs_(outputs),
        wizard_(wizard),
        takes_(takes),
        watcher_(watcher),
        console_(console),
        progress_(console.stage("live")),
        counting_(live.feeds.size()),
        watchdog_(live.settings.rate, monotonic_now() + kHeadStart, outputs, console) {
    if (live.body) unmatched_tags_.emplace(*live.body);
  }

  void run(Groups& groups,
           const Cameras& cameras,
           const LiveRunOptions& options,
           const std::function<bool()>& stop) {
    constexpr milliseconds kLook{100};
    const Stopwatch watch;
    while (!stop() && !(options.seconds && watch.seconds() >= *options.seconds)) {
      const bool wanted = watcher_ && watcher_->wants_thumbnails();
      for (const auto& camera : cameras) camera->want_thumbnails(wanted);
      if (const auto* group = groups.next(kLook)) {
        take(*group);
      } else if (groups.is_over()) {
        break;
      }
      const bool has_changed = watchdog_.update(monotonic_now(), max_pictures(cameras));
      if (has_changed || watch.seconds() - last_status_s_ >= kStatusEvery_s) {
        last_status_s_ = watch.seconds();
        report_status(groups, cameras, false);
      }
    }
    counting_.figures().seconds = watch.seconds();
    if (wizard_) wizard_->end();
    report_status(groups, cameras, true);
  }

  [[nodiscard]] LiveStatistics& figures() { return counting_.figures(); }

 private:
  void take(const capture::LiveGroup<capture::DetectedPicture>& group) {
    const Timestamp taken_up = monotonic_now();
    take_in(group, instant_);
    // Later chains continue with the time base of the first.
    if (!live_.settings.vmc_begin) live_.settings.vmc_begin = instant_.time;
    LiveRequests& requests = outputs_.take_requests();
    if (watcher_) watcher_->take_requests(requests);
    periods_.apply(requests);
    requests.behind = watchdog_.is_behind();
    if (chain_ && std::exchange(is_chain_new_, false)) periods_.add_to(requests);
    const LiveResult& result =
        chain_ ? chain_->step(instant_, requests) : untracked(instant_);
    const Stopwatch sending;
    if (chain_) outputs_.send(result);
    watchdog_.on_instant(monotonic_now(), chain_.has_value());
    counting_.add(group, result, taken_up, sending.seconds());
    counting_.add_cameras(group);
    report_state(state_, result.track.state, console_);
    state_ = result.track.state;
    detect_exchanged_cameras(result);
    if (watcher_) show(group, result);
    // This may replace the chain.
    if (takes_) record(requests, result);
    if (wizard_) run_wizard(instant_);
  }

  void detect_exchanged_cameras(const LiveResult& result) {
    if (!chain_ || !unmatched_tags_) return;
    unmatched_tags_->add(instant_, result.track);
    bool& reported = counting_.figures().has_unmatched_tags;
    if (unmatched_tags_->has_unmatched() && !reported)
      console_.warn(UnmatchedTagsDetector::kText);
    reported = unmatched_tags_->has_unmatched();
  }

  void record(const LiveRequests& requests, const LiveResult& result) {
    if (!chain_) return;
    if (watcher_) {
      if (const auto request = watcher_->record_request()) takes_->want(*request);
    }
    takes_->add(instant_, requests, result, *chain_);
    if (wizard_) wizard_->set_recording(takes_->is_wanted());
  }

  /// Returns the result reported while no body is tracked.
  const LiveResult& untracked(const LiveInstant& instant) {
    untracked_.number = instant.number;
    untracked_.time = instant.time;
    return untracked_;
  }

  /// Runs the wizard, after all packets of the instant were sent.
  void run_wizard(const LiveInstant& instant) {
    wizard_->process(instant);
    auto found = wizard_->take_body();
    if (!found) return;
    chain_.emplace(std::move(found->chain));
    is_chain_new_ = true;
    unmatched_tags_.emplace(found->body);
    if (takes_) takes_->follow(found->body);
    if (watcher_) watcher_->on_body(found->body, chain_->performer());
  }

  void show(const capture::LiveGroup<capture::DetectedPicture>& group,
            const LiveResult& result) {
    watcher_->on_frame(instant_, result);
    for (const auto& frame : group.frames) {
      if (frame.made->thumbnail.empty()) continue;
      watcher_->on_thumbnail(index(frame.camera),
                             frame.made->thumbnail,
                             frame.made->thumbnail_width_px,
                             frame.made->thumbnail_height_px,
                             frame.made->tags);
    }
  }

  /// Warns of videos that ended with an error. Real cameras report their own errors.
  void warn_of_videos() {
    if (live_.videos.empty()) return;
    const std::vector<LiveCameraFigures>& cameras = counting_.figures().cameras;
    is_reported_lost_.resize(cameras.size(), false);
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const capture::FeedHealth& health = cameras[c].health;
      if (is_reported_lost_[c] || health.state != capture::CameraState::kLost) continue;
      is_reported_lost_[c] = true;
      console_.warn("camera " + cameras[c].name + " is lost: " + health.trouble);
    }
  }

  void report_status(const Groups& groups, const Cameras& cameras, bool is_end) {
    LiveStatistics& figures = counting_.figures();
    counting_.count_cameras(cameras, groups);
    warn_of_videos();
    figures.outputs = outputs_.counts();
    figures.flow = watchdog_.flow().flow();
    figures.flow_text = watchdog_.flow().text();
    figures.behind_s = watchdog_.flow().troubled_s();
    counting_.end_minute(is_end);
    if (takes_) {
      figures.recording = takes_->state();
      figures.takes = takes_->finished();
      figures.recording_trouble = takes_->trouble();
    }
    if (progress_) progress_(static_cast<int>(figures.frames), kUnknownTotal);
    if (watcher_) watcher_->on_status(figures, counting_.recent(), state_);
    counting_.reset_recent();
  }

  OpenedLive& live_;
  std::optional<LiveChain>& chain_;
  LiveOutputs& outputs_;
  LiveWizard* wizard_;
  LiveTakes* takes_;
  LiveWatcher* watcher_;
  Console& console_;
  Progress progress_;
  Counting counting_;
  LiveWatchdog watchdog_;
  KeptPeriods periods_;
  bool is_chain_new_ = false;  ///< It has received no instant.
  LiveInstant instant_;
  LiveResult untracked_;
  std::optional<UnmatchedTagsDetector> unmatched_tags_;
  std::vector<bool> is_reported_lost_;  ///< By camera.
  TrackState state_ = TrackState::kWaiting;
  double last_status_s_ = 0.0;
};

capture::GroupFramesOptions grouping(const OpenedLive& live,
                                     const LiveRunOptions& options) {
  capture::GroupFramesOptions out;
  out.mode = capture::GroupingMode::kLive;
  out.rate = live.settings.rate;
  out.origin = std::nullopt;
  out.max_wait = options.max_wait;
  out.capacity = 8;
  return out;
}

}  // namespace

Result<LiveStatistics> run_live(OpenedLive& live,
                                std::optional<LiveChain>& chain,
                                LiveOutputs& outputs,
                                LiveWizard* wizard,
                                LiveTakes* takes,
                                LiveWatcher* watcher,
                                const LiveRunOptions& options,
                                const std::function<bool()>& stop,
                                Console& console) {
  auto cameras = make_cameras(live, options);
  if (!cameras) return cameras.error();
  std::vector<capture::FrameFeed*> feeds;
  for (const auto& feed : live.feeds) feeds.push_back(feed.get());
  const std::vector<capture::ClockModel> clocks(feeds.size());
  Loop loop(live, chain, outputs, wizard, takes, watcher, console);
  // Destroyed first, because its threads use the cameras.
  Groups groups(feeds,
                clocks,
                grouping(live, options),
                [&cameras](CameraId camera,
                           const capture::RawFrame& frame,
                           capture::DetectedPicture& out) {
                  return (*cameras)[index(camera)]->make(frame, out);
                });
  const Timestamp begin = monotonic_now() + kHeadStart;
  for (capture::VideoFeed* video : live.videos) video->begin_at(begin);
  loop.run(groups, *cameras, options, stop);
  return std::move(loop.figures());
}

}  // namespace marey::app
