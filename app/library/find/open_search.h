// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "library/search/find_similar.h"

#include "core/base/result.h"
#include "recordings/library/rows_file.h"

namespace marey::app {

/// The search rows of a library, mapped.
struct OpenedSearch {
  recordings::RowsFile features;
  recordings::RowsFile windows;
  recordings::RowsFile wholes;

  /// Valid as long as this object.
  [[nodiscard]] library::SearchRows rows() const;
};

/// Opens the rows that belong to the index of a library. Cost: that of opening three
/// files; rows are read from the disk when they are searched.
/// Errors (kBadInput): those of recordings::search_file() and RowsFile::open(); another
/// number of clips than in the index.
[[nodiscard]] Result<OpenedSearch> open_search(const std::filesystem::path& library);

}  // namespace marey::app
