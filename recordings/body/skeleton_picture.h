// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// Draws a skeleton at rest from the front (its left hand on the right of the picture)
/// and from its left side, in marey's frame: joints that are bones as dots with the
/// bone's name, left ones blue, right ones red, others grey; tips as ends of lines; the
/// floor Y = 0 and a scale in metres. An .svg is a vector image, a .png has 1600 by 1000
/// pixels. Errors (kBadInput): another extension; a disk error. Precondition: one root,
/// which is the first joint.
[[nodiscard]] Status write_skeleton_picture(const std::filesystem::path& path,
                                            const Skeleton& skeleton,
                                            std::string_view title);

}  // namespace marey::recordings
