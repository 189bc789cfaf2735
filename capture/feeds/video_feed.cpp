// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/video_feed.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <sys/resource.h>

#include "capture/video/open_frames.h"
#include "core/base/assert.h"
#include "core/base/monotonic_clock.h"

namespace marey::capture {
namespace {

using std::chrono::milliseconds;

/// Number of images decoded in advance. Images that wait for the reader are not included.
constexpr std::size_t kAhead = 5;

Status check_sizes(const StreamInfo& first, const std::vector<VideoPart>& then) {
  for (const VideoPart& part : then) {
    const auto source = open_frames(part.path, part.path.string());
    if (!source) return source.error();
    const StreamInfo& info = (*source)->info();
    if (info.width_px == first.width_px && info.height_px == first.height_px) continue;
    return bad_input(part.path.string(),
                     "its pictures have another size than those played before it",
                     "play trials that one camera recorded");
  }
  return Done{};
}

/// Lowers the priority of the calling thread and of threads that it starts: a real camera
/// would use no processor time. A failure only costs time.
void lower_priority() {
  constexpr int kNice = 10;
  // On Linux each thread has its own priority; a process with a higher nice value keeps
  // it.
  const int now = getpriority(PRIO_PROCESS, 0);
  static_cast<void>(setpriority(PRIO_PROCESS, 0, std::min(now + kNice, 19)));
}

/// Opened by a thread of low priority, which the decoder's threads inherit.
Result<std::unique_ptr<FrameSource>> open_at_low_priority(
    const std::filesystem::path& path) {
  std::optional<Result<std::unique_ptr<FrameSource>>> opened;
  std::jthread([&] {
    lower_priority();
    opened.emplace(open_frames(path, path.string()));
  }).join();
  return *std::move(opened);
}

}  // namespace

Result<std::unique_ptr<VideoFeed>> VideoFeed::open(const VideoFeedOptions& options) {
  MAREY_ASSERT(options.buffers > 0 && options.first_frame >= 0);
  auto source = open_at_low_priority(options.path);
  if (!source) return source.error();
  const auto rate = options.rate ? options.rate : (*source)->info().rate;
  if (!rate || !(rate->hz > 0.0)) {
    return bad_input(options.path.string(),
                     "the frame rate is unknown",
                     "set fps for the trial in session.toml");
  }
  std::vector<VideoPart> parts{{options.path, options.first_frame, options.last_frame}};
  parts.insert(parts.end(), options.then.begin(), options.then.end());
  if (const Status ok = check_sizes((*source)->info(), options.then); !ok) {
    return ok.error();
  }
  auto feed = std::unique_ptr<VideoFeed>(
      new VideoFeed(options, std::move(parts), *std::move(source), *rate));
  if (const Status ok = feed->seek_first(); !ok) return ok.error();
  VideoFeed* const raw = feed.get();
  const auto first = raw->decode_one(raw->ring_.front());
  if (!first) return first.error();
  if (!*first) {
    return bad_input(options.path.string(),
                     "it ends before frame " + std::to_string(options.first_frame),
                     "correct the frames of the trial in session.toml");
  }
  raw->count_ = 1;
  raw->decoder_ = std::jthread([raw](const std::stop_token& stop) { raw->decode(stop); });
  return feed;
}

VideoFeed::VideoFeed(const VideoFeedOptions& options,
                     std::vector<VideoPart> parts,
                     std::unique_ptr<FrameSource> source,
                     FrameRate rate)
    : options_(options),
      rate_(rate),
      source_(std::move(source)),
      parts_(std::move(parts)),
      ring_(static_cast<std::size_t>(options.buffers) + kAhead) {
  settings_.format = PixelFormat::kGrey;
  settings_.width_px = source_->info().width_px;
  settings_.height_px = source_->info().height_px;
  settings_.stride = settings_.width_px;
  settings_.rate = rate;
  settings_.buffers = options.buffers;
  settings_.monotonic_clock = true;
}

VideoFeed::~VideoFeed() {
  decoder_.request_stop();
  changed_.notify_all();
}

void VideoFeed::begin_at(Timestamp begin) {
  const std::lock_guard lock(mutex_);
  begin_ = begin;
  changed_.notify_all();
}

Timestamp VideoFeed::due(std::int64_t number) const {
  return *begin_ + Timestamp(std::llround(1e9 * static_cast<double>(number) / rate_.hz));
}

/// Reopens the part's file if it was read further, and skips the frames before the trial.
Status VideoFeed::seek_first() {
  const VideoPart& part = parts_[part_];
  if (next_in_file_ > 0) {
    auto again = open_frames(part.path, part.path.string());
    if (!again) return again.error();
    source_ = *std::move(again);
    next_in_file_ = 0;
  }
  while (next_in_file_ < part.first_frame) {
    const auto frame = source_->next();
    if (!frame) return frame.error();
    if (!*frame) break;
    ++next_in_file_;
  }
  return Done{};
}

/// Decodes the next image; returns false at the end of the part. Damaged images are
/// uniform grey.
Result<bool> VideoFeed::decode_one(Picture& picture) {
  const std::optional<int> last = parts_[part_].last_frame;
  if (last && next_in_file_ > *last) return false;
  const auto frame = source_->next();
  if (!frame) return frame.error();
  if (!*frame) return false;
  ++next_in_file_;
  picture.number = next_number_++;
  const auto width = static_cast<std::size_t>(settings_.width_px);
  const auto height = static_cast<std::size_t>(settings_.height_px);
  picture.pixels.resize(width * height);
  const GrayFrame& grey = **frame;
  for (std::size_t row = 0; row < height && !grey.damaged; ++row) {
    std::memcpy(picture.pixels.data() + row * width,
                grey.pixels + row * static_cast<std::size_t>(grey.stride),
                width);
  }
  if (grey.damaged) {
    std::fill(picture.pixels.begin(), picture.pixels.end(), std::byte{128});
  }
  return true;
}

/// Calls decode_one() part by part; returns false at the end of the last one. A part
/// without any image is the end, to avoid an endless loop.
Result<bool> VideoFeed::decode_next(Picture& picture) {
  auto decoded = decode_one(picture);
  const bool is_last = part_ + 1 == parts_.size();
  if (!decoded || *decoded || (is_last && !options_.loop)) return decoded;
  part_ = is_last ? 0 : part_ + 1;
  if (const Status ok = seek_first(); !ok) return ok.error();
  return decode_one(picture);
}

void VideoFeed::decode(const std::stop_token& stop) {
  lower_priority();
  while (true) {
    Picture* place = nullptr;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop.stop_requested() || count_ < ring_.size(); });
      if (stop.stop_requested()) return;
      // No other thread uses places beyond the count.
      place = &ring_[(first_ + count_) % ring_.size()];
    }
    const auto decoded = decode_next(*place);
    const std::lock_guard lock(mutex_);
    if (!decoded) {
      health_ = {CameraState::kLost, decoded.error().message()};
      events_.push_back({monotonic_now(), "lost: " + health_.trouble});
    }
    ended_ = !decoded || !*decoded;
    if (!ended_) ++count_;
    changed_.notify_all();
    if (ended_) return;
  }
}

/// If more than `buffers` frames are due, drops the oldest.
void VideoFeed::drop_stale(Timestamp now) {
  std::size_t waiting = 0;
  while (waiting < count_ &&
         due(ring_[(first_ + waiting) % ring_.size()].number) <= now) {
    ++waiting;
  }
  for (; waiting > static_cast<std::size_t>(options_.buffers); --waiting) {
    first_ = (first_ + 1) % ring_.size();
    --count_;
    changed_.notify_all();
  }
}

RawFrame VideoFeed::acquire_buffer() {
  const Picture& picture = ring_[first_];
  is_acquired_ = true;
  RawFrame frame;
  frame.bytes = picture.pixels;
  frame.time = due(picture.number);
  frame.sequence = static_cast<std::uint32_t>(picture.number);
  frame.dropped_before =
      static_cast<int>(std::max<std::int64_t>(picture.number - last_handed_out_ - 1, 0));
  last_handed_out_ = picture.number;
  return frame;
}

std::optional<RawFrame> VideoFeed::next(milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  if (is_acquired_) {
    is_acquired_ = false;
    first_ = (first_ + 1) % ring_.size();
    --count_;
    changed_.notify_all();
  }
  const Clock::time_point deadline = Clock::now() + timeout;
  while (true) {
    if (begin_ && count_ > 0) {
      const Timestamp now = monotonic_now();
      drop_stale(now);
      if (due(ring_[first_].number) <= now) return acquire_buffer();
    }
    if (Clock::now() >= deadline || (ended_ && count_ == 0)) return std::nullopt;
    auto until = deadline;
    if (begin_ && count_ > 0) {
      until = std::min(until, Clock::time_point(due(ring_[first_].number)));
    }
    changed_.wait_until(lock, until);
  }
}

std::string VideoFeed::device() const {
  return options_.path.string();
}

std::vector<FeedEvent> VideoFeed::events() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

FeedHealth VideoFeed::health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

bool VideoFeed::is_over() {
  const std::lock_guard lock(mutex_);
  return ended_ && count_ == (is_acquired_ ? 1U : 0U);
}

}  // namespace marey::capture
