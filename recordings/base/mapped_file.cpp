// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/base/mapped_file.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/input_file.h"

namespace marey::recordings {
namespace {

/// Closes a file at its end; the mapping stays.
class OpenDescriptor {
 public:
  explicit OpenDescriptor(const std::filesystem::path& path)
      : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  OpenDescriptor(const OpenDescriptor&) = delete;
  OpenDescriptor& operator=(const OpenDescriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_ = -1;
};

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
  if (const Status ok = check_input_file(path); !ok) return ok.error();
  const OpenDescriptor file(path);
  if (file.get() < 0) {
    return bad_input(path.string(),
                     "it cannot be opened: " + std::generic_category().message(errno),
                     "check the permissions of the file");
  }
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return bad_input(path.string(), "it is not a file", "check the name");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  // An empty range cannot be mapped.
  if (size == 0) return MappedFile(nullptr, 0);
  void* const data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (data == MAP_FAILED) {
    return Error{
        Errc::kDevice,
        path.string(),
        "it cannot be mapped into memory: " + std::generic_category().message(errno),
        "copy it to a local disk, or free some memory"};
  }
  return MappedFile(static_cast<const std::byte*>(data), size);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile::~MappedFile() {
  // mmap() returned the address, so that the cast only restores its type.
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
}

}  // namespace marey::recordings
