// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/atomic_file.h"

#include <system_error>
#include <utility>

namespace marey::recordings {
namespace fs = std::filesystem;

namespace {

Status make_parent_folder(const fs::path& path) {
  const fs::path folder = path.parent_path();
  if (folder.empty()) return Done{};
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!problem) return Done{};
  return bad_input(folder.string(),
                   "the folder cannot be created: " + problem.message(),
                   "choose an output folder that may be written to");
}

Error disk_error(const fs::path& path, const std::string& cause) {
  return {Errc::kDevice, path.string(), cause, "free some disk space and run again"};
}

}  // namespace

AtomicFile::AtomicFile(fs::path path)
    : path_(std::move(path)), partial_(path_.string() + ".partial") {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      partial_(std::move(other.partial_)),
      stream_(std::move(other.stream_)),
      open_(std::exchange(other.open_, false)) {}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() {
  if (!open_) return;
  open_ = false;
  stream_.close();
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    return bad_input(
        path.string(), "a folder is in the way of the file", "remove or rename it");
  }
  if (const Status made = make_parent_folder(path); !made) return made.error();
  AtomicFile file(path);
  file.stream_.open(file.partial_, std::ios::binary | std::ios::trunc);
  if (!file.stream_) {
    return bad_input(path.string(),
                     "the file cannot be written",
                     "check that its folder may be written to");
  }
  file.open_ = true;
  return file;
}

void AtomicFile::append(std::string_view bytes) {
  MAREY_ASSERT(open_);
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

Status AtomicFile::commit() {
  MAREY_ASSERT(open_);
  stream_.close();
  if (!stream_) {
    discard();
    return disk_error(path_, "the file could not be written to its end");
  }
  std::error_code problem;
  fs::rename(partial_, path_, problem);
  if (problem) {
    discard();
    return disk_error(path_, "the file cannot be put in place: " + problem.message());
  }
  open_ = false;
  return Done{};
}

Status write_file(const fs::path& path, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->append(bytes);
  return file->commit();
}

Result<std::string> read_file(const fs::path& path) {
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (!fs::exists(status)) {
    return bad_input(
        path.string(), "the file does not exist", "check the name and the folder");
  }
  if (fs::is_directory(status)) {
    return bad_input(path.string(), "this is a folder, not a file", "name a file in it");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return bad_input(path.string(), "the file cannot be read", "check its permissions");
  }
  // In pieces rather than one of file_size(), which is 0 for pipes and /proc.
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::string bytes;
  if (const auto size = fs::file_size(path, problem); !problem)
    bytes.reserve(size + kPiece);
  for (std::size_t got = kPiece; got == kPiece;) {
    const std::size_t at = bytes.size();
    bytes.resize(at + kPiece);
    stream.read(bytes.data() + at, static_cast<std::streamsize>(kPiece));
    got = static_cast<std::size_t>(stream.gcount());
    bytes.resize(at + got);
  }
  if (stream.bad()) {
    return Error{
        Errc::kDevice, path.string(), "reading failed", "check the disk and try again"};
  }
  return bytes;
}

}  // namespace marey::recordings
