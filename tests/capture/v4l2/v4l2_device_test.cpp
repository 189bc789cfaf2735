// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_device.h"

#include <algorithm>
#include <cerrno>

#include <gtest/gtest.h>

#include "tests/capture/v4l2/fake_kernel.h"

namespace marey::capture {
namespace {

/// 640x480 at 30 frames/s of camera 0.
DeviceRequest vga() {
  DeviceRequest request;
  request.path = "/dev/video0";
  request.width_px = 640;
  request.height_px = 480;
  return request;
}

FakeFormat format(std::uint32_t fourcc,
                  std::uint32_t width_px,
                  std::uint32_t height_px,
                  std::uint32_t rate_hz) {
  return {fourcc, {{width_px, height_px, {rate_hz}}}};
}

Error refusal(FakeKernel& kernel, const DeviceRequest& request = vga()) {
  const auto device = V4l2Device::open(request, kernel);
  if (device) {
    ADD_FAILURE() << "it was opened";
    return {};
  }
  EXPECT_EQ(device.error().code, Errc::kDevice);
  EXPECT_EQ(device.error().where, request.path);
  EXPECT_FALSE(device.error().next.empty());
  EXPECT_EQ(kernel.open_files, 0);
  EXPECT_EQ(kernel.cameras[0].maps, 0);
  return device.error();
}

bool says(const std::vector<std::string>& sentences, const std::string& sentence) {
  return std::ranges::find(sentences, sentence) != sentences.end();
}

TEST(V4l2Open, AsksForMotionJpegByTheNameThatIsListed) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {{V4L2_PIX_FMT_JPEG, {{}}}, {V4L2_PIX_FMT_YUYV, {{}}}};
  DeviceRequest request;
  request.path = kernel.cameras[0].path;
  const auto device = V4l2Device::open(request, kernel);
  ASSERT_TRUE(device);
  EXPECT_EQ(device->settings().format, PixelFormat::kMjpg);
  EXPECT_EQ(kernel.cameras[0].format.pixelformat, V4L2_PIX_FMT_JPEG);
}

TEST(V4l2Open, KnowsHowLongARowIsWhereTheDriverDoesNotSay) {
  FakeKernel kernel;
  kernel.cameras[0].keeps_stride = true;
  DeviceRequest request;
  request.path = kernel.cameras[0].path;
  const auto device = V4l2Device::open(request, kernel);
  ASSERT_TRUE(device);
  EXPECT_EQ(device->settings().stride, 2 * device->settings().width_px);
}

TEST(V4l2Open, RefusesPicturesWithoutASize) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {{V4L2_PIX_FMT_YUYV, {{0, 0, {30}}}}};
  DeviceRequest request;
  request.path = kernel.cameras[0].path;
  const auto device = V4l2Device::open(request, kernel);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().code, Errc::kDevice);
  EXPECT_EQ(kernel.open_files, 0);
}

TEST(V4l2List, ContainsOnlyCaptureDevices) {
  FakeKernel kernel;
  kernel.cameras.resize(3);
  kernel.cameras[1].path = "/dev/video1";
  kernel.cameras[1].can = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  kernel.cameras[2].path = "/dev/video2";
  const DeviceList list = list_devices(kernel);
  ASSERT_EQ(list.devices.size(), 2U);
  EXPECT_EQ(list.devices[0].path, "/dev/video0");
  EXPECT_EQ(list.devices[0].card, "Fake Cam");
  EXPECT_EQ(list.devices[0].place_at_bus, 0);
  EXPECT_EQ(list.devices[1].path, "/dev/video2");
  EXPECT_EQ(list.devices[1].place_at_bus, 1);
  EXPECT_TRUE(list.errors.empty());
  EXPECT_EQ(kernel.open_files, 0);
}

TEST(V4l2List, ReportsADeviceWithoutPermission) {
  FakeKernel kernel;
  kernel.refuse_to_open(EACCES);
  const DeviceList list = list_devices(kernel);
  EXPECT_TRUE(list.devices.empty());
  ASSERT_EQ(list.errors.size(), 1U);
  EXPECT_NE(list.errors[0].next.find("group"), std::string::npos);
}

TEST(V4l2List, HasFormatsInTheOrderOfPreferenceAndRatesFastestFirst) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {format(V4L2_PIX_FMT_GREY, 640, 480, 30),
                               format(V4L2_PIX_FMT_H264, 640, 480, 30),
                               {V4L2_PIX_FMT_MJPEG, {{1280, 720, {15, 60, 30}}}}};
  const DeviceList list = list_devices(kernel);
  ASSERT_EQ(list.devices.size(), 1U);
  const auto& modes = list.devices[0].modes;
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_EQ(modes[0].format, PixelFormat::kMjpg);
  EXPECT_EQ(modes[0].width_px, 1280);
  ASSERT_EQ(modes[0].rates.size(), 3U);
  EXPECT_EQ(modes[0].rates[0].hz, 60.0);
  EXPECT_EQ(modes[1].format, PixelFormat::kGrey);
}

TEST(V4l2Choice, IsMjpgBeforeYuyvWhereBothServe) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {format(V4L2_PIX_FMT_YUYV, 640, 480, 30),
                               format(V4L2_PIX_FMT_MJPEG, 640, 480, 30)};
  const auto device = V4l2Device::open(vga(), kernel);
  ASSERT_TRUE(device);
  EXPECT_EQ(device->settings().format, PixelFormat::kMjpg);
  EXPECT_TRUE(device->settings().differences.empty());
}

TEST(V4l2Choice, IsTheFormatThatHasTheSizeAtTheRate) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {format(V4L2_PIX_FMT_MJPEG, 1280, 720, 30),
                               format(V4L2_PIX_FMT_YUYV, 640, 480, 10),
                               format(V4L2_PIX_FMT_GREY, 640, 480, 30)};
  const auto devices = list_devices(kernel).devices;
  EXPECT_EQ(choose_format(devices.at(0), vga()), PixelFormat::kGrey);
  DeviceRequest fast = vga();
  fast.rate = FrameRate{120.0};
  EXPECT_EQ(choose_format(devices.at(0), fast), PixelFormat::kYuyv);
  DeviceRequest other = vga();
  other.width_px = 100;
  EXPECT_EQ(choose_format(devices.at(0), other), PixelFormat::kMjpg);
  EXPECT_EQ(choose_format(DeviceInfo{}, vga()), std::nullopt);
}

TEST(V4l2Settings, ReportSettingsThatTheDriverChanged) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {format(V4L2_PIX_FMT_YUYV, 320, 240, 30)};
  kernel.cameras[0].always_every = v4l2_fract{2, 25};
  DeviceRequest request = vga();
  request.format = PixelFormat::kMjpg;
  const auto device = V4l2Device::open(request, kernel);
  ASSERT_TRUE(device);
  const DeviceSettings& got = device->settings();
  EXPECT_EQ(got.format, PixelFormat::kYuyv);
  EXPECT_EQ(got.stride, 640);
  EXPECT_EQ(got.rate.hz, 12.5);
  EXPECT_TRUE(says(got.differences, "requested MJPG, got YUYV"));
  EXPECT_TRUE(says(got.differences, "requested 640x480, got 320x240"));
  EXPECT_TRUE(says(got.differences, "requested 30 frames/s, got 12.5"));
}

TEST(V4l2Settings, AreReadBackFromTheControls) {
  FakeKernel kernel;
  kernel.cameras[0].controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 3}},
                                {V4L2_CID_EXPOSURE_AUTO_PRIORITY, {0, 1, 1}},
                                {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 250}},
                                {V4L2_CID_FOCUS_AUTO, {0, 1, 1}},
                                {V4L2_CID_FOCUS_ABSOLUTE, {0, 250, 0}},
                                {V4L2_CID_GAIN, {0, 255, 0}}};
  DeviceRequest request = vga();
  request.exposure_s = 0.0040;
  request.focus = 30;
  request.gain = 300;
  const auto device = V4l2Device::open(request, kernel);
  ASSERT_TRUE(device);
  const DeviceSettings& got = device->settings();
  EXPECT_NEAR(got.exposure_s.value(), 0.004, 1e-9);
  EXPECT_FALSE(got.exposure_is_automatic);
  EXPECT_EQ(got.focus, 30);
  EXPECT_EQ(got.gain, 255);
  EXPECT_EQ(got.differences,
            std::vector<std::string>{"requested a gain of 300, got 255"});
  EXPECT_EQ(kernel.cameras[0].controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY].value, 0);
  EXPECT_EQ(kernel.cameras[0].controls[V4L2_CID_FOCUS_AUTO].value, 0);
}

TEST(V4l2Settings, ReportUnsupportedSettings) {
  FakeKernel kernel;
  kernel.cameras[0].controls = {
      {V4L2_CID_EXPOSURE_AUTO, {0, 3, V4L2_EXPOSURE_APERTURE_PRIORITY, true}},
      {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 250}}};
  DeviceRequest request = vga();
  request.exposure_s = 0.004;
  request.focus = 30;
  const auto device = V4l2Device::open(request, kernel);
  ASSERT_TRUE(device);
  EXPECT_TRUE(device->settings().exposure_is_automatic);
  EXPECT_TRUE(says(device->settings().differences,
                   "requested an exposure of 4 ms, and the camera keeps it automatic"));
  EXPECT_TRUE(says(device->settings().differences,
                   "requested a focus of 30, and the camera has no such control"));
}

TEST(V4l2Settings, KeepTheCamerasValuesWithoutARequest) {
  FakeKernel kernel;
  kernel.cameras[0].controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 3}},
                                {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 156}}};
  const auto device = V4l2Device::open(vga(), kernel);
  ASSERT_TRUE(device);
  EXPECT_TRUE(device->settings().exposure_is_automatic);
  EXPECT_NEAR(device->settings().exposure_s.value(), 0.0156, 1e-9);
  EXPECT_TRUE(device->settings().differences.empty());
}

TEST(V4l2Open, ReportsAMissingDevice) {
  FakeKernel kernel;
  kernel.cameras[0].plugged = false;
  EXPECT_EQ(refusal(kernel).cause, "the device does not exist");
}

TEST(V4l2Open, WithoutPermissionNamesTheGroup) {
  for (const int number : {EACCES, EPERM}) {
    FakeKernel kernel;
    kernel.refuse_to_open(number);
    const Error error = refusal(kernel);
    EXPECT_NE(error.cause.find("not permitted"), std::string::npos);
    EXPECT_NE(error.next.find("usermod -aG video"), std::string::npos);
  }
}

TEST(V4l2Open, ReportsABusyDeviceAtEveryStep) {
  for (const unsigned long request : {0UL, VIDIOC_S_FMT, VIDIOC_REQBUFS}) {
    FakeKernel kernel;
    kernel.refuse(request, EBUSY, 2);
    const Error error = refusal(kernel);
    EXPECT_EQ(error.cause, "another program is using it");
    EXPECT_NE(error.next.find("fuser -v /dev/video0"), std::string::npos);
  }
}

TEST(V4l2Open, ReportsTheKindOfANonCaptureDevice) {
  FakeKernel kernel;
  kernel.refuse(VIDIOC_QUERYCAP, ENOTTY);
  EXPECT_EQ(refusal(kernel).cause, "it is not a capture device: it is no video device");
  kernel.cameras[0].can = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_EQ(refusal(kernel).cause,
            "it is not a capture device: it is a metadata channel of a camera");
  kernel.cameras[0].can = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  EXPECT_EQ(refusal(kernel).cause, "it is not a capture device: it is a video output");
}

TEST(V4l2Open, ReportsThatNoFormatIsReadable) {
  FakeKernel kernel;
  kernel.cameras[0].formats = {format(V4L2_PIX_FMT_H264, 640, 480, 30)};
  EXPECT_NE(refusal(kernel).cause.find("none of the picture formats"), std::string::npos);
  kernel.cameras[0].formats = {format(V4L2_PIX_FMT_YUYV, 640, 480, 30)};
  kernel.cameras[0].always_gives = V4L2_PIX_FMT_H264;
  EXPECT_EQ(refusal(kernel).cause, "requested YUYV, got H264, which marey does not read");
}

TEST(V4l2Open, WithoutBandwidthExplainsIt) {
  FakeKernel kernel;
  kernel.refuse(VIDIOC_STREAMON, ENOSPC);
  const Error error = refusal(kernel);
  EXPECT_NE(error.cause.find("bandwidth"), std::string::npos);
  for (const char* way : {"controller", "MJPG", "smaller size"}) {
    EXPECT_NE(error.next.find(way), std::string::npos) << way;
  }
}

TEST(V4l2Open, ReportsTheStepThatTheDriverRefused) {
  const std::pair<unsigned long, const char*> steps[] = {{VIDIOC_REQBUFS, "REQBUFS"},
                                                         {VIDIOC_QUERYBUF, "mapped"},
                                                         {VIDIOC_QBUF, "QBUF"},
                                                         {VIDIOC_STREAMON, "STREAMON"},
                                                         {VIDIOC_S_FMT, "format"}};
  for (const auto& [request, word] : steps) {
    FakeKernel kernel;
    kernel.refuse(request, EINVAL);
    const Error error = refusal(kernel);
    EXPECT_NE(error.cause.find(word), std::string::npos) << error.message();
    EXPECT_NE(error.cause.find("Invalid argument"), std::string::npos);
    EXPECT_TRUE(V4l2Device::open(vga(), kernel)) << "the next attempt should do";
  }
}

}  // namespace
}  // namespace marey::capture
