// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "live/page/library_request.h"
#include "recordings/library/library_records.h"

namespace marey::app {

/// Clips that fulfil a condition, in the order of a list.
struct FoundClips {
  /// Clips that the query selects: passed, warned, failed.
  std::array<int, 3> counts{};
  std::vector<int> numbers;  ///< With the wanted verdict, in order.
  std::vector<std::string> remarks;
};

/// The clips of a library with the columns of its list. Memory: about 300 bytes per clip.
class ClipListing {
 public:
  /// Reads the index of the library in this folder. Errors (kBadInput): those of
  /// recordings::read_clip_summaries().
  [[nodiscard]] static Result<ClipListing> open(const std::filesystem::path& library);

  [[nodiscard]] int size() const { return static_cast<int>(clips_.size()); }
  /// Precondition: 0 <= number < size().
  [[nodiscard]] const recordings::ClipSummary& operator[](int number) const {
    return clips_[static_cast<std::size_t>(number)];
  }
  /// Returns the number of the clip with this id. Linear in clips.
  [[nodiscard]] std::optional<int> find(std::string_view clip_id) const;

  /// Evaluates the query of a request, sorts and keeps the last results. Offset and count
  /// are ignored. The pointer is valid until the next call. Errors: those of
  /// query_clips().
  [[nodiscard]] Result<const FoundClips*> find(const live::LibraryListRequest& request);

 private:
  struct Kept {
    live::LibraryListRequest request;
    FoundClips found;
  };

  ClipListing(std::filesystem::path library, std::vector<recordings::ClipSummary> clips)
      : library_(std::move(library)), clips_(std::move(clips)) {}
  [[nodiscard]] Result<FoundClips> evaluate(
      const live::LibraryListRequest& request) const;

  std::filesystem::path library_;
  std::vector<recordings::ClipSummary> clips_;
  std::list<Kept> kept_;  ///< Newest first.
};

}  // namespace marey::app
