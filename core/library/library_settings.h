// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace marey {

/// One [[source]] of library.toml: a file, or a folder with all files below it that marey
/// reads.
struct LibrarySource {
  std::string path;     ///< As stated: relative to the library, or absolute.
  std::string kind;     ///< "bvh", "amc"...; empty: all that marey reads.
  std::string licence;  ///< SPDX expression; empty: unknown.
  std::string origin;   ///< Repository, address or person.
  std::string commit;   ///< Version of the origin.
  std::string attribution;
  /// The person who moves: a name, or a pattern for the file's name such as
  /// "{subject}_*".
  std::string subject;
  /// Pattern for names of files, such as "dataset-{set}_{content}_{style}_{n}": each word
  /// in braces becomes a label "WORD:VALUE".
  std::string pattern;
  std::string index;              ///< Table of rates and descriptions; empty: none.
  std::optional<double> rate_hz;  ///< Instead of the file's.
  std::vector<std::string> skip;  ///< Patterns of paths that are left out.
  int line = 0;                   ///< In library.toml, for messages; 0: unknown.
};

/// Limits of a figure: above `warn` a warning, above `fail` a failure.
struct QualityLimit {
  std::string figure;  ///< ClipFigure::name.
  double warn = 0.0;
  double fail = 0.0;
};

/// Division of long motions into clips.
enum class SegmentBy { kNone, kLabels, kStillness, kSteps, kChange };

/// Changes before a motion becomes a clip; the source stays.
enum class CleanBy { kNone, kRepair, kGround };

struct DuplicateRule {
  /// Mean distance of features of the same motion, over their mean change within 0.1 s.
  double max_distance = 0.15;
  /// Distance of the courses of one motion on two bodies (library/duplicates/).
  double max_body_distance = 0.3;
  double max_shift_s = 0.5;      ///< Difference of the starts.
  double min_cover_share = 0.9;  ///< Common part of the shorter one.
};

/// library.toml, the whole input of a library.
struct LibrarySettings {
  std::string name;
  std::string skeleton = "own";   ///< Skeleton of exports: "own", "marey", "smpl22"...
  std::optional<double> rate_hz;  ///< Rate of exports; nullopt: the clip's own.
  std::vector<LibrarySource> sources;
  std::vector<QualityLimit> limits;  ///< Limits that differ from the defaults.
  SegmentBy segment = SegmentBy::kNone;
  CleanBy clean = CleanBy::kNone;
  DuplicateRule duplicates;
  /// Names and shares of the splits; the shares add up to 1. Subjects are never divided.
  std::vector<std::pair<std::string, double>> splits = {
      {"train", 0.8}, {"val", 0.1}, {"test", 0.1}};
};

}  // namespace marey
