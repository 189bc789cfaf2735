// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_takes.h"

#include <chrono>
#include <system_error>
#include <utility>

#include "core/base/assert.h"

namespace marey::app {
namespace {

using reconstruct::TrackState;

template <class T>
bool is_ready(const std::future<T>& made) {
  return made.valid() &&
         made.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Returns the first unused name.
std::filesystem::path free_name(const std::filesystem::path& stem) {
  std::error_code ignored;
  for (int number = 1;; ++number) {
    std::filesystem::path folder = stem;
    folder += '-';
    folder += std::to_string(number);
    if (!std::filesystem::exists(folder, ignored)) return folder;
  }
}

}  // namespace

LiveTakes::LiveTakes(const OpenedLive& live, std::filesystem::path stem, Console& console)
    : live_(live),
      stem_(stem.has_filename() ? std::move(stem) : stem.parent_path()),
      console_(console),
      body_(live.body) {}

LiveTakes::~LiveTakes() = default;

Status LiveTakes::begin_with_run(const std::filesystem::path& folder) {
  MAREY_ASSERT(body_ && !take_);
  auto recorder = LiveRecorder::create(folder, live_, *body_, live_.settings);
  if (!recorder) return recorder.error();
  take_.emplace();
  take_->folder = folder;
  take_->recorder = *std::move(recorder);
  wanted_ = true;
  return Done{};
}

/// Opens a take. Runs on a separate thread.
LiveTakes::Take LiveTakes::open(const Body& body, const LiveSettings& settings) const {
  Take take;
  take.folder = free_name(stem_);
  auto chain = LiveChain::make(body, live_.calibration.cameras, live_.avatars, settings);
  if (!chain) {
    take.trouble = chain.error();
    return take;
  }
  auto recorder = LiveRecorder::create(take.folder, live_, body, settings);
  if (!recorder) {
    take.trouble = recorder.error();
    return take;
  }
  take.next = *std::move(chain);
  take.recorder = *std::move(recorder);
  return take;
}

void LiveTakes::follow(const Body& body) {
  body_ = body;
  if (wanted_) console_.say("the take ends: a take has one body");
  wanted_ = false;
  // The next request starts another take, with this body.
  is_opening_void_ = opening_.valid();
  if (take_) close();
}

void LiveTakes::report_failure(const Error& error) {
  console_.warn(error.message() + " The run goes on without recording.");
  if (!first_trouble_) first_trouble_ = error;
}

void LiveTakes::check_threads() {
  if (is_ready(closing_)) {
    const Take closed = closing_.get();
    if (!closed.trouble && !closed.begin) {
      console_.warn("nothing was recorded, and " + closed.folder.string() +
                    " is removed: the recording ended before its first frame. A "
                    "recording that starts during a run needs one second with the body "
                    "tracked");
    } else if (!closed.trouble) {
      console_.say("recorded to " + closed.folder.string());
      finished_.push_back(closed.folder.string());
    } else if (!closed.is_reported) {
      report_failure(*closed.trouble);
    }
  }
  if (is_ready(opening_)) {
    take_ = opening_.get();
    is_new_ = true;
    tracked_since_.reset();
  }
  if (take_ && take_->recorder && !take_->trouble) {
    take_->trouble = take_->recorder->trouble();
  }
  if (take_ && take_->trouble && !take_->is_reported) {
    take_->is_reported = true;
    report_failure(*take_->trouble);
  }
  const bool is_void = take_ && std::exchange(is_opening_void_, false);
  if (take_ && (!wanted_ || is_void) && !closing_.valid()) close();
  if (wanted_ && !take_ && !opening_.valid() && !closing_.valid()) {
    opening_ = std::async(std::launch::async,
                          [this, body = *body_] { return open(body, live_.settings); });
  }
}

void LiveTakes::close() {
  Take take = *std::move(take_);
  take_.reset();
  if (!take.recorder) return;
  closing_ = std::async(std::launch::async, [take = std::move(take)]() mutable -> Take {
    if (!take.begin && !take.trouble) {
      take.recorder->discard();
    } else if (const Status ok = take.recorder->finish(); !ok) {
      take.trouble = ok.error();
    }
    take.recorder.reset();
    return std::move(take);
  });
}

/// Returns the requests that are still in force, for a new chain.
LiveRequests LiveTakes::pending_requests(const LiveResult& result) const {
  LiveRequests all;
  periods_.add_to(all);
  for (const HandleState& handle : result.handles) {
    if (!handle.active) continue;
    (void)all.add({std::string(handle.id), HandleAction::kMove, handle.p_in_world});
  }
  return all;
}

void LiveTakes::lead_in(const LiveInstant& instant,
                        const LiveRequests& requests,
                        const LiveResult& result,
                        LiveChain& chain) {
  const LiveRequests effective = is_new_ ? pending_requests(result) : requests;
  is_new_ = false;
  take_->recorder->add_lead_in(instant, effective);
  const TrackState before = result.track.state;
  const TrackState now = take_->next->step(instant, effective).track.state;
  if (now != TrackState::kTracked) {
    tracked_since_.reset();
  } else if (!tracked_since_) {
    tracked_since_ = instant.time;
  }
  const bool knows_as_much =
      tracked_since_ && seconds(instant.time - *tracked_since_) >= kLeadIn_s;
  // Before the body is found, the chain has no state to catch up with.
  if (!knows_as_much && before != TrackState::kWaiting) return;
  chain = *std::move(take_->next);
  take_->next.reset();
}

void LiveTakes::add(const LiveInstant& instant,
                    const LiveRequests& requests,
                    const LiveResult& result,
                    LiveChain& chain) {
  now_ = instant.time;
  periods_.apply(requests);
  MAREY_ASSERT(body_);
  check_threads();
  if (!take_ || take_->trouble) return;
  if (take_->next) return lead_in(instant, requests, result, chain);
  if (!take_->begin) take_->begin = instant.time;
  take_->recorder->add(instant, requests, result);
}

std::optional<LiveRecording> LiveTakes::state() const {
  if (!take_ && !opening_.valid()) return std::nullopt;
  LiveRecording out;
  if (take_) out.folder = take_->folder.string();
  if (take_ && take_->trouble) out.trouble = take_->trouble->message();
  if (take_ && take_->begin) out.seconds = seconds(now_ - *take_->begin);
  return out;
}

Status LiveTakes::finish() {
  wanted_ = false;
  if (opening_.valid()) opening_.wait();
  for (int i = 0; i < 2; ++i) {  // A take that is being closed, and the last one.
    if (closing_.valid()) closing_.wait();
    check_threads();
  }
  if (closing_.valid()) closing_.wait();
  check_threads();
  if (first_trouble_) return *first_trouble_;
  return Done{};
}

}  // namespace marey::app
