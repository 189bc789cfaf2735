// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/video_packets.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/program/run_program.h"

namespace marey::testing {

std::string video_packets(const std::filesystem::path& video) {
  const std::filesystem::path to = video.string() + ".bin";
  const auto run = run_program(kFfmpeg,
                               {"-v",
                                "quiet",
                                "-y",
                                "-i",
                                "file:" + video.string(),
                                "-c",
                                "copy",
                                "-f",
                                "data",
                                "-map",
                                "0:v",
                                "file:" + to.string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::ifstream in(to, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace marey::testing
