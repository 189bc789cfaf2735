// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/detect_videos.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "capture/boards/find_board_points.h"
#include "capture/video/open_frames.h"
#include "core/base/frame_range.h"

namespace marey::capture {
namespace {

/// An opened camera recording, and the place of its result.
struct Job {
  std::unique_ptr<FrameSource> source;  ///< Null if it cannot be opened.
  std::optional<TagTracker> tracker;
  std::optional<BoardFinder> board;
  std::optional<FrameRange> range;
  CameraDetections found;
  std::optional<Error> error;
};

/// Counts frames over all workers and reports them, one caller at a time.
class SharedProgress {
 public:
  /// `total` is kUnknownTotal if the number of frames of a stream is unknown.
  SharedProgress(const Progress& progress, int total)
      : progress_(progress), total_(total) {}

  void one_more() {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    ++done_;
    // A container's count may be too small.
    progress_(total_ != kUnknownTotal ? std::min(done_, total_) : done_, total_);
  }

  /// Reports the present count as the total if it was unknown.
  void all_done() {
    if (progress_ && total_ == kUnknownTotal && done_ > 0) progress_(done_, done_);
  }

 private:
  const Progress& progress_;
  int total_;
  std::mutex mutex_;
  int done_ = 0;
};

Error unreached_range(const std::string& name, const FrameRange& range, int frames) {
  return bad_input(name,
                   "frames " + std::to_string(range.first) + " to " +
                       std::to_string(range.last) + " are beyond its end: it has only " +
                       std::to_string(frames),
                   "correct the trial's range of frames");
}

/// Returns a finder of the target's points, if it has any.
Result<std::optional<BoardFinder>> finder_of(
    const std::optional<CalibrationTarget>& target) {
  const auto made = [](Result<BoardFinder> finder) -> Result<std::optional<BoardFinder>> {
    if (!finder) return finder.error();
    return std::optional(std::move(*finder));
  };
  if (!target) return std::optional<BoardFinder>();
  if (const auto* charuco = std::get_if<CharucoBoard>(&*target)) {
    return made(BoardFinder::create(*charuco));
  }
  if (const auto* chess = std::get_if<Chessboard>(&*target)) {
    return made(BoardFinder::create(*chess));
  }
  return std::optional<BoardFinder>();
}

Result<std::optional<TagTracker>> tracker_of(const DetectVideosOptions& options) {
  if (!options.find_tags) return std::optional<TagTracker>();
  TrackTagsOptions tracking = options.tracker;
  if (options.search_every_frame) {
    tracking.full_every_frames = 1;
    tracking.strips = 1;
  }
  auto tracker = TagTracker::create(tracking);
  if (!tracker) return tracker.error();
  return std::optional(std::move(*tracker));
}

FrameDetections detect_frame(const GrayFrame& frame, Job& job) {
  FrameDetections found{frame.index, {}};
  if (job.tracker) found.tags = job.tracker->track(frame);
  if (job.board) found.points = job.board->find(frame);
  return found;
}

Result<Job> open_job(const CameraInput& input, const DetectVideosOptions& options) {
  MAREY_ASSERT(!input.rate || input.rate->hz > 0.0);
  MAREY_ASSERT(!input.range ||
               (input.range->first >= 0 && input.range->first <= input.range->last));
  auto tracker = tracker_of(options);
  if (!tracker) return tracker.error();
  auto board = finder_of(options.target);
  if (!board) return board.error();
  auto source = open_frames(input.path, input.name);
  if (!source && !options.keep_broken) return source.error();
  if (!source) {
    CameraDetections none;
    none.source = input.name.empty() ? input.path.string() : input.name;
    none.camera = input.camera;
    none.broken_off = source.error();
    return Job{nullptr, {}, {}, input.range, std::move(none), {}};
  }
  const StreamInfo& info = (*source)->info();
  const auto rate = input.rate ? input.rate : info.rate;
  if (!rate) {
    return bad_input(info.name,
                     "its frames have no rate",
                     "give the camera's frames per second in the session file");
  }
  CameraDetections found;
  found.source = info.name;
  found.camera = input.camera;
  found.width_px = info.width_px;
  found.height_px = info.height_px;
  found.rate = *rate;
  found.offset = input.offset;
  return Job{std::move(*source),
             std::move(*tracker),
             std::move(*board),
             input.range,
             std::move(found),
             {}};
}

/// Returns the number of frames that a job will read; nullopt if it is unknown.
std::optional<int> expected_frames(const Job& job) {
  if (!job.source) return 0;
  const auto all = job.source->info().expected_frames;
  if (!job.range) return all;
  const int last = job.range->last + 1;
  return std::max(0, std::min(all.value_or(last), last) - job.range->first);
}

/// Reads a job's stream until its range or the stream ends, or `stop()` returns true.
template <class Stop>
Status run_job(Job& job, SharedProgress& progress, const Stop& stop) {
  const int first = job.range ? job.range->first : 0;
  const int last = job.range ? job.range->last : std::numeric_limits<int>::max();
  int frames = 0;
  while (frames <= last && !stop()) {
    auto next = job.source->next();
    if (!next) return next.error();
    if (!*next) {
      if (job.range) return unreached_range(job.found.source, *job.range, frames);
      break;
    }
    const GrayFrame& frame = **next;
    ++frames;
    if (frame.index < first) continue;
    if (frame.damaged) {
      ++job.found.damaged_frames;
      job.found.frames.push_back({frame.index, {}});
    } else {
      job.found.frames.push_back(detect_frame(frame, job));
    }
    progress.one_more();
  }
  if (job.tracker) job.found.dropped = job.tracker->dropped();
  return Done{};
}

/// Runs all jobs on up to `workers` threads. A job stops early after an earlier one has
/// failed, as its result is not needed. Jobs before the failed one continue, because
/// their errors have precedence independent of the threads' schedule.
void run_jobs(std::vector<Job>& jobs,
              int workers,
              bool keep_broken,
              SharedProgress& progress) {
  std::atomic<std::size_t> next_job{0};
  std::atomic<std::size_t> first_failed{jobs.size()};
  const auto work = [&] {
    for (std::size_t i = next_job++; i < jobs.size(); i = next_job++) {
      if (!jobs[i].source) continue;
      const Status status =
          run_job(jobs[i], progress, [&] { return first_failed.load() < i; });
      if (status) continue;
      if (keep_broken) {
        jobs[i].found.broken_off = status.error();
        if (jobs[i].tracker) jobs[i].found.dropped = jobs[i].tracker->dropped();
        continue;
      }
      jobs[i].error = status.error();
      std::size_t failed = first_failed.load();
      while (i < failed && !first_failed.compare_exchange_weak(failed, i)) {
      }
    }
  };
  std::vector<std::jthread> threads;
  for (int i = 1; i < workers; ++i) threads.emplace_back(work);
  work();
}

}  // namespace

Result<std::vector<CameraDetections>> detect_tags_in_videos(
    std::span<const CameraInput> inputs,
    const DetectVideosOptions& options,
    const Progress& progress) {
  std::vector<Job> jobs;
  jobs.reserve(inputs.size());
  std::optional<int> total = 0;
  for (const CameraInput& input : inputs) {
    auto job = open_job(input, options);
    if (!job) return job.error();
    const auto expected = expected_frames(*job);
    total = total && expected ? std::optional(*total + *expected) : std::nullopt;
    jobs.push_back(std::move(*job));
  }
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int wanted = options.workers > 0 ? options.workers : cores;
  SharedProgress shared(progress, total.value_or(kUnknownTotal));
  run_jobs(
      jobs, std::min(wanted, static_cast<int>(jobs.size())), options.keep_broken, shared);

  std::vector<CameraDetections> found;
  found.reserve(jobs.size());
  for (Job& job : jobs) {
    if (job.error) return *job.error;
    found.push_back(std::move(job.found));
  }
  shared.all_done();
  return found;
}

}  // namespace marey::capture
