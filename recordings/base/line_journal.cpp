// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/line_journal.h"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/assert.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxJournalBytes = std::int64_t{1} << 30;

Error journal_disk_error(const fs::path& path, const std::string& what, int error) {
  const bool is_full = error == ENOSPC || error == EDQUOT;
  Error out{Errc::kDevice,
            path.string(),
            what + ": " + std::generic_category().message(error),
            is_full ? "free space on the disk" : "check the disk"};
  out.os_error = error;
  return out;
}

/// Writes all bytes at an offset. Returns errno, or 0.
int write_all(int fd, std::string_view bytes, std::int64_t offset) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += written;
  }
  return 0;
}

/// Returns true if a process has the file open. False if that is unknown.
bool has_open(const std::string& process, const fs::path& file) {
  std::error_code failed;
  for (auto it = fs::directory_iterator("/proc/" + process + "/fd", failed);
       !failed && it != fs::directory_iterator();
       it.increment(failed)) {
    std::error_code other;
    if (fs::equivalent(it->path(), file, other)) return true;
  }
  return false;
}

/// Returns " (process 123)" for the process that holds the lock of a file; empty if
/// that is unknown.
std::string lock_holder(const fs::path& file, ino_t inode) {
  std::ifstream locks("/proc/locks");
  const std::string end = ":" + std::to_string(inode);
  for (std::string line; std::getline(locks, line);) {
    // 1: FLOCK  ADVISORY  WRITE 123 08:01:456 0 EOF
    std::istringstream words(line);
    std::string number;
    std::string kind;
    std::string mode;
    std::string access;
    std::string process;
    std::string locked;
    words >> number >> kind >> mode >> access >> process >> locked;
    if (kind == "FLOCK" && locked.ends_with(end) && has_open(process, file)) {
      return " (process " + process + ")";
    }
  }
  return {};
}

/// Stores a new file's name in its folder.
void sync_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  (void)::fsync(fd);
  ::close(fd);
}

}  // namespace

LineJournal::LineJournal(LineJournal&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      end_(other.end_),
      is_torn_(other.is_torn_),
      unsynced_since_(other.unsynced_since_),
      lines_(std::move(other.lines_)) {}

LineJournal::~LineJournal() {
  if (fd_ < 0) return;
  (void)sync();
  ::close(fd_);
}

Result<LineJournal> LineJournal::open(const fs::path& path) {
  constexpr mode_t kMode = 0644;
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, kMode);
  if (fd < 0) {
    return bad_input(path.string(),
                     "cannot be opened: " + std::generic_category().message(errno),
                     "give a path that may be written to");
  }
  LineJournal journal(path, fd);
  struct stat stat {};
  if (::fstat(fd, &stat) != 0 || !S_ISREG(stat.st_mode)) {
    return bad_input(path.string(), "is not a regular file", "move it away");
  }
  // A file system without locks gives another error: then there is no protection.
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return bad_input(path.string(),
                     "is open in another marey" + lock_holder(path, stat.st_ino),
                     "end that one, or use its page");
  }
  if (::fstat(fd, &stat) != 0) return journal_disk_error(path, "cannot be read", errno);
  if (stat.st_size > kMaxJournalBytes) {
    return bad_input(path.string(), "is larger than 1 GiB", "move it away");
  }
  if (stat.st_size == 0) sync_folder_of(path);
  if (const Status ok = journal.read(); !ok) return ok.error();
  return journal;
}

Status LineJournal::read() {
  std::string text;
  std::string piece(std::size_t{1} << 16, '\0');
  for (;;) {
    const ssize_t got =
        ::pread(fd_, piece.data(), piece.size(), static_cast<off_t>(text.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return journal_disk_error(path_, "cannot be read", errno);
    if (got == 0) break;
    text.append(piece, 0, static_cast<std::size_t>(got));
  }
  std::size_t start = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos;
       end = text.find('\n', start)) {
    lines_.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  end_ = static_cast<std::int64_t>(start);
  is_torn_ = start != text.size();
  return Done{};
}

Status LineJournal::append(std::string_view line) {
  MAREY_ASSERT(fd_ >= 0 && line.find('\n') == std::string_view::npos);
  if (is_torn_ && ::ftruncate(fd_, static_cast<off_t>(end_)) != 0) {
    return journal_disk_error(path_, "cannot be written", errno);
  }
  is_torn_ = false;
  std::string bytes(line);
  bytes += '\n';
  const int failed = write_all(fd_, bytes, end_);
  if (failed != 0) {
    is_torn_ = ::ftruncate(fd_, static_cast<off_t>(end_)) != 0;
    return journal_disk_error(path_, "cannot be written", failed);
  }
  end_ += static_cast<std::int64_t>(bytes.size());
  if (!unsynced_since_) unsynced_since_ = Clock::now();
  return Done{};
}

Status LineJournal::sync() {
  if (!unsynced_since_) return Done{};
  if (::fdatasync(fd_) != 0 && errno != EINVAL) {
    return journal_disk_error(path_, "cannot be written", errno);
  }
  unsynced_since_.reset();
  return Done{};
}

Status LineJournal::sync_older_than(std::chrono::milliseconds age) {
  if (!unsynced_since_ || Clock::now() - *unsynced_since_ < age) return Done{};
  return sync();
}

}  // namespace marey::recordings
