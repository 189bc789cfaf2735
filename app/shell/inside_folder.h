// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace marey::app {

/// Returns true if a path, with its links resolved, is `folder` or below it. False if the
/// path does not exist.
[[nodiscard]] bool is_inside(const std::filesystem::path& path,
                             const std::filesystem::path& folder);

/// Checks one file that may be missing or a link. Errors (kBadInput): it links to a place
/// outside `root`.
[[nodiscard]] Status check_link(const std::filesystem::path& file,
                                const std::filesystem::path& root);

/// Checks that no entry of `folder` is a link to a place outside `root`, so that a page
/// serves no files outside a folder of unknown origin. Checks only the entries of the
/// folder itself. Errors (kBadInput): the first such link, by name.
[[nodiscard]] Status check_links(const std::filesystem::path& folder,
                                 const std::filesystem::path& root);

}  // namespace marey::app
