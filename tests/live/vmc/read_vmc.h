// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace marey::live {

/// A message as liblo reads it: its numbers as doubles, its texts in order.
struct ReadMessage {
  std::string address;
  std::string types;
  std::vector<std::string> texts;
  std::vector<double> numbers;
};

/// All messages of a packet, read by liblo; none if liblo declines it.
[[nodiscard]] std::vector<ReadMessage> read_by_liblo(
    std::span<const std::uint8_t> packet);

}  // namespace marey::live
