// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace marey::recordings {

/// Kinds of files that other_kind() returns.
inline constexpr std::string_view kBinaryKind = "a binary file";
inline constexpr std::string_view kBvhKind = "a BVH motion";
inline constexpr std::string_view kC3dKind = "a C3D file of markers";
inline constexpr std::string_view kGltfKind = "a glTF or VRM file";
inline constexpr std::string_view kTrcKind = "a TRC file of markers";

/// Returns the kind of a file by its first bytes, for a message: "a glTF or VRM file", "a
/// video". Empty if the kind is unknown; the file may be text.
[[nodiscard]] std::string_view other_kind(std::string_view content);

/// Checks the first bytes of a file that should be of the kind `wanted`. Accepts content
/// of unknown kind; its reader checks the rest.
/// Errors (kBadInput), at `file`: the file is empty; it is of another kind.
[[nodiscard]] Status check_kind(std::string_view content,
                                const std::string& file,
                                std::string_view wanted);

/// Returns the error for a file without content (kBadInput).
[[nodiscard]] Error empty_file(const std::string& file);

}  // namespace marey::recordings
