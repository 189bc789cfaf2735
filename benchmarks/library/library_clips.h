// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "library/search/find_similar.h"

namespace marey {

/// A clip of the benchmarks: its name and its features.
struct BenchmarkClip {
  std::string name;         ///< File name without its ending.
  std::vector<float> rows;  ///< library::kFeatureStride per instant.

  [[nodiscard]] int count() const;
};

/// Part `k` of the words between "_" in a name such as
/// "dataset-2_raise-up-left-hand_active_001"; empty: there are fewer.
[[nodiscard]] std::string word_of(const std::string& name, int k);

/// Reads the motions and computes their features, ascending by name. A cache file is read
/// if it exists, and else written. Stops the program, with a message, if a file cannot be
/// read.
[[nodiscard]] std::vector<BenchmarkClip> read_clips(
    const std::vector<std::filesystem::path>& files, const std::filesystem::path& cache);

/// Returns all files below a folder whose name ends like this, sorted.
[[nodiscard]] std::vector<std::filesystem::path> files_below(
    const std::filesystem::path& folder, const std::string& ending);

/// True for the clips of set 1 and for one half of the others, by a hash of the name:
/// constants are chosen on these. The rest is only measured.
[[nodiscard]] bool is_tuned_on(const std::string& name);

/// The search files of clips, in memory.
class ClipLibrary {
 public:
  void add(std::span<const float> rows);
  [[nodiscard]] library::SearchRows rows() const;
  [[nodiscard]] int count() const { return static_cast<int>(feature_begins_.size()) - 1; }
  [[nodiscard]] double hours() const;

 private:
  std::vector<float> features_, windows_, wholes_;
  std::vector<std::uint64_t> feature_begins_{0}, window_begins_{0}, whole_begins_{0};
};

}  // namespace marey
