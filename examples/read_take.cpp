// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the frame times of a recorded take and prints what each camera recorded.
//
//     read_take FOLDER/TRIAL/take.sqlite
#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/base/time.h"
#include "recordings/takes/take_file.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

/// Returns the median time between two frames; 0 with fewer than two. [s]
double median_interval_s(const std::vector<recordings::TakeFrame>& frames) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    intervals.push_back(seconds(frames[i].time - frames[i - 1].time));
  }
  if (intervals.empty()) return 0.0;
  const auto middle =
      intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return fail(bad_input("", "no take is given", "name a take.sqlite"));
  const auto take = recordings::read_take(argv[1]);
  if (!take) return fail(take.error());

  std::printf("trial %s, %s\n", take->trial.c_str(), take->finished ? "complete" : "cut");
  for (const recordings::TakeCamera& camera : take->cameras) {
    int dropped = 0;
    for (const recordings::TakeFrame& frame : camera.frames) {
      dropped += frame.dropped_before;
    }
    const double interval_s = median_interval_s(camera.frames);
    const double length_s =
        camera.frames.empty()
            ? 0.0
            : seconds(camera.frames.back().time - camera.frames.front().time);
    std::printf("%s_frames %zu\n", camera.name.c_str(), camera.frames.size());
    std::printf("%s_dropped %d\n", camera.name.c_str(), dropped);
    std::printf("%s_interval_ms %.3f\n", camera.name.c_str(), 1000.0 * interval_s);
    std::printf("%s_length_s %.3f\n", camera.name.c_str(), length_s);
  }
  return 0;
}
