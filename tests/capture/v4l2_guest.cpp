// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// v4l2_guest: what marey::v4l2 claims, tried on a real kernel in an emulated machine
// (run_v4l2_guest.sh), where vivid makes two cameras and v4l2loopback a third. Prints a
// line for each claim; its exit code is the number of claims that failed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "capture/v4l2/probe_camera.h"
#include "capture/v4l2/reopening_device.h"
#include "capture/v4l2/v4l2_device.h"
#include "tests/capture/v4l2/guest_take.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/program/vivid.h"

namespace marey::guest {
namespace {

using namespace std::chrono_literals;
using capture::CameraState;
using capture::CameraStatus;
using capture::DeviceRequest;
using capture::PixelFormat;
using capture::ReopeningDevice;
using capture::V4l2Device;

constexpr const char* kFirst = "/dev/video0";
constexpr const char* kSecond = "/dev/video1";
constexpr const char* kOutput = "/dev/video2";
constexpr const char* kLoopback = "/dev/video3";

int failures = 0;

bool check(bool true_, const std::string& claim, const std::string& seen = {}) {
  failures += true_ ? 0 : 1;
  std::printf("%s %s%s%s\n",
              true_ ? "ok  " : "FAIL",
              claim.c_str(),
              seen.empty() ? "" : ": ",
              seen.c_str());
  std::fflush(stdout);
  return true_;
}

DeviceRequest small(const char* path, double rate_hz = 30.0) {
  DeviceRequest request;
  request.path = path;
  request.width_px = 320;
  request.height_px = 180;
  request.rate = FrameRate{rate_hz};
  return request;
}

/// Opens a device and receives frames. Calls `before` when the device streams.
template <class Before>
Take take_from(const DeviceRequest& request, int frames, Before before) {
  auto device = V4l2Device::open(request);
  if (!device) {
    Take nothing;
    nothing.error = device.error().message();
    return nothing;
  }
  before();
  return take(*device, frames);
}

Take take_from(const DeviceRequest& request, int frames) {
  return take_from(request, frames, [] {});
}

std::string refusal(const DeviceRequest& request) {
  const auto device = V4l2Device::open(request);
  return device ? "it was opened" : device.error().message();
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

void check_listing() {
  const auto list = capture::list_devices();
  std::string all;
  for (const auto& device : list.devices) {
    all +=
        device.path + " " + device.bus + " " + std::to_string(device.modes.size()) + "; ";
  }
  check(list.devices.size() >= 2 && list.devices[0].path == kFirst &&
            list.devices[0].bus == "platform:vivid-000" &&
            list.devices[1].bus == "platform:vivid-001" && !list.devices[0].modes.empty(),
        "cameras are listed, and outputs are not",
        all);
}

void check_two_at_once() {
  Take first;
  Take second;
  std::thread one([&] {
    auto request = small(kFirst);
    request.width_px = 640;
    request.height_px = 360;
    first = take_from(request, 300);
  });
  std::thread other([&] { second = take_from(small(kSecond), 300); });
  one.join();
  other.join();
  for (const Take& take : {first, second}) {
    check(take.frames == 300 && take.gaps == 0 && take.dropped == 0 &&
              take.damaged == 0 && take.arrival_times == 0,
          "300 frames from each of two cameras at once, contiguous",
          take.text());
    check(std::abs(seconds(take.last - take.first) - 299.0 / 30.0) < 0.05,
          "their stamps are 33.3 ms apart");
  }
}

void check_settings() {
  auto request = small(kFirst);
  request.format = PixelFormat::kMjpg;
  request.width_px = 1280;
  request.height_px = 720;
  request.gain = 200;
  request.exposure_s = 0.004;
  const auto device = V4l2Device::open(request);
  if (!check(device.has_value(), "720p MJPG is answered")) return;
  std::string all;
  for (const auto& sentence : device->settings().differences) all += sentence + "; ";
  check(has(all, "requested MJPG, got YUYV"), "a substituted format is reported", all);
  check(has(all, "requested 30 frames/s, got"), "a lower rate is reported");
  check(has(all, "exposure of 4 ms, and the camera has no such control"),
        "a missing control is reported");
  check(device->settings().gain == 200, "gain is set and read back");
  check(device->settings().monotonic_clock, "the clock is monotonic");
}

void check_drops() {
  set_vivid(kFirst, "Percentage of Dropped Buffers", 30);
  const Take take = take_from(small(kFirst), 200);
  set_vivid(kFirst, "Percentage of Dropped Buffers", 0);
  // The number of frames by the time stamps, independent of the sequence numbers.
  const auto made = std::lround(30.0 * seconds(take.last - take.first)) + 1;
  check(take.frames == 200 && take.dropped > 40 && made == take.frames + take.dropped,
        "dropped frames are counted exactly",
        take.text() + ", " + std::to_string(made) + " made by their stamps");
}

void check_wraps() {
  set_vivid(kFirst, "Wrap Sequence Number", 1);
  const Take numbers = take_from(small(kFirst), 200);
  set_vivid(kFirst, "Wrap Sequence Number", 0);
  check(numbers.wrapped && numbers.gaps == 0 && numbers.dropped == 0,
        "a sequence number that wraps around is not a loss",
        numbers.text());
  set_vivid(kFirst, "Wrap Timestamp", 1);
  const Take stamps = take_from(small(kFirst), 30);
  set_vivid(kFirst, "Wrap Timestamp", 0);
  check(stamps.frames == 30 && stamps.arrival_times == 30 &&
            std::abs(seconds(stamps.last - stamps.first) - 29.0 / 30.0) < 0.05,
        "stamps that are far off are replaced by arrival times",
        stamps.text());
}

void check_refusals() {
  for (const char* step : {"REQBUFS", "QBUF", "STREAMON"}) {
    set_vivid(kFirst, std::string("Inject VIDIOC_") + step + " Error");
    const std::string message = refusal(small(kFirst));
    check(has(message, step) && has(message, "Next: "),
          std::string("a refused ") + step + " is reported",
          message);
    const Take after = take_from(small(kFirst), 5);
    check(after.frames == 5, "and survived", after.text());
  }
  std::thread spoiler;
  const Take damaged = take_from(small(kFirst), 60, [&spoiler] {
    spoiler = std::thread([] {
      for (int i = 0; i < 3; ++i) {
        std::this_thread::sleep_for(100ms);
        set_vivid(kFirst, "Inject V4L2_BUF_FLAG_ERROR");
      }
    });
  });
  spoiler.join();
  check(damaged.frames == 60 && damaged.damaged == 3 && damaged.dropped == 0,
        "three damaged buffers are three damaged frames",
        damaged.text());
  const Take requeued =
      take_from(small(kFirst), 60, [] { set_vivid(kFirst, "Inject VIDIOC_QBUF Error"); });
  check(requeued.frames == 60 && requeued.dropped == 0,
        "a buffer refused while streaming is offered again",
        requeued.text());
  const Take fatal = take_from(
      small(kFirst), 60, [] { set_vivid(kFirst, "Inject Fatal Streaming Error"); });
  check(fatal.frames < 60 && has(fatal.error, "it stopped streaming"),
        "a fatal streaming error is reported",
        fatal.text());
}

void check_wrong_devices() {
  const std::string missing = refusal(small("/dev/video9"));
  check(has(missing, "the device does not exist"), "no device", missing);
  const std::string null = refusal(small("/dev/null"));
  check(has(null, "not a capture device"), "not a video device", null);
  const std::string output = refusal(small(kOutput));
  check(has(output, "it is a video output"), "an output", output);
  {
    auto device = V4l2Device::open(small(kFirst));
    const std::string busy = refusal(small(kFirst));
    check(has(busy, "another program is using it"), "a busy device", busy);
    check(take(*device, 30).gaps == 0, "a busy device keeps streaming to its user");
  }
  if (::seteuid(1000) == 0) {
    const std::string forbidden = refusal(small(kFirst));
    const bool back = ::seteuid(0) == 0;
    check(back && has(forbidden, "usermod -aG video"), "no permission", forbidden);
  }
}

/// A camera whose losses and returns are recorded.
struct Watched {
  explicit Watched(const DeviceRequest& request)
      : device(ReopeningDevice::open(request, [this](const CameraStatus& status) {
          if (status.state == CameraState::kLost) {
            lost = status.since;
            why = status.trouble ? status.trouble->message() : "";
          }
          if (status.state == CameraState::kStreaming) back = status.since;
        })) {}

  /// Receives frames for this time, like a worker.
  void run(Timestamp duration) {
    const auto end = std::chrono::steady_clock::now() + duration;
    while (device && std::chrono::steady_clock::now() < end) {
      frames += device->next(100ms) ? 1 : 0;
    }
  }

  int frames = 0;
  std::optional<Timestamp> lost;
  std::optional<Timestamp> back;
  std::string why;
  Result<ReopeningDevice> device;
};

/// Returns the time from `start` to `end`, in seconds; a large number without an end.
double since(Timestamp start, std::optional<Timestamp> end) {
  return end ? seconds(*end - start) : 1e9;
}

/// libstdc++'s steady clock is CLOCK_MONOTONIC.
Timestamp now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void check_disconnect() {
  Watched camera(small(kFirst));
  Take other;
  std::thread neighbour([&] { other = take_from(small(kSecond), 300); });
  camera.run(1s);
  const Timestamp pressed = now();
  check(set_vivid(kFirst, "Disconnect"), "vivid disconnects");
  camera.run(5s);
  const double noticed_s = since(pressed, camera.lost);
  const double back_s = since(pressed, camera.back);
  check(noticed_s < 1.0 && has(camera.why, "the camera is gone"),
        "a disconnect is noticed within 1 s",
        std::to_string(noticed_s) + " s; " + camera.why);
  check(back_s < 3.0 && camera.device->status().restarts == 1 && camera.frames > 120,
        "and the camera is back within 3 s",
        std::to_string(back_s) + " s, " + std::to_string(camera.frames) + " frames");
  neighbour.join();
  check(other.frames == 300 && other.gaps == 0,
        "while its neighbour went on without a gap",
        other.text());
}

void check_replug() {
  const std::string driver = "/sys/bus/platform/drivers/vivid/";
  Watched camera(small(kFirst));
  camera.run(1s);
  const Timestamp unplugged = now();
  std::thread unplug([&] { write_file(driver + "unbind", "vivid.0"); });
  camera.run(4s);
  unplug.join();
  const double noticed_s = since(unplugged, camera.lost);
  check(noticed_s < 1.0 && ::access(kFirst, F_OK) != 0,
        "a removed device file is noticed within 1 s",
        std::to_string(noticed_s) + " s");
  check(!camera.back, "it stays lost while it is out");
  const Timestamp replugged = now();
  write_file(driver + "bind", "vivid.0");
  camera.run(4s);
  const double back_s = since(replugged, camera.back);
  check(back_s < 3.0 && camera.device->status().losses == 1,
        "and it is back within 3 s",
        std::to_string(back_s) + " s, at " + camera.device->info().path);
}

void check_mjpg() {
  std::vector<std::vector<std::byte>> pictures;
  for (const char* path : {"/mjpg_1.jpg", "/mjpg_2.jpg", "/mjpg_3.jpg", "/mjpg_4.jpg"}) {
    pictures.push_back(read_file(path));
  }
  const LoopbackFeeder feeder(kLoopback, pictures);
  if (!check(feeder.works(), "v4l2loopback takes MJPG")) return;
  std::this_thread::sleep_for(300ms);
  auto device = V4l2Device::open(small(kLoopback));
  if (!check(
          device.has_value(), "MJPG is opened", device ? "" : device.error().message())) {
    return;
  }
  Take all;
  int wrong = 0;
  while (all.frames < 150) {
    const auto frame = device->next(2000ms);
    if (!frame || !*frame) break;
    all.add(**frame);
    const auto& fed = pictures[(*frame)->sequence % pictures.size()];
    wrong += std::ranges::equal((*frame)->bytes, fed) ? 0 : 1;
  }
  check(device->settings().format == PixelFormat::kMjpg && all.frames == 150 &&
            wrong == 0 && all.damaged == 0,
        "every MJPG frame has the bytes that were sent",
        all.text() + ", " + std::to_string(wrong) + " wrong");
  check(all.dropped == 0 && all.gaps == 0 && all.last_sequence > 150,
        "frames from before the first read are not a loss",
        "last number " + std::to_string(all.last_sequence));
  check(!device->settings().monotonic_clock && all.arrival_times == 0,
        "stamps without a promise are taken where they make sense");
}

void check_allocations() {
  auto device = V4l2Device::open(small(kFirst));
  if (!device) return;
  static_cast<void>(take(*device, 5));
  const long before = testing::allocations();
  int frames = 0;
  for (int i = 0; i < 100; ++i) {
    const auto frame = device->next(1000ms);
    frames += frame && *frame ? 1 : 0;
  }
  const long during = testing::allocations() - before;
  check(frames == 100 && during == 0,
        "frames allocate nothing",
        std::to_string(during) + " allocations");
}

void check_measuring() {
  DeviceRequest request = small(kFirst);
  request.width_px = 640;
  request.height_px = 360;
  const capture::CameraProbe found = capture::probe_camera(request);
  check(!found.trouble && found.measured && std::abs(found.measured->hz - 30.0) < 0.5,
        "a camera's rate is measured",
        capture::summary(found));
}

int run() {
  check_listing();
  check_measuring();
  check_allocations();
  check_two_at_once();
  check_settings();
  check_drops();
  check_wraps();
  check_refusals();
  check_wrong_devices();
  check_disconnect();
  check_mjpg();
  check_replug();
  return failures;
}

}  // namespace
}  // namespace marey::guest

int main() {
  return marey::guest::run();
}
