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
  std::string start;  ///< In ticks since the host's start; empty: unknown.

  [[nodiscard]] std::string text() const {
    return host + " " + std::to_string(process) + " " + start + "\n";
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

LockHolder this_process() {
  return {host_name(), getpid(), start_of(getpid())};
}

std::optional<LockHolder> read_holder(const fs::path& file) {
  std::ifstream in(file);
  LockHolder out;
  if (!(in >> out.host >> out.process)) return std::nullopt;
  in >> out.start;
  return out;
}

bool has_ended(const LockHolder& holder) {
  return holder.host == host_name() && start_of(holder.process) != holder.start;
}

Error lock_error(const fs::path& file, const std::string& cause) {
  return {Errc::kDevice,
          file.string(),
          "the library cannot be locked: " + cause,
          "check that the library's folder may be written to, and has space"};
}

Error held_by(const fs::path& file, const LockHolder& holder) {
  if (holder.host == host_name()) {
    return bad_input(file.string(),
                     "process " + std::to_string(holder.process) +
                         " builds this library at the moment",
                     "wait until it has ended");
  }
  return bad_input(file.string(),
                   "process " + std::to_string(holder.process) + " of the host " +
                       in_quotes(holder.host) + " builds this library",
                   "wait until it has ended; if that host has stopped, delete the file");
}

/// Moves the lock of a process that has ended out of the way. Returns false if the lock
/// is another one by now; that one is put back.
bool remove_lock_of(const LockHolder& ended, const fs::path& file, const fs::path& own) {
  const fs::path removed = own.string() + ".ended";
  if (::rename(file.c_str(), removed.c_str()) != 0) return errno == ENOENT;
  const auto holder = read_holder(removed);
  const bool is_same = !holder || holder->text() == ended.text();
  if (!is_same) (void)::link(removed.c_str(), file.c_str());
  ::unlink(removed.c_str());
  return is_same;
}

}  // namespace

Result<LibraryLock> LibraryLock::take(const fs::path& library) {
  const fs::path file = recordings::LibraryPaths(library).lock();
  const LockHolder self = this_process();
  const fs::path own =
      file.string() + "." + self.host + "." + std::to_string(self.process);
  {
    std::ofstream out(own, std::ios::trunc);
    out << self.text();
    out.close();
    if (!out) return lock_error(file, std::strerror(errno));
  }
  constexpr int kAttempts = 10;
  std::optional<Error> failure;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    failure.reset();
    if (::link(own.c_str(), file.c_str()) == 0) break;
    if (errno != EEXIST) {
      failure = lock_error(file, std::strerror(errno));
      break;
    }
    // A lock without content belongs to no process: the content comes before the name.
    const LockHolder holder = read_holder(file).value_or(LockHolder{self.host, 0, "-"});
    failure = held_by(file, holder);
    if (!has_ended(holder)) break;
    (void)remove_lock_of(holder, file, own);
  }
  ::unlink(own.c_str());
  if (failure) return *failure;
  return LibraryLock(file, self.process);
}

LibraryLock::LibraryLock(LibraryLock&& other) noexcept
    : file_(std::exchange(other.file_, fs::path())), process_(other.process_) {}

LibraryLock::~LibraryLock() {
  if (file_.empty() || getpid() != process_) return;
  ::unlink(file_.c_str());
}

}  // namespace marey::app
