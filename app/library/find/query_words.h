// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "recordings/library/select_clips.h"

namespace marey::app {

/// Meaning of the word before a comparison.
struct QueryWord {
  enum class Kind {
    kText,       ///< `text` of the record.
    kNumber,     ///< `number` of the record.
    kFigure,     ///< The figure `name`.
    kQuality,    ///< The verdict.
    kLabel,      ///< A label with this text.
    kLabelWord,  ///< A label "`name`:value".
    kEvent,
    kProblem,
    kDuplicate,  ///< yes or no.
    kMirror,     ///< yes or no.
  };
  Kind kind = Kind::kText;
  recordings::ClipText text = recordings::ClipText::kName;
  recordings::ClipNumber number = recordings::ClipNumber::kSeconds;
  std::string name;
};

/// Words of one library, read from its index when they are first needed.
class QueryVocabulary {
 public:
  /// Precondition: `selector` lives longer.
  explicit QueryVocabulary(const recordings::ClipSelector& selector)
      : selector_(selector) {}

  /// Returns the distinct words of a kind, ascending. Errors: those of ClipSelector.
  [[nodiscard]] Result<std::span<const std::string>> words(recordings::WordKind kind);

  /// Returns the words that come before ':' in labels, ascending: "content".
  [[nodiscard]] Result<std::vector<std::string>> label_words();

  /// Returns the meaning of a word before a comparison; nullopt: it has none. The words
  /// of records come first, then figures, then words of labels. A figure may be written
  /// without its unit: "slide" is "slide_cm_s" if no other figure is so called.
  /// "figure.NAME" is always a figure.
  [[nodiscard]] Result<std::optional<QueryWord>> meaning(std::string_view word);

  /// Returns all words that may stand before a comparison; `numbers_only`: those before
  /// < and >.
  [[nodiscard]] Result<std::vector<std::string>> known_words(bool numbers_only);

 private:
  [[nodiscard]] Result<std::vector<std::string>> figures_called(std::string_view word);

  const recordings::ClipSelector& selector_;
  std::map<recordings::WordKind, std::vector<std::string>> words_;
};

/// Returns a correction for `wrong`, as suggestion(), with at most eight of the nearest
/// words if none is near. Precondition: `words` not empty.
[[nodiscard]] std::string nearest_suggestion(std::string_view wrong,
                                             std::span<const std::string> words);

}  // namespace marey::app
