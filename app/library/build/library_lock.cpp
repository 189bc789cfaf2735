// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/library_lock.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include "core/base/in_quotes.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

/// A process, such that another one with the same number differs from it.
struct LockHolder {
  std::string host;
  int process = 0;
  std::string start = "-";  ///< In ticks since the host's start.
  /// Number space of processes: containers of one host have several.
  std::string space = "-";

  [[nodiscard]] std::string text() const {
    return host + " " + std::to_string(process) + " " + start + " " + space + "\n";
  }
};

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  return name.data();
}

/// Returns the start of a process, the 22nd value of /proc/PID/stat; empty: it has ended.
std::string start_of(int process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(in, text);
  // The second value, the name in brackets, may have blanks.
  const std::size_t close = text.rfind(')');
  if (close == std::string::npos) return {};
  std::istringstream values(text.substr(close + 1));
  constexpr int kValuesAfterName = 20;
  std::string value;
  for (int i = 0; i < kValuesAfterName; ++i) values >> value;
  return values ? value : std::string();
}

/// Returns the number space of this process: "pid:[4026531836]".
std::string process_space() {
  std::error_code failed;
  const fs::path space = fs::read_symlink("/proc/self/ns/pid", failed);
  return failed ? "-" : space.string();
}

LockHolder this_process() {
  return {host_name(), getpid(), start_of(getpid()), process_space()};
}

std::optional<LockHolder> read_holder(const fs::path& file) {
  std::ifstream in(file);
  LockHolder out;
  if (!(in >> out.host >> out.process)) return std::nullopt;
  in >> out.start >> out.space;
  return out;
}

/// Processes of another host or container cannot be seen.
bool is_visible(const LockHolder& holder) {
  return holder.host == host_name() && holder.space == process_space();
}

bool has_ended(const LockHolder& holder) {
  return is_visible(holder) && start_of(holder.process) != holder.start;
}

Error lock_error(const fs::path& file, const std::string& cause) {
  return {Errc::kDevice,
          file.string(),
          "the library cannot be locked: " + cause,
          "check that the library's folder may be written to, and has space"};
}

Error held_by(const fs::path& file, const LockHolder& holder) {
  if (is_visible(holder)) {
    return bad_input(file.string(),
                     "process " + std::to_string(holder.process) +
                         " builds this library at the moment",
                     "wait until it has ended");
  }
  return bad_input(
      file.string(),
      "process " + std::to_string(holder.process) + " of the host " +
          in_quotes(holder.host) + " builds this library",
      "wait until it has ended; if that host or container has stopped, delete "
      "the file");
}

/// Removes the lock of a process that has ended. Only one process at a time does so, and
/// compares the lock again before: a new lock is never removed.
void remove_ended_lock(const LockHolder& ended,
                       const fs::path& file,
                       const fs::path& own) {
  const fs::path guard = file.string() + ".takeover";
  if (::link(own.c_str(), guard.c_str()) != 0) {
    // Another process takes the lock over. If it was killed while doing so, its guard
    // goes, and the next attempt succeeds.
    const auto other = read_holder(guard);
    if (other && has_ended(*other)) ::unlink(guard.c_str());
    constexpr useconds_t kWait_us = 20'000;
    ::usleep(kWait_us);
    return;
  }
  const auto holder = read_holder(file);
  if (holder && holder->text() == ended.text()) ::unlink(file.c_str());
  ::unlink(guard.c_str());
}

/// Removes the files that killed processes of this host left while they took the lock.
void remove_left_own_files(const fs::path& file) {
  std::vector<fs::path> left;
  std::error_code failed;
  const std::string name = file.filename().string() + ".";
  for (fs::directory_iterator at(file.parent_path(), failed), end; !failed && at != end;
       at.increment(failed)) {
    if (!at->path().filename().string().starts_with(name)) continue;
    const auto holder = read_holder(at->path());
    if (holder && has_ended(*holder)) left.push_back(at->path());
  }
  for (const fs::path& path : left) ::unlink(path.c_str());
}

}  // namespace

Result<LibraryLock> LibraryLock::take(const fs::path& library) {
  const fs::path file = recordings::LibraryPaths(library).lock();
  const LockHolder self = this_process();
  remove_left_own_files(file);
  const fs::path own =
      file.string() + "." + self.host + "." + std::to_string(self.process);
  {
    std::ofstream out(own, std::ios::trunc);
    out << self.text();
    out.close();
    if (!out) {
      const int error = errno;
      ::unlink(own.c_str());
      return lock_error(file, std::strerror(error));
    }
  }
  constexpr int kAttempts = 100;
  Error failure = lock_error(file, "other processes take it all the time");
  bool is_taken = false;
  for (int attempt = 0; attempt < kAttempts && !is_taken; ++attempt) {
    if (::link(own.c_str(), file.c_str()) == 0) {
      is_taken = true;
      break;
    }
    if (errno != EEXIST) {
      failure = lock_error(file, std::strerror(errno));
      break;
    }
    const auto holder = read_holder(file);
    if (!holder) continue;  // Given back meanwhile.
    failure = held_by(file, *holder);
    if (!has_ended(*holder)) break;
    remove_ended_lock(*holder, file, own);
  }
  ::unlink(own.c_str());
  if (!is_taken) return failure;
  return LibraryLock(file, self.process);
}

LibraryLock::LibraryLock(LibraryLock&& other) noexcept
    : file_(std::exchange(other.file_, fs::path())), process_(other.process_) {}

LibraryLock::~LibraryLock() {
  if (file_.empty() || getpid() != process_) return;
  // A person may have deleted the lock, and another process taken it.
  const auto holder = read_holder(file_);
  if (holder && holder->text() == this_process().text()) ::unlink(file_.c_str());
}

}  // namespace marey::app
