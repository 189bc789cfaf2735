// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/zip_store.h"

#include <array>
#include <utility>

namespace marey::recordings {
namespace {

// PKWARE's APPNOTE 6.3.10: 4.3.7 (local header), 4.3.12 (directory), 4.3.16 (its end).
constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kDirectoryEntry = 0x02014b50;
constexpr std::uint32_t kDirectoryEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kFirstDay = (1U << 5) | 1U;  // 1 January 1980.
constexpr std::size_t kLargest = 0xffffffff;         // That value says "see ZIP64".
constexpr std::size_t kMostFiles = 0xfffe;

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t rest = i;
    for (int bit = 0; bit < 8; ++bit) {
      rest = (rest & 1U) != 0 ? 0xedb88320U ^ (rest >> 1U) : rest >> 1U;
    }
    table[i] = rest;
  }
  return table;
}

void append_word(std::string& bytes, std::size_t value) {
  for (unsigned shift = 0; shift < 16; shift += 8) {
    bytes += static_cast<char>((value >> shift) & 0xffU);
  }
}

void append_double_word(std::string& bytes, std::size_t value) {
  append_word(bytes, value & 0xffffU);
  append_word(bytes, value >> 16U);
}

/// What a local header and a directory entry have in common.
void append_facts(std::string& bytes, std::string_view name, std::string_view content) {
  append_word(bytes, 0);  // Flags.
  append_word(bytes, 0);  // Stored.
  append_word(bytes, 0);  // Midnight.
  append_word(bytes, kFirstDay);
  append_double_word(bytes, crc32(content));
  append_double_word(bytes, content.size());
  append_double_word(bytes, content.size());
  append_word(bytes, name.size());
  append_word(bytes, 0);  // Extra.
}

}  // namespace

std::uint32_t crc32(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = crc_table();
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) {
    crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 0xffU] ^ (crc >> 8U);
  }
  return ~crc;
}

void ZipStore::add(std::string_view name, std::string_view bytes) {
  constexpr std::size_t kHeaders = 128;
  if (archive_.size() + directory_.size() + bytes.size() + 2 * name.size() + kHeaders >
          kLargest ||
      files_ == kMostFiles) {
    too_large_ = true;
    return;
  }
  const std::size_t place = archive_.size();
  append_double_word(archive_, kLocalHeader);
  append_word(archive_, kVersion);
  append_facts(archive_, name, bytes);
  archive_.append(name).append(bytes);

  append_double_word(directory_, kDirectoryEntry);
  append_word(directory_, kVersion);
  append_word(directory_, kVersion);
  append_facts(directory_, name, bytes);
  append_word(directory_, 0);         // Comment.
  append_word(directory_, 0);         // Disk.
  append_word(directory_, 0);         // Internal attributes.
  append_double_word(directory_, 0);  // External attributes.
  append_double_word(directory_, place);
  directory_ += name;
  ++files_;
}

std::optional<std::string> ZipStore::finish() && {
  if (too_large_) return std::nullopt;
  const std::size_t place = archive_.size();
  archive_ += directory_;
  append_double_word(archive_, kDirectoryEnd);
  append_word(archive_, 0);  // Disk.
  append_word(archive_, 0);  // Disk of the directory.
  append_word(archive_, files_);
  append_word(archive_, files_);
  append_double_word(archive_, directory_.size());
  append_double_word(archive_, place);
  append_word(archive_, 0);  // Comment.
  return std::move(archive_);
}

}  // namespace marey::recordings
