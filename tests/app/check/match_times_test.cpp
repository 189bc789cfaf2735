// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/match_times.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "app/check/check_frame_times.h"
#include "core/base/frame_range.h"
#include "recordings/base/atomic_file.h"
#include "recordings/takes/take_file.h"
#include "tests/support/files/run_sql.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using recordings::kTakeFile;
using recordings::TakeWriter;
using recordings::Trial;
using testing::ScratchFolder;

constexpr int kVideoFrames = 90;
constexpr int kDropped = 40;  ///< The frame that the second camera drops.

/// A take of two cameras at 30 frames per second, with detections. The tag and the point
/// of each frame carry the number of the instant at which the frame was taken.
class SmallTake {
 public:
  explicit SmallTake(const fs::path& folder, const std::string& long_name = "cam") {
    fs::create_directories(folder);
    recordings::Take description;
    description.trial = trial.name = "walk";
    for (int c = 0; c < 2; ++c) {
      const std::string name = long_name + std::to_string(c);
      recordings::TakeCamera one;
      one.name = name;
      one.file = name + ".mkv";
      description.cameras.push_back(one);
      trial.videos.push_back({CameraId{c}, folder / one.file, {}, 0});
    }
    auto writer = TakeWriter::create(folder / kTakeFile, description);
    EXPECT_TRUE(writer) << writer.error().message();
    for (int c = 0; c < 2; ++c) {
      CameraDetections& camera = found.emplace_back();
      camera.camera = CameraId{c};
      camera.source = (folder / description.cameras[static_cast<std::size_t>(c)].file);
      for (int k = 0; k < kVideoFrames; ++k) {
        if (c == 1 && k == kDropped) continue;
        recordings::TakeFrame stamp;
        stamp.time = from_seconds(7000.0 + k / 30.0);
        stamp.sequence = static_cast<unsigned>(k);
        stamp.dropped_before = c == 1 && k == kDropped + 1 ? 1 : 0;
        writer->add(c, stamp);
        FrameDetections frame;
        frame.frame = static_cast<int>(camera.frames.size());
        frame.tags.emplace_back().id = TagId{k};
        frame.points.emplace_back().point = k;
        camera.frames.push_back(frame);
      }
    }
    EXPECT_TRUE(writer->finish());
  }

  Status match() { return match_times(trial, found, findings); }

  /// Returns the number in a camera's frame of an instant; nullopt for a frame that the
  /// camera does not have.
  [[nodiscard]] std::optional<int> at(std::size_t camera, int instant) const {
    const auto& frames = found[camera].frames;
    const FrameDetections& frame =
        frames.at(static_cast<std::size_t>(instant - frames[0].frame));
    EXPECT_EQ(frame.frame, instant);
    EXPECT_EQ(frame.tags.size(), frame.points.size());
    if (frame.tags.empty()) return std::nullopt;
    EXPECT_EQ(number(frame.tags[0].id), frame.points[0].point);
    return frame.points[0].point;
  }

  Trial trial;
  std::vector<CameraDetections> found;
  std::vector<Finding> findings;
};

TEST(MatchTimes, PutsAllThatWasFoundInAFrameAtItsInstant) {
  const ScratchFolder folder;
  SmallTake take(folder.path());
  ASSERT_TRUE(has_times_file(take.trial));
  ASSERT_TRUE(take.match());
  for (int k = 0; k < kVideoFrames; ++k) {
    EXPECT_EQ(take.at(0, k), k);
    EXPECT_EQ(take.at(1, k), k == kDropped ? std::nullopt : std::optional(k));
  }
}

TEST(MatchTimes, CutsATakeToItsRangeOfInstants) {
  const ScratchFolder folder;
  SmallTake take(folder.path());
  take.trial.frames = {30, kVideoFrames - 1};
  ASSERT_TRUE(take.match());
  for (std::size_t c = 0; c < 2; ++c) {
    ASSERT_EQ(take.found[c].frames.size(), 60U);
    EXPECT_EQ(take.at(c, 30), 30);
    EXPECT_EQ(take.at(c, 89), 89);
  }
  EXPECT_EQ(take.at(1, kDropped), std::nullopt);
}

TEST(MatchTimes, DeclinesARangeThatATakeDoesNotReach) {
  for (const FrameRange range :
       {FrameRange{5000, 5100}, {10, 90}, {90, 90}, {0, 2147483647}}) {
    const ScratchFolder folder;
    SmallTake take(folder.path());
    take.trial.frames = range;
    const Status matched = take.match();
    ASSERT_FALSE(matched);
    EXPECT_EQ(matched.error().code, Errc::kBadInput);
    EXPECT_EQ(matched.error().cause,
              "frames " + std::to_string(range.first) + " to " +
                  std::to_string(range.last) + " are beyond its end: it has only 90");
  }
}

TEST(MatchTimes, DeclinesTimesThatReachTooFar) {
  const ScratchFolder folder;
  SmallTake take(folder.path());
  testing::run_sql(
      folder / kTakeFile,
      "UPDATE frame SET time_ns = time_ns + 3000000000000000 WHERE camera = 0 AND "
      "number >= 40");
  const Status matched = take.match();
  ASSERT_FALSE(matched);
  EXPECT_EQ(matched.error().code, Errc::kBadInput);
  EXPECT_EQ(matched.error().cause,
            "its times span too long for the number of frames: frame 40 of cam0.mkv "
            "comes 3000000.0 s after the previous one");
}

TEST(MatchTimes, AddsUpMoreDroppedFramesThanAnyTakeHas) {
  const ScratchFolder folder;
  SmallTake take(folder.path());
  testing::run_sql(folder / kTakeFile, "UPDATE frame SET dropped_before = 2147483647");
  ASSERT_TRUE(take.match());
  ASSERT_EQ(take.findings.size(), 2U);
  EXPECT_NE(take.findings[0].message().find(": 193273528230 frames were dropped"),
            std::string::npos);
}

TEST(MatchTimes, DoesNotTruncateMessagesOfLongPaths) {
  const ScratchFolder folder;
  const fs::path deep = folder.path() / std::string(200, 'a') / std::string(200, 'b');
  SmallTake take(deep);
  // One frame in nine is late by a third of a period.
  testing::run_sql(deep / kTakeFile,
                   "UPDATE frame SET time_ns = time_ns + 11000000 WHERE number % 9 = 4");
  ASSERT_TRUE(take.match());
  ASSERT_FALSE(take.findings.empty());
  const std::string& warning = take.findings.front().cause;
  EXPECT_NE(warning.find("ms away from a steady rate of"), std::string::npos) << warning;
  EXPECT_TRUE(warning.ends_with(" Hz")) << warning;
}

// A file of times applies only to the videos in its own folder.
TEST(MatchTimes, ReportsATakeThatIsNotUsed) {
  const ScratchFolder folder;
  SmallTake take(folder / "one");
  fs::create_directories(folder / "other");
  take.trial.videos[1].path = folder / "other" / "cam1.mkv";
  EXPECT_FALSE(has_times_file(take.trial));
  const std::vector<CameraDetections> before = take.found;
  ASSERT_TRUE(take.match());
  EXPECT_EQ(take.found[1].frames.size(), before[1].frames.size());
  ASSERT_EQ(take.findings.size(), 1U);
  EXPECT_NE(take.findings[0].cause.find("it is not used"), std::string::npos);
  std::swap(take.trial.videos[0], take.trial.videos[1]);
  EXPECT_FALSE(has_times_file(take.trial));
}

/// Videos of the sample: the walk has 30 frames per second, the calibration 5.
struct RatedVideos {
  RatedVideos(std::vector<std::string> files, double hz) {
    trial.name = "walk";
    trial.rate = FrameRate{hz};
    for (std::size_t c = 0; c < files.size(); ++c) {
      const fs::path path =
          marey::testing::source_dir() / "recordings/samples/first-light" / files[c];
      trial.videos.push_back({CameraId{static_cast<int>(c)}, path, {}, 0});
      CameraDetections& camera = found.emplace_back();
      camera.camera = CameraId{static_cast<int>(c)};
      camera.source = path.string();
      camera.rate = FrameRate{hz};
      camera.frames.emplace_back();
    }
  }
  Trial trial;
  std::vector<CameraDetections> found;
  std::vector<Finding> findings;
};

TEST(CheckEven, NamesAnFpsThatIsNotTheVideos) {
  RatedVideos videos({"walk/cam0.mp4", "walk/cam1.mp4"}, 60.0);
  ASSERT_TRUE(check_frame_times(videos.trial, videos.found, videos.findings));
  ASSERT_EQ(videos.findings.size(), 1U);
  const Finding& failure = videos.findings[0];
  EXPECT_EQ(failure.severity, Severity::kPoor);
  EXPECT_EQ(failure.code, Errc::kQuality);
  EXPECT_NE(failure.cause.find("a steady 30.00 frames per second"), std::string::npos);
  EXPECT_NE(failure.cause.find("fps of trial walk is 60.00"), std::string::npos);
  EXPECT_NE(failure.cause.find("2.00 times as fast"), std::string::npos);
}

TEST(CheckEven, NamesSlowMotionAsAReasonForAnotherRate) {
  RatedVideos videos({"walk/cam0.mp4", "walk/cam1.mp4"}, 120.0);
  ASSERT_TRUE(check_frame_times(videos.trial, videos.found, videos.findings));
  ASSERT_EQ(videos.findings.size(), 1U);
  EXPECT_NE(videos.findings[0].next.find("slow_motion = 4"), std::string::npos)
      << videos.findings[0].next;
}

TEST(CheckEven, TakesSlowMotionThatIsDeclared) {
  RatedVideos videos({"walk/cam0.mp4", "walk/cam1.mp4"}, 120.0);
  videos.trial.slow_motion = 4.0;
  ASSERT_TRUE(check_frame_times(videos.trial, videos.found, videos.findings));
  EXPECT_TRUE(videos.findings.empty());
}

TEST(CheckEven, DeclinesSlowMotionThatTheVideosDoNotState) {
  for (const auto& [hz, slow] : {std::pair(120.0, 8.0), std::pair(30.0, 4.0)}) {
    RatedVideos videos({"walk/cam0.mp4", "walk/cam1.mp4"}, hz);
    videos.trial.slow_motion = slow;
    const Status checked = check_frame_times(videos.trial, videos.found, videos.findings);
    ASSERT_FALSE(checked) << hz;
    EXPECT_EQ(checked.error().code, Errc::kBadInput);
    EXPECT_NE(checked.error().where.find("walk/cam"), std::string::npos)
        << checked.error().where;
    EXPECT_NE(checked.error().cause.find("slow_motion"), std::string::npos);
  }
}

TEST(CheckEven, DeclinesAVideoOfAnotherRateAmongOthers) {
  RatedVideos videos({"walk/cam0.mp4", "calib/cam1.mp4"}, 30.0);
  const Status checked = check_frame_times(videos.trial, videos.found, videos.findings);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Errc::kBadInput);
  EXPECT_NE(checked.error().where.find("calib/cam1.mp4"), std::string::npos);
  EXPECT_NE(checked.error().cause.find("a steady 5.00 frames per second"),
            std::string::npos)
      << checked.error().cause;
}

TEST(CheckEven, PassesVideosOfTheGivenRate) {
  RatedVideos videos({"walk/cam0.mp4", "walk/cam1.mp4"}, 30.0);
  ASSERT_TRUE(check_frame_times(videos.trial, videos.found, videos.findings));
  EXPECT_TRUE(videos.findings.empty());
}

}  // namespace
}  // namespace marey::app
