// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/atomic_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/input_file.h"

namespace marey::recordings {
namespace fs = std::filesystem;

namespace {

/// A partial file that a signal handler would have to remove. The state determines the
/// owner of the path: the creator while kTaken, the handler once it is kNamed.
struct PartialPath {
  enum State : int { kFree, kTaken, kNamed };
  std::atomic<int> state{kFree};
  std::array<char, 4096> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "a handler may use it");

// A global, because a signal handler has no argument.
std::array<PartialPath, 16> partial_paths;  // NOLINT(*-non-const-global-variables)

/// Differs between processes, also those of one fork, and is never used again: another
/// process could otherwise hold a file of that name for stale and remove the next one.
std::string next_word() {
  static const std::string word = std::to_string(std::random_device()());
  static std::atomic<unsigned> count{0};
  return word + std::to_string(::getpid()) + std::to_string(count.fetch_add(1));
}

void remember(const std::string& path) {
  if (path.size() >= partial_paths[0].path.size()) return;
  for (PartialPath& place : partial_paths) {
    int expected = PartialPath::kFree;
    if (!place.state.compare_exchange_strong(expected, PartialPath::kTaken)) continue;
    std::memcpy(place.path.data(), path.c_str(), path.size() + 1);
    place.state.store(PartialPath::kNamed);
    return;
  }
}

void unregister(const std::string& path) {
  for (PartialPath& place : partial_paths) {
    if (place.state.load() != PartialPath::kNamed || path != place.path.data()) continue;
    place.state.store(PartialPath::kFree);
    return;
  }
}

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

/// A file that is open for its lock alone. The lock ends with the process in any case, so
/// an unlocked partial file has no writer.
class Lock {
 public:
  enum class Wait { kNo, kYes };

  Lock(const fs::path& path, Wait wait)
      : fd_(::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)) {
    if (fd_ < 0) {
      is_removed_ = errno == ENOENT;
      return;
    }
    const int operation = wait == Wait::kYes ? LOCK_EX : LOCK_EX | LOCK_NB;
    is_held_ = ::fstat(fd_, &stat_) == 0 && S_ISREG(stat_.st_mode) &&
               ::flock(fd_, operation) == 0 && ::fstat(fd_, &stat_) == 0;
    is_removed_ = is_held_ && stat_.st_nlink == 0;
  }
  ~Lock() {
    if (fd_ >= 0) ::close(fd_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  [[nodiscard]] bool is_held() const { return is_held_; }
  /// Another process removed the file before its lock.
  [[nodiscard]] bool is_removed() const { return is_removed_; }
  [[nodiscard]] bool is_ours_alone() const {
    return is_held_ && stat_.st_nlink == 1 && stat_.st_uid == ::geteuid();
  }
  /// Returns the open file, which keeps the lock, to the caller; -1: there is no lock.
  [[nodiscard]] int release() { return is_held_ ? std::exchange(fd_, -1) : -1; }

 private:
  int fd_ = -1;
  bool is_held_ = false;
  bool is_removed_ = false;
  struct stat stat_ {};
};

/// Returns true for "NAME.123456.partial" of the file NAME.
bool is_partial_of(std::string_view found, std::string_view name) {
  constexpr std::string_view kEnd = ".partial";
  if (!found.starts_with(name) || !found.ends_with(kEnd)) return false;
  if (found.size() < name.size() + 2 + kEnd.size()) return false;
  const std::string_view word =
      found.substr(name.size(), found.size() - name.size() - kEnd.size());
  return word[0] == '.' &&
         word.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Removes the partial files that no process has locked.
void remove_unlocked(const std::vector<fs::path>& partials) {
  for (const fs::path& partial : partials) {
    const Lock lock(partial, Lock::Wait::kNo);
    if (lock.is_ours_alone()) ::unlink(partial.c_str());
  }
}

/// Removes partial files of the same file left by killed processes of this user: regular
/// files without a process's lock. Links are neither followed nor removed.
void remove_stale(const fs::path& path) {
  std::error_code problem;
  const std::string name = path.filename().string();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<fs::path> stale;
  for (auto it = fs::directory_iterator(folder, problem);
       !problem && it != fs::directory_iterator();
       it.increment(problem)) {
    if (is_partial_of(it->path().filename().string(), name)) stale.push_back(it->path());
  }
  remove_unlocked(stale);
}

std::string reason(int error) {
  return error == 0 ? "" : ": " + std::generic_category().message(error);
}

Error disk_error(const fs::path& path, const std::string& what, int error) {
  const bool is_full = error == ENOSPC || error == EDQUOT;
  return {Errc::kDevice,
          path.string(),
          what + reason(error),
          is_full
              ? "free some disk space and run again"
              : "check the disk and that its folder may be written to, and run again"};
}

}  // namespace

AtomicFile::AtomicFile(fs::path path)
    : path_(std::move(path)), partial_(path_.string() + "." + next_word() + ".partial") {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      partial_(std::move(other.partial_)),
      stream_(std::move(other.stream_)),
      lock_fd_(std::exchange(other.lock_fd_, -1)),
      write_errno_(other.write_errno_),
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
  unlock();
  unregister(partial_.string());
}

void AtomicFile::unlock() {
  const int fd = std::exchange(lock_fd_, -1);
  if (fd >= 0) ::close(fd);
}

bool AtomicFile::open_partial() {
  // Another process may treat a file without a lock as stale, lock and remove it: then
  // wait for the end of its lock, and repeat.
  for (int attempt = 0; attempt < 10; ++attempt) {
    errno = 0;
    stream_.open(partial_, std::ios::binary | std::ios::trunc);
    if (!stream_) return false;
    Lock lock(partial_, Lock::Wait::kYes);
    if (!lock.is_removed()) {
      lock_fd_ = lock.release();
      return true;
    }
    stream_.close();
  }
  return false;
}

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    return bad_input(
        path.string(), "a folder is in the way of the file", "remove or rename it");
  }
  // Renaming onto a device or a pipe would replace it by a regular file.
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    return bad_input(path.string(),
                     "it is a device or a pipe, not a file",
                     "name a file: results appear whole or not at all");
  }
  if (const Status made = make_parent_folder(path); !made) return made.error();
  AtomicFile file(path);
  remove_stale(path);
  // Before the file exists, so that no signal can occur in between.
  remember(file.partial_.string());
  if (!file.open_partial()) {
    const int error = errno;
    unregister(file.partial_.string());
    return bad_input(path.string(),
                     "the file cannot be written" + reason(error),
                     "check that its folder may be written to");
  }
  file.open_ = true;
  return file;
}

void AtomicFile::append(std::string_view bytes) {
  MAREY_ASSERT(open_);
  if (!stream_) return;
  errno = 0;
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) write_errno_ = errno;
}

int AtomicFile::sync_partial() const {
  const int fd = ::open(partial_.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return errno;
  // File systems without fsync() report EINVAL.
  const int error = ::fsync(fd) == 0 || errno == EINVAL ? 0 : errno;
  ::close(fd);
  return error;
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  MAREY_ASSERT(open_);
  if (!stream_) return;
  stream_.seekp(static_cast<std::streamoff>(offset));
  append(bytes);
  stream_.seekp(0, std::ios::end);
}

Status AtomicFile::commit(OnDisk when) {
  MAREY_ASSERT(open_);
  errno = 0;
  stream_.close();
  int error = 0;
  if (!stream_) {
    error = write_errno_ != 0 ? write_errno_ : errno;
  } else if (when == OnDisk::kNow) {
    error = sync_partial();
  }
  if (!stream_ || error != 0) {
    discard();
    return disk_error(path_, "the file could not be written to its end", error);
  }
  std::error_code problem;
  fs::rename(partial_, path_, problem);
  if (problem) {
    discard();
    return disk_error(path_, "the file cannot be put in place", problem.value());
  }
  open_ = false;
  unlock();
  unregister(partial_.string());
  return Done{};
}

void remove_abandoned_files(const fs::path& folder) {
  std::vector<fs::path> abandoned;
  std::error_code problem;
  for (auto it = fs::recursive_directory_iterator(folder, problem);
       !problem && it != fs::recursive_directory_iterator();
       it.increment(problem)) {
    const std::string name = it->path().filename().string();
    const fs::path stem = it->path().stem();  // "NAME.WORD"
    if (is_partial_of(name, stem.stem().string())) abandoned.push_back(it->path());
  }
  remove_unlocked(abandoned);
}

void visit_partial_files(void (*visit)(const char* path)) noexcept {
  for (const PartialPath& place : partial_paths) {
    if (place.state.load() == PartialPath::kNamed) visit(place.path.data());
  }
}

Status write_file(const fs::path& path, std::string_view bytes, OnDisk when) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  file->append(bytes);
  return file->commit(when);
}

Result<std::string> read_file(const fs::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return bad_input(path.string(),
                     "the file cannot be read" + reason(errno),
                     "check its permissions");
  }
  // In pieces rather than one of file_size(), which is 0 for files of /proc.
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  // Files read as a whole are tables, texts or bodies: all are far smaller than this.
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;
  std::string bytes;
  std::error_code problem;
  const std::uintmax_t size = fs::file_size(path, problem);
  if (!problem && size > kMaxBytes) {
    return bad_input(path.string(),
                     "the file is larger than 4 GiB",
                     "name the file that was meant, or a shorter recording");
  }
  if (!problem) bytes.reserve(size + kPiece);
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
