// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace marey::capture {

/// A gap in a folder of numbered images.
struct NumberGap {
  std::string before;  ///< Name of the last image before it.
  std::string after;   ///< Name of the first image after it.
  int missing = 0;     ///< Number of images missing between the two.
  int gaps = 1;        ///< Number of gaps in the whole folder.
};

/// Returns the first gap in the numbers of `images`. The number of an image is the last
/// one in its name; images are in the order of list_images(). The sequence counts as even
/// if nine of ten steps are equal and the others are multiples of them. Returns nullopt
/// if there is no gap, or if the numbers are not frame counts, such as time stamps. Cost:
/// linear.
[[nodiscard]] std::optional<NumberGap> find_number_gap(
    std::span<const std::filesystem::path> images);

}  // namespace marey::capture
