// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// How fast are files of labelled markers read? Time for a recording of 50 markers and 20
// analog channels, made up here: bytes of the file per second, and frames.
#include <cmath>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_markers.h"
#include "recordings/markers/marker_file.h"
#include "recordings/markers/trc.h"

namespace marey::recordings {
namespace {

constexpr int kMarkers = 50;

std::string c3d_bytes(int frames) {
  C3dInfo info;
  info.points = kMarkers;
  info.analog_channels = 20;
  info.analog_per_frame = 10;
  info.frames = frames;
  std::vector<std::string> labels;
  for (int i = 0; i < kMarkers; ++i) labels.push_back(std::to_string(i));
  put_texts(info.groups, "POINT", "LABELS", labels);
  put_texts(info.groups, "POINT", "UNITS", {"mm"});
  put_texts(info.groups, "POINT", "Y_SCREEN", {"+Z"});
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / "marey_benchmark.c3d";
  Result<C3dWriter> writer = C3dWriter::create(path, info);
  if (!writer) return {};
  C3dFrame frame;
  frame.analog.assign(200, 1.0F);
  for (int f = 0; f < frames; ++f) {
    frame.points.clear();
    for (int m = 0; m < kMarkers; ++m) {
      const double height = 1700.0 * m / kMarkers + 20.0 * std::sin(0.01 * f + m);
      frame.points.insert(frame.points.end(),
                          {10.0F, 20.0F, static_cast<float>(height), 3});
    }
    writer->append(frame);
  }
  if (!writer->commit()) return {};
  Result<std::string> bytes = read_file(path);
  std::filesystem::remove(path);
  return bytes ? *std::move(bytes) : std::string();
}

void count(benchmark::State& state, std::size_t bytes, std::int64_t frames) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
  state.SetItemsProcessed(state.iterations() * frames);
}

void stream_c3d(benchmark::State& state) {
  const std::string bytes = c3d_bytes(static_cast<int>(state.range(0)));
  C3dFrame frame;
  for (auto _ : state) {
    Result<C3dReader> reader = C3dReader::of_bytes(bytes, "benchmark.c3d");
    if (!reader) return state.SkipWithError("no reader");
    for (Result<bool> more = reader->next(frame); more && *more;)
      more = reader->next(frame);
    benchmark::DoNotOptimize(frame.points.data());
  }
  count(state, bytes.size(), state.range(0));
}
BENCHMARK(stream_c3d)->Arg(5000)->Unit(benchmark::kMillisecond);

void read_c3d_markers(benchmark::State& state) {
  const std::string bytes = c3d_bytes(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(parse_c3d_markers(bytes, "benchmark.c3d"));
  }
  count(state, bytes.size(), state.range(0));
}
BENCHMARK(read_c3d_markers)->Arg(5000)->Unit(benchmark::kMillisecond);

void read_trc(benchmark::State& state) {
  const std::string bytes = c3d_bytes(static_cast<int>(state.range(0)));
  const Result<MarkerFile> markers = parse_c3d_markers(bytes, "benchmark.c3d");
  if (!markers) return state.SkipWithError("no markers");
  const std::string text = trc_text(markers->tracks, markers->axes, "benchmark.trc");
  for (auto _ : state) benchmark::DoNotOptimize(parse_trc(text, "benchmark.trc"));
  count(state, text.size(), state.range(0));
}
BENCHMARK(read_trc)->Arg(5000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace marey::recordings

BENCHMARK_MAIN();
