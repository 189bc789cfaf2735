// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/library/build/build_inputs.h"
#include "app/library/build/collect_records.h"
#include "core/base/result.h"

namespace marey::app {

/// Returns the name of the folder of search rows for these clips: 16 hexadecimal digits
/// that depend on the clips, their order and their features.
[[nodiscard]] std::string search_folder_name(const CollectedRecords& clips);

/// Returns true if the rows in search/NAME exist and are whole, by their checksums.
[[nodiscard]] bool has_search_rows(const BuildInputs& inputs, const std::string& name);

/// Writes the rows for searches of all clips into search/NAME, unless they exist: their
/// features, windows and whole clips. Reads one object of features at a time.
/// Errors: (kBadInput) objects of features are damaged; `damaged` gets the index of a
/// record of each; (kDevice) the disk.
[[nodiscard]] Status write_search_rows(const BuildInputs& inputs,
                                       const CollectedRecords& clips,
                                       const std::string& name,
                                       std::vector<std::size_t>& damaged);

/// Removes the folders of search rows except `current` and `before`: readers of the
/// version before may still open theirs.
void remove_old_search_rows(const BuildInputs& inputs,
                            const std::string& current,
                            const std::string& before);

}  // namespace marey::app
