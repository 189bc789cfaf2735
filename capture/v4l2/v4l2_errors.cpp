// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_errors.h"

#include <cerrno>
#include <system_error>

namespace marey::capture {
namespace {

constexpr const char* kSeeDoctor = "plug it in; `marey doctor` lists all cameras";

std::string what_failed(V4l2Step step) {
  switch (step) {
    case V4l2Step::kOpen:
      return "it cannot be opened";
    case V4l2Step::kQueryCapabilities:
      return "it does not report its type";
    case V4l2Step::kSetFormat:
      return "it refused the picture format";
    case V4l2Step::kRequestBuffers:
      return "it refused to provide buffers (REQBUFS)";
    case V4l2Step::kMapBuffer:
      return "its buffers cannot be mapped into memory";
    case V4l2Step::kQueueBuffer:
      return "it refused a buffer (QBUF)";
    case V4l2Step::kStart:
      return "it refused to start streaming (STREAMON)";
    case V4l2Step::kTakeFrame:
      return "it stopped streaming";
  }
  return "it failed";
}

Error error(const std::string& path, std::string cause, std::string next) {
  return {Errc::kDevice, path, std::move(cause), std::move(next)};
}

/// Includes the kernel's own text, for reports and for searching.
Error other_error(const std::string& path, V4l2Step step, int number) {
  return error(path,
               what_failed(step) + ": " + std::system_category().message(number),
               "unplug the camera, wait a moment and plug it in again");
}

}  // namespace

bool is_disconnect_errno(int number) {
  return number == ENODEV || number == ENXIO;
}

Error not_a_camera(const std::string& path, const std::string& what_it_is) {
  return error(path,
               "it is not a capture device: it is " + what_it_is,
               "`marey doctor` lists all cameras");
}

namespace {

Error plain_error(const std::string& path, V4l2Step step, int number) {
  const bool missing = number == ENOENT || number == ENOTDIR;
  if (step == V4l2Step::kOpen && missing) {
    return error(path, "the device does not exist", kSeeDoctor);
  }
  if (is_disconnect_errno(number)) {
    return error(path,
                 "the camera is gone: it was unplugged, or lost its power",
                 "plug it into the same port again");
  }
  switch (number) {
    case EACCES:
    case EPERM:
      return error(
          path,
          "using it is not permitted: it belongs to the group video",
          "add yourself to the group: sudo usermod -aG video $USER; then log out "
          "and in again");
    case EBUSY:
      return error(path,
                   "another program is using it",
                   "close that program (a video call, a browser, OBS); `fuser -v " +
                       path + "` names it");
    case ENOSPC:
      return error(
          path,
          "its USB bus has no bandwidth left for this stream: other cameras use it too",
          "plug it into a port of another USB controller (not the same hub), use "
          "MJPG, a smaller size or a lower rate");
    case ENOMEM:
      return error(path,
                   what_failed(step) + ": there is not enough memory",
                   "close other programs, or choose a smaller size");
    default:
      return other_error(path, step, number);
  }
}

}  // namespace

Error device_error(const std::string& path, V4l2Step step, int number) {
  Error out = plain_error(path, step, number);
  out.os_error = number;
  return out;
}

}  // namespace marey::capture
