// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/process/recorded_walk.h"

#include <algorithm>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "recordings/motion/motion_tables.h"
#include "tests/support/files/video_packets.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/truth/truth.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kSample = marey::testing::sample_session();

}  // namespace

const std::vector<std::string>& RecordedWalk::cameras() {
  static const std::vector<std::string> names{"cam0", "cam1", "cam2", "cam3"};
  return names;
}

bool RecordedWalk::is_dropped(std::size_t camera, int k) {
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

RecordedWalk::RecordedWalk(Made made) {
  for (std::size_t c = 0; c < cameras().size(); ++c) {
    session_.replace("name = \"" + cameras()[c] + "\"",
                     "name = \"" + cameras()[c] + "\"\ndevice = \"/dev/video" +
                         std::to_string(c) + "\"");
  }
  session_.replace_in_trial(
      "walk",
      "videos = { cam0 = \"walk/cam0.mp4\", cam1 = \"walk/cam1.mp4\", cam2 = "
      "\"walk/cam2.mp4\", cam3 = \"walk/cam3.mp4\" }\n",
      "");
  fs::remove_all(session_.out() / "walk");  // Detections in the sample's videos.
  if (made == Made::kNothing) return;
  fs::create_directories(folder());
  for (std::size_t c = 0; c < cameras().size(); ++c) make_video(c);
  make_take();
}

void RecordedWalk::make_video(std::size_t camera) const {
  std::string keep = "select='1";
  for (int k = 0; k < kWalkFrames; ++k) {
    if (is_dropped(camera, k)) keep += "*not(eq(n," + std::to_string(k) + "))";
  }
  const auto run = run_program(kFfmpeg,
                               {"-v",
                                "error",
                                "-i",
                                SpoiledSession::sample_video("walk", cameras()[camera]),
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
                                (folder() / (cameras()[camera] + ".mkv")).string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

std::vector<std::vector<Timestamp>> RecordedWalk::times() {
  const auto truth = truth_cameras(kSample / "walk/truth/cameras.json");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> jitter_s(-0.003, 0.003);
  std::vector<std::vector<Timestamp>> all;
  for (std::size_t c = 0; c < cameras().size(); ++c) {
    const double lag_s = truth ? (*truth)[c].offset_s : 0.0;
    auto& times = all.emplace_back();
    for (int k = 0; k < kWalkFrames; ++k) {
      times.push_back(from_seconds(7000.0 + k / kWalkRate_hz + lag_s + jitter_s(random)));
    }
  }
  return all;
}

void RecordedWalk::make_take() const {
  recordings::Take description;
  description.trial = "walk";
  for (const std::string& name : cameras()) {
    description.cameras.push_back(
        {name, name + ".mkv", 1280, 720, {kWalkRate_hz}, "", "", {}});
  }
  auto writer = recordings::TakeWriter::create(take(), description);
  ASSERT_TRUE(writer) << writer.error().message();
  const auto all = times();
  for (std::size_t c = 0; c < cameras().size(); ++c) {
    int dropped = 0;
    for (int k = 0; k < kWalkFrames; ++k) {
      if (is_dropped(c, k)) {
        ++dropped;
        continue;
      }
      recordings::TakeFrame frame;
      frame.time = all[c][static_cast<std::size_t>(k)];
      frame.sequence = static_cast<unsigned>(k);
      frame.dropped_before = std::exchange(dropped, 0);
      writer->add(static_cast<int>(c), frame);
    }
  }
  ASSERT_TRUE(writer->finish());
}

void RecordedWalk::spoil_take(const std::string& statements) const {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(take().c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
}

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

}  // namespace marey::testing
