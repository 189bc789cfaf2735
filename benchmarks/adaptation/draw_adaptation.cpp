// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Draws results of the adapter: the scenes of docs/adaptation.md.
//
//   draw_adaptation FOLDER
//
// Writes a GLB for each scene, and a JSON with the view and the labels.
// tests/tools/draw_scenes.py renders pictures from both.
#include <array>
#include <cstdio>
#include <filesystem>

#include "benchmarks/adaptation/adaptation_figures.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: draw_adaptation FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::error_code ignored;  // write() reports a missing folder.
  std::filesystem::create_directories(folder, ignored);
  for (const auto draw : {marey::draw_control,
                          marey::draw_root_share,
                          marey::draw_flexibility,
                          marey::draw_stair,
                          marey::draw_balance,
                          marey::draw_strategies,
                          marey::draw_crowd,
                          marey::draw_loads}) {
    const marey::Status written = draw().write(folder);
    if (!written) {
      std::fprintf(stderr, "%s\n", written.error().message().c_str());
      return 1;
    }
  }
  return 0;
}
