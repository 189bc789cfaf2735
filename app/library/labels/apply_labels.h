// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/library/labels/library_labels.h"
#include "core/finding.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// A line of a table that changed no record.
struct UnusedLabel {
  std::string file;  ///< "labels/anna.csv".
  int line = 0;
  std::string cause;  ///< "no clip or source is named "walk"".
};

/// Adds the labels of people to the clips that they belong to. A label of a clip is cut
/// at the clip's end. A label of a source is cut to each of its clips: frame f of the
/// source is at f / rate, its times become relative to the clip, and a part shorter than
/// half a frame is left out. Labels stay ascending by start, then text; equal ones occur
/// once. Returns the lines that fit no clip, in order. Linear in records and labels, but
/// for sorting the labels of each clip.
[[nodiscard]] std::vector<UnusedLabel> apply_labels(const LibraryLabels& labels,
                                                    std::vector<ClipRecord>& records);

/// Returns a warning for each table with unused lines: their number, and the first one.
[[nodiscard]] std::vector<Finding> unused_label_findings(
    std::span<const UnusedLabel> unused);

/// Returns the first 16 hexadecimal digits of the SHA-256 of all labels of a clip, which
/// differ if any label does.
[[nodiscard]] std::string labels_digest(const ClipRecord& record);

}  // namespace marey::app
