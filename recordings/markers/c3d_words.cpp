// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/c3d_words.h"

#include <bit>
#include <cmath>

namespace marey::recordings {
namespace {

std::uint32_t byte_at(const char* bytes, int i) {
  return static_cast<unsigned char>(bytes[i]);
}

// A VAX F real: sign, 8 bits of exponent, 23 of fraction, with its 16-bit words swapped.
// Its value is 0.1fraction * 2^(exponent - 128); the same bits read as an IEEE real are
// four times as large. Exponent 0 is zero.
constexpr std::uint32_t kVaxExponent = 0x7F800000U;
constexpr std::uint32_t kVaxLargest = 0x7FFFFFFFU;

float from_vax(std::uint32_t bits) {
  const std::uint32_t exponent = (bits & kVaxExponent) >> 23U;
  if (exponent == 0) return 0.0F;
  const auto fraction = static_cast<double>((bits & 0x7FFFFFU) | 0x800000U);
  const double size = std::ldexp(fraction, static_cast<int>(exponent) - 128 - 24);
  return static_cast<float>((bits & 0x80000000U) != 0 ? -size : size);
}

std::uint32_t to_vax(float value) {
  if (value == 0.0F || std::isnan(value)) return 0;
  const std::uint32_t sign = std::signbit(value) ? 0x80000000U : 0U;
  if (std::isinf(value)) return sign | kVaxLargest;
  int exponent = 0;
  const double fraction = std::frexp(std::abs(static_cast<double>(value)), &exponent);
  if (exponent + 128 > 255) return sign | kVaxLargest;
  if (exponent + 128 < 1) return 0;
  const auto bits = static_cast<std::uint32_t>(std::ldexp(fraction, 24)) & 0x7FFFFFU;
  return sign | static_cast<std::uint32_t>(exponent + 128) << 23U | bits;
}

}  // namespace

std::uint16_t c3d_word(C3dProcessor processor, const char* bytes) {
  const bool big = processor == C3dProcessor::kMips;
  return static_cast<std::uint16_t>(byte_at(bytes, big ? 1 : 0) |
                                    byte_at(bytes, big ? 0 : 1) << 8U);
}

float c3d_real(C3dProcessor processor, const char* bytes) {
  const std::uint32_t first = c3d_word(processor, bytes);
  const std::uint32_t second = c3d_word(processor, bytes + 2);
  switch (processor) {
    case C3dProcessor::kIntel:
      return std::bit_cast<float>(first | second << 16U);
    case C3dProcessor::kDec:
      return from_vax(first << 16U | second);
    case C3dProcessor::kMips:
      return std::bit_cast<float>(first << 16U | second);
  }
  return 0.0F;
}

void append_c3d_word(std::string& out, C3dProcessor processor, std::uint16_t value) {
  const auto low = static_cast<char>(value & 0xFFU);
  const auto high = static_cast<char>(value >> 8U);
  const bool big = processor == C3dProcessor::kMips;
  out += big ? high : low;
  out += big ? low : high;
}

void append_c3d_real(std::string& out, C3dProcessor processor, float value) {
  const bool dec = processor == C3dProcessor::kDec;
  const std::uint32_t bits = dec ? to_vax(value) : std::bit_cast<std::uint32_t>(value);
  const auto high = static_cast<std::uint16_t>(bits >> 16U);
  const auto low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  const bool low_first = processor == C3dProcessor::kIntel;
  append_c3d_word(out, processor, low_first ? low : high);
  append_c3d_word(out, processor, low_first ? high : low);
}

}  // namespace marey::recordings
