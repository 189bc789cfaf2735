// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the filter of marey edit on labelled markers with a known truth.
//
//   measure_marker_filter ../shared/data/blender [seeds, default 20]
//
// Reads truth/joints_120hz.csv of the rendered recordings as four markers: hip, wrist,
// ankle and toe of the left side. Adds white noise of 1 and 3 mm to each coordinate, once
// without gaps and once with a gap of 24 frames in each second of each marker. Applies
// the operation `filter`, and divides the root mean square error of each coordinate by
// that of the best Butterworth cut-off, which knows the truth of that coordinate (without
// gaps). Prints the mean over coordinates and seeds, the largest mean over seeds of a
// coordinate, and the noise that the operation reports. Errors are of samples that are
// seen.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "edit/markers/apply_marker_op.h"

#include "benchmarks/editing/noisy_channels.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"

namespace marey {
namespace {

constexpr std::size_t kMarkers = 4;

struct NamedFilter {
  std::string name;
  FilterOp op;
};

std::vector<NamedFilter> marker_filters() {
  std::vector<NamedFilter> out;
  FilterOp op;
  out.push_back({"spline (default)", op});
  op.order = 3;
  out.push_back({"spline, quintic", op});
  op.order = 2;
  op.method = FilterMethod::kButterworth;
  op.cutoff = CutoffRule::kGiven;
  op.cutoff_hz = 6.0;
  out.push_back({"Butterworth, 6 Hz", op});
  op.cutoff = CutoffRule::kWinter;
  out.push_back({"Butterworth, Winter", op});
  op.cutoff = CutoffRule::kYu;
  out.push_back({"Butterworth, Yu", op});
  return out;
}

/// Returns the channels as markers. With gaps, 24 of 120 frames are missing, at another
/// place in each marker.
edit::MarkerState markers_of(const NoisyChannels& channels, bool gaps) {
  MarkerTracks tracks;
  tracks.labels = {"hip", "wrist", "ankle", "toe"};
  tracks.rate = FrameRate{kTruthRate_hz};
  for (std::size_t t = 0; t < channels[0].size(); ++t) {
    for (std::size_t m = 0; m < kMarkers; ++m) {
      auto& sample = tracks.samples.emplace_back();
      if (gaps && (t + 30 * m) % 120 >= 96) continue;
      sample.emplace();
      sample->p_in_world = {
          channels[3 * m][t], channels[3 * m + 1][t], channels[3 * m + 2][t]};
    }
  }
  auto state = edit::make_marker_state(std::move(tracks));
  if (!state) stop_benchmark(state.error().message());
  return *std::move(state);
}

std::vector<double> errors_of(const edit::MarkerState& state,
                              const NoisyChannels& truth) {
  std::vector<double> out;
  for (std::size_t channel = 0; channel < truth.size(); ++channel) {
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t t = 0; t < state.tracks.frames(); ++t) {
      const auto& sample = state.tracks.at(t, channel / 3);
      if (!sample) continue;
      const double apart =
          sample->p_in_world[static_cast<int>(channel % 3)] - truth[channel][t];
      squares += apart * apart;
      count += 1.0;
    }
    out.push_back(std::sqrt(squares / count));
  }
  return out;
}

/// Figures of one filter over all seeds.
struct FilterFigures {
  std::array<double, 3 * kMarkers> ratio_sums{};
  std::vector<double> noise_mm;
  std::vector<double> cutoff_hz;
};

void run_filter(const NamedFilter& filter,
                const edit::MarkerState& noisy,
                const NoisyChannels& truth,
                const std::vector<double>& oracle_m,
                FilterFigures& figures) {
  EditOp op;
  op.parameters = filter.op;
  edit::OpReport report;
  const auto made = edit::apply_marker_op({op, 0}, noisy, report);
  if (!made) stop_benchmark(made.error().message());
  const auto errors = errors_of(made->front(), truth);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    figures.ratio_sums[k] += errors[k] / oracle_m[k];
  }
  for (const auto& [name, value] : report.figures) {
    if (name.ends_with("_noise_mm")) figures.noise_mm.push_back(value);
    if (name.ends_with("_cutoff_hz")) figures.cutoff_hz.push_back(value);
  }
}

void measure_markers(const TruthClip& clip, double sigma_m, bool gaps, unsigned seeds) {
  const std::vector<NamedFilter> filters = marker_filters();
  std::vector<FilterFigures> figures(filters.size());
  std::vector<double> oracle_mm;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const NoisyChannels noisy = with_channel_noise(clip.truth_m, {sigma_m}, seed);
    std::vector<double> oracle_m;
    for (std::size_t k = 0; k < noisy.size(); ++k) {
      oracle_m.push_back(best_butterworth(noisy[k], clip.truth_m[k]).error_m);
      oracle_mm.push_back(1e3 * oracle_m.back());
    }
    const edit::MarkerState state = markers_of(noisy, gaps);
    for (std::size_t f = 0; f < filters.size(); ++f) {
      run_filter(filters[f], state, clip.truth_m, oracle_m, figures[f]);
    }
  }
  char title[160];
  std::snprintf(title,
                sizeof title,
                "%s, %.0f mm, %s: oracle's median error %.2f mm",
                clip.name.c_str(),
                1e3 * sigma_m,
                gaps ? "gaps" : "no gaps",
                median(oracle_mm));
  ResultTable table{clip.name,
                    title,
                    {{"filter"},
                     {"mean"},
                     {"worst coordinate"},
                     {"noise reported mm"},
                     {"cut-off Hz", 1}},
                    {},
                    {}};
  for (std::size_t f = 0; f < filters.size(); ++f) {
    double mean = 0.0;
    double worst = 0.0;
    for (const double sum : figures[f].ratio_sums) {
      mean += sum / seeds / static_cast<double>(figures[f].ratio_sums.size());
      worst = std::max(worst, sum / seeds);
    }
    table.rows.push_back({filters[f].name,
                          mean,
                          worst,
                          median(figures[f].noise_mm),
                          median(figures[f].cutoff_hz)});
  }
  print_table(table);
}

int run_marker_filters(int argc, char** argv) {
  if (argc < 2) stop_benchmark("usage: measure_marker_filter FOLDER [SEEDS]");
  const std::filesystem::path folder = argv[1];
  const unsigned seeds = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 20;
  std::vector<TruthClip> clips;
  for (const char* name : {"walk", "jump", "reach", "rom"}) {
    clips.push_back(read_truth_clip(folder / "dev", name));
  }
  for (const char* name : {"walk", "rom"}) {
    clips.push_back(read_truth_clip(folder / "second", name));
    clips.back().name = "second " + clips.back().name;
  }
  for (const TruthClip& clip : clips) {
    for (const bool gaps : {false, true}) {
      for (const double sigma_m : {0.001, 0.003}) {
        measure_markers(clip, sigma_m, gaps, seeds);
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run_marker_filters(argc, argv);
}
