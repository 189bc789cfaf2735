// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace marey::live {

/// Writes OSC 1.0 bundles ("immediately", no bundles inside) as bytes, several when there
/// is a limit to a packet's size.
///
/// It writes straight into buffers that it keeps: after the first frame of a size nothing
/// is allocated, and the same calls give the same bytes. (liblo builds a list of messages
/// on the heap for every bundle and then copies it; it is the judge of these bytes in
/// tests/live/osc_writer_test.cpp.)
class OscWriter {
 public:
  /// `limit_bytes`: of one packet. Messages larger than that have a packet of their own.
  explicit OscWriter(std::size_t limit_bytes = 65507);

  /// Forgets all packets.
  void clear();

  /// Begins a message; its arguments must follow as `types` says, without the comma,
  /// before the next begin() or packets(). Text ends where it has a zero byte.
  OscWriter& begin(std::string_view address, std::string_view types);
  OscWriter& add(std::int32_t number);
  OscWriter& add(float number);
  OscWriter& add(std::string_view text);

  /// What was written since clear(): whole bundles, in order. Valid until the next call
  /// of anything else.
  [[nodiscard]] std::span<const std::span<const std::uint8_t>> packets();

 private:
  [[nodiscard]] std::vector<std::uint8_t>& open() { return buffers_[used_ - 1]; }
  void start_packet();
  void end_message();
  void put(std::uint32_t word);
  void pad(std::string_view text);

  std::size_t limit_bytes_;
  std::vector<std::vector<std::uint8_t>> buffers_;
  std::size_t used_ = 0;           ///< Of the buffers.
  std::size_t message_start_ = 0;  ///< Of its size, in the open buffer; 0: none is open.
  std::vector<std::span<const std::uint8_t>> packets_;
};

}  // namespace marey::live
