// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The parts of measure_accuracy, all for results of `marey process`. Each part prints its
// figures. It reports unreadable files on stderr, and then returns false.

#include <filesystem>
#include <string>
#include <vector>

namespace marey::benchmarks {

/// Results, the recording's truth, and the trials that both have.
struct AccuracyCase {
  std::filesystem::path out;
  std::filesystem::path truth;
  std::vector<std::string> trials;
};

/// Measures the rotation errors of the segments with tags. marey's axes and the truth's
/// differ by a constant rotation of each segment. This rotation is removed, one per
/// segment for all trials together. It minimizes the sum of the angles instead of their
/// squares, so that flips have little influence. Flips are frames that are more than 60
/// degrees off. Frames without a row, and without hips and chest, are counted as lost.
bool measure_segments(const AccuracyCase& a);

/// Measures the calibration of the sigmas: the share of joint centres whose error, in
/// sigmas, is within the 95 % radius of three normal coordinates. Prints the shares of
/// the twelve joints of the limbs by the joint's source.
bool measure_honesty(const AccuracyCase& a);

}  // namespace marey::benchmarks
