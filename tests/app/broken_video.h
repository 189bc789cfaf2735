// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

namespace marey::testing {

/// The first part of a file: what is left of it when the disk was full. `share` 0 to 1.
void copy_part(const std::filesystem::path& from,
               const std::filesystem::path& to,
               double share);

/// The first part of an MP4 whose index ("moov") comes last, as cameras write them: the
/// index is what gets lost. `from` may have it anywhere.
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

}  // namespace marey::testing
