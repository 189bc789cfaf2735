// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "core/base/result.h"
#include "core/library/clip_record.h"
#include "recordings/library/source_stage.h"

namespace marey::app {

/// Clips of one source.
struct SourceClips {
  /// Without names, provenance and everything that depends on other clips.
  std::vector<ClipRecord> records;
  /// Bytes of a file of rows (recordings/library/rows_file.h): features of the bodies'
  /// motions, one body after another. CollectedRecords::first_rows has the first row of
  /// each clip.
  std::string features;
};

/// Removes idle frames from both ends of the motions of a source, divides the rest into
/// clips (LibrarySettings::segment), and measures them: quality, labels, events. Reads
/// the motions' objects, not the source. Errors: an object that cannot be read.
[[nodiscard]] Result<SourceClips> make_clips(const BuildInputs& inputs,
                                             const SourceFile& file,
                                             const recordings::SourceStage& stage,
                                             const std::string& source_id);

}  // namespace marey::app
