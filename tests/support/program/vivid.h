// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

// Changes to the cameras by the program in the emulated machine, without marey.
namespace marey::guest {

/// Sets a control of the driver vivid by its name, or presses it where it is a button.
/// False when there is none of that name.
bool set_vivid(const std::string& device, const std::string& control, int value = 1);

/// Writes `text` into a file of /sys.
bool write_file(const std::string& path, const std::string& text);

[[nodiscard]] std::vector<std::byte> read_file(const std::string& path);

/// Writes pictures into a v4l2loopback device, one after the other and again from the
/// first, 30 a second, while it lives.
class LoopbackFeeder {
 public:
  LoopbackFeeder(std::string device, std::vector<std::vector<std::byte>> pictures);
  LoopbackFeeder(const LoopbackFeeder&) = delete;
  LoopbackFeeder& operator=(const LoopbackFeeder&) = delete;
  ~LoopbackFeeder();

  [[nodiscard]] bool works() const { return fd_ >= 0; }

 private:
  void feed();

  std::vector<std::vector<std::byte>> pictures_;
  int fd_ = -1;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace marey::guest
