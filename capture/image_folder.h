// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "capture/frame_source.h"

namespace marey::capture {

/// Whether `a` comes before `b` when a person counts: runs of digits compare as numbers,
/// so "frame9.png" comes before "frame10.png". A strict total order on strings.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

/// The .png, .jpg and .jpeg files (any case) directly in a folder, or those of them that
/// a pattern stands for (core/name_pattern.h), in natural order of their names. kBadInput
/// when it cannot be listed or has none. Messages call the folder `name`.
[[nodiscard]] Result<std::vector<std::filesystem::path>> list_images(
    const std::filesystem::path& folder, const std::string& name);

/// The images of a folder as frames, in list_images()'s order, read one at a time. They
/// have no rate. Errors (kBadInput): none there; one that cannot be read; one whose size
/// differs from the first's.
[[nodiscard]] Result<std::unique_ptr<FrameSource>> open_image_folder(
    const std::filesystem::path& folder, std::string name);

}  // namespace marey::capture
