// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// write_page_library FOLDER COUNT: writes a library of walks for the tests of its page.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/app/library/page/page_library.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: write_page_library FOLDER COUNT\n");
    return 2;
  }
  try {
    const auto clips = marey::testing::sample_page_clips(std::atoi(argv[2]));
    marey::testing::write_page_library(argv[1], clips);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
