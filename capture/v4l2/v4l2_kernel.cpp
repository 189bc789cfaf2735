// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_kernel.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "capture/v4l2/device_types.h"

namespace marey::capture {
namespace {

/// Returns the negative errno if a call returns -1.
int or_errno(int result) {
  return result == -1 ? -errno : result;
}

class SystemKernel final : public V4l2Kernel {
 public:
  int open(const std::string& path) override {
    return or_errno(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  }

  int close(int fd) override { return or_errno(::close(fd)); }

  int ioctl(int fd, unsigned long request, void* argument) override {
    int result = 0;
    do {
      result = or_errno(::ioctl(fd, request, argument));
    } while (result == -EINTR);
    return result;
  }

  int poll(int fd, std::chrono::milliseconds timeout) override {
    pollfd what{fd, POLLIN, 0};
    const int result = or_errno(::poll(&what, 1, static_cast<int>(timeout.count())));
    return result > 0 ? what.revents : result;
  }

  std::byte* map(int fd, std::size_t size, std::int64_t offset) override {
    void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
    return memory == MAP_FAILED ? nullptr : static_cast<std::byte*>(memory);
  }

  void unmap(std::byte* memory, std::size_t size) override { ::munmap(memory, size); }

  std::vector<std::string> video_paths() override;

  Timestamp now() override {
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  void sleep(std::chrono::milliseconds duration) override {
    std::this_thread::sleep_for(duration);
  }
};

std::vector<std::string> SystemKernel::video_paths() {
  constexpr std::string_view kPrefix = "video";
  std::vector<int> numbers;
  std::error_code failed;
  std::filesystem::directory_iterator entry("/dev", failed);
  for (; !failed && entry != std::filesystem::directory_iterator();
       entry.increment(failed)) {
    const std::string file = entry->path().filename();
    if (!file.starts_with(kPrefix)) continue;
    const char* const end = file.data() + file.size();
    int number = 0;
    const auto read = std::from_chars(file.data() + kPrefix.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end) numbers.push_back(number);
  }
  std::ranges::sort(numbers);
  std::vector<std::string> paths;
  paths.reserve(numbers.size());
  for (const int number : numbers) {
    paths.push_back("/dev/video" + std::to_string(number));
  }
  return paths;
}

}  // namespace

V4l2Kernel& system_kernel() {
  static SystemKernel kernel;
  return kernel;
}

}  // namespace marey::capture
