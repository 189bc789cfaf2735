// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/sync/align_frames.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace marey::capture {
namespace {

using Recorded = std::vector<std::optional<int>>;

Timestamp ms(double value) {
  return from_seconds(1e-3 * value);
}

/// A camera of 100 Hz: frame k at 10 k + lag, jittered, without the frames in `dropped`.
CameraTimes camera(int id,
                   double lag_ms,
                   double jitter_ms,
                   const std::vector<int>& dropped,
                   double rate_hz = 100.0) {
  std::mt19937 random(static_cast<unsigned>(id + 1));
  std::uniform_real_distribution<double> jitter(-jitter_ms, jitter_ms);
  CameraTimes out;
  out.camera = CameraId{id};
  for (int k = 0; k < 200; ++k) {
    const double time_ms = 5e6 + 1000.0 * k / rate_hz + lag_ms + jitter(random);
    if (std::find(dropped.begin(), dropped.end(), k) != dropped.end()) continue;
    out.times.push_back(ms(time_ms));
  }
  return out;
}

/// Returns the expected result of align_frames(): the frames' own numbers, without
/// counting dropped frames.
Recorded numbers(const std::vector<int>& dropped) {
  Recorded out;
  int next = 0;
  for (int k = 0; k < 200; ++k) {
    const bool lost = std::find(dropped.begin(), dropped.end(), k) != dropped.end();
    out.push_back(lost ? std::optional<int>() : std::optional(next++));
  }
  return out;
}

TEST(AlignFrames, PutsDroppedFramesAtTheirNumbers) {
  const std::vector<std::vector<int>> dropped{{3, 4, 5, 77}, {}, {0, 1, 120}};
  const std::vector<CameraTimes> cameras{camera(0, 0.0, 0.0, dropped[0]),
                                         camera(1, 4.0, 0.0, dropped[1]),
                                         camera(2, -4.5, 0.0, dropped[2])};
  const auto found = align_frames(cameras);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rate.hz, 100.0, 1e-6);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(found->cameras[c].recorded, numbers(dropped[c])) << c;
    EXPECT_EQ(found->cameras[c].surplus, 0);
  }
  EXPECT_NEAR(seconds(found->cameras[0].offset), 0.0, 1e-9);
  EXPECT_NEAR(seconds(found->cameras[1].offset), 0.004, 1e-8);
  EXPECT_NEAR(seconds(found->cameras[2].offset), -0.0045, 1e-8);
}

// Jitter of a third of a period, lags up to nearly the middle between two instants.
TEST(AlignFrames, BearsJitter) {
  for (const double lag_ms : {-4.3, -2.0, 3.0, 4.3}) {
    const std::vector<CameraTimes> cameras{camera(0, 0.0, 3.0, {9}),
                                           camera(1, lag_ms, 3.0, {50, 51})};
    const auto found = align_frames(cameras);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cameras[0].recorded, numbers({9}));
    EXPECT_EQ(found->cameras[1].recorded, numbers({50, 51})) << lag_ms;
    // 200 frames with a jitter of sigma 1.7 ms in both cameras.
    EXPECT_NEAR(seconds(found->cameras[1].offset), 1e-3 * lag_ms, 1e-3) << lag_ms;
    EXPECT_GT(seconds(found->cameras[1].spread), 2e-3);
    EXPECT_LT(seconds(found->cameras[1].spread), 3.5e-3);
  }
}

TEST(AlignFrames, GivesACameraOfHalfTheRateEverySecondInstant) {
  const std::vector<CameraTimes> cameras{camera(0, 0.0, 0.0, {}),
                                         camera(1, 1.0, 0.0, {}, 50.0)};
  const auto found = align_frames(cameras);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rate.hz, 100.0, 1e-6);
  const Recorded& slow = found->cameras[1].recorded;
  ASSERT_GE(slow.size(), 4U);
  EXPECT_EQ(slow[0], 0);
  EXPECT_EQ(slow[1], std::nullopt);
  EXPECT_EQ(slow[2], 1);
}

TEST(AlignFrames, CountsSurplusFramesOfAFasterCamera) {
  const std::vector<CameraTimes> cameras{camera(0, 0.0, 0.0, {}),
                                         camera(1, 0.0, 0.0, {}, 104.0)};
  const auto found = align_frames(cameras, FrameRate{100.0});
  ASSERT_TRUE(found);
  // 200 frames in 192 periods.
  EXPECT_NEAR(found->cameras[1].surplus, 8, 1);
}

TEST(AlignFrames, DeclinesTimesWithoutARate) {
  const std::vector<CameraTimes> none{{CameraId{0}, {}}};
  EXPECT_FALSE(align_frames(none));
  const std::vector<CameraTimes> one{{CameraId{0}, {ms(3), ms(13)}}};
  EXPECT_FALSE(align_frames(one));
  EXPECT_TRUE(align_frames(one, FrameRate{100.0}));
  const std::vector<Timestamp> still(5, ms(3));
  EXPECT_FALSE(measured_rate(still));
}

// A month between two frames would be a hundred million instants.
TEST(AlignFrames, DeclinesATimeStampThatIsFarOff) {
  CameraTimes wild = camera(0, 0.0, 0.0, {});
  wild.times.back() += std::chrono::hours(24 * 35);
  const std::vector<CameraTimes> within{wild, camera(1, 0.0, 0.0, {})};
  EXPECT_FALSE(align_frames(within));
  CameraTimes elsewhere = camera(1, 0.0, 0.0, {});
  for (Timestamp& time : elsewhere.times) time += std::chrono::hours(24 * 35);
  const std::vector<CameraTimes> between{camera(0, 0.0, 0.0, {}), elsewhere};
  EXPECT_FALSE(align_frames(between));
}

TEST(AlignFrames, BearsAMinuteWithoutFrames) {
  CameraTimes pausing = camera(0, 0.0, 0.0, {});
  for (std::size_t k = 100; k < 200; ++k) pausing.times[k] += std::chrono::minutes(1);
  const auto found = align_frames(std::span(&pausing, 1));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->cameras[0].recorded.size(), 6200U);
  EXPECT_EQ(found->cameras[0].recorded[6100], 100);
}

TEST(MeasuredRate, IsThatOfTheStreamWhateverIsMissing) {
  CameraTimes times = camera(0, 0.0, 0.0, {1, 2, 3, 4, 60, 61, 150}, 29.97);
  const auto rate = measured_rate(times.times);
  ASSERT_TRUE(rate);
  EXPECT_NEAR(rate->hz, 29.97, 1e-5);
}

}  // namespace
}  // namespace marey::capture
