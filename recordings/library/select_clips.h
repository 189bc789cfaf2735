// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/library/clip_record.h"

namespace marey::recordings {

/// An entry per clip, by number: true for the selected ones.
using ClipSet = std::vector<bool>;

enum class Comparison { kEqual, kNotEqual, kLess, kLessEqual, kGreater, kGreaterEqual };

/// Texts of a clip's record.
enum class ClipText {
  kId,
  kName,
  kPath,
  kKind,
  kLicence,
  kOrigin,
  kSubject,
  kSplit,
  kBody,
  kRateBasis,
  kDuplicateOf,
  kMirrorOf,
};

/// Numbers of a clip's record.
enum class ClipNumber { kSeconds, kRateHz, kFrames };

/// Kinds of words whose list the index has.
enum class WordKind {
  kFigure,
  kLabel,
  kEvent,
  kProblem,
  kKind,
  kLicence,
  kSubject,
  kSplit
};

/// An open library.sqlite that selects clips by conditions. Opened once for all
/// conditions of a query, for reading only, as library_records.h. Values are bound, never
/// a part of the SQL. Errors (kBadInput) of all functions: a damaged index.
/// Cost of a condition: linear in the rows that it selects or has to look at, 5 to 60 ms
/// for 100 000 clips (docs/accuracy/library.md).
class ClipSelector {
 public:
  /// Errors (kBadInput): no index at `index`, a damaged one, or of another version.
  [[nodiscard]] static Result<ClipSelector> open(const std::filesystem::path& index);

  ClipSelector(ClipSelector&& other) noexcept;
  ClipSelector& operator=(ClipSelector&&) = delete;
  ClipSelector(const ClipSelector&) = delete;
  ClipSelector& operator=(const ClipSelector&) = delete;
  ~ClipSelector();

  [[nodiscard]] int clip_count() const;

  /// Returns the distinct words of a kind, ascending.
  [[nodiscard]] Result<std::vector<std::string>> words(WordKind kind) const;

  [[nodiscard]] Result<ClipSet> with_text(ClipText which, std::string_view value) const;
  /// Selects clips whose text contains `part`. The case of A to Z does not count.
  [[nodiscard]] Result<ClipSet> with_part_of_text(ClipText which,
                                                  std::string_view part) const;
  [[nodiscard]] Result<ClipSet> with_number(ClipNumber which,
                                            Comparison comparison,
                                            double value) const;
  /// Selects clips with a figure of this name whose value compares so.
  [[nodiscard]] Result<ClipSet> with_figure(std::string_view name,
                                            Comparison comparison,
                                            double value) const;
  /// Selects clips with a label of this text that lasts for `min_s` or longer.
  [[nodiscard]] Result<ClipSet> with_label(std::string_view text,
                                           double min_s = 0.0) const;
  /// Selects clips with a label that begins with `beginning` and contains `part` after
  /// it. The case of A to Z does not count in `part`.
  [[nodiscard]] Result<ClipSet> with_part_of_label(std::string_view part,
                                                   std::string_view beginning = {}) const;
  [[nodiscard]] Result<ClipSet> with_event(std::string_view name) const;
  [[nodiscard]] Result<ClipSet> with_problem(std::string_view kind) const;
  /// Selects clips with all of these words in their name or their labels (not those by
  /// marey), in any order. Case, accents and punctuation do not count; a word of several
  /// parts, such as "turn-left", has them one after another. Words without a letter or a
  /// digit select nothing.
  [[nodiscard]] Result<ClipSet> with_words(std::span<const std::string> words) const;
  [[nodiscard]] Result<ClipSet> with_quality(Verdict quality) const;

 private:
  class Index;
  explicit ClipSelector(std::unique_ptr<Index> index);
  std::unique_ptr<Index> index_;
};

}  // namespace marey::recordings
