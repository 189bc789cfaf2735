// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace marey::capture {

/// A place in a folder of numbered images where some are missing.
struct NumberGap {
  std::string before;  ///< The name of the last image before it.
  std::string after;   ///< Of the first behind it.
  int missing = 0;     ///< Images that should be between the two.
  int gaps = 1;        ///< In the whole folder.
};

/// Returns the first place at which the last numbers in the names of `images`, in the
/// order of list_images(), leave out some of an otherwise even sequence: nine of ten
/// steps are alike, and the others are multiples of it. nullopt where nothing is missing,
/// or where the numbers count no frames, such as time stamps. Cost: linear.
[[nodiscard]] std::optional<NumberGap> find_number_gap(
    std::span<const std::filesystem::path> images);

}  // namespace marey::capture
