// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace marey::testing {

/// Copies the first part of a file, as a full disk leaves it. `share` is 0 to 1.
void copy_part(const std::filesystem::path& from,
               const std::filesystem::path& to,
               double share);

/// Copies the first part of an MP4 whose index ("moov") is last, as in files of cameras.
/// The copy has no index. `from` may have the index anywhere.
void copy_part_without_index(const std::filesystem::path& from,
                             const std::filesystem::path& to,
                             double share);

/// A video of `frames` frames of nothing but grey, of the size and rate of `like`.
void write_grey_video(const std::filesystem::path& like,
                      const std::filesystem::path& to,
                      int frames);

/// A copy in which only the frames that `is_kept` keeps show anything.
void copy_with_blanks(const std::filesystem::path& from,
                      const std::filesystem::path& to,
                      const std::function<bool(int frame)>& is_kept);

/// A copy of a camera that was started `late` frames later.
void copy_late(const std::filesystem::path& from,
               const std::filesystem::path& to,
               int late);

/// A copy whose pictures are turned by a quarter (their size is, too) or by half.
void copy_turned(const std::filesystem::path& from,
                 const std::filesystem::path& to,
                 int degrees,
                 int frames);

/// A copy of an MP4 with a mark that its pictures are to be shown upside down.
void copy_marked_upside_down(const std::filesystem::path& from,
                             const std::filesystem::path& to);

/// Grey images of the size of `like`, named frame_000.png to frame_012.png, without those
/// of the numbers 7 and 8.
void write_images_with_a_gap(const std::filesystem::path& like,
                             const std::filesystem::path& folder);

}  // namespace marey::testing
