// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "app/library/check/library_check.h"

namespace marey::app {

/// Largest number of clips on the page; the worst ones are kept. Its file has about 4 MB
/// then.
inline constexpr std::size_t kMaxPageClips = 10'000;

/// Returns check.html: one file that loads no other. The page has the totals, the
/// distribution of each figure with its limits, a table of clips that is sorted and
/// filtered in the browser, and the sources without clips. Same input, same bytes.
[[nodiscard]] std::string check_page(const LibraryCheck& check);

}  // namespace marey::app
