// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey {

/// The parameter that a trial of a throw sets; all others keep the captured values.
enum class ThrowParameter {
  kCaptured,      ///< None: the captured throw itself, as a control.
  kPlaceLeft,     ///< Wrist at release, heading frame of the hips. [m]
  kPlaceUp,       ///< [m]
  kPlaceForward,  ///< [m]
  kAzimuth,       ///< For the ball; positive to the left. [degrees]
  kElevation,     ///< [degrees]
  kSpeed,         ///< [m/s]
  kRelease,       ///< Time from start to release. [s]
};

/// Words in files, with the unit of the value.
inline constexpr std::array<std::string_view, 8> kThrowParameters{"captured",
                                                                  "place_left_m",
                                                                  "place_up_m",
                                                                  "place_forward_m",
                                                                  "azimuth_deg",
                                                                  "elevation_deg",
                                                                  "speed_m_s",
                                                                  "release_s"};

/// One kind of throw, repeated.
struct ThrowTrial {
  ThrowParameter parameter = ThrowParameter::kCaptured;
  double value = 0.0;  ///< In the unit of the parameter's word.
  int repeat = 1;
};

enum class TrialOrder {
  kListed,    ///< As in the file, repetitions one after another.
  kShuffled,  ///< All trials in one random order.
  kBlocks,    ///< Block r holds the r-th repetition of each, in a random order.
};

/// Trials of a study (docs/formats/trials.md).
struct TrialList {
  std::string name{};
  std::uint64_t seed = 0;
  TrialOrder order = TrialOrder::kBlocks;
  std::vector<ThrowTrial> trials{};
};

/// One throw of the study.
struct PlannedTrial {
  std::size_t trial = 0;  ///< Position in TrialList::trials.
  int repetition = 0;     ///< From 0.
  bool operator==(const PlannedTrial&) const = default;
};

/// Returns all throws in their order. Shuffles are those of Fisher and Yates from the
/// last element down: element i is exchanged with element j = floor(r (i + 1) / 2^64), r
/// the next number of SplitMix64 started with the seed. Same input, same order, on every
/// machine.
[[nodiscard]] std::vector<PlannedTrial> trial_order(const TrialList& list);

}  // namespace marey
