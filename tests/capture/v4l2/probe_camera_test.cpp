// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/probe_camera.h"

#include <cerrno>
#include <string>

#include <gtest/gtest.h>

#include "tests/capture/v4l2/fake_kernel.h"

namespace marey::capture {
namespace {

class ProbeCamera : public testing::Test {
 protected:
  FakeKernel kernel_;
  FakeCamera& camera_ = kernel_.cameras[0];

  ProbeCamera() {
    camera_.formats = {{V4L2_PIX_FMT_MJPEG, {{1280, 720, {60, 30}}, {640, 480, {30}}}}};
    camera_.frames = frames_from(0, 1000);
    camera_.controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, V4L2_EXPOSURE_MANUAL}},
                        {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 40}}};
  }

  CameraProbe check() {
    DeviceRequest request;
    request.path = camera_.path;
    CameraProbe found = probe_camera(request, {}, kernel_);
    EXPECT_EQ(kernel_.open_files, 0);
    return found;
  }

  /// Returns the only advice.
  std::string advice() {
    const CameraProbe found = check();
    if (found.advice.size() != 1) {
      ADD_FAILURE() << found.advice.size() << " pieces of advice";
      return {};
    }
    return found.advice[0];
  }
};

TEST_F(ProbeCamera, MeasuresForASecondAndHasNoAdviceForAGoodOne) {
  const Timestamp before = kernel_.now();
  const CameraProbe found = check();
  EXPECT_FALSE(found.trouble);
  ASSERT_TRUE(found.measured);
  EXPECT_NEAR(found.measured->hz, 30.3, 0.1);
  EXPECT_NEAR(found.frames, 31, 1);
  EXPECT_LT(kernel_.now() - before, std::chrono::milliseconds(1300));
  EXPECT_TRUE(found.advice.empty());
  EXPECT_EQ(summary(found), "MJPG 1280x720 at 30.3 of 30 frames/s, exposure 4 ms");
}

TEST_F(ProbeCamera, AdvisesOnBlur) {
  camera_.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value = 156;
  EXPECT_EQ(advice(),
            "its exposure of 15.6 ms blurs a tag at 2 m and 2 m/s by 14.1 px: "
            "set it to 4 ms or less, and add light");
  camera_.controls[V4L2_CID_EXPOSURE_AUTO].value = V4L2_EXPOSURE_APERTURE_PRIORITY;
  EXPECT_NE(advice().find("its exposure is automatic"), std::string::npos);
  camera_.controls.clear();
  EXPECT_NE(advice().find("no exposure control"), std::string::npos);
}

TEST_F(ProbeCamera, AdvisesOnASlowCamera) {
  for (FakeFrame& frame : camera_.frames) frame.wait = std::chrono::milliseconds(66);
  EXPECT_EQ(advice().substr(0, 32), "it gives 15.2 of 30 frames/s: au");
}

TEST_F(ProbeCamera, AdvisesOnDroppedFrames) {
  camera_.frames.erase(camera_.frames.begin() + 10, camera_.frames.begin() + 14);
  EXPECT_NE(advice().find("4 were dropped and 0 damaged"), std::string::npos);
}

TEST_F(ProbeCamera, AdvisesOnBandwidth) {
  camera_.formats = {{V4L2_PIX_FMT_YUYV, {{1280, 720, {30}}}}};
  EXPECT_NE(advice().find("YUYV needs 55 MB/s"), std::string::npos);
}

TEST_F(ProbeCamera, ReportsACameraInUse) {
  kernel_.refuse(VIDIOC_S_FMT, EBUSY);
  const CameraProbe found = check();
  EXPECT_TRUE(found.trouble);
  EXPECT_TRUE(found.in_use);
  EXPECT_EQ(summary(found), "another program is using it");
}

TEST_F(ProbeCamera, ReportsASilentOrForbiddenCamera) {
  camera_.frames.clear();
  const CameraProbe silent = check();
  ASSERT_TRUE(silent.trouble);
  EXPECT_EQ(silent.trouble->cause, "it was opened and sends no frames");
  EXPECT_EQ(summary(silent), "MJPG 1280x720: it was opened and sends no frames");
  kernel_.refuse_to_open(EACCES);
  const CameraProbe forbidden = check();
  ASSERT_TRUE(forbidden.trouble);
  EXPECT_FALSE(forbidden.in_use);
}

TEST_F(ProbeCamera, ListsFormatsAndRates) {
  camera_.formats.push_back({V4L2_PIX_FMT_GREY, {{640, 480, {}}}});
  const auto devices = list_devices(kernel_).devices;
  EXPECT_EQ(
      offers(devices.at(0)),
      (std::vector<std::string>{"MJPG 1280x720 (60, 30), 640x480 (30)", "GREY 640x480"}));
}

}  // namespace
}  // namespace marey::capture
