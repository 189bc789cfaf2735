// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/markers/c3d.h"

namespace marey::recordings {

/// A small file with all features: three points, two channels of four samples a frame,
/// parameters of every type, events.
inline C3dInfo example_info(C3dProcessor processor, C3dNumbers numbers) {
  C3dInfo info;
  info.processor = processor;
  info.numbers = numbers;
  info.points = 3;
  info.analog_channels = 2;
  info.analog_per_frame = 4;
  info.rate_hz = 120.0;
  info.scale = 0.125;
  info.first_frame = 7;
  info.frames = 5;
  info.interpolation_gap = 10;
  put_texts(info.groups, "POINT", "LABELS", {"LHEE", "RHEE", "SACR"});
  put_texts(info.groups, "POINT", "UNITS", {"mm"});
  put_texts(info.groups, "POINT", "X_SCREEN", {"+X"});
  put_texts(info.groups, "POINT", "Y_SCREEN", {"+Z"});
  put_parameter(info.groups,
                "LAB",
                {"MATRIX", "of reals", true, {2, 3}, C3dReals{1, -2, 0.5F, 1e-3F, 4, 5}});
  put_parameter(info.groups, "LAB", {"FLAGS", "", false, {3}, C3dBytes{-1, 0, 127}});
  put_parameter(info.groups, "LAB", {"COUNT", "one", false, {}, C3dIntegers{-300}});
  put_parameter(info.groups, "LAB", {"NOTHING", "", false, {0}, C3dIntegers{}});
  info.header_events = {{"LHS", 0.25, true}, {"RTO", 0.5, false}};
  return info;
}

/// Its frames, in words that both integers and reals can represent.
inline std::vector<C3dFrame> example_frames(const C3dInfo& info) {
  std::vector<C3dFrame> frames;
  for (int f = 0; f < info.frames; ++f) {
    C3dFrame frame;
    for (int p = 0; p < info.points; ++p) {
      const bool seen = f != p;
      for (int i = 0; i < 3; ++i) {
        const int word = 4000 * (i + 1) * (p == 1 ? -1 : 1) + 31 * f + p;
        frame.points.push_back(seen ? static_cast<float>(word) : 0.0F);
      }
      // Cameras 1, 3 and 7, residual of 11 steps.
      frame.points.push_back(seen ? static_cast<float>(0x4500 + 11) : -1.0F);
    }
    for (int s = 0; s < info.analog_channels * info.analog_per_frame; ++s) {
      frame.analog.push_back(static_cast<float>(1000 * s - 32000 * (s % 2) + f));
    }
    frames.push_back(frame);
  }
  return frames;
}

inline void write_frames(const std::filesystem::path& path,
                         const C3dInfo& info,
                         const std::vector<C3dFrame>& frames) {
  Result<C3dWriter> writer = C3dWriter::create(path, info);
  ASSERT_TRUE(writer) << writer.error().message();
  for (const C3dFrame& frame : frames) writer->append(frame);
  const Status done = writer->commit();
  ASSERT_TRUE(done) << done.error().message();
}

inline std::vector<C3dFrame> frames_of(C3dReader& reader) {
  std::vector<C3dFrame> frames;
  C3dFrame frame;
  for (;;) {
    const Result<bool> more = reader.next(frame);
    EXPECT_TRUE(more) << more.error().message();
    if (!more || !*more) return frames;
    frames.push_back(frame);
  }
}

}  // namespace marey::recordings
