// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/markers/c3d.h"

namespace marey::recordings {

inline constexpr std::size_t kC3dBlock = 512;

/// Position of the frames in a file.
struct C3dLayout {
  std::uint64_t data_at = 0;    ///< Byte of the first frame.
  std::size_t frame_words = 0;  ///< Words per frame, of points and analog samples.
  std::size_t bytes_per_word = 4;
};

/// Position of the parameter section, and the processor that it names.
struct C3dSection {
  std::size_t begin = 0;  ///< Byte of the section's own four-byte header.
  C3dProcessor processor = C3dProcessor::kIntel;
};

/// Finds the parameter section: at the header's position, else in the blocks after the
/// header, which is reported in `notes`. `bytes` is the beginning of the file. Errors:
/// not a C3D file.
[[nodiscard]] Result<C3dSection> find_c3d_section(std::string_view bytes,
                                                  const std::string& file,
                                                  std::vector<std::string>& notes);

/// Reads the header and reconciles it with the parameters in `info.groups` and with the
/// file's size. If they contradict each other, the numbers whose frames end at the end of
/// the file are used. Errors (kBadInput): no usable frame rate; no complete frame though
/// the header declares some. Preconditions: `header` has 512 bytes; `info.groups` and
/// `info.processor` are set.
[[nodiscard]] Result<C3dLayout> lay_out_c3d(std::string_view header,
                                            std::uint64_t file_size,
                                            const std::string& file,
                                            C3dInfo& info);

}  // namespace marey::recordings
