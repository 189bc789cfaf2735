// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/zip_archive.h"

#include <cstdint>
#include <system_error>

#include <zip.h>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

/// Moves what libzip wrote into a string. Precondition: the archive is closed.
std::string take_bytes(zip_source_t* source) {
  zip_stat_t facts;
  MAREY_ASSERT(zip_source_stat(source, &facts) == 0 && zip_source_open(source) == 0);
  std::string bytes(facts.size, '\0');
  MAREY_ASSERT(zip_source_read(source, bytes.data(), bytes.size()) ==
               static_cast<zip_int64_t>(bytes.size()));
  zip_source_close(source);
  return bytes;
}

/// Adds a file, whose bytes must outlive zip_close().
void add_file(zip_t* archive, const std::string& name, const std::string& bytes) {
  constexpr zip_uint16_t kFirstDay = (1U << 5U) | 1U;  // 1 January 1980.
  zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
  MAREY_ASSERT(source != nullptr);
  const zip_int64_t added = zip_file_add(archive, name.c_str(), source, 0);
  MAREY_ASSERT(added >= 0);
  const auto at = static_cast<zip_uint64_t>(added);
  // With a time stamp, libzip would convert it to the local time.
  MAREY_ASSERT(zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) == 0 &&
               zip_file_set_dostime(archive, at, 0, kFirstDay, 0) == 0);
}

}  // namespace

void ZipWriter::add(std::string name, std::string bytes) {
  constexpr std::size_t kHeaders = 128;
  size_ += 2 * name.size() + bytes.size() + kHeaders;
  files_.emplace_back(std::move(name), std::move(bytes));
}

std::optional<std::string> ZipWriter::finish() && {
  constexpr std::size_t kMaxSize = 0xffffffff;
  if (size_ > kMaxSize) return std::nullopt;
  // Nothing but a lack of memory can fail from here on.
  zip_source_t* sink = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  MAREY_ASSERT(sink != nullptr);
  zip_t* archive = zip_open_from_source(sink, ZIP_TRUNCATE, nullptr);
  MAREY_ASSERT(archive != nullptr);
  zip_source_keep(sink);
  for (const auto& [name, bytes] : files_) add_file(archive, name, bytes);
  MAREY_ASSERT(zip_close(archive) == 0);
  files_.clear();
  std::string bytes = take_bytes(sink);
  zip_source_free(sink);
  return bytes;
}

void ZipReader::Discard::operator()(zip* archive) const {
  zip_discard(archive);
}

std::optional<ZipReader> ZipReader::open(std::string_view archive) {
  zip_source_t* source =
      zip_source_buffer_create(archive.data(), archive.size(), 0, nullptr);
  MAREY_ASSERT(source != nullptr);
  if (zip_t* opened = zip_open_from_source(source, ZIP_RDONLY, nullptr)) {
    return ZipReader(opened, archive.size());
  }
  zip_source_free(source);
  return std::nullopt;
}

std::optional<ZipReader> ZipReader::open_file(const std::filesystem::path& path) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  if (failed) return std::nullopt;
  int problem = 0;
  zip_t* opened = zip_open(path.c_str(), ZIP_RDONLY, &problem);
  if (opened == nullptr) return std::nullopt;
  return ZipReader(opened, static_cast<std::size_t>(size));
}

bool ZipReader::contains(const std::string& name) const {
  return zip_name_locate(archive_.get(), name.c_str(), 0) >= 0;
}

bool ZipReader::contains_ending(std::string_view ending) const {
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr && std::string_view(name).ends_with(ending)) return true;
  }
  return false;
}

std::variant<std::string, ZipProblem> ZipReader::read(const std::string& name) {
  zip_stat_t facts;
  if (zip_stat(archive_.get(), name.c_str(), 0, &facts) != 0) return ZipProblem::kAbsent;
  if (facts.comp_method != ZIP_CM_STORE) return ZipProblem::kCompressed;
  if (facts.size > unread_) return ZipProblem::kDamaged;
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
      zip_fopen_index(archive_.get(), facts.index, 0), zip_fclose);
  if (!file) return ZipProblem::kDamaged;
  std::string bytes(facts.size, '\0');
  const zip_int64_t count = zip_fread(file.get(), bytes.data(), bytes.size());
  // libzip checks the checksum at the end of the file.
  char beyond = 0;
  if (count == static_cast<zip_int64_t>(bytes.size()) &&
      zip_fread(file.get(), &beyond, 1) == 0) {
    unread_ -= bytes.size();
    return bytes;
  }
  const bool wrong = zip_error_code_zip(zip_file_get_error(file.get())) == ZIP_ER_CRC;
  return wrong ? ZipProblem::kWrongChecksum : ZipProblem::kDamaged;
}

}  // namespace marey::recordings
