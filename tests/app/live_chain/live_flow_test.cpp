// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A live run whose poses do not keep up, by a clock that the tests turn.
#include "app/live_chain/live_flow.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/live/live_watchdog.h"
#include "live/udp/udp_listener.h"
#include "live/vmc/vmc_assembler.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;

constexpr double kFlowRate_hz = 30.0;

Timestamp frame_time_of(double time_s) {
  return Timestamp(1'000'000'000'000 + std::llround(1e9 * time_s));
}

/// A run as its loop sees it: pictures come at a rate, of which some become poses.
class PlayedRun {
 public:
  explicit PlayedRun(double rate_hz = kFlowRate_hz)
      : rate_hz_(rate_hz), flow({rate_hz}, frame_time_of(0.0)) {}

  /// Runs until `end_s` with pictures at `pictures_hz`. `becomes_pose` selects the
  /// pictures that become poses. The loop looks at every pose, and ten times a second.
  void go_on(double end_s,
             double pictures_hz,
             const std::function<bool(long picture)>& becomes_pose) {
    constexpr double kTick_s = 1e-3;
    for (; time_s < end_s; time_s += kTick_s) {
      bool looks = time_s - last_look_s_ >= 0.1;
      if (pictures_hz > 0.0 && time_s >= next_picture_s_) {
        next_picture_s_ = std::max(next_picture_s_, time_s - kTick_s) + 1.0 / pictures_hz;
        if (becomes_pose(++pictures_)) {
          flow.on_instant(frame_time_of(time_s));
          looks = true;
        }
      }
      if (!looks) continue;
      last_look_s_ = time_s;
      const Flow now = flow.update(frame_time_of(time_s), pictures_);
      if (now != Flow::kSteady && !trouble_since_s) trouble_since_s = time_s;
      if (now == Flow::kSteady) trouble_since_s.reset();
    }
  }

  void keep_up_until(double end_s) {
    go_on(end_s, rate_hz_, [](long) { return true; });
  }

  double time_s = 0.0;
  std::optional<double> trouble_since_s;

 private:
  double rate_hz_;
  double next_picture_s_ = 0.05;
  double last_look_s_ = 0.0;
  long pictures_ = 0;

 public:
  LiveFlow flow;
};

TEST(LiveFlow, IsSteadyWhilePosesKeepUp) {
  for (const double rate_hz : {5.0, 10.0, 30.0, 60.0, 120.0}) {
    PlayedRun run(rate_hz);
    run.keep_up_until(20.0);
    EXPECT_EQ(run.flow.flow(), Flow::kSteady) << rate_hz;
    EXPECT_EQ(run.flow.troubled_s(), 0.0) << rate_hz;
    EXPECT_EQ(run.flow.text(), "");
  }
}

// A webcam in the dark has fewer pictures; half of the pictures are enough to follow.
TEST(LiveFlow, IsSteadyWithSlowCamerasAndWithHalfOfThePictures) {
  PlayedRun slow;
  slow.go_on(10.0, 12.0, [](long) { return true; });
  EXPECT_EQ(slow.flow.troubled_s(), 0.0);
  PlayedRun half;
  half.go_on(10.0, kFlowRate_hz, [](long picture) { return picture % 2 == 0; });
  EXPECT_EQ(half.flow.troubled_s(), 0.0);
}

// Six of 150 instants, as on a computer that is starved; and a tenth, a quarter.
TEST(LiveFlow, ReportsFewPosesWithinASecond) {
  for (const int one_in : {4, 10, 25}) {
    PlayedRun run;
    run.keep_up_until(3.0);
    run.go_on(8.0, kFlowRate_hz, [=](long picture) { return picture % one_in == 0; });
    ASSERT_TRUE(run.trouble_since_s) << one_in;
    EXPECT_LE(*run.trouble_since_s, 4.0) << one_in;
    EXPECT_GT(run.flow.troubled_s(), 3.9) << one_in;
    EXPECT_NE(run.flow.text(), "");
  }
}

TEST(LiveFlow, ReportsAStopWithinASecond) {
  for (const double rate_hz : {5.0, 30.0, 60.0}) {
    PlayedRun run(rate_hz);
    run.keep_up_until(3.0);
    run.go_on(8.0, 0.0, [](long) { return true; });
    EXPECT_EQ(run.flow.flow(), Flow::kStopped) << rate_hz;
    ASSERT_TRUE(run.trouble_since_s) << rate_hz;
    EXPECT_LE(*run.trouble_since_s, 4.0) << rate_hz;
    EXPECT_NE(run.flow.text().find("no new pose for 5"), std::string::npos)
        << run.flow.text();
  }
}

TEST(LiveFlow, IsSteadyAgainAfterASecondAndAHalf) {
  PlayedRun run;
  run.keep_up_until(3.0);
  run.go_on(8.0, 0.0, [](long) { return true; });
  run.keep_up_until(9.5);
  EXPECT_EQ(run.flow.flow(), Flow::kSteady);
  EXPECT_EQ(run.flow.text(), "");
}

TEST(LiveFlow, GivesTheFirstPoseTimeButNotForEver) {
  PlayedRun run;
  run.go_on(1.9, 0.0, [](long) { return true; });
  EXPECT_EQ(run.flow.flow(), Flow::kSteady);
  run.go_on(2.5, 0.0, [](long) { return true; });
  EXPECT_EQ(run.flow.flow(), Flow::kStopped);
}

/// A watchdog with a receiver of VMC.
class WatchedLive : public ::testing::Test {
 protected:
  /// Returns the tracking state of the packets since the last call; nullopt: no packet.
  std::optional<bool> received_tracking() {
    std::optional<bool> tracking;
    listener_.wait(50ms);
    for (auto packet = listener_.receive(); packet; packet = listener_.receive()) {
      assembler_.take(*packet);
      tracking = assembler_.status().tracking;
    }
    return tracking;
  }

  live::UdpListener listener_ = *live::UdpListener::open({"127.0.0.1", 0});
  LiveOutputs outputs_ =
      *LiveOutputs::open({VmcStream{}}, {{{{"127.0.0.1", listener_.port()}}}});
  Console console_{ProgressStyle::kAuto};
  live::VmcAssembler assembler_;
};

TEST_F(WatchedLive, NotifiesReceiversAndTheConsoleWithoutInstants) {
  LiveWatchdog watchdog({kFlowRate_hz}, frame_time_of(0.0), outputs_, console_);
  ::testing::internal::CaptureStderr();
  long pictures = 0;
  double time_s = 0.0;
  for (; time_s < 2.0; time_s += 1.0 / kFlowRate_hz) {
    watchdog.on_instant(frame_time_of(time_s), true);
    EXPECT_FALSE(watchdog.update(frame_time_of(time_s), ++pictures));
  }
  EXPECT_EQ(received_tracking(), std::nullopt) << "instants send their own packets";
  int changes = 0;
  for (const double end_s = time_s + 1.0; time_s < end_s; time_s += 0.1) {
    changes += watchdog.update(frame_time_of(time_s), ++pictures);
  }
  EXPECT_EQ(changes, 1);
  EXPECT_TRUE(watchdog.is_behind());
  EXPECT_EQ(received_tracking(), false);
  (void)watchdog.update(frame_time_of(time_s + 0.3), pictures);
  EXPECT_EQ(received_tracking(), false) << "it is sent repeatedly";
  for (const double end_s = time_s + 6.0; time_s < end_s; time_s += 1.0 / kFlowRate_hz) {
    watchdog.on_instant(frame_time_of(time_s), true);
    (void)watchdog.update(frame_time_of(time_s), ++pictures);
  }
  EXPECT_FALSE(watchdog.is_behind());
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("no new pose for"), std::string::npos) << said;
  EXPECT_NE(said.find("Next: close other programs"), std::string::npos) << said;
  EXPECT_NE(said.find("poses keep up with the cameras again"), std::string::npos) << said;
}

// One message, not one for each of many short gaps.
TEST_F(WatchedLive, DoesNotFloodTheConsole) {
  LiveWatchdog watchdog({kFlowRate_hz}, frame_time_of(0.0), outputs_, console_);
  ::testing::internal::CaptureStderr();
  long pictures = 0;
  for (int f = 0; f < 60 * 30; ++f) {
    const double time_s = f / kFlowRate_hz;
    ++pictures;
    if (f % 60 < 35) watchdog.on_instant(frame_time_of(time_s), true);
    (void)watchdog.update(frame_time_of(time_s), pictures);
  }
  const std::string said = ::testing::internal::GetCapturedStderr();
  std::size_t count = 0;
  for (auto place = said.find("Next:"); place != std::string::npos;
       place = said.find("Next:", place + 1)) {
    ++count;
  }
  EXPECT_EQ(count, 1U) << said;
}

}  // namespace
}  // namespace marey::app
