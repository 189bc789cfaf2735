// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>

#include "calib/model/calibrated_rig.h"

// The parts of measure_calibration: each reads its data, prints figures, and returns the
// program's exit code.
namespace marey::calib {

[[nodiscard]] int measure_wand(const std::filesystem::path& folder);
[[nodiscard]] int measure_room(const std::filesystem::path& folder);
[[nodiscard]] int measure_rendered(const std::filesystem::path& folder);
[[nodiscard]] int measure_stereo(const std::filesystem::path& folder);
[[nodiscard]] int measure_webcams(const std::filesystem::path& folder);

void print_rig(const CalibratedRig& rig);
/// Prints nothing when there is none.
void print_cross_validation(const CalibratedRig& rig);

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace marey::calib
