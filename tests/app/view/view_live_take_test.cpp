// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A take of a live run, shown as it was.
#include "app/view/view_live_take.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/live_chain/live_chain.h"
#include "app/view/view_files.h"
#include "recordings/session/calibration_file.h"
#include "recordings/session/subject_file.h"
#include "recordings/takes/live_take.h"
#include "tests/support/bodies/synthetic_person.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_hz = 30.0;
constexpr int kTakeFrames = 36;
constexpr int kLeadIn = 5;
constexpr int kPassedOver = 20;

class ViewLiveTake : public ::testing::Test {
 protected:
  void SetUp() override {
    recordings::Calibration calibration;
    calibration.cameras = cameras_;
    calibration.quality.resize(cameras_.size());
    calibration.clocks.resize(cameras_.size());
    ASSERT_TRUE(recordings::write_calibration(folder_ / "calibration.toml", calibration));
    ASSERT_TRUE(recordings::write_subject(folder_ / "subject.toml", body_));
    settings_.rate = {kRate_hz};
    settings_.lag_known.assign(cameras_.size(), true);
    marey::testing::Film how;
    how.frames = kTakeFrames;
    how.hz = kRate_hz;
    const auto seen =
        marey::testing::film(body_, marey::testing::walking(body_), cameras_, how);
    for (int f = 0; f < kTakeFrames; ++f) {
      if (f == kPassedOver) continue;
      LiveInstant instant;
      instant.number = 100 + f;
      instant.time = Timestamp{std::llround(1e9 * (1.0 + f / kRate_hz))};
      for (std::size_t c = 0; c < cameras_.size(); ++c) {
        instant.views.push_back({CameraId{static_cast<int>(c)},
                                 instant.time,
                                 seen[c].frames[static_cast<std::size_t>(f)].tags});
      }
      instants_.push_back(std::move(instant));
    }
  }

  void write(int frames) {
    recordings::LiveTakeHead head;
    head.session = "room";
    head.started = "2026-11-21T11:56:29Z";
    head.rate = {kRate_hz};
    for (const Camera& camera : cameras_) head.cameras.push_back(camera.name);
    head.settings = live_settings_text(settings_);
    auto writer = recordings::LiveTakeWriter::create(folder_ / "live.sqlite", head);
    ASSERT_TRUE(writer) << writer.error().message();
    for (int i = 0; i < frames; ++i) {
      const std::vector<std::byte> results(i < kLeadIn ? 0 : 1);
      ASSERT_TRUE(writer->add(
          {instants_[static_cast<std::size_t>(i)], live_requests_text({}), results}));
    }
    ASSERT_TRUE(writer->finish());
  }

  const Body body_ = marey::testing::tagged_person();
  const std::vector<Camera> cameras_ = marey::testing::ring_of_cameras();
  LiveSettings settings_;
  std::vector<LiveInstant> instants_;
  const marey::testing::ScratchFolder folder_;
};

TEST_F(ViewLiveTake, ShowsTheBodyAsItWasLive) {
  write(kTakeFrames - 1);
  auto chain = LiveChain::make(body_, cameras_, {}, settings_);
  ASSERT_TRUE(chain);
  std::vector<Pose> live;
  for (const LiveInstant& instant : instants_) {
    live.push_back(*chain->step(instant, {}).pose);
  }
  for (const fs::path& what : {folder_.path(), folder_ / "live.sqlite"}) {
    const auto view = read_view({what, "", {}});
    ASSERT_TRUE(view) << view.error().message();
    EXPECT_EQ(view->rate.hz, kRate_hz);
    EXPECT_EQ(view->cameras.size(), cameras_.size());
    ASSERT_EQ(view->frames, kTakeFrames - kLeadIn) << "with the one that was passed over";
    ASSERT_EQ(view->figures.size(), 1U);
    const std::vector<Pose>& shown = view->figures.front().motion.poses;
    ASSERT_EQ(shown.size(), static_cast<std::size_t>(view->frames));
    for (int f = kLeadIn; f < kTakeFrames; ++f) {
      // The one that was passed over shows the one before.
      const int i = f < kPassedOver ? f : f - 1;
      const Pose& expected = live[static_cast<std::size_t>(i)];
      const Pose& pose = shown[static_cast<std::size_t>(f - kLeadIn)];
      EXPECT_EQ(pose.root_in_world, expected.root_in_world) << f;
      EXPECT_EQ(pose.parent_from_joint, expected.parent_from_joint) << f;
    }
    ASSERT_EQ(view->graphs.front().values.size(), shown.size());
    EXPECT_LT(*std::ranges::max_element(view->graphs.front().values), 1.0);
    EXPECT_FALSE(view->tracks.empty());
  }
}

TEST_F(ViewLiveTake, ReportsThatNoSubjectWasFound) {
  write(kLeadIn);
  const auto view = read_view({folder_.path(), "", {}});
  ASSERT_FALSE(view);
  EXPECT_NE(view.error().message().find("Next: "), std::string::npos);
}

}  // namespace
}  // namespace marey::app
