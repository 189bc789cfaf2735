// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Do a few cameras on two cores keep up with real time? Decodes their videos and follows
// the tags in them, all cameras at once, as `marey track` does.
//
//   measure_throughput 2 walk/cam0.mp4 walk/cam1.mp4 walk/cam2.mp4 walk/cam3.mp4
//
// The first argument is how many threads may work; keep other work off the machine, or
// look at the processor's time alone. Prints how many times faster than the recording it
// was by the clock and by the processor's time, and how much of that was decoding.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "capture/search/detect_videos.h"
#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"

namespace marey::capture {
namespace {

double clock_s() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time that decoding all of the videos takes; negative when one cannot be
/// read.
double decoding_s(const std::vector<CameraInput>& inputs) {
  const double begin = processor_s();
  for (const CameraInput& input : inputs) {
    auto source = open_frames(input.path);
    if (!source) return -1.0;
    while (true) {
      const auto frame = (*source)->next();
      if (!frame) return -1.0;
      if (!*frame) break;
    }
  }
  return processor_s() - begin;
}

int run(int threads, const std::vector<CameraInput>& inputs) {
  DetectVideosOptions options;
  options.workers = threads;
  const double clock_before = clock_s();
  const double processor_before = processor_s();
  const auto found = detect_tags_in_videos(inputs, options);
  const double elapsed_s = clock_s() - clock_before;
  const double used_s = processor_s() - processor_before;
  if (!found) {
    std::fprintf(stderr, "error: %s\n", found.error().message().c_str());
    return 3;
  }
  double recorded_s = 0.0;
  long frames = 0;
  long tags = 0;
  for (const CameraDetections& camera : *found) {
    recorded_s =
        std::max(recorded_s, static_cast<double>(camera.frames.size()) / camera.rate.hz);
    frames += static_cast<long>(camera.frames.size());
    for (const FrameDetections& frame : camera.frames) {
      tags += static_cast<long>(frame.tags.size());
    }
  }
  const double decoding = decoding_s(inputs);
  std::printf("cameras %zu, threads %d, frames %ld, tags %ld, recorded %.1f s\n",
              inputs.size(),
              threads,
              frames,
              tags,
              recorded_s);
  std::printf("by the clock            %.2f times real time\n", recorded_s / elapsed_s);
  std::printf("by the processor's time %.2f times real time\n",
              recorded_s * threads / used_s);
  if (decoding >= 0.0) {
    std::printf("once decoded            %.2f times real time (decoding is %.0f %%)\n",
                recorded_s * threads / std::max(1e-9, used_s - decoding),
                100.0 * decoding / used_s);
  }
  return 0;
}

}  // namespace
}  // namespace marey::capture

int main(int argc, char** argv) {
  const int threads = argc > 2 ? std::atoi(argv[1]) : 0;
  if (threads < 1) {
    std::fprintf(stderr, "usage: measure_throughput THREADS VIDEO...\n");
    return 2;
  }
  std::vector<marey::capture::CameraInput> inputs;
  for (int i = 2; i < argc; ++i) {
    marey::capture::CameraInput input;
    input.path = argv[i];
    input.camera = marey::CameraId{i - 2};
    inputs.push_back(input);
  }
  return marey::capture::run(threads, inputs);
}
