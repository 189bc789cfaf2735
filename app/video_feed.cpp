// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/video_feed.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <sys/resource.h>

#include "app/monotonic_clock.h"
#include "core/assert.h"

namespace marey::app {
namespace {

using std::chrono::milliseconds;

/// Pictures that are decoded ahead, beside those that wait for the reader.
constexpr std::size_t kAhead = 5;

Status check_sizes(const capture::StreamInfo& first, const std::vector<VideoPart>& then) {
  for (const VideoPart& part : then) {
    const auto source = capture::open_frames(part.path, part.path.string());
    if (!source) return source.error();
    const capture::StreamInfo& info = (*source)->info();
    if (info.width_px == first.width_px && info.height_px == first.height_px) continue;
    return bad_input(part.path.string(),
                     "its pictures are of another size than those played before it",
                     "play trials that one camera recorded");
  }
  return Done{};
}

/// From now on the calling thread, and those it starts, leave the processor to others
/// that want it: a camera would not take any of it. Where that is refused, nothing is
/// lost but time.
void give_way() {
  constexpr int kNice = 10;
  // Of Linux, where a thread has its own; a process that is nicer already stays so.
  const int now = getpriority(PRIO_PROCESS, 0);
  static_cast<void>(setpriority(PRIO_PROCESS, 0, std::min(now + kNice, 19)));
}

/// Opened by a thread that gives way, so that those of the decoder do.
Result<std::unique_ptr<capture::FrameSource>> open_quietly(
    const std::filesystem::path& path) {
  std::optional<Result<std::unique_ptr<capture::FrameSource>>> opened;
  std::jthread([&] {
    give_way();
    opened.emplace(capture::open_frames(path, path.string()));
  }).join();
  return *std::move(opened);
}

}  // namespace

Result<std::unique_ptr<VideoFeed>> VideoFeed::open(const VideoFeedOptions& options) {
  MAREY_ASSERT(options.buffers > 0 && options.first_frame >= 0);
  auto source = open_quietly(options.path);
  if (!source) return source.error();
  const auto rate = options.rate ? options.rate : (*source)->info().rate;
  if (!rate || !(rate->hz > 0.0)) {
    return bad_input(options.path.string(),
                     "nobody knows how many frames it has a second",
                     "give the trial its fps in session.toml");
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
                     "see the frames of the trial in session.toml");
  }
  raw->count_ = 1;
  raw->decoder_ = std::jthread([raw](const std::stop_token& stop) { raw->decode(stop); });
  return feed;
}

VideoFeed::VideoFeed(const VideoFeedOptions& options,
                     std::vector<VideoPart> parts,
                     std::unique_ptr<capture::FrameSource> source,
                     FrameRate rate)
    : options_(options),
      rate_(rate),
      source_(std::move(source)),
      parts_(std::move(parts)),
      ring_(static_cast<std::size_t>(options.buffers) + kAhead) {
  settings_.format = capture::PixelFormat::kGrey;
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
  return *begin_ +
         Timestamp(std::llround(1e9 * static_cast<double>(number) / rate_.hz));
}

/// Opens the part's file if it was read on, and passes over what comes before the trial.
Status VideoFeed::seek_first() {
  const VideoPart& part = parts_[part_];
  if (next_in_file_ > 0) {
    auto again = capture::open_frames(part.path, part.path.string());
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

/// The next picture; false at the end of the part. Damaged ones are grey all over.
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
  const capture::GrayFrame& grey = **frame;
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

/// As decode_one(), from part to part; false at the end of the last one. A part without a
/// picture is the end, lest a loop of them go on for ever.
Result<bool> VideoFeed::decode_next(Picture& picture) {
  auto decoded = decode_one(picture);
  const bool is_last = part_ + 1 == parts_.size();
  if (!decoded || *decoded || (is_last && !options_.loop)) return decoded;
  part_ = is_last ? 0 : part_ + 1;
  if (const Status ok = seek_first(); !ok) return ok.error();
  return decode_one(picture);
}

void VideoFeed::decode(const std::stop_token& stop) {
  give_way();
  while (true) {
    Picture* place = nullptr;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock,
                    [&] { return stop.stop_requested() || count_ < ring_.size(); });
      if (stop.stop_requested()) return;
      // Nobody else touches places beyond the count.
      place = &ring_[(first_ + count_) % ring_.size()];
    }
    const auto decoded = decode_next(*place);
    const std::lock_guard lock(mutex_);
    if (!decoded) {
      health_ = {capture::CameraState::kLost, decoded.error().message()};
      events_.push_back({monotonic_now(), "lost: " + health_.trouble});
    }
    ended_ = !decoded || !*decoded;
    if (!ended_) ++count_;
    changed_.notify_all();
    if (ended_) return;
  }
}

/// Of more than `buffers` frames whose time has come, forgets the oldest.
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

capture::RawFrame VideoFeed::lend_first() {
  const Picture& picture = ring_[first_];
  lent_ = true;
  capture::RawFrame frame;
  frame.bytes = picture.pixels;
  frame.time = due(picture.number);
  frame.sequence = static_cast<std::uint32_t>(picture.number);
  frame.dropped_before =
      static_cast<int>(std::max<std::int64_t>(picture.number - last_handed_out_ - 1, 0));
  last_handed_out_ = picture.number;
  return frame;
}

std::optional<capture::RawFrame> VideoFeed::next(milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  if (lent_) {
    lent_ = false;
    first_ = (first_ + 1) % ring_.size();
    --count_;
    changed_.notify_all();
  }
  const Clock::time_point give_up = Clock::now() + timeout;
  while (true) {
    if (begin_ && count_ > 0) {
      const Timestamp now = monotonic_now();
      drop_stale(now);
      if (due(ring_[first_].number) <= now) return lend_first();
    }
    if (Clock::now() >= give_up || (ended_ && count_ == 0)) return std::nullopt;
    auto until = give_up;
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
  return ended_ && count_ == (lent_ ? 1U : 0U);
}

}  // namespace marey::app
