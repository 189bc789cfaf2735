// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/library/clip_record.h"

namespace marey::app {

/// The clip or the source that a label names.
struct LabelTarget {
  enum class Kind {
    kUnknown,
    kAmbiguous,  ///< Several sources fit equally well.
    kClip,       ///< Times count from the clip's first frame.
    kSource,     ///< Times count from frame 0 of the source.
  };
  Kind kind = Kind::kUnknown;
  std::string name;                ///< Id of the clip, or path of the source.
  std::vector<std::size_t> clips;  ///< Indexes of records, ascending.

  [[nodiscard]] bool is_found() const {
    return kind == Kind::kClip || kind == Kind::kSource;
  }
};

/// Finds the clips that a table of labels names. Borrows the records.
class LabelTargets {
 public:
  /// Linear in records.
  explicit LabelTargets(std::span<const ClipRecord> records);

  /// Returns the clip with this id, else the source with this path, else the only source
  /// whose file has this name. Names are compared without folders, extension, and the
  /// endings "_poses" and "_stageii" of AMASS. A source with more folders in common is
  /// preferred, then one with the same extension. A name with folders fits no source in
  /// another folder: the nearest folders must be equal, if both have one. Nothing is
  /// guessed: equally good sources are ambiguous. Constant time per source of the same
  /// name.
  [[nodiscard]] LabelTarget find(std::string_view name) const;

 private:
  [[nodiscard]] LabelTarget source(const std::string& path) const;

  std::unordered_map<std::string, std::size_t> clip_by_id_;
  std::unordered_map<std::string, std::vector<std::size_t>> clips_by_path_;
  std::unordered_map<std::string, std::vector<std::string>> paths_by_stem_;
};

}  // namespace marey::app
