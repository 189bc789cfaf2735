// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/session/session.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {

/// A complete session, without its videos.
inline constexpr std::string_view kSession = R"(format = 1
name = "dev"
media = "videos"
[subject]
name = "S16"
stature_m = 1.734
mass_kg = 70
[tags]
family = "tag36h11"
[[tags.tag]]
id = 41
segment = "hips"
size_m = 0.09
[[tags.tag]]
id = 73
segment = "head"
size_m = 0.075
[board]
type = "aprilgrid"
rows = 6
columns = 5
tag_size_m = 0.1
gap_m = 0.03
first_id = 0
thickness_m = 0.005
[[camera]]
name = "right"
[[camera]]
name = "left"
[[trial]]
name = "calib"
kind = "calibration"
fps = 10
videos = { left = "calib/left.mp4", right = "calib/right.mp4" }
[[trial]]
name = "floor"
kind = "floor"
frames = [0, 7]
videos = { left = "calib/left.mp4", right = "calib/right.mp4" }
[[trial]]
name = "walk"
kind = "motion"
videos = { left = "walk/left.mp4", right = "walk/right.mp4" }
time_offset_s = { left = 0.0073 }
)";

/// Returns kSession with every `from` replaced; the test fails if there is none.
inline std::string with(std::string_view from, std::string_view to) {
  std::string text(kSession);
  std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Reads a session of this text; its folder no longer exists.
inline Result<Session> read(std::string_view text) {
  const testing::ScratchFolder folder;
  EXPECT_TRUE(write_file(folder / "session.toml", text));
  return read_session(folder.path());
}

/// Returns the message after the folder: "session.toml:6: ...". Empty without an error.
inline std::string mistake(std::string_view text) {
  const Result<Session> session = read(text);
  if (session) return "";
  const std::string message = session.error().message();
  return message.substr(message.find("session.toml"));
}

}  // namespace marey::recordings
