// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace marey::app {

/// Whether a path, its links followed, is `folder` or below it. False where it is not there.
[[nodiscard]] bool is_inside(const std::filesystem::path& path,
                             const std::filesystem::path& folder);

/// Checks one file that may be missing or a link. Errors (kBadInput): it leads out of `root`.
[[nodiscard]] Status check_link(const std::filesystem::path& file,
                                const std::filesystem::path& root);

/// Checks that nothing in `folder` leads out of `root` by a link: what a page serves of a
/// folder that somebody else made stays in it. Looks at the folder's own entries only.
/// Errors (kBadInput): the first link that does, by name.
[[nodiscard]] Status check_links(const std::filesystem::path& folder,
                                 const std::filesystem::path& root);

}  // namespace marey::app
