// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes that end before their first frame, takes of another body, and the files in their
// folders.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "app/live/live_takes.h"
#include "app/live/live_wizard.h"
#include "app/live_chain/open_live_take.h"
#include "recordings/session/subject_file.h"
#include "tests/support/bodies/synthetic_person.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

constexpr double kTakeRate_hz = 30.0;

/// A person who stands still before four cameras, for as many instants as a test needs.
class TakesOfARun : public ::testing::Test {
 protected:
  void SetUp() override {
    live_.session = "a run";
    live_.calibration.cameras = testing::ring_of_cameras();
    const std::size_t cameras = live_.calibration.cameras.size();
    live_.calibration.quality.resize(cameras);
    live_.calibration.clocks.resize(cameras);
    live_.body = testing::tagged_person();
    live_.body->name = "first";
    live_.settings.rate = FrameRate{kTakeRate_hz};
    film_ = testing::film(*live_.body,
                          testing::standing(*live_.body),
                          live_.calibration.cameras,
                          {1, kTakeRate_hz, "stand", {}, {}, {}});
    chain_.emplace(chain_of(*live_.body));
    takes_.emplace(live_, folder_ / "live", console_);
  }

  [[nodiscard]] LiveChain chain_of(const Body& body) const {
    auto chain =
        LiveChain::make(body, live_.calibration.cameras, live_.avatars, live_.settings);
    EXPECT_TRUE(chain) << chain.error().message();
    return *std::move(chain);
  }

  [[nodiscard]] LiveInstant instant() {
    LiveInstant out;
    out.number = number_++;
    out.time = Timestamp(
        static_cast<std::int64_t>(1e9 * static_cast<double>(out.number) / kTakeRate_hz));
    for (std::size_t c = 0; c < film_.size(); ++c) {
      out.views.push_back(
          {CameraId{static_cast<int>(c)}, out.time, film_[c].frames[0].tags});
    }
    return out;
  }

  /// An instant as a run has it.
  void play() {
    const LiveInstant seen = instant();
    takes_->add(seen, {}, chain_->step(seen, {}), *chain_);
  }

  /// Instants until something is recorded that can be replayed.
  [[nodiscard]] bool play_until_recorded() {
    for (int i = 0; i < 5000; ++i) {
      play();
      const auto now = takes_->state();
      if (now && now->seconds > 0.1) return true;
      // Folders and files are made meanwhile.
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

  /// Follows another body, as after a measurement, and requests a recording at once.
  void follow_another() {
    Body other = *live_.body;
    other.name = "second";
    chain_.emplace(chain_of(other));
    takes_->follow(other);
    takes_->want(true);
  }

  [[nodiscard]] static std::string body_of(const std::filesystem::path& take) {
    const auto body = recordings::read_subject(take / "subject.toml");
    EXPECT_TRUE(body);
    return body ? body->name : "";
  }

  testing::ScratchFolder folder_;
  Console console_{ProgressStyle::kQuiet};
  OpenedLive live_;
  std::vector<CameraDetections> film_;
  std::int64_t number_ = 0;
  std::optional<LiveChain> chain_;
  std::optional<LiveTakes> takes_;
};

TEST_F(TakesOfARun, AreTakenAwayWhenTheyEndBeforeTheirFirstFrame) {
  for (int i = 0; i < 3; ++i) play();
  takes_->want(true);
  play();
  takes_->want(false);
  play();
  EXPECT_TRUE(takes_->finish());
  EXPECT_TRUE(takes_->finished().empty());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "live-1"));
  takes_->want(true);
  ASSERT_TRUE(play_until_recorded());
  EXPECT_TRUE(takes_->finish());
  ASSERT_EQ(takes_->finished().size(), 1U);
  const auto take = open_live_take(takes_->finished().front());
  ASSERT_TRUE(take) << take.error().message();
  EXPECT_FALSE(take->take.instants.back().results.empty());
}

TEST_F(TakesOfARun, AreRemovedWhenAWholeRunHasNoFrame) {
  const auto folder = folder_ / "whole";
  std::filesystem::create_directory(folder);
  ASSERT_TRUE(takes_->begin_with_run(folder));
  EXPECT_FALSE(std::filesystem::is_empty(folder));
  EXPECT_TRUE(takes_->finish());
  EXPECT_TRUE(takes_->finished().empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

// The disk has room: it is the name that is wrong.
TEST_F(TakesOfARun, AreNotRecordedIntoFiles) {
  const auto file = folder_ / "taken";
  std::ofstream(file).flush();
  for (const auto& folder : {file, file / "take"}) {
    const Status ok = takes_->begin_with_run(folder);
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().code, Errc::kBadInput);
    EXPECT_NE(ok.error().cause.find("file, and a take needs a folder"), std::string::npos)
        << ok.error().message();
    EXPECT_EQ(ok.error().next.find("disk"), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

TEST_F(TakesOfARun, EndWithTheirBody) {
  takes_->want(true);
  ASSERT_TRUE(play_until_recorded());
  follow_another();
  ASSERT_TRUE(play_until_recorded());
  EXPECT_TRUE(takes_->finish());
  ASSERT_EQ(takes_->finished().size(), 2U);
  EXPECT_EQ(body_of(takes_->finished()[0]), "first");
  EXPECT_EQ(body_of(takes_->finished()[1]), "second");
}

TEST_F(TakesOfARun, AreNotOfABodyThatWasFollowedAsTheyWereOpened) {
  takes_->want(true);
  play();  // Opens one, which is not there yet.
  follow_another();
  ASSERT_TRUE(play_until_recorded());
  EXPECT_TRUE(takes_->finish());
  ASSERT_EQ(takes_->finished().size(), 1U);
  EXPECT_EQ(body_of(takes_->finished().front()), "second");
}

TEST_F(TakesOfARun, KnowTheirCamerasByName) {
  takes_->want(true);
  ASSERT_TRUE(play_until_recorded());
  EXPECT_TRUE(takes_->finish());
  const std::filesystem::path take = takes_->finished().front();
  ASSERT_TRUE(open_live_take(take));
  recordings::Calibration other = live_.calibration;
  std::swap(other.cameras[0], other.cameras[1]);
  ASSERT_TRUE(recordings::write_calibration(take / "calibration.toml", other));
  const auto swapped = open_live_take(take);
  ASSERT_TRUE(swapped);
  EXPECT_EQ(swapped->calibration.cameras[0].name, live_.calibration.cameras[0].name);
  other.cameras[0].name = "door";
  ASSERT_TRUE(recordings::write_calibration(take / "calibration.toml", other));
  const auto renamed = open_live_take(take);
  ASSERT_FALSE(renamed);
  EXPECT_NE(renamed.error().message().find("the cameras of the take"), std::string::npos);
}

// Two avatars have the same name in two folders, and two kinds of avatars share one bone
// map.
TEST_F(TakesOfARun, KeepAvatarsWhoseNamesAreAlike) {
  const std::filesystem::path root = folder_.path();
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directory(root / folder);
    for (const char* name : {"x.glb", "x.vrm", "x.bones.toml"}) {
      std::ofstream(root / folder / name) << folder << name;
    }
  }
  for (const char* file : {"a/x.glb", "b/x.glb", "b/x.vrm"}) {
    live_.avatars.push_back({});
    live_.avatars.back().file = root / file;
    live_.settings.avatars.push_back(shown_name(file));
  }
  auto recorder = LiveRecorder::create(root / "take", live_, *live_.body, live_.settings);
  ASSERT_TRUE(recorder) << recorder.error().message();
  ASSERT_TRUE((*recorder)->finish());
  const auto content = [&](const char* name) {
    std::ifstream in(root / "take/avatars" / name);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(content("1.glb"), "ax.glb");
  EXPECT_EQ(content("1.bones.toml"), "ax.bones.toml");
  EXPECT_EQ(content("2.glb"), "bx.glb");
  EXPECT_EQ(content("3.vrm"), "bx.vrm");
  EXPECT_EQ(content("3.bones.toml"), "bx.bones.toml");
}

// A run that has ended does not wait for a subject to stand still.
TEST_F(TakesOfARun, MeasureNoSubjectAfterTheEnd) {
  live_.prior = {"first", 1.75, std::nullopt, testing::tags_of(*live_.body)};
  live_.subject_file = folder_ / "subject.toml";
  LiveWizard wizard(live_, {.begin = true, .by_itself = true}, console_);
  for (int i = 0; i < 5; ++i) wizard.process(instant());
  wizard.end();
  EXPECT_EQ(wizard.ui_state().step, live::WizardStep::kFailed);
  EXPECT_FALSE(wizard.has_measured());
}

}  // namespace
}  // namespace marey::app
