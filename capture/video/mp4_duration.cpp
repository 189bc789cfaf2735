// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/mp4_duration.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/extension.h"
#include "core/base/input_file.h"

namespace marey::capture {
namespace {

/// Reads a big-endian number, as all in MP4; returns nullopt at the end of the file.
std::optional<std::uint64_t> read_number(std::istream& in, std::size_t bytes) {
  std::array<char, 8> raw{};
  if (!in.read(raw.data(), static_cast<std::streamsize>(bytes))) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    value = (value << 8U) | static_cast<unsigned char>(raw[i]);
  }
  return value;
}

/// Skips boxes from the position of `in` until it is inside the first one with `type`.
/// Returns false if there is none.
bool enter_box(std::istream& in, std::string_view type) {
  constexpr int kMaxBoxes = 10000;  // Protects against endless loops in a broken file.
  for (int i = 0; i < kMaxBoxes; ++i) {
    auto size = read_number(in, 4);
    std::array<char, 4> name{};
    if (!size || !in.read(name.data(), name.size())) return false;
    std::uint64_t header = 8;
    if (*size == 1) {
      size = read_number(in, 8);
      header = 16;
    }
    if (std::string_view(name.data(), name.size()) == type) return true;
    constexpr std::uint64_t kLargest = std::uint64_t{1} << 50U;
    if (!size || *size < header || *size > kLargest) return false;
    in.seekg(static_cast<std::streamoff>(*size - header), std::ios::cur);
  }
  return false;
}

}  // namespace

bool is_mp4(const std::filesystem::path& path) {
  const std::string kind = kind_by_extension(path);
  return kind == ".mp4" || kind == ".mov" || kind == ".m4v";
}

std::optional<double> mp4_duration_s(const std::filesystem::path& path) {
  if (!check_input_file(path)) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!enter_box(in, "moov") || !enter_box(in, "mvhd")) return std::nullopt;
  const auto version = read_number(in, 1);
  if (!version || *version > 1) return std::nullopt;
  const std::size_t wide = *version == 1 ? 8 : 4;
  // Flags, time of creation, time of modification.
  in.ignore(static_cast<std::streamsize>(3 + 2 * wide));
  const auto ticks_per_second = read_number(in, 4);
  const auto ticks = read_number(in, wide);
  if (!ticks || *ticks == 0 || *ticks_per_second == 0) return std::nullopt;
  return static_cast<double>(*ticks) / static_cast<double>(*ticks_per_second);
}

}  // namespace marey::capture
