// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace marey {

/// Rate of the truth of the rendered recordings.
inline constexpr double kTruthRate_hz = 120.0;

using NoisyChannels = std::vector<std::vector<double>>;

/// True coordinates of a recording. [m]
struct TruthClip {
  std::string name;
  NoisyChannels truth_m;  ///< Hip, wrist, ankle, toe of the left side; x, y, z of each.
};

/// Noise: its sigma, and the correlation of consecutive samples (first-order process).
struct ChannelNoise {
  double sigma_m = 0.0;
  double correlation = 0.0;
};

/// The best Butterworth filter of a channel, by its truth.
struct OracleFilter {
  double cutoff_hz = 0.0;
  double error_m = 1e9;
};

/// Prints the text and ends the program with code 1.
[[noreturn]] void stop_benchmark(const std::string& text);

/// Reads NAME/truth/joints_120hz.csv of a folder. Ends the program if it cannot be read.
[[nodiscard]] TruthClip read_truth_clip(const std::filesystem::path& folder,
                                        const std::string& name);

/// Returns the channels with noise of this seed.
[[nodiscard]] NoisyChannels with_channel_noise(NoisyChannels channels,
                                               const ChannelNoise& noise,
                                               unsigned seed);

/// Returns the root mean square difference of two channels.
[[nodiscard]] double channel_error(const std::vector<double>& a,
                                   const std::vector<double>& truth);

/// Returns the error of a channel after a Butterworth filter.
[[nodiscard]] double butterworth_error(std::vector<double> channel,
                                       const std::vector<double>& truth,
                                       double cutoff_hz);

/// Searches cut-offs from 0.7 to 57 Hz in steps of 4 %.
[[nodiscard]] OracleFilter best_butterworth(const std::vector<double>& channel,
                                            const std::vector<double>& truth);

}  // namespace marey
