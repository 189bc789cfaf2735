// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/library/clip_record.h"
#include "core/motion.h"

namespace marey::testing {

/// A clip of a library for tests.
struct PageClip {
  std::string name;
  Motion motion;
  std::string licence = "CC0-1.0";
  std::vector<std::string> labels;  ///< For the whole clip, by "table".
};

/// Writes a library as a build does, without its sources: library.toml, objects,
/// library.sqlite and the search files. Clips get their numbers in the order of the list.
/// Throws std::runtime_error if that fails.
void write_page_library(const std::filesystem::path& folder,
                        std::span<const PageClip> clips);

/// Returns `count` walks of different lengths, the odd ones with an injected defect.
[[nodiscard]] std::vector<PageClip> sample_page_clips(int count);

}  // namespace marey::testing
