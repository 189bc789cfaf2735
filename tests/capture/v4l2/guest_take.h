// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

#include "capture/v4l2/v4l2_device.h"

namespace marey::guest {

/// Frames received from a device.
struct Take {
  int frames = 0;
  int dropped = 0;
  int damaged = 0;
  int gaps = 0;           ///< Steps of the sequence number other than one.
  int arrival_times = 0;  ///< Frames with an invalid time stamp.
  bool wrapped = false;
  Timestamp first{0};
  Timestamp last{0};
  std::uint32_t last_sequence = 0;
  std::string error;

  void add(const capture::RawFrame& frame) {
    if (frames > 0) gaps += frame.sequence == last_sequence + 1 ? 0 : 1;
    if (frames == 0) first = frame.time;
    wrapped |= frames > 0 && frame.sequence < last_sequence;
    last = frame.time;
    last_sequence = frame.sequence;
    ++frames;
    dropped += frame.dropped_before;
    damaged += frame.damaged ? 1 : 0;
    arrival_times += frame.time_is_arrival ? 1 : 0;
  }

  [[nodiscard]] std::string text() const {
    return std::to_string(frames) + " frames in " +
           std::to_string(std::lround(1e3 * seconds(last - first))) + " ms, " +
           std::to_string(dropped) + " dropped, " + std::to_string(damaged) +
           " damaged, " + std::to_string(gaps) + " gaps" +
           (error.empty() ? "" : "; " + error);
  }
};

/// Receives `frames` frames, or those before an error or a silence of 2 s.
[[nodiscard]] inline Take take(capture::V4l2Device& device, int frames) {
  Take result;
  while (result.frames < frames) {
    const auto frame = device.next(std::chrono::seconds(2));
    if (!frame || !*frame) {
      result.error = frame ? "no frame in 2 s" : frame.error().message();
      return result;
    }
    result.add(**frame);
  }
  return result;
}

}  // namespace marey::guest
