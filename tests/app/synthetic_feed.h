// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/record_take.h"

namespace marey::testing {

/// A camera that is none: frame k of `camera` is made of its numbers alone, so that who
/// reads a recording knows what must be in it.
class SyntheticFeed final : public app::FrameFeed {
 public:
  struct Behaviour {
    double rate_hz = 100.0;
    long frames = -1;          ///< After so many it is silent; -1: it never ends.
    int drop_every = 0;        ///< Each so-many-th frame never comes; 0: all come.
    bool is_grey = false;      ///< Raw pixels instead of JPEG.
    int empty_every = 0;       ///< Each so-many-th frame is without bytes.
    bool in_real_time = true;  ///< Else as fast as they are fetched.
  };

  SyntheticFeed(int camera, const Behaviour& behaviour);

  std::optional<capture::RawFrame> next(std::chrono::milliseconds timeout) override;
  [[nodiscard]] const capture::DeviceSettings& settings() const override {
    return settings_;
  }
  [[nodiscard]] std::string device() const override { return "synthetic"; }
  std::vector<std::string> events() override { return {}; }

  /// Frames handed out so far, from any thread.
  [[nodiscard]] long handed_out() const { return handed_out_; }

  /// What frame k holds, when it was taken, and whether it never comes.
  [[nodiscard]] std::vector<std::byte> bytes_of(long k) const;
  [[nodiscard]] Timestamp time_of(long k) const;
  [[nodiscard]] bool is_dropped(long k) const;

 private:
  int camera_;
  Behaviour behaviour_;
  capture::DeviceSettings settings_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  long next_ = 0;
  std::atomic<long> handed_out_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace marey::testing
