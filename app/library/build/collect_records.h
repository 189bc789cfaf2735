// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "app/library/build/source_outcome.h"
#include "core/library/clip_record.h"

namespace marey::app {

/// Records of all clips, and where their rows of features are.
struct CollectedRecords {
  std::vector<ClipRecord> records;
  /// Key of the object with the features of each record's source.
  std::vector<std::string> feature_keys;
  /// First row of the record's features in that object.
  std::vector<std::size_t> first_rows;
  std::vector<std::string> remarks;
  /// Indexes of sources with a damaged object.
  std::vector<std::size_t> damaged;
};

/// Reads the records of all sources in their order, and adds what the settings state:
/// names, origin, licence, subject, labels of names. A source with the bytes of an
/// earlier one has no records; a remark names it.
[[nodiscard]] CollectedRecords collect_records(
    const BuildInputs& inputs,
    const std::vector<SourceFile>& sources,
    const std::vector<SourceOutcome>& outcomes);

}  // namespace marey::app
