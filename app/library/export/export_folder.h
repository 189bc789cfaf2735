// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/base/result.h"

namespace marey::app {

/// Name of the list of files in every export.
inline constexpr const char* kManifest = "MANIFEST.sha256";

/// Checks that a folder is not in the library: a build reads or removes what is there.
/// Errors (kBadInput): it is.
[[nodiscard]] Status check_outside(const std::filesystem::path& out,
                                   const std::filesystem::path& library);

/// Checks that an export may be written to `out`: it does not exist, is an empty folder,
/// or is an earlier export (it has MANIFEST.sha256) with nothing else in it and
/// `replaces` is set. Errors (kBadInput), with the path.
[[nodiscard]] Status check_export_folder(const std::filesystem::path& out, bool replaces);

/// Writes MANIFEST.sha256 of all files below a folder: lines of sha256sum(1), ascending
/// by path. Linear in bytes. Errors: the disk (kDevice).
[[nodiscard]] Status write_manifest(const std::filesystem::path& folder);

}  // namespace marey::app
