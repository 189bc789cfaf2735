// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

// Private to recordings/moves: sums of blobs, and sums in the reserved bytes at the end
// of each page of a database, which SQLite leaves to programs.
namespace marey::recordings {

/// Reserved bytes of a page.
inline constexpr std::size_t kPageSumBytes = 8;

/// Writes the sum of each page: XXH3 with 64 bits of its other bytes, with the page's
/// number (from 1 on) as the seed; most significant byte first.
/// Precondition: whole pages of `page_bytes`, each with its reserved bytes.
void write_page_sums(std::string& bytes, std::size_t page_bytes);

/// Returns the number of the first page, from 1 on, whose sum differs from the stored
/// one; nullopt: all are equal. Same precondition.
[[nodiscard]] std::optional<std::size_t> find_damaged_page(std::string_view bytes,
                                                           std::size_t page_bytes);

/// Returns the sum of a blob: XXH3 with 128 bits, as 32 hexadecimal digits.
[[nodiscard]] std::string blob_sum(std::string_view bytes);

}  // namespace marey::recordings
