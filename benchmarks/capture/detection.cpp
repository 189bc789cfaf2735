// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How many cameras can one core follow? Time per frame of decoding a video and of finding
// the tags in it, apart. The video is the one that the environment variable
// MAREY_BENCH_VIDEO names, else a rendered one of the shared data; without either, the
// benchmarks skip.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "capture/tags/detect_tags.h"
#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"
#include "tests/support/program/paths.h"

namespace marey::capture {
namespace {

std::string video_path() {
  const char* asked = std::getenv("MAREY_BENCH_VIDEO");
  return asked != nullptr ? asked
                          : marey::testing::shared_data() / "blender/dev/rom/cam0.mp4";
}

/// Frames of the video, copied out of it.
class KeptFrames {
 public:
  explicit KeptFrames(int maximum) {
    auto source = open_frames(video_path());
    if (!source) return;
    while (static_cast<int>(pixels_.size()) < maximum) {
      const auto frame = (*source)->next();
      if (!frame || !*frame) return;
      const GrayFrame& view = **frame;
      const auto bytes = static_cast<std::size_t>(view.stride) *
                         static_cast<std::size_t>(view.height_px);
      pixels_.emplace_back(view.pixels, view.pixels + bytes);
      views_.push_back(view);
      views_.back().pixels = pixels_.back().data();
    }
  }

  [[nodiscard]] const std::vector<GrayFrame>& views() const { return views_; }

 private:
  std::vector<std::vector<std::uint8_t>> pixels_;
  std::vector<GrayFrame> views_;
};

void decode(benchmark::State& state) {
  if (!std::filesystem::exists(video_path())) {
    state.SkipWithError("no video; set MAREY_BENCH_VIDEO");
    return;
  }
  std::int64_t frames = 0;
  for ([[maybe_unused]] auto iteration : state) {
    auto source = open_frames(video_path());
    if (!source) {
      state.SkipWithError(source.error().message().c_str());
      return;
    }
    while (true) {
      const auto frame = (*source)->next();
      if (!frame || !*frame) break;
      benchmark::DoNotOptimize((*frame)->pixels);
      ++frames;
    }
  }
  state.SetItemsProcessed(frames);
  state.counters["per_frame"] =
      benchmark::Counter(static_cast<double>(frames),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(decode)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Arguments: quad_decimate, and whether patterns are aligned.
void detect(benchmark::State& state) {
  const KeptFrames kept(/*most=*/32);
  if (kept.views().empty()) {
    state.SkipWithError("no video; set MAREY_BENCH_VIDEO");
    return;
  }
  TagDetectorOptions options;
  options.quad_decimate = static_cast<double>(state.range(0));
  options.align_patterns = state.range(1) != 0;
  auto detector = TagDetector::create(options);
  std::size_t next = 0;
  std::size_t tags = 0;
  for ([[maybe_unused]] auto iteration : state) {
    tags += detector->detect(kept.views()[next]).size();
    next = (next + 1) % kept.views().size();
  }
  state.counters["tags_per_frame"] =
      benchmark::Counter(static_cast<double>(tags), benchmark::Counter::kAvgIterations);
}
BENCHMARK(detect)
    ->ArgNames({"decimate", "align"})
    ->Args({1, 0})
    ->Args({1, 1})
    ->Args({2, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey::capture

BENCHMARK_MAIN();
