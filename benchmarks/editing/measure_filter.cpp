// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the error of low-pass filters on true joint places with noise.
//
//   measure_filter ../shared/data/blender [seeds, default 20]
//
// Reads truth/joints_120hz.csv of the rendered recordings and uses 12 channels of each:
// hip, wrist, ankle and toe of the left side, x, y and z. Adds noise of 1 and 3 mm, white
// and with a correlation of 0.5 between consecutive frames. Divides the root mean square
// error of each filter by that of the best Butterworth cut-off, which knows the truth of
// each channel. Prints per recording and noise: the oracle's median cut-off and error;
// for each filter the mean of the ratio over channels and seeds, the largest mean over
// seeds of a channel, and the largest ratio of all. Then prints the time to choose the
// penalties of 75 channels of 1 minute and of 200 channels of 5 minutes, and to smooth
// them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "edit/signal/butterworth.h"

#include "benchmarks/editing/noisy_channels.h"
#include "benchmarks/parts/result_table.h"
#include "core/base/quantile.h"
#include "core/base/stopwatch.h"
#include "core/signal/choose_smoothing.h"

namespace marey {
namespace {

using Channels = NoisyChannels;
using Clip = TruthClip;
constexpr double kRate_hz = kTruthRate_hz;

/// Root, arm and leg; indices of the 12 channels.
std::vector<std::vector<std::size_t>> body_groups() {
  return {{0, 1, 2}, {3, 4, 5}, {6, 7, 8, 9, 10, 11}};
}

/// A made motion: sines of random phase up to 3 Hz (hip), 8 Hz (wrist) and 5 Hz (leg).
Clip made_clip(const std::string& name, double band_factor, unsigned seed) {
  Clip clip{name, Channels(12, std::vector<double>(600, 0.0))};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (std::size_t k = 0; k < clip.truth_m.size(); ++k) {
    const double band_hz = band_factor * (k < 3 ? 3.0 : k < 6 ? 8.0 : 5.0);
    for (int wave = 0; wave < 12; ++wave) {
      const double w = 2.0 * std::numbers::pi * band_hz * (wave + unit(random)) / 12.0;
      const double phase = 2.0 * std::numbers::pi * unit(random);
      for (std::size_t i = 0; i < clip.truth_m[k].size(); ++i) {
        clip.truth_m[k][i] += 0.2 / (1.0 + wave * wave) *
                              std::sin(w * static_cast<double>(i) / kRate_hz + phase);
      }
    }
  }
  return clip;
}

/// Ratios of one filter.
struct Ratios {
  std::array<double, 12> sums{};
  double worst = 0.0;
  void add(std::size_t channel, double ratio) {
    sums[channel] += ratio;
    worst = std::max(worst, ratio);
  }
};

std::vector<std::string> filter_names() {
  return {"6 Hz",
          "Winter",
          "Yu",
          "GCV, median of the group",
          "GCV, joint",
          "GCV, each channel alone",
          "GCV, median, quintic",
          "GCV, joint, quintic"};
}

/// Errors of each filter for each channel. [m]
std::vector<std::vector<double>> filter_errors(const Channels& noisy,
                                               const Channels& truth) {
  std::vector<std::vector<double>> errors(filter_names().size());
  for (std::size_t k = 0; k < noisy.size(); ++k) {
    errors[0].push_back(butterworth_error(noisy[k], truth[k], 6.0));
    const double winter_hz =
        edit::winter_cutoff_hz(noisy[k], kRate_hz).value_or(edit::yu_cutoff_hz(kRate_hz));
    errors[1].push_back(butterworth_error(noisy[k], truth[k], winter_hz));
    errors[2].push_back(
        butterworth_error(noisy[k], truth[k], edit::yu_cutoff_hz(kRate_hz)));
  }
  std::vector<std::vector<std::size_t>> singles;
  for (std::size_t k = 0; k < noisy.size(); ++k) singles.push_back({k});
  const auto spline = [&](std::size_t filter,
                          int order,
                          GroupRule rule,
                          const std::vector<std::vector<std::size_t>>& groups) {
    Channels smoothed = noisy;
    static_cast<void>(smooth_groups(smoothed, groups, kRate_hz, {{order}, rule}));
    for (std::size_t k = 0; k < noisy.size(); ++k) {
      errors[filter].push_back(channel_error(smoothed[k], truth[k]));
    }
  };
  spline(3, 2, GroupRule::kMedian, body_groups());
  spline(4, 2, GroupRule::kJoint, body_groups());
  spline(5, 2, GroupRule::kMedian, singles);
  spline(6, 3, GroupRule::kMedian, body_groups());
  spline(7, 3, GroupRule::kJoint, body_groups());
  return errors;
}

void measure(const Clip& clip, const ChannelNoise& noise, unsigned seeds) {
  const std::vector<std::string> names = filter_names();
  std::vector<Ratios> ratios(names.size());
  std::vector<double> cutoffs;
  std::vector<double> oracle_errors;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Channels noisy = with_channel_noise(clip.truth_m, noise, seed);
    const auto errors = filter_errors(noisy, clip.truth_m);
    for (std::size_t k = 0; k < noisy.size(); ++k) {
      const OracleFilter oracle = best_butterworth(noisy[k], clip.truth_m[k]);
      cutoffs.push_back(oracle.cutoff_hz);
      oracle_errors.push_back(oracle.error_m);
      for (std::size_t filter = 0; filter < names.size(); ++filter) {
        ratios[filter].add(k, errors[filter][k] / oracle.error_m);
      }
    }
  }
  char title[160];
  std::snprintf(title,
                sizeof title,
                "%s, %.0f mm%s: oracle's median cut-off %.1f Hz, median error %.2f mm",
                clip.name.c_str(),
                1000.0 * noise.sigma_m,
                noise.correlation > 0.0 ? ", correlation 0.5" : "",
                median(cutoffs),
                1000.0 * median(oracle_errors));
  ResultTable table{clip.name,
                    title,
                    {{"filter"}, {"mean"}, {"worst channel"}, {"worst of all"}},
                    {},
                    {}};
  for (std::size_t filter = 0; filter < names.size(); ++filter) {
    double mean = 0.0;
    double worst = 0.0;
    for (const double sum : ratios[filter].sums) {
      mean += sum / seeds / 12.0;
      worst = std::max(worst, sum / seeds);
    }
    table.rows.push_back({names[filter], mean, worst, ratios[filter].worst});
  }
  print_table(table);
}

void measure_time(std::size_t channel_count, std::size_t frames) {
  Channels channels(channel_count, std::vector<double>(frames));
  std::vector<std::vector<std::size_t>> groups(6);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.002);
  for (std::size_t k = 0; k < channels.size(); ++k) {
    groups[k % groups.size()].push_back(k);
    const double w = 2.0 * std::numbers::pi * (0.5 + 4.0 * static_cast<double>(k) / 75.0);
    for (std::size_t i = 0; i < frames; ++i) {
      channels[k][i] =
          0.2 * std::sin(w * static_cast<double>(i) / kRate_hz) + noise(random);
    }
  }
  for (const int order : {2, 3}) {
    Channels smoothed = channels;
    const Stopwatch watch;
    static_cast<void>(smooth_groups(smoothed, groups, kRate_hz, {{order}}));
    std::printf("%zu channels of %zu frames, order %d: %.3f s\n",
                channel_count,
                frames,
                order,
                watch.seconds());
  }
}

int run(int argc, char** argv) {
  if (argc < 2) stop_benchmark("usage: measure_filter FOLDER [SEEDS]");
  const std::filesystem::path folder = argv[1];
  const unsigned seeds = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 20;
  std::vector<Clip> clips;
  for (const char* name : {"walk", "jump", "reach", "rom"}) {
    clips.push_back(read_truth_clip(folder / "dev", name));
  }
  for (const char* name : {"walk", "rom"}) {
    clips.push_back(read_truth_clip(folder / "second", name));
    clips.back().name = "second " + clips.back().name;
  }
  clips.push_back(made_clip("made, slow", 0.7, 11));
  clips.push_back(made_clip("made, fast", 2.0, 12));
  for (const Clip& clip : clips) {
    for (const ChannelNoise& noise : {ChannelNoise{0.001, 0.0},
                                      ChannelNoise{0.003, 0.0},
                                      ChannelNoise{0.001, 0.5},
                                      ChannelNoise{0.003, 0.5}}) {
      measure(clip, noise, seeds);
    }
  }
  measure_time(75, 7200);
  measure_time(200, 36000);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  return marey::run(argc, argv);
}
