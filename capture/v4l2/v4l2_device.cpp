// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_device.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <utility>

#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_controls.h"
#include "capture/v4l2/v4l2_errors.h"
#include "capture/v4l2/v4l2_formats.h"
#include "capture/v4l2/v4l2_stream.h"

namespace marey::capture {
namespace {

/// An open file descriptor, closed by the destructor.
class OpenFile {
 public:
  OpenFile(V4l2Kernel& kernel, const std::string& path)
      : kernel_(&kernel), fd_(kernel.open(path)) {}
  OpenFile(OpenFile&& other) noexcept
      : kernel_(other.kernel_), fd_(std::exchange(other.fd_, -1)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile() {
    if (fd_ >= 0) kernel_->close(fd_);
  }
  /// Negative: the errno.
  [[nodiscard]] int fd() const { return fd_; }

 private:
  V4l2Kernel* kernel_;
  int fd_;
};

/// Returns the text of a fixed-size field of the kernel, which may lack a terminating
/// zero.
template <std::size_t N>
std::string text_of(const std::uint8_t (&field)[N]) {
  return {std::begin(field), std::find(std::begin(field), std::end(field), '\0')};
}

std::string kind_of(std::uint32_t can) {
  if ((can & (V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_VIDEO_M2M_MPLANE)) != 0) {
    return "a multi-planar device, which marey does not read";
  }
  if ((can & V4L2_CAP_META_CAPTURE) != 0) return "a metadata channel of a camera";
  if ((can & V4L2_CAP_VIDEO_OUTPUT) != 0) return "a video output";
  if ((can & V4L2_CAP_VIDEO_M2M) != 0) return "a video converter";
  if ((can & V4L2_CAP_VIDEO_CAPTURE) != 0) return "one that cannot stream";
  return "another kind of video device";
}

struct Identity {
  DeviceInfo info;  ///< Without modes.
  bool is_camera = false;
  std::string kind;  ///< Set if it is not a camera.
};

Result<Identity> identify(V4l2Kernel& kernel, int fd, const std::string& path) {
  v4l2_capability capability{};
  const int refused = kernel.ioctl(fd, VIDIOC_QUERYCAP, &capability);
  if (refused == -ENOTTY) return Identity{{}, false, "no video device"};
  if (refused < 0) return device_error(path, V4l2Step::kQueryCapabilities, -refused);
  const bool own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = own ? capability.device_caps : capability.capabilities;
  constexpr std::uint32_t kNeeded = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  Identity identity;
  identity.info.path = path;
  identity.info.card = text_of(capability.card);
  identity.info.bus = text_of(capability.bus_info);
  identity.info.driver = text_of(capability.driver);
  identity.is_camera = (can & kNeeded) == kNeeded;
  identity.kind = kind_of(can);
  return identity;
}

/// Calls `with` for every camera while it is open, with its index at its port set. Adds
/// failures to `errors`.
template <class With>
void for_each_camera(V4l2Kernel& kernel, std::vector<Error>& errors, With with) {
  std::vector<std::string> buses;
  for (const std::string& path : kernel.video_paths()) {
    const OpenFile file(kernel, path);
    if (file.fd() < 0) {
      errors.push_back(device_error(path, V4l2Step::kOpen, -file.fd()));
      continue;
    }
    auto identity = identify(kernel, file.fd(), path);
    if (!identity) {
      errors.push_back(identity.error());
      continue;
    }
    if (!identity->is_camera) continue;
    DeviceInfo& info = identity->info;
    info.place_at_bus = static_cast<int>(std::ranges::count(buses, info.bus));
    buses.push_back(info.bus);
    with(std::move(info), file.fd());
  }
}

}  // namespace

DeviceList list_devices(V4l2Kernel& kernel) {
  DeviceList list;
  for_each_camera(kernel, list.errors, [&](DeviceInfo info, int fd) {
    info.modes = list_modes(kernel, fd);
    list.devices.push_back(std::move(info));
  });
  return list;
}

std::optional<std::string> find_again(const DeviceInfo& lost, V4l2Kernel& kernel) {
  std::optional<std::string> found;
  std::vector<Error> errors;
  for_each_camera(kernel, errors, [&](const DeviceInfo& info, int) {
    if (info.bus == lost.bus && info.card == lost.card && info.driver == lost.driver &&
        info.place_at_bus == lost.place_at_bus) {
      found = info.path;
    }
  });
  return found;
}

/// Members are destroyed in reverse: the stream unmaps its memory before the file is
/// closed.
struct V4l2Device::Impl {
  OpenFile file;
  DeviceInfo info;
  DeviceSettings settings;
  std::optional<V4l2Stream> stream;
};

V4l2Device::V4l2Device(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
V4l2Device::V4l2Device(V4l2Device&&) noexcept = default;
V4l2Device& V4l2Device::operator=(V4l2Device&&) noexcept = default;
V4l2Device::~V4l2Device() = default;

const DeviceInfo& V4l2Device::info() const {
  return impl_->info;
}
const DeviceSettings& V4l2Device::settings() const {
  return impl_->settings;
}

namespace {

/// Returns the device of a link such as those in /dev/v4l/by-id.
std::string real_path(const std::string& path) {
  std::error_code failed;
  const std::string real = std::filesystem::canonical(path, failed);
  return failed ? path : real;
}

/// Returns the number of capture devices at the same port before it.
int place_of(V4l2Kernel& kernel, const DeviceInfo& device) {
  int place = 0;
  std::vector<Error> errors;
  for_each_camera(kernel, errors, [&](const DeviceInfo& info, int) {
    if (info.path == device.path) place = info.place_at_bus;
  });
  return place;
}

}  // namespace

Result<V4l2Device> V4l2Device::open(const DeviceRequest& request, V4l2Kernel& kernel) {
  MAREY_ASSERT(request.width_px > 0 && request.height_px > 0);
  MAREY_ASSERT(request.rate.hz > 0.0 && request.buffers > 0);
  OpenFile file(kernel, request.path);
  const int fd = file.fd();
  if (fd < 0) return device_error(request.path, V4l2Step::kOpen, -fd);
  auto identity = identify(kernel, fd, request.path);
  if (!identity) return identity.error();
  if (!identity->is_camera) return not_a_camera(request.path, identity->kind);
  auto impl = std::make_unique<Impl>(Impl{std::move(file), identity->info, {}, {}});
  impl->info.path = real_path(request.path);
  impl->info.modes = list_modes(kernel, fd);
  impl->info.place_at_bus = place_of(kernel, impl->info);

  const auto format =
      request.format ? request.format : choose_format(impl->info, request);
  if (!format) {
    return Error{Errc::kDevice,
                 request.path,
                 "it offers none of the picture formats MJPG, YUYV, NV12 and GREY",
                 "use another camera"};
  }
  DeviceSettings& settings = impl->settings;
  const auto listed = std::ranges::find(impl->info.modes, *format, &DeviceMode::format);
  const std::uint32_t fourcc =
      listed == impl->info.modes.end() ? fourcc_of(*format) : listed->fourcc;
  if (auto set = set_format(kernel, fd, request, *format, fourcc, settings); !set) {
    return set.error();
  }
  set_controls(kernel, fd, request);
  auto stream = V4l2Stream::start(kernel, fd, request.path, settings, request.buffers);
  if (!stream) return stream.error();
  impl->stream.emplace(*std::move(stream));
  settings.buffers = impl->stream->buffers();
  settings.monotonic_clock = impl->stream->monotonic_clock();
  // Some cameras accept settings only while they stream, and some lose them at the start.
  set_controls(kernel, fd, request);
  read_controls(kernel, fd, request, settings);
  return V4l2Device(std::move(impl));
}

Result<std::optional<RawFrame>> V4l2Device::next(std::chrono::milliseconds timeout) {
  return impl_->stream->next(timeout);
}

}  // namespace marey::capture
