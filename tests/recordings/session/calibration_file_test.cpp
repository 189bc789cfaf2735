// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/session/calibration_file.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// Two cameras whose numbers have no short decimal form.
Calibration two_cameras() {
  Calibration calibration;
  for (const double i : {1.0, 2.0}) {
    Camera camera;
    camera.name = i == 1.0 ? "left" : "Right 2.0";
    camera.intrinsics.width_px = 1280;
    camera.intrinsics.height_px = 720;
    camera.intrinsics.focal_px = {931.0 + i / 3.0, 932.0 + i / 7.0};
    camera.intrinsics.centre_px = {640.0 - i / 9.0, 354.0 + i / 11.0};
    camera.intrinsics.distortion = {-0.118 / i, 0.047 / 3, 1e-5 * i / 3, -4e-4 / 7, 0.0};
    camera.camera_from_world.rotation =
        rotation_from_vector({i / 3.0, -i / 7.0, 2.0 + i / 9.0});
    camera.camera_from_world.translation = {i / 3.0, -i / 7.0, 3.0};
    camera.tag_shrinkage = {0.1 / 3.0 * i, 0.001 / 7.0};
    calibration.cameras.push_back(camera);
    calibration.quality.push_back({.rms_px = 0.2 / 3.0 * i,
                                   .p95_px = 0.5 / 3.0,
                                   .centre_sigma_m = 1e-3 / 7.0,
                                   .focal_sigma_px = 0.7 / 3.0,
                                   .views = 88,
                                   .corners = 1234,
                                   .coverage = 1.0 / 3.0});
    calibration.clocks.push_back({-0.0111 / 3.0, 2.0 / 3.0});
  }
  calibration.rms_px = 0.3 / 7.0;
  return calibration;
}

constexpr std::string_view kPose2Sim = R"([int_cam1_img]
name = "int_cam1_img"
size = [ 1088.0, 1920.0]
matrix = [ [ 1681.244, 0.0, 532.196], [ 0.0, 1681.078, 948.378], [ 0.0, 0.0, 1.0]]
distortions = [ -0.0461, 0.139, -0.00058, -0.00049]
rotation = [ 1.2, 0.9, -0.8]
translation = [ -1.1, 0.4, 4.6]
fisheye = false

[metadata]
adjusted = false
error = 0.0
)";

std::string calibration_mistake(const std::string& text) {
  const Result<Calibration> calibration = parse_calibration(text, "c.toml");
  return calibration ? "" : calibration.error().message();
}

TEST(CalibrationFile, GivesBackEveryDouble) {
  const Calibration written = two_cameras();
  const Result<Calibration> read = parse_calibration(calibration_text(written), "c.toml");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->cameras.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Camera& a = written.cameras[i];
    const Camera& b = read->cameras[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.intrinsics.width_px, b.intrinsics.width_px);
    EXPECT_EQ(a.intrinsics.height_px, b.intrinsics.height_px);
    EXPECT_EQ(a.intrinsics.parameters(), b.intrinsics.parameters());
    EXPECT_EQ(a.camera_from_world.rotation, b.camera_from_world.rotation);
    EXPECT_EQ(a.camera_from_world.translation, b.camera_from_world.translation);
    EXPECT_EQ(a.tag_shrinkage.offset_px, b.tag_shrinkage.offset_px);
    EXPECT_EQ(a.tag_shrinkage.slope, b.tag_shrinkage.slope);
  }
  EXPECT_EQ(read->rms_px, written.rms_px);
}

TEST(CalibrationFile, WritesTheSameBytesAfterReading) {
  const std::string text = calibration_text(two_cameras());
  const Result<Calibration> read = parse_calibration(text, "c.toml");
  ASSERT_TRUE(read);
  EXPECT_EQ(calibration_text(*read), text);
}

TEST(CalibrationFile, IsReadFromDisk) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_calibration(folder / "calibration.toml", two_cameras()));
  const Result<Calibration> read = read_calibration(folder / "calibration.toml");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->quality[1].corners, 1234);
}

TEST(CalibrationFile, ReadsPose2SimsOwn) {
  const Result<Calibration> read = parse_calibration(kPose2Sim, "Calib.toml");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->cameras.size(), 1U);
  const Camera& camera = read->cameras[0];
  EXPECT_EQ(camera.name, "int_cam1_img");
  EXPECT_EQ(camera.intrinsics.height_px, 1920);
  EXPECT_EQ(camera.intrinsics.distortion[1], 0.139);
  EXPECT_EQ(camera.intrinsics.distortion[4], 0.0);
  EXPECT_EQ(camera.camera_from_world.translation.z, 4.6);
  const glm::dvec3 vector_rad = rotation_vector(camera.camera_from_world.rotation);
  EXPECT_NEAR(vector_rad.y, 0.9, 1e-12 /* rad, rounding */);
}

TEST(CalibrationFile, PassesOverKeysOfOthers) {
  const std::string text = testing::replace_first(
      std::string(kPose2Sim), "fisheye", "rotation_count = 0\nport = 1\nfisheye");
  EXPECT_EQ(calibration_mistake(text), "");
}

TEST(CalibrationFile, WritesTheKeysThatPose2SimReads) {
  const std::string text = calibration_text(two_cameras());
  for (const char* line : {"[left]\nname = \"left\"\nsize = [1280, 720]\nmatrix = [[",
                           "\ndistortions = [",
                           "\nrotation = [",
                           "\ntranslation = [",
                           "\nfisheye = false\n",
                           "\n[metadata]\nadjusted = false\nerror = "}) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

TEST(CalibrationFile, WorldFromCameraHoldsTheCentreOfTheCamera) {
  Calibration calibration = two_cameras();
  calibration.cameras.resize(1);
  calibration.quality.resize(1);
  calibration.clocks.resize(1);
  calibration.cameras[0].camera_from_world = {{1.0, 0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}};
  EXPECT_NE(
      calibration_text(calibration)
          .find("world_from_camera = [[1.0, 0.0, 0.0, -1.0], [0.0, 1.0, 0.0, -2.0], "
                "[0.0, 0.0, 1.0, -3.0], [0.0, 0.0, 0.0, 1.0]]"),
      std::string::npos);
}

TEST(CalibrationFile, RefusesAPoseWhoseFormsDisagree) {
  const std::string text = testing::replace_first(
      calibration_text(two_cameras()), "rotation = [0.3", "rotation = [0.4");
  EXPECT_EQ(
      calibration_mistake(text),
      "c.toml:12: \"rotation\" and \"rotation_wxyz\" are different rotations. Next: "
      "remove rotation_wxyz, and world_from_camera, if rotation is right.");
}

TEST(CalibrationFile, RefusesAMatrixThatIsNotThePose) {
  const std::string text = testing::replace_first(
      calibration_text(two_cameras()), "translation = [0.3", "translation = [0.4");
  EXPECT_TRUE(calibration_mistake(text).starts_with(
      "c.toml:13: \"world_from_camera\" is not the"));
}

TEST(CalibrationFile, RefusesCamerasThatStandNowhereNear) {
  Calibration ours = two_cameras();
  const auto moved_to = [&](double x_m) {
    ours.cameras[0].camera_from_world.translation = {x_m, 0.0, 0.0};
    return calibration_mistake(calibration_text(ours));
  };
  EXPECT_EQ(moved_to(900.0), "");
  EXPECT_EQ(moved_to(1e17),
            "c.toml:11: the camera stands more than a kilometre from the world's origin. "
            "Next: correct it, or run marey calibrate again.");
}

TEST(CalibrationFile, NamesTheLineOfAMissingKey) {
  const std::string text = testing::replace_first(
      std::string(kPose2Sim), "rotation = [ 1.2, 0.9, -0.8]\n", "");
  EXPECT_TRUE(calibration_mistake(text).starts_with(
      "c.toml:1: the key \"rotation\" is missing in [int_cam1_img]"));
}

TEST(CalibrationFile, HasFourTermsForAFisheye) {
  const auto read = parse_calibration(
      testing::replace_first(std::string(kPose2Sim), "false", "true"), "c.toml");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->cameras[0].intrinsics.lens, LensModel::kFisheye);
  EXPECT_EQ(read->cameras[0].intrinsics.distortion[3], -0.00049);
}

TEST(CalibrationFile, KeepsEveryLens) {
  Calibration calibration = two_cameras();
  Intrinsics& wide = calibration.cameras[0].intrinsics;
  wide.lens = LensModel::kRational;
  wide.distortion = {0.31, -0.1 / 3, 1e-4, -2e-4 / 7, 0.01, 0.6 / 7, -0.02, 0.003 / 7};
  Intrinsics& widest = calibration.cameras[1].intrinsics;
  widest.lens = LensModel::kFisheye;
  widest.distortion = {-0.02, 0.01 / 3, -0.004, 0.001 / 7};
  const auto back = parse_calibration(calibration_text(calibration), "c.toml");
  ASSERT_TRUE(back);
  for (std::size_t c = 0; c < 2; ++c) {
    const Intrinsics& a = calibration.cameras[c].intrinsics;
    const Intrinsics& b = back->cameras[c].intrinsics;
    EXPECT_EQ(a.lens, b.lens);
    EXPECT_EQ(a.distortion, b.distortion);
  }
}

TEST(CalibrationFile, RefusesSkew) {
  EXPECT_TRUE(
      calibration_mistake(testing::replace_first(
                              std::string(kPose2Sim), "1681.244, 0.0", "1681.244, 0.5"))
          .starts_with("c.toml:4: \"matrix\" must be [[fx, 0, cx]"));
}

TEST(CalibrationFile, RefusesARowTooFew) {
  EXPECT_TRUE(calibration_mistake(testing::replace_first(
                                      std::string(kPose2Sim), ", [ 0.0, 0.0, 1.0]]", "]"))
                  .starts_with("c.toml:4: \"matrix\" has the wrong number of rows"));
}

TEST(CalibrationFile, RefusesAFileWithoutCameras) {
  EXPECT_EQ(
      calibration_mistake("[metadata]\nerror = 0.0\n"),
      "c.toml:1: no camera in it. Next: run marey calibrate, or name another file.");
}

TEST(CalibrationFile, NamesTheLineThatIsNotToml) {
  EXPECT_TRUE(
      calibration_mistake("[left]\nname = \n").starts_with("c.toml:2: not valid TOML: "));
}

}  // namespace
}  // namespace marey::recordings
