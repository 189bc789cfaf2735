// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// record_guest: what the recorder claims, tried on a real kernel in an emulated machine
// (tests/capture/run_v4l2_guest.sh), where vivid makes two cameras. Prints a line for
// each claim; its exit code is the number of claims that failed.
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/device_feed.h"
#include "app/record_take.h"
#include "recordings/take_file.h"
#include "recordings/video_times.h"
#include "tests/support/vivid.h"

namespace marey::guest {
namespace {

namespace fs = std::filesystem;
using app::DeviceFeed;
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
std::vector<std::unique_ptr<DeviceFeed>> open_both() {
  std::vector<std::unique_ptr<DeviceFeed>> feeds;
  for (std::size_t c = 0; c < 2; ++c) {
    capture::DeviceRequest request;
    request.path = kPaths[c];
    request.width_px = 320;
    request.height_px = 180;
    auto feed = DeviceFeed::open(kNames[c], request, [](const std::string&) {});
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

/// Records both for a while; `meanwhile` runs beside it.
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

/// Frames whose number does not follow from that before, and what is said of losses.
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

}  // namespace
}  // namespace marey::guest

int main() {
  marey::guest::check_two_at_once();
  marey::guest::check_disconnect();
  return marey::guest::failures;
}
