// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace marey::tests {

/// Returns the brightness that write_video() gives to frame `index`: steps large enough
/// to survive the codec.
[[nodiscard]] int brightness_of_frame(int index);

/// Writes a motion JPEG film of `frames` plain grey frames, 64x48, 25 frames a second, in
/// the container of the extension of `path` (.mp4, .avi, .mkv).
void write_video(const std::filesystem::path& path, int frames);

/// Writes the same frames as PNG images, f0.png, f1.png...
void write_images(const std::filesystem::path& folder, int frames);

/// Cuts a file to a part of its size.
void truncate(const std::filesystem::path& path, double fraction);

}  // namespace marey::tests
