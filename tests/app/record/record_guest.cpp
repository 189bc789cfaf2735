// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// record_guest: tests the recorder and live runs with cameras that disconnect and return.
// It runs on a real kernel in an emulated machine (tests/capture/run_v4l2_guest.sh),
// where vivid provides two cameras. Prints a line for each claim; its exit code is the
// number of claims that failed.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "app/record/record_take.h"
#include "capture/feeds/device_feed.h"
#include "capture/feeds/live_groups.h"
#include "recordings/takes/take_file.h"
#include "recordings/takes/video_times.h"
#include "tests/support/program/vivid.h"

namespace marey::guest {
namespace {

namespace fs = std::filesystem;
using capture::DeviceFeed;
using recordings::Take;
using recordings::TakeFrame;

const std::array<std::string, 2> kNames{"first", "second"};
const std::array<std::string, 2> kPaths{"/dev/video0", "/dev/video1"};

int failures = 0;

bool check(bool true_, const std::string& claim, const std::string& seen = {}) {
  failures += true_ ? 0 : 1;
  std::printf("%s %s%s%s\n",
              true_ ? "ok  " : "FAIL",
              claim.c_str(),
              seen.empty() ? "" : ": ",
              seen.c_str());
  std::fflush(stdout);
  return true_;
}

/// Cameras that stream for a while before they are recorded.
std::vector<std::unique_ptr<capture::DeviceFeed>> open_both() {
  std::vector<std::unique_ptr<capture::DeviceFeed>> feeds;
  for (std::size_t c = 0; c < 2; ++c) {
    capture::DeviceRequest request;
    request.path = kPaths[c];
    request.width_px = 320;
    request.height_px = 180;
    auto feed = capture::DeviceFeed::open(kNames[c], request, [](const std::string&) {});
    if (!check(feed.has_value(), kNames[c] + " is opened")) return {};
    feeds.push_back(std::move(*feed));
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));
  return feeds;
}

struct Recorded {
  Timestamp begin{0};
  std::vector<app::CameraSummary> summaries;
  Take take;
};

/// Records both cameras for `duration_s`; `meanwhile` runs at the same time.
template <class Meanwhile>
Recorded record(const fs::path& folder, double duration_s, Meanwhile meanwhile) {
  Recorded out;
  const auto feeds = open_both();
  if (feeds.size() < 2) return out;
  const std::array<app::RecordedCamera, 2> cameras{
      {{kNames[0], feeds[0].get()}, {kNames[1], feeds[1].get()}}};
  app::RecordOptions options;
  options.folder = folder;
  options.trial = "walk";
  options.seconds = duration_s;
  out.begin = std::chrono::steady_clock::now().time_since_epoch();
  std::thread other(meanwhile);
  auto done = app::record_take(cameras, options, [] { return false; });
  other.join();
  if (!check(done.has_value(), "it records", done ? "" : done.error().message())) {
    return out;
  }
  out.summaries = std::move(*done);
  auto take = recordings::read_take(folder / recordings::kTakeFile);
  if (check(take && take->cameras.size() == 2, "its take is read")) {
    out.take = std::move(*take);
  }
  return out;
}

/// Counts the frames whose number does not follow from the previous number and the
/// reported losses.
int gaps(const std::vector<TakeFrame>& frames) {
  int count = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const auto expected =
        frames[i - 1].sequence + 1U + static_cast<unsigned>(frames[i].dropped_before);
    count += frames[i].sequence == expected ? 0 : 1;
  }
  return count;
}

std::string text_of(const app::CameraSummary& summary) {
  return std::to_string(summary.frames) + " frames, " + std::to_string(summary.dropped) +
         " dropped" + (summary.error ? "; " + summary.error->message() : "");
}

void check_two_at_once() {
  const fs::path folder = "/two/walk";
  const Recorded recorded = record(folder, 11.0, [] {});
  if (recorded.take.cameras.size() < 2) return;
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& summary = recorded.summaries[c];
    const auto& frames = recorded.take.cameras[c].frames;
    check(summary.frames >= 300 && summary.dropped == 0 && !summary.error &&
              static_cast<long>(frames.size()) == summary.frames && gaps(frames) == 0,
          "300 frames and more of " + kNames[c] + ", contiguous",
          text_of(summary));
    if (frames.empty()) continue;
    check(frames.front().time >= recorded.begin && frames.front().dropped_before == 0,
          "they begin with one that was taken since the beginning");
    const double mean_s = seconds(frames.back().time - frames.front().time) /
                          static_cast<double>(frames.size() - 1);
    check(std::abs(mean_s - 1.0 / 30.0) < 2e-4, "their stamps are 33.3 ms apart");
    const auto times = recordings::video_times(folder / (kNames[c] + ".mkv"));
    check(times && times->size() == frames.size(), "its video has as many");
  }
}

void check_disconnect() {
  const Recorded recorded = record("/unplugged/walk", 8.0, [] {
    std::this_thread::sleep_for(std::chrono::seconds(2));
    set_vivid(kPaths[0].c_str(), "Disconnect");
  });
  if (recorded.take.cameras.size() < 2) return;
  const auto& first = recorded.take.cameras[0].frames;
  const auto& second = recorded.take.cameras[1].frames;
  std::string events;
  bool in_time = true;
  for (const recordings::TakeEvent& event : recorded.take.events) {
    events += event.text.substr(0, event.text.find(':')) + " " +
              std::to_string(seconds(event.time - recorded.begin)) + "; ";
    in_time = in_time && event.camera == 0 && event.time > recorded.begin;
  }
  check(recorded.take.events.size() >= 2 && in_time &&
            recorded.take.events.front().text.rfind("lost", 0) == 0 &&
            recorded.take.events.back().text == "streaming",
        "a disconnect and the return are in the take, with their times",
        events);
  check(first.size() > 90 && !recorded.summaries[0].error,
        "the camera's frames from before and after are kept",
        text_of(recorded.summaries[0]));
  check(second.size() >= 225 && gaps(second) == 0 && recorded.summaries[1].dropped == 0,
        "its neighbour's have no gap",
        text_of(recorded.summaries[1]));
}

/// Results of a live run whose first camera is unplugged and returns.
struct Seen {
  double max_wait_s = 0.0;   ///< Until the next instant of any camera.
  double max_pause_s = 0.0;  ///< Between two instants of the first camera.
  int with_second = 0;
  int alone = 0;  ///< Instants of the second camera alone.
  std::string trouble;
  double back_after_s = -1.0;  ///< First camera's next frame after its return.
};

/// Unplugs the first camera for two seconds. vivid restores its device when the last file
/// descriptor of it is closed: an open one keeps it unplugged. Returns the time of the
/// release.
Timestamp unplug_for_two_seconds() {
  const int held = ::open(kPaths[0].c_str(), O_RDWR);
  set_vivid(kPaths[0].c_str(), "Disconnect");
  std::this_thread::sleep_for(std::chrono::seconds(2));
  const Timestamp now = std::chrono::steady_clock::now().time_since_epoch();
  ::close(held);
  return now;
}

Seen watch_live(const std::vector<std::unique_ptr<capture::DeviceFeed>>& feeds,
                const std::atomic<std::int64_t>& back_ns) {
  using Clock = std::chrono::steady_clock;
  const std::array<capture::FrameFeed*, 2> both{feeds[0].get(), feeds[1].get()};
  const std::vector<capture::ClockModel> clocks(2);
  capture::GroupFramesOptions options;
  options.mode = capture::GroupingMode::kLive;
  options.origin = std::nullopt;
  options.capacity = 8;
  capture::LiveGroups<int> groups(
      both, clocks, options, [](CameraId, const capture::RawFrame&, int&) {
        return true;
      });
  Seen seen;
  const auto begin = Clock::now();
  auto last = begin;
  auto first_camera = begin;
  while (Clock::now() - begin < std::chrono::seconds(8)) {
    const auto* group = groups.next(std::chrono::milliseconds(100));
    const capture::FeedHealth health = feeds[0]->health();
    if (health.state == capture::CameraState::kLost) seen.trouble = health.trouble;
    if (!group) continue;
    const auto now = Clock::now();
    const auto since = [now](Clock::time_point then) { return seconds(now - then); };
    seen.max_wait_s = std::max(seen.max_wait_s, since(last));
    last = now;
    for (const auto& frame : group->frames) {
      seen.with_second += frame.camera == CameraId{1};
      seen.alone += frame.camera == CameraId{1} && group->frames.size() == 1;
      if (frame.camera != CameraId{0}) continue;
      seen.max_pause_s = std::max(seen.max_pause_s, since(first_camera));
      if (back_ns > 0 && seen.back_after_s < 0.0) {
        seen.back_after_s = seconds(frame.time - Timestamp{back_ns.load()});
      }
      first_camera = now;
    }
  }
  return seen;
}

void check_live() {
  const auto feeds = open_both();
  if (feeds.size() < 2) return;
  std::atomic<std::int64_t> back_ns = 0;
  std::thread other([&back_ns] {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    back_ns = unplug_for_two_seconds().count();
  });
  const Seen seen = watch_live(feeds, back_ns);
  other.join();
  check(seen.trouble.find(kPaths[0]) != std::string::npos,
        "live, an unplugged camera is reported",
        seen.trouble);
  check(seen.max_pause_s >= 2.0 && seen.back_after_s >= 0.0 && seen.back_after_s <= 3.0,
        "it is back within 3 s of its return",
        std::to_string(seen.back_after_s) + " s, gone for " +
            std::to_string(seen.max_pause_s) + " s");
  check(seen.with_second >= 225 && seen.max_wait_s <= 0.2,
        "instants go on with its neighbour meanwhile",
        std::to_string(seen.with_second) + ", of which alone " +
            std::to_string(seen.alone) + "; none for " + std::to_string(seen.max_wait_s) +
            " s at most");
  check(feeds[0]->health().state == capture::CameraState::kStreaming,
        "and then it streams again");
}

}  // namespace
}  // namespace marey::guest

int main() {
  marey::guest::check_two_at_once();
  marey::guest::check_disconnect();
  marey::guest::check_live();
  return marey::guest::failures;
}
