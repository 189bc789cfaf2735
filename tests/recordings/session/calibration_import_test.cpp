// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/session/calibration_file.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

const fs::path kCamera = marey::testing::shared_data() / "camera";

constexpr std::string_view kPair = R"(%YAML:1.0
image_width: 640
image_height: 480
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.5e+02, 0., 3.25e+02, 0., 5.6e+02, 2.4e+02, 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ 2.5e-01, -1., 0., 0.,
       .5 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.1e+02, 0., 3.3e+02, 0., 5.2e+02, 2.5e+02, 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 8
   cols: 1
   dt: d
   data: [ 1., 2., 3., 4., 5., 6., 7., 8. ]
)";

constexpr std::string_view kPairPose = R"(%YAML:1.0
---
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0., -1., 0., 1., 0., 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -2.5e-01, 0.5, 0. ]
)";

constexpr std::string_view kXml = R"(<?xml version="1.0"?>
<opencv_storage>
<calibration_time>"Sat 01 Jan 2022"</calibration_time>
<image_width>640</image_width>
<image_height>480</image_height>
<fisheye_model>1</fisheye_model>
<camera_matrix type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    5.5e+02 0. 3.25e+02 0. 5.6e+02 2.4e+02 0. 0. 1.</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix">
  <rows>4</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    1. 2. 3. 4.</data></distortion_coefficients>
</opencv_storage>
)";

constexpr std::string_view kChain = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.2, 0.1, 0.001, -0.002]
  distortion_model: radtan
  intrinsics: [460.5, 459.25, 365.0, 250.5]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [0.0, -1.0, 0.0, -0.25]
  - [1.0, 0.0, 0.0, 0.5]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]
  distortion_model: equidistant
  intrinsics: [457.0, 456.0, 379.0, 255.0]
  resolution: [752, 480]
  timeshift_cam_imu: 0.01
cam2:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, 1.0]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [457.0, 456.0, 379.0, 255.0]
  resolution: [752, 480]
)";

constexpr std::string_view kCaliscope = R"([cameras.0]
cam_id = 0
rotation_count = -1
error = 0.19
ignore = false
size = [1280, 720]
matrix = [[894.5, 0.0, 624.0], [0.0, 896.75, 361.0], [0.0, 0.0, 1.0]]
distortions = [-0.25, 0.125, -0.5, 0.75, -1.0]
translation = [-0.25, 0.5, 1.5]
rotation = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
verified_resolutions = [[640, 480], [1280, 720]]

[cameras.7]
cam_id = 7
ignore = true
)";

class CalibrationImport : public ::testing::Test {
 protected:
  Result<Calibration> read(const std::string& name, std::string_view text) {
    EXPECT_TRUE(write_file(folder_ / name, text));
    return read_calibration(folder_ / name);
  }

  /// Returns the message without the folder.
  std::string mistake(const std::string& name, std::string_view text) {
    const Result<Calibration> calibration = read(name, text);
    if (calibration) return "";
    std::string message = calibration.error().message();
    const std::string prefix = folder_.path().string() + "/";
    if (message.starts_with(prefix)) message.erase(0, prefix.size());
    return message;
  }

  ScratchFolder folder_;
};

/// x, y, z becomes -y - 0.25, x + 0.5, z: the second camera of the texts above.
void expect_quarter_turn(const RigidTransform& camera_from_world, double z_m) {
  const glm::dvec3 p = camera_from_world * glm::dvec3(1.0, 2.0, 3.0);
  EXPECT_NEAR(p.x, -2.25, 1e-12 /* m, rounding */);
  EXPECT_NEAR(p.y, 1.5, 1e-12 /* m, rounding */);
  EXPECT_NEAR(p.z, 3.0 + z_m, 1e-12 /* m, rounding */);
}

TEST_F(CalibrationImport, TakesAStereoPairOfOpenCv) {
  const std::string pose(kPairPose.substr(kPairPose.find("R:")));
  const auto calibration = read("pair.yml", std::string(kPair) + pose);
  ASSERT_TRUE(calibration) << calibration.error().message();
  ASSERT_EQ(calibration->cameras.size(), 2U);
  EXPECT_EQ(calibration->quality.size(), 2U);
  EXPECT_EQ(calibration->clocks.size(), 2U);
  const Camera& first = calibration->cameras[0];
  EXPECT_EQ(first.name, "cam1");
  EXPECT_EQ(first.intrinsics.width_px, 640);
  EXPECT_EQ(first.intrinsics.focal_px, glm::dvec2(550.0, 560.0));
  EXPECT_EQ(first.intrinsics.centre_px, glm::dvec2(325.0, 240.0));
  EXPECT_EQ(first.intrinsics.distortion,
            (std::array<double, 8>{0.25, -1.0, 0.0, 0.0, 0.5}));
  EXPECT_EQ(first.camera_from_world.translation, glm::dvec3(0.0));
  const Camera& second = calibration->cameras[1];
  EXPECT_EQ(second.intrinsics.lens, LensModel::kRational);
  EXPECT_EQ(second.intrinsics.distortion[7], 8.0);
  expect_quarter_turn(second.camera_from_world, 0.0);
}

TEST_F(CalibrationImport, FindsRAndTInTheFolderOfALensFile) {
  EXPECT_EQ(mistake("intrinsics.yml", kPair),
            "intrinsics.yml:2: the pose of the second camera is missing: the file has no "
            "R and T. Next: add R and T as cv::stereoCalibrate gives them, or put "
            "extrinsics.yml with them into the same folder.");
  ASSERT_TRUE(write_file(folder_ / "extrinsics.yml", kPairPose));
  const auto calibration = read("intrinsics.yml", kPair);
  ASSERT_TRUE(calibration) << calibration.error().message();
  expect_quarter_turn(calibration->cameras[1].camera_from_world, 0.0);
}

TEST_F(CalibrationImport, TakesOneFisheyeOfOpenCvsXml) {
  const auto calibration = read("lens.xml", kXml);
  ASSERT_TRUE(calibration) << calibration.error().message();
  ASSERT_EQ(calibration->cameras.size(), 1U);
  const Intrinsics& k = calibration->cameras[0].intrinsics;
  EXPECT_EQ(k.lens, LensModel::kFisheye);
  EXPECT_EQ(k.focal_px, glm::dvec2(550.0, 560.0));
  EXPECT_EQ(k.distortion, (std::array<double, 8>{1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(calibration->cameras[0].camera_from_world.translation, glm::dvec3(0.0));
}

TEST_F(CalibrationImport, FollowsKalibrsChain) {
  const auto calibration = read("camchain.yaml", kChain);
  ASSERT_TRUE(calibration) << calibration.error().message();
  ASSERT_EQ(calibration->cameras.size(), 3U);
  const Camera& first = calibration->cameras[0];
  EXPECT_EQ(first.name, "cam0");
  EXPECT_EQ(first.intrinsics.focal_px, glm::dvec2(460.5, 459.25));
  EXPECT_EQ(first.intrinsics.distortion,
            (std::array<double, 8>{-0.2, 0.1, 0.001, -0.002}));
  EXPECT_EQ(calibration->cameras[1].intrinsics.lens, LensModel::kFisheye);
  expect_quarter_turn(calibration->cameras[1].camera_from_world, 0.0);
  const glm::dvec3 p = calibration->cameras[2].camera_from_world * glm::dvec3(1, 2, 3);
  EXPECT_NEAR(p.x, -1.25, 1e-12 /* m, rounding */);
}

// Kalibr's and TagSLAM's cameras.yaml of several cameras, without camera_poses.yaml.
TEST_F(CalibrationImport, TakesLensesOfCamerasThatStandNowhere) {
  constexpr std::string_view kLenses =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.2, 0.1, 0.001, -0.002]\n"
      "  distortion_model: radtan\n  intrinsics: [460.5, 459.25, 320.0, 240.0]\n"
      "  resolution: [640, 480]\n  rig_body: left\n"
      "cam1:\n  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.0, 0.0, 0.0]\n"
      "  distortion_model: equidistant\n  intrinsics: [300.0, 301.0, 320.0, 240.0]\n"
      "  resolution: [640, 480]\n  rig_body: right\n";
  EXPECT_TRUE(write_file(folder_ / "cameras.yaml", kLenses));
  EXPECT_FALSE(read_calibration(folder_ / "cameras.yaml"));
  const auto lenses = read_lenses(folder_ / "cameras.yaml");
  ASSERT_TRUE(lenses) << lenses.error().message();
  ASSERT_EQ(lenses->cameras.size(), 2U);
  EXPECT_EQ(lenses->cameras[0].intrinsics.focal_px, glm::dvec2(460.5, 459.25));
  EXPECT_EQ(lenses->cameras[1].name, "cam1");
  EXPECT_EQ(lenses->cameras[1].intrinsics.lens, LensModel::kFisheye);
}

TEST_F(CalibrationImport, TakesCaliscopesArray) {
  const auto calibration = read("camera_array.toml", kCaliscope);
  ASSERT_TRUE(calibration) << calibration.error().message();
  ASSERT_EQ(calibration->cameras.size(), 1U);  // The other is ignored.
  EXPECT_EQ(calibration->cameras[0].name, "cam_0");
  expect_quarter_turn(calibration->cameras[0].camera_from_world, 1.5);
}

TEST_F(CalibrationImport, IsReadUnderTheNameOfMareysOwn) {
  const auto calibration = read("calibration.toml", kChain);
  ASSERT_TRUE(calibration) << calibration.error().message();
  const auto back = parse_calibration(calibration_text(*calibration), "c.toml");
  ASSERT_TRUE(back) << back.error().message();
  EXPECT_EQ(back->cameras[1].intrinsics.parameters(),
            calibration->cameras[1].intrinsics.parameters());
  expect_quarter_turn(back->cameras[1].camera_from_world, 0.0);
}

TEST_F(CalibrationImport, DistinguishesCalibrationsFromSessionsByContent) {
  for (const std::string_view text : {kPair, kXml, kChain, kCaliscope}) {
    EXPECT_TRUE(write_file(folder_ / "a", text));
    EXPECT_TRUE(is_calibration(folder_ / "a")) << text;
  }
  EXPECT_TRUE(
      write_file(folder_ / "a", "# A comment: here\nformat = 1\nname = \"a:b\"\n"));
  EXPECT_FALSE(is_calibration(folder_ / "a"));
}

TEST_F(CalibrationImport, RefusesBrokenOpenCvFilesWithTheirLine) {
  EXPECT_EQ(mistake("a.yml", testing::replace_first(kPair, "image_width: 640\n", "")),
            "a.yml:2: the file does not state how large the pictures are. Next: add the "
            "keys image_width and image_height, in pixels.");
  for (const char* size : {"[ 1e+30, 480 ]", "[ 640, 0 ]", "[ -1e+300, 480 ]"}) {
    EXPECT_EQ(mistake("a.yml",
                      testing::replace_first(
                          kPair, "image_width: 640", std::string("image_size: ") + size)),
              "a.yml:2: \"image_size\" is not a picture size. Next: correct it.");
  }
  EXPECT_EQ(mistake("a.yml", testing::replace_first(kPair, "5.6e+02", "five")),
            "a.yml:8: \"data\" must be an array of 9 numbers. Next: write it as "
            "docs/formats/calibration.md shows.");
  EXPECT_EQ(mistake("a.yml", testing::replace_first(kPair, "cols: 5", "cols: 4")),
            "a.yml:13: \"D1\" has another number of values than its rows and cols state. "
            "Next: copy the file again.");
  EXPECT_EQ(mistake("a.yml", testing::replace_first(kPair, "5.5e+02, 0.", "5.5e+02, 3.")),
            "a.yml:4: \"M1\" must be [fx, 0, cx, 0, fy, cy, 0, 0, 1]. Next: calibrate "
            "without skew.");
  const std::string pose(kPairPose.substr(kPairPose.find("R:")));
  EXPECT_EQ(
      mistake("a.yml",
              std::string(kPair) + testing::replace_first(pose, "-2.5e-01", "-60.")),
      "a.yml:30: T puts the second camera more than 20 m from the first. Next: give "
      "T in metres: divide it by 1000 if it is in millimetres.");
  EXPECT_EQ(
      mistake("a.yml", std::string(kPair) + testing::replace_first(pose, "-1.", "-1.1")),
      "a.yml:25: \"R\" is not a rotation. Next: copy it from the calibration again.");
  EXPECT_EQ(mistake("a.yml", "%YAML:1.0\nM1: [ 1, 2\n").substr(0, 21),
            "a.yml:3: not valid YA");
  EXPECT_EQ(mistake("a.xml", testing::replace_first(kXml, "</camera_matrix>", ""))
                .substr(0, 22),
            "a.xml:19: not valid XM");
}

TEST_F(CalibrationImport, RefusesBrokenChainsWithTheirLine) {
  EXPECT_EQ(
      mistake("a.yaml", testing::replace_first(kChain, "model: pinhole", "model: omni")),
      "a.yaml:3: \"omni\" is a camera that marey does not have. Next: calibrate with "
      "pinhole-radtan or, for a fisheye, pinhole-equi.");
  EXPECT_EQ(mistake("a.yaml", testing::replace_first(kChain, "radtan", "fov")),
            "a.yaml:5: \"fov\" is a distortion that marey does not have. Next: calibrate "
            "with radtan or equidistant.");
  EXPECT_EQ(mistake("a.yaml", testing::replace_first(kChain, "[0.0, -1.0", "[0.0, -1.5")),
            "a.yaml:10: \"T_cn_cnm1\" is not a rotation and a translation. Next: copy it "
            "from the calibration again.");
  EXPECT_EQ(
      mistake("a.yaml", testing::replace_first(kChain, "cam2:", "cam3:")),
      "a.yaml:21: \"cam3\" does not follow: cameras are cam0, cam1... with none left "
      "out. Next: number them so.");
  EXPECT_EQ(mistake("a.yaml", testing::replace_first(kChain, "[752, 480]", "[752]")),
            "a.yaml:7: \"resolution\" must be an array of 2 numbers. Next: write it as "
            "docs/formats/calibration.md shows.");
}

TEST_F(CalibrationImport, RefusesMillimetresAndEndlessReferences) {
  EXPECT_EQ(mistake("a.toml", testing::replace_first(kCaliscope, "1.5]", "1500.0]")),
            "a.toml:9: the camera stands more than 100 m from the world's origin. Next: "
            "give positions in metres: divide them by 1000 if they are millimetres.");
  EXPECT_EQ(mistake("a.yaml", "a: &a [1]\nb: &b [*a, *b]\n"),
            "a.yaml: its lists or references have no end. Next: write the numbers out, "
            "without & and *.");
}

TEST(RealCalibration, ProjectsTheWandOfTagSlamToItsImagePositions) {
  const fs::path file = kCamera / "tagslam_tracks/test_4/cameras.yaml";
  if (!fs::exists(file))
    GTEST_SKIP() << "the recordings camera/tagslam_tracks are missing";
  const auto calibration = read_calibration(file);
  ASSERT_TRUE(calibration) << calibration.error().message();
  ASSERT_EQ(calibration->cameras.size(), 8U);
  EXPECT_EQ(calibration->cameras[7].intrinsics.centre_px,
            glm::dvec2(957.183663, 599.473163));
  const glm::dvec3 centre = centre_in_world(calibration->cameras[4]);
  EXPECT_NEAR(centre.x, 5.63120896, 1e-12 /* m, rounding */);
  // The centre of the wand's tag 0 at the first instant: its position from TagSLAM's
  // poses, and the mean of its four corners in the images.
  const glm::dvec3 p_in_world{2.64750927, 0.51286786, 1.35267844};
  const std::array<glm::dvec2, 4> seen_px{
      {{712.725, 139.591}, {564.359, 285.241}, {349.890, 808.908}, {551.565, 879.838}}};
  for (std::size_t i = 0; i < seen_px.size(); ++i) {
    const auto pixel_px = project(calibration->cameras[4 + i], p_in_world);
    ASSERT_TRUE(pixel_px);
    EXPECT_LT(glm::distance(*pixel_px, seen_px[i]), 1.5 /* px, TagSLAM's own misfit */);
  }
}

TEST(RealCalibration, ReadsFourCamerasOfCaliscope) {
  const fs::path sessions = kCamera / "caliscope/sessions";
  if (!fs::exists(sessions))
    GTEST_SKIP() << "the recordings camera/caliscope are missing";
  for (const char* session : {"4_cam_recording", "charuco_calibration"}) {
    const auto calibration = read_calibration(sessions / session / "camera_array.toml");
    ASSERT_TRUE(calibration) << calibration.error().message();
    ASSERT_EQ(calibration->cameras.size(), 4U);
    EXPECT_EQ(calibration->cameras[3].name, "cam_3");
    EXPECT_EQ(calibration->cameras[3].intrinsics.height_px, 720);
  }
}

TEST(RealCalibration, ReadsALensOfOpenCvOrReportsTheMissingPart) {
  const fs::path samples = kCamera / "opencv_samples";
  if (!fs::exists(samples)) GTEST_SKIP() << "camera/opencv_samples is missing";
  const auto lens = read_calibration(samples / "left_intrinsics.yml");
  ASSERT_TRUE(lens) << lens.error().message();
  EXPECT_EQ(lens->cameras[0].intrinsics.focal_px.x, 5.3591573396163199e+02);
  EXPECT_EQ(lens->cameras[0].intrinsics.distortion[4], 2.3839153080878486e-01);
  const auto cause = [&](const char* name) {
    const auto calibration = read_calibration(samples / name);
    return calibration ? "" : calibration.error().cause;
  };
  EXPECT_EQ(cause("intrinsics.yml"),
            "the file does not state how large the pictures are");
  // Lists of images.
  EXPECT_TRUE(cause("calibration.yml").starts_with("no camera in it"));
  EXPECT_TRUE(cause("stereo_calib.xml").starts_with("no camera in it"));
}

}  // namespace
}  // namespace marey::recordings
