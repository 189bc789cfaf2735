// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/marker_file.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {

/// A folder with walk.c3d (4 markers, 2 analog channels of 4 samples a frame, a point
/// with angles, 240 frames from number 21 at 120 Hz, events) and walk.trc with its
/// markers.
class MarkerEditFolder {
 public:
  MarkerEditFolder() {
    write_c3d("walk.c3d", 1);
    const auto read = recordings::read_markers(folder_ / "walk.c3d");
    EXPECT_TRUE(read) << read.error().message();
    recordings::MarkerWriteOptions options;
    options.axes = read->axes;
    options.axes->up = recordings::FileAxis::kPlusY;
    EXPECT_TRUE(recordings::write_markers(folder_ / "walk.trc", *read, options));
  }

  /// The third marker is not seen from frame 100 to 109.
  void write_c3d(const std::string& name, std::uint64_t seed) const {
    recordings::C3dInfo info;
    info.points = 5;
    info.analog_channels = 2;
    info.analog_per_frame = 4;
    info.rate_hz = 120.0;
    info.scale = 0.01;
    info.first_frame = 21;
    info.frames = 240;
    put_texts(info.groups, "POINT", "LABELS", {"LASI", "RASI", "LKNE", "RKNE", "Angle"});
    put_texts(info.groups, "POINT", "ANGLES", {"Angle"});
    put_texts(info.groups, "POINT", "UNITS", {"mm"});
    put_texts(info.groups, "POINT", "X_SCREEN", {"+X"});
    put_texts(info.groups, "POINT", "Y_SCREEN", {"+Z"});
    put_texts(info.groups, "LAB", "OPERATOR", {"the laboratory"});
    put_events(info);
    auto writer = recordings::C3dWriter::create(folder_ / name, info);
    ASSERT_TRUE(writer) << writer.error().message();
    Dice dice(seed);
    for (int t = 0; t < 240; ++t) {
      recordings::C3dFrame frame;
      for (int m = 0; m < 4; ++m) {
        const bool is_seen = m != 2 || t < 100 || t > 109;
        const double phase = 0.1 * t + m;
        const glm::dvec3 p{10.0 * t + dice.noise(2.0),
                           100.0 * m + 30.0 * std::sin(phase) + dice.noise(2.0),
                           900.0 - 100.0 * m + 20.0 * std::cos(phase) + dice.noise(2.0)};
        for (int axis = 0; axis < 3; ++axis) {
          frame.points.push_back(is_seen ? static_cast<float>(p[axis]) : 0.0F);
        }
        frame.points.push_back(is_seen ? static_cast<float>(0x0300 + 40) : -1.0F);
      }
      for (const float word : {1.0F * static_cast<float>(t), 2.0F, 3.0F, 0.0F}) {
        frame.points.push_back(word);
      }
      for (int s = 0; s < 8; ++s) {
        frame.analog.push_back(static_cast<float>(10 * t + s));
      }
      writer->append(frame);
    }
    const Status done = writer->commit();
    ASSERT_TRUE(done) << done.error().message();
  }

  void write_recipe(const std::string& operations,
                    const std::string& source = "walk.c3d",
                    const std::string& name = "a") const {
    const std::string text = "format = 1\nname = \"" + name + "\"\n[source]\npath = \"" +
                             source + "\"\n" + operations;
    EXPECT_TRUE(recordings::write_file(folder_ / (name + ".edit.toml"), text));
  }
  [[nodiscard]] ProgramRun run(std::vector<std::string> more = {},
                               const std::string& recipe = "a.edit.toml") const {
    std::vector<std::string> arguments{"edit", recipe, "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(std::move(arguments));
  }
  [[nodiscard]] ProgramRun call(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"--progress", "none"});
    return run_program(
        program(), arguments, {.folder = folder_.path(), .interrupt_at = {}});
  }
  [[nodiscard]] recordings::MarkerFile read(const std::string& name) const {
    auto file = recordings::read_markers(folder_ / name);
    EXPECT_TRUE(file) << file.error().message();
    return file ? *std::move(file) : recordings::MarkerFile{};
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  [[nodiscard]] std::string bytes(const std::string& name) const {
    const auto text = recordings::read_file(folder_ / name);
    return text ? *text : "missing";
  }

 private:
  static void put_events(recordings::C3dInfo& info) {
    put_texts(info.groups, "EVENT", "LABELS", {"Foot Strike", "Foot Off", "Foot Strike"});
    put_texts(info.groups, "EVENT", "CONTEXTS", {"Left", "Left", "Left"});
    put_texts(info.groups, "EVENT", "SUBJECTS", {"Ann", "Ann", "Ann"});
    put_parameter(info.groups,
                  "EVENT",
                  {"TIMES",
                   "",
                   false,
                   {2, 3},
                   recordings::C3dReals{0.0F, 0.5F, 0.0F, 1.0F, 0.0F, 1.5F}});
    put_parameter(
        info.groups, "EVENT", {"USED", "", false, {}, recordings::C3dIntegers{3}});
  }

  ScratchFolder folder_;
};

}  // namespace marey::testing
