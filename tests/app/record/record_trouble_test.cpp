// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Recordings in which something goes wrong.
#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/record/record_take.h"
#include "recordings/base/atomic_file.h"
#include "recordings/takes/take_file.h"
#include "recordings/takes/video_times.h"
#include "tests/app/synthetic_feed.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using capture::DeviceSettings;
using capture::PixelFormat;
using testing::options_for;
using testing::ScratchFolder;
using testing::SyntheticFeed;

recordings::Take take_in(const fs::path& folder) {
  const auto take = recordings::read_take(folder / recordings::kTakeFile);
  EXPECT_TRUE(take) << take.error().message();
  return take ? *take : recordings::Take{};
}

TEST(RecordTrouble, KeepsCameraEventsWithTheirOwnTimes) {
  const ScratchFolder folder;
  SyntheticFeed left(0,
                     {.frames = 90, .events = {{20, "lost: gone"}, {50, "streaming"}}});
  SyntheticFeed right(1, {.frames = 90, .events = {{30, "silent"}}});
  const std::array<RecordedCamera, 2> cameras{{{"left", &left}, {"right", &right}}};
  const auto done = record_take(cameras, options_for(folder / "walk", left), [&] {
    return left.is_done() && right.is_done();
  });
  ASSERT_TRUE(done) << done.error().message();
  const recordings::Take take = take_in(folder / "walk");
  ASSERT_EQ(take.events.size(), 3U);
  const std::array<const char*, 3> texts{"lost: gone", "silent", "streaming"};
  const std::array<int, 3> whose{0, 1, 0};
  const std::array<Timestamp, 3> times{
      left.event_time(20), right.event_time(30), left.event_time(50)};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(take.events[i].text, texts[i]);
    EXPECT_EQ(take.events[i].camera, whose[i]);
    EXPECT_EQ(take.events[i].time, times[i]);
  }
}

// Every tenth frame is more than all that may wait.
TEST(RecordTrouble, CountsFramesThatExceedTheQueue) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {.frames = 100, .big_every = 10, .big_bytes = 1 << 20});
  RecordOptions options = options_for(folder / "walk", feed);
  options.queue_bytes = 1 << 20;
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  const auto done = record_take(cameras, options, [&] { return feed.is_done(); });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 90);
  EXPECT_EQ(done->at(0).dropped, 10);
  EXPECT_EQ(done->at(0).unsaved, 10);
  long next = 0;
  const recordings::Take take = take_in(folder / "walk");
  for (const recordings::TakeFrame& frame : take.cameras.at(0).frames) {
    EXPECT_EQ(static_cast<long>(frame.sequence), next + frame.dropped_before);
    next = static_cast<long>(frame.sequence) + 1;
  }
}

TEST(RecordTrouble, ReportsACameraThatReturnsWithAnotherSize) {
  const ScratchFolder folder;
  SyntheticFeed changing(1, {.frames = 80, .other_size_from = 30});
  SyntheticFeed good(0, {.frames = 80});
  const std::array<RecordedCamera, 2> cameras{{{"changing", &changing}, {"good", &good}}};
  const auto done = record_take(cameras, options_for(folder / "walk", good), [&] {
    return changing.is_done() && good.is_done();
  });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 30);
  EXPECT_EQ(done->at(0).dropped, 50);
  ASSERT_TRUE(done->at(0).error);
  EXPECT_EQ(done->at(0).error->code, Errc::kDevice);
  EXPECT_EQ(
      done->at(0).error->cause,
      "after a reconnect its pictures have another size or format; these frames were "
      "not kept");
  EXPECT_FALSE(done->at(1).error);
  EXPECT_EQ(done->at(1).frames, 80);
  const recordings::Take take = take_in(folder / "walk");
  ASSERT_EQ(take.events.size(), 1U);
  EXPECT_EQ(take.events[0].text, "it came back with another size or format");
  EXPECT_EQ(take.events[0].time, changing.time_of(30));
}

TEST(RecordTrouble, ReportsACameraThatStopsHalfWay) {
  const ScratchFolder folder;
  SyntheticFeed dying(1, {.frames = 50});
  SyntheticFeed good(0, {.frames = 300});
  const std::array<RecordedCamera, 2> cameras{{{"dying", &dying}, {"good", &good}}};
  const auto done = record_take(cameras, options_for(folder / "walk", good), [&] {
    return dying.is_done() && good.is_done();
  });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 50);
  ASSERT_TRUE(done->at(0).error);
  EXPECT_EQ(done->at(0).error->code, Errc::kDevice);
  EXPECT_EQ(done->at(0).error->cause,
            "no frames came from it in the last 2 s of the take");
  EXPECT_FALSE(done->at(1).error);
  EXPECT_EQ(done->at(1).frames, 300);
}

TEST(RecordTrouble, ReportsACameraThatNeverSends) {
  const ScratchFolder folder;
  SyntheticFeed dead(1, {.frames = 0});
  SyntheticFeed good(0, {.frames = 50});
  const std::array<RecordedCamera, 2> cameras{{{"dead", &dead}, {"good", &good}}};
  const auto done = record_take(
      cameras, options_for(folder / "walk", good), [&] { return good.is_done(); });
  ASSERT_TRUE(done) << done.error().message();
  ASSERT_TRUE(done->at(0).error);
  EXPECT_EQ(done->at(0).error->code, Errc::kDevice);
  EXPECT_EQ(done->at(0).error->cause, "it sent no frames");
  EXPECT_FALSE(done->at(1).error);
  EXPECT_EQ(done->at(1).frames, 50);
}

/// Calls `claim` in a process whose files may not grow beyond `bytes`.
bool holds_with_small_files(rlim_t bytes, const std::function<bool()>& claim) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    _exit(setrlimit(RLIMIT_FSIZE, &limit) == 0 && claim() ? 0 : 1);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

TEST(RecordTrouble, ReportsAFailedDiskAndKeepsTheWrittenFramesReadable) {
  const ScratchFolder folder;
  const auto claim = [&] {
    SyntheticFeed small(0, {.frames = 100});
    SyntheticFeed big(1, {.frames = 100, .big_every = 8, .big_bytes = 100000});
    const std::array<RecordedCamera, 2> cameras{{{"big", &big}, {"small", &small}}};
    const auto done = record_take(cameras, options_for(folder / "walk", small), [&] {
      return big.is_done() && small.is_done();
    });
    return done && done->at(0).error && done->at(0).error->code == Errc::kDevice &&
           done->at(0).error->where == (folder / "walk" / "big.mkv").string() &&
           done->at(0).frames + done->at(0).dropped == 100 && !done->at(1).error &&
           done->at(1).frames == 100;
  };
  EXPECT_TRUE(holds_with_small_files(400000, claim));
  const recordings::Take take = take_in(folder / "walk");
  ASSERT_EQ(take.cameras.size(), 2U);
  EXPECT_EQ(take.cameras[1].frames.size(), 100U);
  EXPECT_FALSE(take.cameras[0].frames.empty());
  EXPECT_LT(take.cameras[0].frames.size(), 100U);
  ASSERT_EQ(take.events.size(), 1U);
  EXPECT_NE(take.events[0].text.find("big.mkv"), std::string::npos);
  EXPECT_TRUE(recordings::video_times(folder / "walk" / "big.mkv"));
}

TEST(RecordTrouble, LeavesNoFilesWhenTheDiskIsFullFromTheStart) {
  const ScratchFolder folder;
  for (const rlim_t bytes : {rlim_t{10}, rlim_t{5000}, rlim_t{20000}}) {
    const auto claim = [&] {
      SyntheticFeed feed(0, {.frames = 5});
      const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
      const auto done = record_take(
          cameras, options_for(folder / "walk", feed), [&] { return feed.is_done(); });
      return !done && done.error().code == Errc::kDevice && !fs::exists(folder / "walk");
    };
    EXPECT_TRUE(holds_with_small_files(bytes, claim)) << bytes;
  }
}

void expect_refused(const fs::path& folder) {
  SyntheticFeed feed(0, {.frames = 5});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  const auto again =
      record_take(cameras, options_for(folder, feed), [&] { return feed.is_done(); });
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Errc::kBadInput);
  EXPECT_EQ(again.error().cause, "a recording already exists");
}

TEST(RecordTrouble, RefusesToReplaceARecordingAndKeepsIt) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {.frames = 5});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  const fs::path walk = folder / "walk";
  ASSERT_TRUE(
      record_take(cameras, options_for(walk, feed), [&] { return feed.is_done(); }));
  const auto video = recordings::read_file(walk / "cam.mkv");
  expect_refused(walk);
  // Also when of the two only one is there.
  fs::rename(walk / "cam.mkv", folder / "cam.mkv");
  expect_refused(walk);
  fs::rename(folder / "cam.mkv", walk / "cam.mkv");
  fs::remove(walk / recordings::kTakeFile);
  expect_refused(walk);
  EXPECT_EQ(*recordings::read_file(walk / "cam.mkv"), *video);
  EXPECT_FALSE(fs::exists(walk / recordings::kTakeFile));
}

struct Odd {
  const char* what;
  PixelFormat format;
  int width_px;
  int height_px;
  int stride;
};

TEST(RecordTrouble, ReportsInvalidDriverSettingsAndLeavesNoFiles) {
  const ScratchFolder folder;
  for (const Odd& odd : {Odd{"no width", PixelFormat::kMjpg, 0, 48, 0},
                         Odd{"a negative height", PixelFormat::kMjpg, 64, -48, 0},
                         Odd{"odd width", PixelFormat::kYuyv, 63, 48, 128},
                         Odd{"odd height", PixelFormat::kNv12, 64, 47, 64},
                         Odd{"no stride", PixelFormat::kGrey, 64, 48, 0},
                         Odd{"short stride", PixelFormat::kYuyv, 64, 48, 127}}) {
    SyntheticFeed good(0, {.frames = 5});
    SyntheticFeed bad(1, {.frames = 5});
    DeviceSettings& settings = bad.settings_to_spoil();
    settings.format = odd.format;
    settings.width_px = odd.width_px;
    settings.height_px = odd.height_px;
    settings.stride = odd.stride;
    const std::array<RecordedCamera, 2> cameras{{{"good", &good}, {"bad", &bad}}};
    const auto done = record_take(
        cameras, options_for(folder / "walk", good), [&] { return good.is_done(); });
    ASSERT_FALSE(done) << odd.what;
    EXPECT_EQ(done.error().code, Errc::kDevice) << odd.what;
    EXPECT_EQ(done.error().where, "camera bad") << odd.what;
    EXPECT_FALSE(fs::exists(folder / "walk")) << odd.what;
  }
  // And so the next try is not refused.
  SyntheticFeed good(0, {.frames = 5});
  const std::array<RecordedCamera, 1> cameras{{{"good", &good}}};
  EXPECT_TRUE(record_take(
      cameras, options_for(folder / "walk", good), [&] { return good.is_done(); }));
}

}  // namespace
}  // namespace marey::app
