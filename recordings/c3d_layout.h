// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/c3d.h"

namespace marey::recordings {

inline constexpr std::size_t kC3dBlock = 512;

/// Where a file's frames are.
struct C3dLayout {
  std::uint64_t data_at = 0;    ///< Byte of the first frame.
  std::size_t frame_words = 0;  ///< Of points and analog samples.
  std::size_t bytes_per_word = 4;
};

/// Where the parameter section begins, and the processor that it names.
struct C3dSection {
  std::size_t begin = 0;  ///< Byte of the section's own four bytes.
  C3dProcessor processor = C3dProcessor::kIntel;
};

/// Finds the parameter section: where the header says, else in the blocks after it, which
/// is told in `notes`. `bytes` are the file's first ones. Errors: this is no C3D file.
[[nodiscard]] Result<C3dSection> find_c3d_section(std::string_view bytes,
                                                  const std::string& file,
                                                  std::vector<std::string>& notes);

/// Reads the header and reconciles it with the parameters in `info.groups`, which with
/// `info.processor` are there already, and with the size of the file. Where they
/// contradict each other, the numbers are believed whose frames end where the file does.
/// Errors (kBadInput): no usable frame rate; no whole frame, though some are promised.
/// Precondition: `header` has 512 bytes.
[[nodiscard]] Result<C3dLayout> lay_out_c3d(std::string_view header,
                                            std::uint64_t file_size,
                                            const std::string& file,
                                            C3dInfo& info);

}  // namespace marey::recordings
