// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Private to capture: codes of OpenCV's dictionaries of 1000 markers. The dictionaries of
// 50, 100 and 250 markers are their first ones.
namespace marey::capture {

inline constexpr std::size_t kArucoCodes = 1000;

extern const std::array<std::uint16_t, kArucoCodes> kCodes4x4;
extern const std::array<std::uint32_t, kArucoCodes> kCodes5x5;
extern const std::array<std::uint64_t, kArucoCodes> kCodes6x6;
extern const std::array<std::uint64_t, kArucoCodes> kCodes7x7;

}  // namespace marey::capture
