// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/page_sums.h"

#include <cstring>

#include <xxhash.h>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

static_assert(sizeof(XXH64_canonical_t) == kPageSumBytes);

XXH64_canonical_t page_sum(std::string_view page, std::size_t number) {
  XXH64_canonical_t sum{};
  XXH64_canonicalFromHash(
      &sum, XXH3_64bits_withSeed(page.data(), page.size() - kPageSumBytes, number));
  return sum;
}

}  // namespace

void write_page_sums(std::string& bytes, std::size_t page_bytes) {
  MAREY_ASSERT(page_bytes > kPageSumBytes && bytes.size() % page_bytes == 0);
  for (std::size_t at = 0; at < bytes.size(); at += page_bytes) {
    const std::string_view page = std::string_view(bytes).substr(at, page_bytes);
    const XXH64_canonical_t sum = page_sum(page, at / page_bytes + 1);
    std::memcpy(bytes.data() + at + page_bytes - kPageSumBytes, &sum, kPageSumBytes);
  }
}

std::optional<std::size_t> find_damaged_page(std::string_view bytes,
                                             std::size_t page_bytes) {
  MAREY_ASSERT(page_bytes > kPageSumBytes && bytes.size() % page_bytes == 0);
  for (std::size_t at = 0; at < bytes.size(); at += page_bytes) {
    const std::string_view page = bytes.substr(at, page_bytes);
    const XXH64_canonical_t sum = page_sum(page, at / page_bytes + 1);
    const char* const stored = page.data() + page_bytes - kPageSumBytes;
    if (std::memcmp(stored, &sum, kPageSumBytes) != 0) return at / page_bytes + 1;
  }
  return std::nullopt;
}

std::string blob_sum(std::string_view bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  XXH128_canonical_t sum{};
  XXH128_canonicalFromHash(&sum, XXH3_128bits(bytes.data(), bytes.size()));
  std::string text;
  for (const unsigned char byte : sum.digest) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

}  // namespace marey::recordings
