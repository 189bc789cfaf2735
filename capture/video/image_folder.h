// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "capture/video/frame_source.h"

namespace marey::capture {

/// Returns true if `a` precedes `b` in natural order: runs of digits compare as numbers,
/// so "frame9.png" comes before "frame10.png". A strict total order on strings.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

/// Returns the .png, .jpg and .jpeg files (any case) directly in a folder, or only the
/// names that match a pattern (core/base/name_pattern.h), in natural order. Errors
/// (kBadInput): the folder cannot be listed, or has no images. `name` is the folder's
/// name in messages.
[[nodiscard]] Result<std::vector<std::filesystem::path>> list_images(
    const std::filesystem::path& folder, const std::string& name);

/// Returns the images of a folder as frames, in the order of list_images(), read one at a
/// time. They have no rate. Errors (kBadInput): no images; an unreadable image; an image
/// whose size differs from the first's.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_image_folder(
    const std::filesystem::path& folder, std::string name);

}  // namespace marey::capture
