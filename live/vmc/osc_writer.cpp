// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/osc_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace marey::live {
namespace {

// "#bundle" with its zero byte, then the time tag "immediately".
constexpr std::array<std::uint8_t, 16> kBundleHead{
    '#', 'b', 'u', 'n', 'd', 'l', 'e', 0, 0, 0, 0, 0, 0, 0, 0, 1};

constexpr std::size_t kSizeBytes = 4;

}  // namespace

OscWriter::OscWriter(std::size_t limit_bytes) : limit_bytes_(limit_bytes) {}

void OscWriter::clear() {
  used_ = 0;
  message_start_ = 0;
  packets_.clear();
}

void OscWriter::start_packet() {
  if (used_ == buffers_.size()) buffers_.emplace_back();
  ++used_;
  open().assign(kBundleHead.begin(), kBundleHead.end());
}

OscWriter& OscWriter::begin(std::string_view address, std::string_view types) {
  end_message();
  if (used_ == 0) start_packet();
  message_start_ = open().size();
  put(0);  // Placeholder for the size; end_message() writes it.
  pad(address);
  open().push_back(',');
  open().insert(open().end(), types.begin(), types.end());
  open().resize(open().size() + 4 - (types.size() + 1) % 4);
  return *this;
}

void OscWriter::end_message() {
  if (message_start_ == 0) return;
  const std::size_t start = std::exchange(message_start_, 0);
  std::vector<std::uint8_t>& packet = open();
  const auto size = static_cast<std::uint32_t>(packet.size() - start - kSizeBytes);
  for (std::size_t i = 0; i < kSizeBytes; ++i) {
    packet[start + i] = static_cast<std::uint8_t>(size >> (24 - 8 * i));
  }
  if (packet.size() <= limit_bytes_ || start == kBundleHead.size()) return;
  start_packet();
  std::vector<std::uint8_t>& full = buffers_[used_ - 2];
  const auto message = full.begin() + static_cast<std::ptrdiff_t>(start);
  open().insert(open().end(), message, full.end());
  full.erase(message, full.end());
}

void OscWriter::put(std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    open().push_back(static_cast<std::uint8_t>(word >> shift));
  }
}

void OscWriter::pad(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  open().insert(open().end(), text.begin(), text.end());
  open().resize(open().size() + 4 - text.size() % 4);
}

OscWriter& OscWriter::add(std::int32_t number) {
  put(static_cast<std::uint32_t>(number));
  return *this;
}

OscWriter& OscWriter::add(float number) {
  put(std::bit_cast<std::uint32_t>(number));
  return *this;
}

OscWriter& OscWriter::add(std::string_view text) {
  pad(text);
  return *this;
}

std::span<const std::span<const std::uint8_t>> OscWriter::packets() {
  end_message();
  packets_.clear();
  for (std::size_t i = 0; i < used_; ++i) packets_.emplace_back(buffers_[i]);
  return packets_;
}

}  // namespace marey::live
