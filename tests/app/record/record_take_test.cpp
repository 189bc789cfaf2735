// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record/record_take.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recordings/takes/take_file.h"
#include "recordings/takes/video_times.h"
#include "tests/app/synthetic_feed.h"
#include "tests/support/files/video_packets.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::kFfmpeg;
using testing::options_for;
using testing::ScratchFolder;
using testing::SyntheticFeed;

/// The bytes that the recorded frames should have.
std::string expected_packets(const SyntheticFeed& feed,
                             const std::vector<recordings::TakeFrame>& frames) {
  std::string all;
  for (const recordings::TakeFrame& frame : frames) {
    const auto bytes = feed.bytes_of(static_cast<long>(frame.sequence));
    all.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  return all;
}

/// Expects that each row matches the feed's frame, and that the rows count each frame
/// between them as dropped.
void expect_true_rows(const SyntheticFeed& feed,
                      const std::vector<recordings::TakeFrame>& frames) {
  long next = 0;
  for (const recordings::TakeFrame& frame : frames) {
    const auto k = static_cast<long>(frame.sequence);
    EXPECT_EQ(frame.time, feed.time_of(k));
    EXPECT_EQ(k, next + frame.dropped_before);
    next = k + 1;
  }
}

TEST(RecordTake, KeepsEveryFrameByteForByteWithItsTime) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const ScratchFolder folder;
  SyntheticFeed left(0, {.frames = 150});
  SyntheticFeed right(1, {.frames = 150, .drop_every = 10});
  const std::array<RecordedCamera, 2> cameras{{{"left", &left}, {"right", &right}}};
  std::vector<std::pair<int, int>> said;
  const Timestamp begin = left.now();
  const auto done = record_take(
      cameras,
      options_for(folder / "walk", left),
      [&] { return left.is_done() && right.is_done(); },
      [&](int frames, int total) { said.emplace_back(frames, total); });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_FALSE(done->at(0).error);
  EXPECT_FALSE(done->at(1).error);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back(), std::pair(285, 285));
  EXPECT_EQ(done->at(0).frames, 150);
  EXPECT_EQ(done->at(0).dropped, 0);
  EXPECT_EQ(done->at(1).frames, 135);
  EXPECT_EQ(done->at(1).dropped, 15);
  const auto take = recordings::read_take(folder / "walk" / recordings::kTakeFile);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_TRUE(take->finished);
  EXPECT_EQ(take->trial, "walk");
  ASSERT_EQ(take->cameras.size(), 2U);
  EXPECT_NE(take->cameras[0].settings.find("exposure_s = 0.004\n"), std::string::npos);
  const std::array<const SyntheticFeed*, 2> feeds{&left, &right};
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& frames = take->cameras[c].frames;
    expect_true_rows(*feeds[c], frames);
    const fs::path video = folder / "walk" / take->cameras[c].file;
    EXPECT_EQ(testing::video_packets(video), expected_packets(*feeds[c], frames));
    const auto times = recordings::video_times(video);
    ASSERT_TRUE(times);
    ASSERT_EQ(times->size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      // Players get milliseconds.
      EXPECT_NEAR(seconds((*times)[i]), seconds(frames[i].time - begin), 0.0006);
    }
  }
}

TEST(RecordTake, EncodesPixelsThatAreNotCompressed) {
  const ScratchFolder folder;
  SyntheticFeed grey(0, {.frames = 50, .is_grey = true});
  const std::array<RecordedCamera, 1> cameras{{{"grey", &grey}}};
  const auto done = record_take(
      cameras, options_for(folder / "walk", grey), [&] { return grey.is_done(); });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 50);
  const auto times = recordings::video_times(folder / "walk" / "grey.mkv");
  ASSERT_TRUE(times);
  EXPECT_EQ(times->size(), 50U);
}

TEST(RecordTake, EndsWhenItsTimeIsOver) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {.frames = 5});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  RecordOptions options = options_for(folder / "walk", feed);
  options.seconds = 0.01;
  EXPECT_TRUE(record_take(cameras, options, [] { return false; }));
}

TEST(RecordTake, CountsFramesWithoutBytesAsDropped) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {.frames = 60, .empty_every = 20});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  const auto done = record_take(
      cameras, options_for(folder / "walk", feed), [&] { return feed.is_done(); });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 57);
  EXPECT_EQ(done->at(0).dropped, 3);
  const auto take = recordings::read_take(folder / "walk" / recordings::kTakeFile);
  ASSERT_TRUE(take);
  expect_true_rows(feed, take->cameras[0].frames);
}

// Frames that the driver's buffers contain before the recording begins, and frames that
// the full buffers drop, do not belong to the take. They are no losses of it.
TEST(RecordTake, BeginsWithTheFirstFrameThatWasTakenSinceItsBeginning) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {.frames = 40, .stale = 4, .dropped_after_stale = 70});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  const auto done = record_take(
      cameras, options_for(folder / "walk", feed), [&] { return feed.is_done(); });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 36);
  EXPECT_EQ(done->at(0).dropped, 0);
  const auto take = recordings::read_take(folder / "walk" / recordings::kTakeFile);
  ASSERT_TRUE(take);
  const auto& frames = take->cameras[0].frames;
  ASSERT_EQ(frames.size(), 36U);
  EXPECT_EQ(frames[0].sequence, 4U);
  EXPECT_EQ(frames[0].time, feed.time_of(4));
  EXPECT_EQ(frames[0].dropped_before, 0);
}

// The frames before it are on the disk though none comes after them.
TEST(RecordTake, HasWrittenAllThatCameBeforeAnOutage) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {.frames = 20});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  bool is_written = false;
  int looked = 0;
  const auto done = record_take(cameras, options_for(folder / "walk", feed), [&] {
    const auto times = recordings::video_times(folder / "walk" / "cam.mkv");
    is_written = times && times->size() == 20;
    return is_written || ++looked == 40;  // Ten seconds and more.
  });
  EXPECT_TRUE(done);
  EXPECT_TRUE(is_written);
}

/// Shared with the child that is killed.
struct Handed {
  std::atomic<long> left;
  std::atomic<long> right;
};

/// Number of frames of each camera that were handed out before a time.
struct Count {
  std::chrono::steady_clock::time_point when;
  std::array<long, 2> frames;
};

// A child process records from two cameras and is killed without warning. The test
// compares the files with the frames that the cameras had delivered one second earlier.
TEST(RecordTake, LosesAtMostTheLastSecondWhenItsProcessIsKilled) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  void* const memory = mmap(
      nullptr, sizeof(Handed), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  auto& handed = *new (memory) Handed{};
  const ScratchFolder folder;
  const SyntheticFeed::Behaviour behaviour{.drop_every = 10, .in_real_time = true};
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    SyntheticFeed left(0, behaviour);
    SyntheticFeed right(1, behaviour);
    const std::array<RecordedCamera, 2> cameras{{{"left", &left}, {"right", &right}}};
    const std::jthread teller([&](const std::stop_token& end) {
      while (!end.stop_requested()) {
        handed.left = left.handed_out();
        handed.right = right.handed_out();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
    (void)record_take(cameras, options_for(folder / "walk", left), [] { return false; });
    _exit(1);
  }
  using Clock = std::chrono::steady_clock;
  std::vector<Count> counts;
  int status = 0;
  while (handed.left < 350) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_EQ(waitpid(child, &status, WNOHANG), 0) << "the recorder ended by itself";
    counts.push_back({Clock::now(), {handed.left, handed.right}});
  }
  kill(child, SIGKILL);
  const auto a_second_before = Clock::now() - std::chrono::seconds(1);
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  std::array<long, 2> to_be_kept{};
  for (const Count& count : counts) {
    if (count.when <= a_second_before) to_be_kept = count.frames;
  }
  const auto take = recordings::read_take(folder / "walk" / recordings::kTakeFile);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_FALSE(take->finished);
  for (std::size_t c = 0; c < 2; ++c) {
    const SyntheticFeed feed(static_cast<int>(c), behaviour);
    const auto& camera = take->cameras[c];
    const fs::path video = folder / "walk" / camera.file;
    expect_true_rows(feed, camera.frames);
    const auto times = recordings::video_times(video);
    ASSERT_TRUE(times);
    const std::size_t both = std::min(times->size(), camera.frames.size());
    EXPECT_GT(to_be_kept[c], 100);
    EXPECT_GE(static_cast<long>(both), to_be_kept[c]);
    const std::string read = testing::video_packets(video);
    const std::string expected = expected_packets(
        feed, {camera.frames.begin(), camera.frames.begin() + static_cast<long>(both)});
    EXPECT_EQ(read.substr(0, expected.size()), expected);
  }
  munmap(memory, sizeof(Handed));
}

}  // namespace
}  // namespace marey::app
