// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/library/export/check_licences.h"
#include "app/library/export/exported_clip.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// A clip that was selected, but is not in the export.
struct LeftOutClip {
  std::string clip_id;
  std::string name;
  std::string reason;
};

/// Content of an export.
struct ExportReport {
  std::vector<ClipRecord> clips;  ///< As exported, mirrored copies after their clips.
  std::int64_t frames = 0;
  std::size_t selected = 0;  ///< Clips that the query selected.
  std::size_t in_library = 0;
  std::vector<LeftOutClip> left_out;
  std::vector<UnknownSide> unknown_sides;
  std::vector<LicenceGroup> licences;  ///< All licences of the selected clips.
};

/// Returns the number of exported clips without a subject. Splits by subject can divide
/// the person of these clips: only clips of one source stay together.
[[nodiscard]] std::size_t count_without_subject(const ExportReport& report);

}  // namespace marey::app
