// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/text/zip_store.h"

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
// The maximum value means "see ZIP64".
constexpr std::size_t kMaxZipValue = 0xffffffff;
constexpr std::size_t kMaxFiles = 0xfffe;

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

/// Appends the fields common to a local header and a directory entry.
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

std::size_t word_at(std::string_view bytes, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + i]));
  };
  return byte(0) | byte(1) << 8U;
}

std::size_t double_word_at(std::string_view bytes, std::size_t at) {
  return word_at(bytes, at) | word_at(bytes, at + 2) << 16U;
}

constexpr std::size_t kLocalHeaderBytes = 30;
constexpr std::size_t kDirectoryEntryBytes = 46;
constexpr std::size_t kDirectoryEndBytes = 22;

/// Sets the content of the directory's entry at `at`; returns false if the archive ends
/// before.
bool take_entry(std::string_view archive, std::size_t at, ZipEntry& entry) {
  const std::size_t method = word_at(archive, at + 10);
  const std::size_t size = double_word_at(archive, at + 20);
  const std::size_t place = double_word_at(archive, at + 42);
  entry.name = archive.substr(at + kDirectoryEntryBytes, word_at(archive, at + 28));
  entry.crc = static_cast<std::uint32_t>(double_word_at(archive, at + 16));
  entry.is_compressed = method != 0;
  if (place > archive.size() || archive.size() - place < kLocalHeaderBytes) return false;
  if (double_word_at(archive, place) != kLocalHeader) return false;
  const std::size_t begin = place + kLocalHeaderBytes + word_at(archive, place + 26) +
                            word_at(archive, place + 28);
  if (begin > archive.size() || size > archive.size() - begin) return false;
  if (!entry.is_compressed) entry.bytes = archive.substr(begin, size);
  return true;
}

}  // namespace

std::optional<std::vector<ZipEntry>> zip_entries(std::string_view archive) {
  if (archive.size() < kDirectoryEndBytes) return std::nullopt;
  // A comment of 64 KiB may follow the directory's end.
  std::size_t end = archive.size() - kDirectoryEndBytes;
  const std::size_t first = end > 0xffff ? end - 0xffff : 0;
  while (double_word_at(archive, end) != kDirectoryEnd) {
    if (end == first) return std::nullopt;
    --end;
  }
  const std::size_t count = word_at(archive, end + 10);
  std::size_t at = double_word_at(archive, end + 16);
  std::vector<ZipEntry> entries;
  for (std::size_t i = 0; i < count; ++i) {
    if (at > end || end - at < kDirectoryEntryBytes) return std::nullopt;
    if (double_word_at(archive, at) != kDirectoryEntry) return std::nullopt;
    const std::size_t length = kDirectoryEntryBytes + word_at(archive, at + 28) +
                               word_at(archive, at + 30) + word_at(archive, at + 32);
    if (length > end - at) return std::nullopt;
    ZipEntry entry;
    if (!take_entry(archive, at, entry)) return std::nullopt;
    entries.push_back(entry);
    at += length;
  }
  return entries;
}

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
          kMaxZipValue ||
      files_ == kMaxFiles) {
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
