// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The parts of measure_accuracy, all of results that `marey process` wrote. Each prints,
// tells on stderr what it cannot read, and is false then.

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

/// How far the segments that wear tags are turned away from the truth. marey's axes
/// and the truth's differ by a rotation that each segment keeps: it is taken off, one per
/// segment for all trials together (the rotation that is least far from all in sum, not
/// in squares, so that flips do not pull it). Flips are frames that are more than 60
/// degrees off. Frames without a row, and without hips and chest, are counted as lost.
bool measure_segments(const AccuracyCase& a);

/// Whether sigmas are honest: the share of joint centres whose error, in sigmas, is
/// within what holds 95 % of three normal coordinates, by the joint's source; the twelve
/// of the limbs.
bool measure_honesty(const AccuracyCase& a);

}  // namespace marey::benchmarks
