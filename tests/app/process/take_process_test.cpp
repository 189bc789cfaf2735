// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The sample's walk as `marey record` would have recorded it: cameras that drop frames,
// whose clocks jitter, of which one stops early.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/record/record_take.h"
#include "recordings/base/atomic_file.h"
#include "tests/app/process/recorded_walk.h"
#include "tests/app/spoiled_session.h"
#include "tests/support/files/video_packets.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

int lines_of_errors(const std::string& err) {
  int count = 0;
  for (std::size_t at = err.find("error: "); at != std::string::npos;
       at = err.find("error: ", at + 1)) {
    ++count;
  }
  return count;
}

std::string warnings_of(const ProgramRun& run) {
  return Json::parse(run.out).at("warnings").dump();
}

// By their numbers, frames would be up to 10 apart: 0.3 s of walking, half a metre.
TEST(RecordedTake, IsMatchedByTimeThroughDropsAndJitter) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  const ProgramRun run = walk.session().run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // 3.5 mm when every frame is there.
  EXPECT_LT(median_error_mm(walk.session()), 6.0);
  const Json report = Json::parse(run.out);
  EXPECT_EQ(report.at("trials").at(0).at("frames"), kWalkFrames);
  EXPECT_NEAR(report.at("trials").at(0).at("rate_hz"), kWalkRate_hz, 0.03);
  EXPECT_NE(warnings_of(run).find("cam3.mkv: 10 frames were dropped while recording"),
            std::string::npos)
      << warnings_of(run);
}

TEST(RecordedTake, IsUsedWithAWarningWhenCutOff) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  // The last moments of one camera's times, and of another's video.
  walk.spoil_take(
      "UPDATE take SET finished=0; DELETE FROM frame WHERE camera=0 AND number>=80");
  const fs::path video = walk.folder() / "cam3.mkv";
  fs::resize_file(video, fs::file_size(video) * 9 / 10);
  const ProgramRun run = walk.session().run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(warnings_of(run).find("the recording was cut off"), std::string::npos);
  EXPECT_LT(median_error_mm(walk.session()), 6.0);
}

TEST(RecordedTake, WithoutItsTimesIsDeclined) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  fs::remove(walk.take());
  const ProgramRun run = walk.session().run("track");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(lines_of_errors(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("take.sqlite: the file does not exist"), std::string::npos)
      << run.err;
}

TEST(RecordedTake, IsDeclinedWhenItsVersionIsNewer) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  walk.spoil_take("PRAGMA user_version=9");
  const ProgramRun run = walk.session().run("track");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(lines_of_errors(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("recorded by a newer version of marey (format 9"),
            std::string::npos);
}

TEST(RecordedTake, GoesOnWithoutAVideoThatIsLostOrEmptyAndEndsWith3) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  fs::remove(walk.folder() / "cam1.mkv");
  const ProgramRun lost = walk.session().run();
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_EQ(lines_of_errors(lost.err), 1) << lost.err;
  EXPECT_NE(lost.err.find("trial walk has no recording of camera \"cam1\""),
            std::string::npos);
  EXPECT_TRUE(walk.session().has_result("walk/joints.csv"));
  ASSERT_TRUE(recordings::write_file(walk.folder() / "cam1.mkv", ""));
  const ProgramRun empty = walk.session().run();
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_EQ(lines_of_errors(empty.err), 1) << empty.err;
  EXPECT_NE(warnings_of(empty).find("cam1.mkv: the file is empty"), std::string::npos);
}

TEST(RecordedTake, WithDamagedFramesLosesTheseAlone) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  const fs::path video = walk.folder() / "cam0.mkv";
  auto bytes = recordings::read_file(video);
  ASSERT_TRUE(bytes);
  std::size_t at = 0;
  for (int k = 0; k < 30; ++k) {
    at = bytes->find("\xFF\xD8\xFF", at + 1);
    if (k % 6 == 1) bytes->replace(at + 2, 2000, 2000, '\0');
  }
  ASSERT_TRUE(recordings::write_file(video, *bytes));
  const ProgramRun run = walk.session().run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(warnings_of(run).find("cam0.mkv: 5 of 90 frames are damaged"),
            std::string::npos)
      << warnings_of(run);
  EXPECT_LT(median_error_mm(walk.session()), 6.0);
}

TEST(RecordedTake, IsCutToTheRangeThatTheTrialNames) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  RecordedWalk walk;
  walk.session().replace_in_trial(
      "walk", "kind = \"motion\"", "kind = \"motion\"\nframes = [20, 79]");
  const ProgramRun run = walk.session().run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json trial = Json::parse(run.out).at("trials").at(0);
  EXPECT_EQ(trial.at("first_frame"), 20);
  EXPECT_EQ(trial.at("frames"), 60);
  EXPECT_LT(median_error_mm(walk.session()), 6.0);
}

TEST(RecordedTake, IsDeclinedWithFewerFramesThanTheTrialNames) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  RecordedWalk walk;
  walk.session().replace_in_trial(
      "walk", "kind = \"motion\"", "kind = \"motion\"\nframes = [5000, 5100]");
  const ProgramRun run = walk.session().run("track");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(lines_of_errors(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("frames 5000 to 5100 are beyond its end: it has only 90"),
            std::string::npos)
      << run.err;
}

// Each would be years of instants.
TEST(RecordedTake, WithTimesThatCannotBeIsDeclined) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  for (const char* change :
       {"UPDATE frame SET time_ns = time_ns + 3000000000000000 WHERE number >= 40",
        "UPDATE frame SET time_ns = 9223372036854775807 WHERE number = 60",
        "UPDATE frame SET time_ns = 0 WHERE number = 0",
        "UPDATE frame SET time_ns = -time_ns"}) {
    const RecordedWalk walk;
    walk.spoil_take(change);
    const ProgramRun run = walk.session().run("track");
    EXPECT_EQ(run.exit_code, 3) << change;
    EXPECT_EQ(lines_of_errors(run.err), 1) << run.err;
    EXPECT_NE(run.err.find("take.sqlite: "), std::string::npos) << run.err;
  }
}

/// A camera that shows the sample's walk.
class WalkFeed final : public capture::FrameFeed {
 public:
  /// `pictures` has all frames as %d.jpg.
  WalkFeed(std::size_t camera, fs::path pictures)
      : camera_(camera), pictures_(std::move(pictures)) {
    settings_.width_px = 1280;
    settings_.height_px = 720;
    settings_.rate = {kWalkRate_hz};
  }

  std::optional<capture::RawFrame> next(std::chrono::milliseconds /*timeout*/) override {
    int dropped = 0;
    for (; next_ < kWalkFrames && RecordedWalk::is_dropped(camera_, next_); ++next_) {
      ++dropped;
    }
    if (next_ >= kWalkFrames) return std::nullopt;
    const auto file = pictures_ / (std::to_string(next_) + ".jpg");
    bytes_ = *recordings::read_file(file);
    capture::RawFrame frame;
    frame.bytes = std::as_bytes(std::span(bytes_));
    frame.time = times_[static_cast<std::size_t>(next_)];
    frame.sequence = static_cast<std::uint32_t>(next_);
    frame.dropped_before = dropped;
    ++next_;
    return frame;
  }
  [[nodiscard]] const capture::DeviceSettings& settings() const override {
    return settings_;
  }
  [[nodiscard]] std::string device() const override { return "walk"; }
  std::vector<capture::FeedEvent> events() override { return {}; }

  /// From any thread.
  [[nodiscard]] bool is_done() const { return next_ >= kWalkFrames; }

 private:
  std::size_t camera_;
  fs::path pictures_;
  std::vector<Timestamp> times_ = RecordedWalk::times()[camera_];
  capture::DeviceSettings settings_;
  std::atomic<int> next_ = 0;
  std::string bytes_;
};

TEST(RecordedTake, IsProcessedAsTheRecorderMadeIt) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk(RecordedWalk::Made::kNothing);
  std::vector<std::unique_ptr<WalkFeed>> feeds;
  std::vector<app::RecordedCamera> cameras;
  for (std::size_t c = 0; c < RecordedWalk::cameras().size(); ++c) {
    const std::string& name = RecordedWalk::cameras()[c];
    const fs::path pictures = walk.session().out().parent_path() / ("pictures-" + name);
    fs::create_directories(pictures);
    const auto run = run_program(kFfmpeg,
                                 {"-v",
                                  "error",
                                  "-i",
                                  SpoiledSession::sample_video("walk", name),
                                  "-q:v",
                                  "2",
                                  "-pix_fmt",
                                  "yuvj420p",
                                  "-start_number",
                                  "0",
                                  (pictures / "%d.jpg").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    feeds.push_back(std::make_unique<WalkFeed>(c, pictures));
    cameras.push_back({name, feeds.back().get()});
  }
  app::RecordOptions options;
  options.folder = walk.folder();
  options.trial = "walk";
  // The cameras' clock, from before their first frames to just after the last.
  options.now = [before = true]() mutable {
    return from_seconds(std::exchange(before, false) ? 6999.0 : 7003.2);
  };
  const auto recorded = app::record_take(cameras, options, [&] {
    return std::all_of(
        feeds.begin(), feeds.end(), [](const auto& feed) { return feed->is_done(); });
  });
  ASSERT_TRUE(recorded) << recorded.error().message();
  for (const app::CameraSummary& camera : *recorded) {
    EXPECT_FALSE(camera.error) << camera.error->message();
    EXPECT_EQ(camera.unsaved, 0);
  }
  const ProgramRun run = walk.session().run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(median_error_mm(walk.session()), 6.0);
  EXPECT_EQ(Json::parse(run.out).at("trials").at(0).at("frames"), kWalkFrames);
}

// A phone's video: frames at times of their own.
TEST(Record, ReportsEveryCameraThatCannotBeOpened) {
  SpoiledSession session;
  session.replace("name = \"cam0\"", "name = \"cam0\"\ndevice = \"/dev/no-video0\"");
  session.replace("name = \"cam1\"", "name = \"cam1\"\ndevice = \"/dev/no-video1\"");
  session.replace_in_trial("walk",
                           "videos = { cam0 = \"walk/cam0.mp4\", cam1 = "
                           "\"walk/cam1.mp4\", cam2 = \"walk/cam2.mp4\", cam3 = "
                           "\"walk/cam3.mp4\" }",
                           "");
  const fs::path take = session.out() / "take";
  const ProgramRun run = run_program(
      marey::testing::program(),
      {"record", session.file().string(), "--out", take.string(), "--trial", "walk"});
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("/dev/no-video0"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("/dev/no-video1"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("camera cam2 has no device"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(take));
}

/// The walk of one camera without seven frames of every thirty.
void leave_out_frames(SpoiledSession& session) {
  const fs::path video = session.new_video("walk", "cam2");
  const auto made = run_program(kFfmpeg,
                                {"-v",
                                 "error",
                                 "-i",
                                 SpoiledSession::sample_video("walk", "cam2"),
                                 "-vf",
                                 "select='not(between(mod(n,30),10,16))'",
                                 "-vsync",
                                 "vfr",
                                 "-c:v",
                                 "libx264",
                                 "-crf",
                                 "12",
                                 video.string()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
}

TEST(UnevenVideo, IsDeclinedWhenFramesAreChosenByNumber) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  SpoiledSession session;
  leave_out_frames(session);
  session.replace_in_trial("walk", "kind =", "frames = [0, 30]\nkind =");
  const ProgramRun run = session.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("its frame rate varies"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("remove \"frames\" from trial walk"), std::string::npos)
      << run.err;
}

TEST(UnevenVideo, IsUsedByItsOwnTimesWithAWarning) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  SpoiledSession session;
  leave_out_frames(session);
  const ProgramRun run = session.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(warnings_of(run).find("its frame rate varies"), std::string::npos);
  EXPECT_NE(warnings_of(run).find("its own times are used"), std::string::npos);
  EXPECT_LT(median_error_mm(session), 6.0);
}

}  // namespace
}  // namespace marey::testing
