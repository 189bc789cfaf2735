// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace marey::live {

/// Writes OSC 1.0 bundles (time tag "immediately", not nested) as bytes. A limit of the
/// packet size splits the messages over several bundles.
///
/// Writes directly into buffers that are reused: nothing is allocated after the first
/// frame of a size. The same calls give the same bytes. (liblo builds a list of messages
/// on the heap for every bundle and then copies it; tests/live/vmc/osc_writer_test.cpp
/// uses it as the reference for these bytes.)
class OscWriter {
 public:
  /// `limit_bytes`: maximum size of one packet. A larger message gets its own packet.
  explicit OscWriter(std::size_t limit_bytes = 65507);

  /// Removes all packets; keeps the buffers.
  void clear();

  /// Begins a message. `types` has no comma. The arguments must follow as in `types`,
  /// before the next begin() or packets(). Text ends at its first zero byte.
  OscWriter& begin(std::string_view address, std::string_view types);
  OscWriter& add(std::int32_t number);
  OscWriter& add(float number);
  OscWriter& add(std::string_view text);

  /// Returns the complete bundles written since clear(), in order. Valid until the next
  /// call of another member.
  [[nodiscard]] std::span<const std::span<const std::uint8_t>> packets();

 private:
  [[nodiscard]] std::vector<std::uint8_t>& open() { return buffers_[used_ - 1]; }
  void start_packet();
  void end_message();
  void put(std::uint32_t word);
  void pad(std::string_view text);

  std::size_t limit_bytes_;
  std::vector<std::vector<std::uint8_t>> buffers_;
  std::size_t used_ = 0;           ///< Number of buffers in use.
  std::size_t message_start_ = 0;  ///< Offset of the open message's size; 0: none open.
  std::vector<std::span<const std::uint8_t>> packets_;
};

}  // namespace marey::live
