// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The sample's walk as `marey record` would have recorded it: cameras that drop frames,
// whose clocks jitter, of which one stops early.
#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include "core/quantile.h"
#include "recordings/atomic_file.h"
#include "recordings/motion_tables.h"
#include "recordings/take_file.h"
#include "tests/app/broken_video.h"
#include "tests/app/spoiled_session.h"
#include "tests/support/truth.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using recordings::kTakeFile;
using recordings::Take;
using recordings::TakeWriter;

const char* const kFfmpeg = "/usr/bin/ffmpeg";
const fs::path kSample = MAREY_SAMPLE;
constexpr int kFrames = 90;
constexpr double kRate = 30.0;
const std::vector<std::string> kCameras{"cam0", "cam1", "cam2", "cam3"};

/// Frames that each camera dropped: single ones, a burst, the beginning, one in nine.
bool is_dropped(std::size_t camera, int k) {
  switch (camera) {
    case 1:
      return k == 10 || k == 40 || (k >= 60 && k < 65);
    case 2:
      return k < 3;
    case 3:
      return k % 9 == 4;
    default:
      return false;
  }
}

/// The sample's session, its walk recorded in its own folder.
class RecordedWalk {
 public:
  RecordedWalk() {
    for (std::size_t c = 0; c < kCameras.size(); ++c) {
      session_.replace("name = \"" + kCameras[c] + "\"",
                       "name = \"" + kCameras[c] + "\"\ndevice = \"/dev/video" +
                           std::to_string(c) + "\"");
    }
    session_.replace_in_trial(
        "walk",
        "videos = { cam0 = \"walk/cam0.mp4\", cam1 = \"walk/cam1.mp4\", cam2 = "
        "\"walk/cam2.mp4\", cam3 = \"walk/cam3.mp4\" }\n",
        "");
    fs::create_directories(folder());
    for (std::size_t c = 0; c < kCameras.size(); ++c) make_video(c);
    make_take();
    fs::remove_all(session_.out() / "walk");  // What was found in the other videos.
  }

  [[nodiscard]] fs::path folder() const { return session_.file().parent_path() / "walk"; }
  [[nodiscard]] fs::path take() const { return folder() / kTakeFile; }
  [[nodiscard]] const SpoiledSession& session() const { return session_; }

 private:
  void make_video(std::size_t camera) const {
    std::string keep = "select='1";
    for (int k = 0; k < kFrames; ++k) {
      if (is_dropped(camera, k)) keep += "*not(eq(n," + std::to_string(k) + "))";
    }
    const auto run = run_program(kFfmpeg,
                                 {"-v",
                                  "error",
                                  "-i",
                                  SpoiledSession::sample_video("walk", kCameras[camera]),
                                  "-vf",
                                  keep + "'",
                                  "-vsync",
                                  "0",
                                  "-c:v",
                                  "mjpeg",
                                  "-q:v",
                                  "2",
                                  "-pix_fmt",
                                  "yuvj420p",
                                  (folder() / (kCameras[camera] + ".mkv")).string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }

  void make_take() const {
    const auto cameras = truth_cameras(kSample / "walk/truth/cameras.json");
    Take description;
    description.trial = "walk";
    for (const std::string& name : kCameras) {
      description.cameras.push_back(
          {name, name + ".mkv", 1280, 720, {kRate}, "", "", {}});
    }
    auto writer = TakeWriter::create(take(), description);
    ASSERT_TRUE(writer) << writer.error().message();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> jitter_s(-0.003, 0.003);
    for (std::size_t c = 0; c < kCameras.size(); ++c) {
      const double lag_s = cameras ? (*cameras)[c].offset_s : 0.0;
      int dropped = 0;
      for (int k = 0; k < kFrames; ++k) {
        const double time_s = 7000.0 + k / kRate + lag_s + jitter_s(random);
        if (is_dropped(c, k)) {
          ++dropped;
          continue;
        }
        recordings::TakeFrame frame;
        frame.time = from_seconds(time_s);
        frame.sequence = static_cast<unsigned>(k);
        frame.dropped_before = std::exchange(dropped, 0);
        writer->add(static_cast<int>(c), frame);
      }
    }
    ASSERT_TRUE(writer->finish());
  }

  SpoiledSession session_;
};

/// Median distance of the limbs' joints to their truth. [mm]
double median_error_mm(const SpoiledSession& session) {
  const auto truth = truth_joints(kSample / "walk/truth/joints.csv");
  const auto rows = recordings::read_joints_csv(session.out() / "walk/joints.csv");
  EXPECT_TRUE(truth);
  EXPECT_TRUE(rows);
  if (!truth || !rows) return 1e9;
  std::vector<double> errors_mm;
  for (const recordings::JointRow& row : *rows) {
    const auto bone = human_bone(row.joint);
    const auto known = bone ? truth->find({row.frame, *bone}) : truth->end();
    if (known == truth->end()) continue;
    errors_mm.push_back(1000.0 * glm::distance(row.p_in_world, known->second));
  }
  EXPECT_GT(errors_mm.size(), 500U);
  std::sort(errors_mm.begin(), errors_mm.end());
  return errors_mm[errors_mm.size() / 2];
}

int error_lines(const std::string& err) {
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
  EXPECT_EQ(report.at("trials").at(0).at("frames"), kFrames);
  EXPECT_NEAR(report.at("trials").at(0).at("rate_hz"), kRate, 0.03);
  EXPECT_NE(warnings_of(run).find("cam3.mkv: 10 frames were dropped while recording"),
            std::string::npos)
      << warnings_of(run);
}

TEST(RecordedTake, ThatWasCutOffIsUsedAndTold) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(walk.take().c_str(), &database), SQLITE_OK);
  // The last moments of one camera's times, and of another's video.
  ASSERT_EQ(sqlite3_exec(database,
                         "UPDATE take SET finished=0; DELETE FROM frame WHERE camera=0 "
                         "AND number>=80",
                         nullptr,
                         nullptr,
                         nullptr),
            SQLITE_OK);
  sqlite3_close(database);
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
  EXPECT_EQ(error_lines(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("take.sqlite: it is missing"), std::string::npos) << run.err;
}

TEST(RecordedTake, OfANewerVersionIsDeclined) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(walk.take().c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "PRAGMA user_version=9", nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  const ProgramRun run = walk.session().run("track");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(error_lines(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("recorded by a newer marey (format 9"), std::string::npos);
}

TEST(RecordedTake, GoesOnWithoutAVideoThatIsLostOrEmptyAndEndsWith3) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const RecordedWalk walk;
  fs::remove(walk.folder() / "cam1.mkv");
  const ProgramRun lost = walk.session().run();
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_EQ(error_lines(lost.err), 1) << lost.err;
  EXPECT_NE(lost.err.find("trial walk has no recording of camera \"cam1\""),
            std::string::npos);
  EXPECT_TRUE(walk.session().has_result("walk/joints.csv"));
  ASSERT_TRUE(recordings::write_file(walk.folder() / "cam1.mkv", ""));
  const ProgramRun empty = walk.session().run();
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_EQ(error_lines(empty.err), 1) << empty.err;
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

// A phone's video: frames at times of their own.
TEST(UnevenVideo, IsUsedByItsOwnTimesAndTold) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  SpoiledSession session;
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
  const ProgramRun run = session.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(warnings_of(run).find("its frame rate varies"), std::string::npos);
  EXPECT_NE(warnings_of(run).find("its own times are used"), std::string::npos);
  EXPECT_LT(median_error_mm(session), 6.0);
}

}  // namespace
}  // namespace marey::testing
