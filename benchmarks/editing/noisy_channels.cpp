// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/editing/noisy_channels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "edit/signal/butterworth.h"

#include "recordings/base/atomic_file.h"
#include "recordings/base/csv_line.h"

namespace marey {

void stop_benchmark(const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

TruthClip read_truth_clip(const std::filesystem::path& folder, const std::string& name) {
  const auto file = folder / name / "truth" / "joints_120hz.csv";
  const auto text = recordings::read_file(file);
  if (!text) stop_benchmark(text.error().message());
  recordings::CsvLines lines(*text);
  const auto header = lines.next();
  if (!header) stop_benchmark(file.string() + ": empty");
  std::map<std::string, std::size_t> columns;
  recordings::CsvFields names(*header);
  const auto count =
      static_cast<std::size_t>(std::count(header->begin(), header->end(), ',')) + 1;
  for (std::size_t i = 0; i < count; ++i) columns[std::string(names.text())] = i;
  std::vector<std::size_t> wanted;
  for (const char* joint : {"hip_l", "wrist_l", "ankle_l", "toe_l"}) {
    for (const char* axis : {"_x", "_y", "_z"}) {
      const auto column = columns.find(std::string(joint) + axis);
      if (column == columns.end())
        stop_benchmark(file.string() + ": no column of " + joint);
      wanted.push_back(column->second);
    }
  }
  TruthClip clip{name, NoisyChannels(wanted.size())};
  while (const auto line = lines.next()) {
    recordings::CsvFields fields(*line);
    std::vector<double> row(count);
    for (double& value : row) value = fields.number<double>();
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      clip.truth_m[k].push_back(row[wanted[k]]);
    }
  }
  return clip;
}

double channel_error(const std::vector<double>& a, const std::vector<double>& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squares += (a[i] - truth[i]) * (a[i] - truth[i]);
  }
  return std::sqrt(squares / static_cast<double>(a.size()));
}

double butterworth_error(std::vector<double> channel,
                         const std::vector<double>& truth,
                         double cutoff_hz) {
  edit::filter_butterworth(channel, cutoff_hz, kTruthRate_hz);
  return channel_error(channel, truth);
}

OracleFilter best_butterworth(const std::vector<double>& channel,
                              const std::vector<double>& truth) {
  OracleFilter best;
  for (int step = 0; step < 113; ++step) {  // 0.7 to 57 Hz.
    const double cutoff_hz = 0.7 * std::pow(1.04, step);
    const double error_m = butterworth_error(channel, truth, cutoff_hz);
    if (error_m < best.error_m) best = {cutoff_hz, error_m};
  }
  return best;
}

NoisyChannels with_channel_noise(NoisyChannels channels,
                                 const ChannelNoise& noise,
                                 unsigned seed) {
  std::mt19937 random(7919 * seed + 1);
  std::normal_distribution<double> unit(0.0, 1.0);
  const double fresh = std::sqrt(1.0 - noise.correlation * noise.correlation);
  for (auto& channel : channels) {
    double state = unit(random);
    for (double& value : channel) {
      value += noise.sigma_m * state;
      state = noise.correlation * state + fresh * unit(random);
    }
  }
  return channels;
}

}  // namespace marey
