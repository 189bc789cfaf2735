// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record_take.h"

#include <array>
#include <csignal>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/frame_queue.h"
#include "recordings/take_file.h"
#include "recordings/video_times.h"
#include "tests/app/synthetic_feed.h"
#include "tests/support/count_allocations.h"
#include "tests/support/run_program.h"
#include "tests/support/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;
using testing::SyntheticFeed;

const char* const kFfmpeg = "/usr/bin/ffmpeg";

RecordOptions options_for(const fs::path& folder) {
  RecordOptions options;
  options.folder = folder;
  options.trial = "walk";
  return options;
}

/// The packets of a video, one after the other, as another program reads them.
std::string packets(const fs::path& video) {
  const fs::path to = video.string() + ".bin";
  const auto run = testing::run_program(kFfmpeg,
                                        {"-v",
                                         "quiet",
                                         "-i",
                                         video.string(),
                                         "-c",
                                         "copy",
                                         "-f",
                                         "data",
                                         "-map",
                                         "0:v",
                                         to.string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::ifstream in(to, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

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

/// Whether every row is what the feed did, and nothing between two rows is unaccounted.
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
  SyntheticFeed left(0, {100.0, 150, 0, false, 0, true});
  SyntheticFeed right(1, {100.0, 150, 10, false, 0, true});
  const std::array<RecordedCamera, 2> cameras{{{"left", &left}, {"right", &right}}};
  RecordOptions options = options_for(folder / "walk");
  options.seconds = 1.8;
  const auto done = record_take(cameras, options, [] { return false; });
  ASSERT_TRUE(done) << done.error().message();
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
    EXPECT_EQ(packets(video), expected_packets(*feeds[c], frames));
    const auto times = recordings::video_times(video);
    ASSERT_TRUE(times);
    ASSERT_EQ(times->size(), frames.size());
    for (std::size_t i = 1; i < frames.size(); ++i) {
      // Players get milliseconds.
      EXPECT_NEAR(seconds((*times)[i] - (*times)[0]),
                  seconds(frames[i].time - frames[0].time),
                  0.0011);
    }
  }
}

TEST(RecordTake, EncodesPixelsThatAreNotCompressed) {
  const ScratchFolder folder;
  SyntheticFeed grey(0, {100.0, 50, 0, true, 0, true});
  const std::array<RecordedCamera, 1> cameras{{{"grey", &grey}}};
  RecordOptions options = options_for(folder / "walk");
  options.seconds = 0.8;
  const auto done = record_take(cameras, options, [] { return false; });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 50);
  const auto times = recordings::video_times(folder / "walk" / "grey.mkv");
  ASSERT_TRUE(times);
  EXPECT_EQ(times->size(), 50U);
}

TEST(RecordTake, CountsFramesWithoutBytesAsDropped) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {100.0, 60, 0, false, 20, true});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  RecordOptions options = options_for(folder / "walk");
  options.seconds = 0.9;
  const auto done = record_take(cameras, options, [] { return false; });
  ASSERT_TRUE(done) << done.error().message();
  EXPECT_EQ(done->at(0).frames, 57);
  EXPECT_EQ(done->at(0).dropped, 3);
  const auto take = recordings::read_take(folder / "walk" / recordings::kTakeFile);
  ASSERT_TRUE(take);
  expect_true_rows(feed, take->cameras[0].frames);
}

TEST(RecordTake, GoesOnWithoutASilentCameraAndTellsIt) {
  const ScratchFolder folder;
  SyntheticFeed dead(0, {100.0, 0, 0, false, 0, true});
  SyntheticFeed good(1, {100.0, 50, 0, false, 0, true});
  const std::array<RecordedCamera, 2> cameras{{{"dead", &dead}, {"good", &good}}};
  RecordOptions options = options_for(folder / "walk");
  options.seconds = 0.8;
  const auto done = record_take(cameras, options, [] { return false; });
  ASSERT_TRUE(done) << done.error().message();
  ASSERT_TRUE(done->at(0).error);
  EXPECT_EQ(done->at(0).error->code, Errc::kDevice);
  EXPECT_EQ(done->at(0).error->cause, "not a single frame came from it");
  EXPECT_FALSE(done->at(1).error);
  EXPECT_EQ(done->at(1).frames, 50);
}

TEST(RecordTake, DoesNotWriteOverARecording) {
  const ScratchFolder folder;
  SyntheticFeed feed(0, {100.0, 5, 0, false, 0, true});
  const std::array<RecordedCamera, 1> cameras{{{"cam", &feed}}};
  RecordOptions options = options_for(folder / "walk");
  options.seconds = 0.1;
  ASSERT_TRUE(record_take(cameras, options, [] { return false; }));
  const auto size = fs::file_size(folder / "walk" / "cam.mkv");
  const auto again = record_take(cameras, options, [] { return false; });
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().cause, "there is a recording already");
  EXPECT_EQ(fs::file_size(folder / "walk" / "cam.mkv"), size);
}

/// Shared with the child that is killed.
struct Handed {
  std::atomic<long> left;
  std::atomic<long> right;
};

// A child records from two cameras and is killed without warning; what is on the disk is
// read back and compared with what the cameras had handed out by then.
TEST(RecordTake, LosesAtMostTheLastSecondWhenItsProcessIsKilled) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  void* const memory = mmap(
      nullptr, sizeof(Handed), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  auto& handed = *new (memory) Handed{};
  const ScratchFolder folder;
  const SyntheticFeed::Behaviour behaviour{100.0, -1, 10, false, 0, true};
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
    (void)record_take(cameras, options_for(folder / "walk"), [] { return false; });
    _exit(1);
  }
  while (handed.left < 350) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const auto take = recordings::read_take(folder / "walk" / recordings::kTakeFile);
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_FALSE(take->finished);
  const std::array<long, 2> handed_out{handed.left, handed.right};
  for (int c = 0; c < 2; ++c) {
    const SyntheticFeed feed(c, behaviour);
    const auto& camera = take->cameras[static_cast<std::size_t>(c)];
    const fs::path video = folder / "walk" / camera.file;
    expect_true_rows(feed, camera.frames);
    const auto times = recordings::video_times(video);
    ASSERT_TRUE(times);
    const std::size_t both = std::min(times->size(), camera.frames.size());
    // A second has 90 frames that come.
    EXPECT_GE(static_cast<long>(both), handed_out[static_cast<std::size_t>(c)] - 90);
    const std::string read = packets(video);
    const std::string expected = expected_packets(
        feed, {camera.frames.begin(), camera.frames.begin() + static_cast<long>(both)});
    EXPECT_EQ(read.substr(0, expected.size()), expected);
    RecordProperty("lost_frames_" + camera.name,
                   static_cast<int>(handed_out[static_cast<std::size_t>(c)] -
                                    static_cast<long>(both)));
  }
  munmap(memory, sizeof(Handed));
}

TEST(FrameQueue, RefusesWhatItHasNoPlaceForAndLosesNothingElse) {
  FrameQueue queue(3);
  const std::array<std::byte, 4> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  recordings::TakeFrame stamp;
  for (unsigned k = 0; k < 3; ++k) {
    stamp.sequence = k;
    EXPECT_TRUE(queue.push(bytes, stamp));
  }
  EXPECT_FALSE(queue.push(bytes, stamp));
  EXPECT_EQ(queue.pop()->stamp.sequence, 0U);
  EXPECT_FALSE(queue.push(bytes, stamp));  // The first is lent, and keeps its place.
  EXPECT_EQ(queue.pop()->stamp.sequence, 1U);
  stamp.sequence = 7;
  EXPECT_TRUE(queue.push(bytes, stamp));
  queue.close();
  EXPECT_EQ(queue.pop()->stamp.sequence, 2U);
  EXPECT_EQ(queue.pop()->stamp.sequence, 7U);
  EXPECT_EQ(queue.pop(), nullptr);
}

TEST(FrameQueue, AllocatesNothingOnceItsPlacesAreWarm) {
  FrameQueue queue(4);
  const std::vector<std::byte> bytes(5000, std::byte{7});
  const auto pass = [&] {
    EXPECT_TRUE(queue.push(bytes, {}));
    EXPECT_NE(queue.pop(), nullptr);
  };
  for (int k = 0; k < 8; ++k) pass();
  const long before = testing::allocations();
  for (int k = 0; k < 10000; ++k) pass();
  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::app
