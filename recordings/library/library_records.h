// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

// Clips of library.sqlite. A clip's number is its place in the list that
// write_library_index() wrote: the numbers are 0 to clips - 1.
//
// The index is opened for reading only, as an immutable file: a build that replaces it
// does not disturb the reader, and nothing is written next to it. Errors (kBadInput) of
// all functions: no index at `index`; a damaged one, or one of another version of marey;
// a number that it does not have. The next step names the command that makes it again.
// Ids and keys of clips are checked: they are hexadecimal digits, so that they are safe
// as names of files. The id of a mirrored copy in an export's index ends with "_mirror".

/// Returns the number of clips. Cost: that of opening the file, about 1 ms.
[[nodiscard]] Result<int> count_library_clips(const std::filesystem::path& index);

/// Returns the complete records of the clips with these numbers, in this order. They
/// equal the written records. Cost: docs/accuracy/library.md.
[[nodiscard]] Result<std::vector<ClipRecord>> read_library_records(
    const std::filesystem::path& index, std::span<const int> numbers);

/// Returns the complete records of all clips, in the order of their numbers. Memory:
/// about 4 kB for each clip with 20 figures and ten labels.
[[nodiscard]] Result<std::vector<ClipRecord>> read_library_records(
    const std::filesystem::path& index);

/// A clip in a list.
struct ClipSummary {
  int number = 0;
  std::string clip_id;
  std::string name;
  double duration_s = 0.0;
  double rate_hz = 0.0;
  Verdict quality = Verdict::kPass;
  std::string licence;
  std::string subject;
  std::string split;
  /// Distinct texts of the labels by people and tables, ascending.
  std::vector<std::string> labels;
  /// Distinct texts of the labels by marey, ascending.
  std::vector<std::string> found_labels;
};

/// Returns the summaries of the clips with these numbers, in this order: a page of the
/// result of a query.
[[nodiscard]] Result<std::vector<ClipSummary>> read_clip_summaries(
    const std::filesystem::path& index, std::span<const int> numbers);

/// Returns the summaries of `count` clips from number `first` on; fewer at the end of the
/// library. Precondition: neither is negative.
[[nodiscard]] Result<std::vector<ClipSummary>> read_clip_summaries(
    const std::filesystem::path& index, int first, int count);

}  // namespace marey::recordings
