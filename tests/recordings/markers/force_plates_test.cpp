// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/force_plates.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_analog.h"
#include "recordings/markers/marker_file.h"
#include "tests/recordings/markers/c3d_example.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;
namespace fs = std::filesystem;

// A push on the plate; in the plate's frame: x and y along it, z down.
const glm::dvec3 kForce{40.0, -25.0, -700.0};
const glm::dvec3 kPress{0.08, -0.11, 0.0};  // From the middle. [m]
constexpr double kTwist = 3.5;              // [N m]

/// A plate of 400 mm by 600 mm in a file in mm whose Z is up; its x is the file's Y.
C3dInfo plate_info(int type, const glm::dvec3& origin_mm) {
  C3dInfo info;
  info.frames = 2;
  info.analog_channels = type == 3 ? 8 : 6;
  info.rate_hz = 100.0;
  put_texts(info.groups, "POINT", "UNITS", {"mm"});
  put_texts(info.groups, "POINT", "Y_SCREEN", {"+Z"});
  const char* group = "FORCE_PLATFORM";
  const auto type_word = static_cast<std::int16_t>(type);
  put_parameter(info.groups, group, {"USED", "", false, {}, C3dIntegers{1}});
  put_parameter(info.groups, group, {"TYPE", "", false, {1}, C3dIntegers{type_word}});
  const C3dReals corners{800, 700, 0, 800, 300, 0, 200, 300, 0, 200, 700, 0};
  put_parameter(info.groups, group, {"CORNERS", "", false, {3, 4, 1}, corners});
  const C3dReals origin{static_cast<float>(origin_mm.x),
                        static_cast<float>(origin_mm.y),
                        static_cast<float>(origin_mm.z)};
  put_parameter(info.groups, group, {"ORIGIN", "", false, {3, 1}, origin});
  const auto count = static_cast<std::uint8_t>(info.analog_channels);
  C3dIntegers channels;
  for (std::int16_t i = 1; i <= count; ++i) channels.push_back(i);
  put_parameter(info.groups, group, {"CHANNEL", "", false, {count, 1}, channels});
  return info;
}

/// Moment of the push about a point in the plate's frame. [N m]
glm::dvec3 moment_about(const glm::dvec3& point_m) {
  const glm::dvec3 arm = kPress - point_m;
  return glm::cross(arm, kForce) + glm::dvec3(0.0, 0.0, kTwist);
}

ForcePlates plates_of(const C3dInfo& info, const std::vector<double>& words) {
  const ScratchFolder folder;
  C3dFrame frame;
  for (const double word : words) frame.analog.push_back(static_cast<float>(word));
  write_frames(folder / "a.c3d", info, {frame, frame});
  const auto markers = read_markers(folder / "a.c3d");
  EXPECT_TRUE(markers) << markers.error().message();
  auto plates = read_force_plates(folder / "a.c3d", markers->axes);
  EXPECT_TRUE(plates) << plates.error().message();
  return plates ? *std::move(plates) : ForcePlates{};
}

void expect_the_push(const ForcePlates& plates) {
  ASSERT_EQ(plates.plates.size(), 1U);
  ASSERT_EQ(plates.plates[0].samples.size(), 2U);
  const PlateSample& sample = plates.plates[0].samples[1];
  // The plate's x is the file's Y, which is the world's -Z; its y is the file's X.
  EXPECT_LT(glm::distance(sample.force_in_world, {-25.0, 700.0, -40.0}), 1e-3);
  ASSERT_TRUE(sample.centre_in_world);
  // The plate's middle is at (500, 500, 0) mm in the file.
  const glm::dvec3 centre{0.5 - 0.11, 0.0, -0.5 - 0.08};
  EXPECT_LT(glm::distance(*sample.centre_in_world, centre), 1e-5);
  EXPECT_LT(glm::distance(sample.free_moment_in_world, {0.0, -kTwist, 0.0}), 1e-3);
}

TEST(ForcePlates, ReadThePushOfType1Directly) {
  expect_the_push(plates_of(plate_info(1, {}),
                            {kForce.x,
                             kForce.y,
                             kForce.z,
                             1000.0 * kPress.x,
                             1000.0 * kPress.y,
                             1000.0 * kTwist}));
}

TEST(ForcePlates, ComputeThePushOfType2FromForceAndMoment) {
  // The sensor is 40 mm below the surface and a little off its middle.
  const glm::dvec3 origin_mm{2.0, -3.0, -40.0};
  const glm::dvec3 m = 1000.0 * moment_about(-1e-3 * origin_mm);
  expect_the_push(
      plates_of(plate_info(2, origin_mm), {kForce.x, kForce.y, kForce.z, m.x, m.y, m.z}));
}

TEST(ForcePlates, CorrectAnOriginOfTheOtherSignAndReportIt) {
  const glm::dvec3 origin_mm{2.0, -3.0, -40.0};
  const glm::dvec3 m = 1000.0 * moment_about(-1e-3 * origin_mm);
  const ForcePlates plates =
      plates_of(plate_info(2, -origin_mm), {kForce.x, kForce.y, kForce.z, m.x, m.y, m.z});
  expect_the_push(plates);
  ASSERT_EQ(plates.notes.size(), 1U);
  EXPECT_NE(plates.notes[0].find("its sign is changed"), std::string::npos);
}

TEST(ForcePlates, ComputeThePushOfType3FromEightSensors) {
  // Sensors at (+-a, +-b), 50 mm deep: forces that add up to the push.
  constexpr double kA = 0.12;
  constexpr double kB = 0.2;
  const glm::dvec3 m = moment_about({0.0, 0.0, 0.05});
  const double fz = kForce.z / 4.0;
  const double along_x = m.x / (4.0 * kB);
  const double along_y = m.y / (4.0 * kA);
  // Mz = b (-Fx12 + Fx34) + a (Fy14 - Fy23), here by the first alone.
  const double turn = m.z / (2.0 * kB);
  expect_the_push(plates_of(plate_info(3, {120.0, 200.0, -50.0}),
                            {kForce.x / 2.0 - turn,
                             kForce.x / 2.0 + turn,
                             kForce.y / 2.0,
                             kForce.y / 2.0,
                             fz + along_x - along_y,
                             fz + along_x + along_y,
                             fz - along_x + along_y,
                             fz - along_x - along_y}));
}

TEST(ForcePlates, ComputeThePushOfType4WithTheirMatrix) {
  const glm::dvec3 origin_mm{0.0, 0.0, -40.0};
  const glm::dvec3 m = 1000.0 * moment_about(-1e-3 * origin_mm);
  C3dInfo info = plate_info(4, origin_mm);
  // Fz is 2 of channel 3 and 0.5 of channel 1, My is 10 of channel 5; column by column.
  C3dReals matrix(36, 0.0F);
  for (std::size_t i = 0; i < 6; ++i) matrix[7 * i] = 1.0F;
  matrix[2 + 6 * 2] = 2.0F;
  matrix[2 + 6 * 0] = 0.5F;
  matrix[4 + 6 * 4] = 10.0F;
  put_parameter(
      info.groups, "FORCE_PLATFORM", {"CAL_MATRIX", "", false, {6, 6, 1}, matrix});
  expect_the_push(plates_of(
      info,
      {kForce.x, kForce.y, (kForce.z - 0.5 * kForce.x) / 2.0, m.x, m.y / 10.0, m.z}));
}

TEST(ForcePlates, OffsetsAndScalesAreOfEachChannel) {
  const glm::dvec3 m = 1000.0 * moment_about({});
  C3dInfo info = plate_info(2, {});
  put_parameter(info.groups, "ANALOG", {"GEN_SCALE", "", false, {}, C3dReals{0.5F}});
  const C3dReals scale{-1, -1, -2, 10, 10, 10};
  put_parameter(info.groups, "ANALOG", {"SCALE", "", false, {6}, scale});
  const C3dIntegers offset{2048, 2048, 0, 1, 1, -7};
  put_parameter(info.groups, "ANALOG", {"OFFSET", "", false, {6}, offset});
  std::vector<double> words{kForce.x, kForce.y, kForce.z, m.x, m.y, m.z};
  for (std::size_t i = 0; i < 6; ++i) {
    words[i] = words[i] / (0.5 * static_cast<double>(scale[i])) + offset[i];
  }
  expect_the_push(plates_of(info, words));
}

TEST(ForcePlates, ForcesOfTheBodyOnThePlateAreTurnedRound) {
  const glm::dvec3 m = -1000.0 * moment_about({});
  const ForcePlates plates =
      plates_of(plate_info(2, {}), {-kForce.x, -kForce.y, -kForce.z, m.x, m.y, m.z});
  expect_the_push(plates);
  ASSERT_EQ(plates.notes.size(), 1U);
  EXPECT_EQ(plates.notes[0], "plate 1: the forces point down; their sign was reversed");
}

TEST(ForcePlates, DetectMomentsInAnotherUnitThanTheFileStates) {
  const glm::dvec3 m = 1000.0 * moment_about({});
  C3dInfo info = plate_info(2, {});
  put_texts(info.groups, "ANALOG", "UNITS", {"N", "N", "N", "Nm", "Nm", "Nm"});
  const ForcePlates plates =
      plates_of(info, {kForce.x, kForce.y, kForce.z, m.x, m.y, m.z});
  expect_the_push(plates);
  ASSERT_EQ(plates.notes.size(), 1U);
  EXPECT_NE(plates.notes[0].find("the body would be next to"), std::string::npos);
}

TEST(ForcePlates, HaveNoCentreWithoutAPersonOnThem) {
  const ForcePlates plates =
      plates_of(plate_info(2, {}), {0.0, 0.0, -19.0, 900.0, 0.0, 0.0});
  ASSERT_EQ(plates.plates.size(), 1U);
  EXPECT_FALSE(plates.plates[0].samples[0].centre_in_world);
  EXPECT_NEAR(plates.plates[0].samples[0].force_in_world.y, 19.0, 1e-9);
}

TEST(ForcePlates, OmitUnreadablePlatesAndReportTheReason) {
  C3dInfo info = plate_info(2, {});
  put_parameter(info.groups, "FORCE_PLATFORM", {"TYPE", "", false, {1}, C3dIntegers{7}});
  EXPECT_EQ(plates_of(info, std::vector<double>(6)).notes[0],
            "plate 1 is left out: its type is 7, and 1 to 4 are read");
  info = plate_info(2, {});
  put_parameter(info.groups,
                "FORCE_PLATFORM",
                {"CHANNEL", "", false, {6, 1}, C3dIntegers{1, 2, 3, 4, 5, 7}});
  EXPECT_EQ(plates_of(info, std::vector<double>(6)).notes[0],
            "plate 1 is left out: FORCE_PLATFORM:CHANNEL names channels that do not "
            "exist");
  info = plate_info(2, {});
  put_parameter(info.groups,
                "FORCE_PLATFORM",
                {"CORNERS", "", false, {3, 4, 1}, C3dReals(12, 5.0F)});
  EXPECT_EQ(plates_of(info, std::vector<double>(6)).notes[0],
            "plate 1 is left out: FORCE_PLATFORM:CORNERS span no plate");
}

TEST(AnalogSignals, KeepLabelsUnitsAndTime) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kMips, C3dNumbers::kInteger);
  put_texts(info.groups, "ANALOG", "LABELS", {"EMG1"});
  put_texts(info.groups, "ANALOG", "UNITS", {"V", "mV"});
  put_parameter(info.groups, "ANALOG", {"SCALE", "", false, {2}, C3dReals{0.5F, 2.0F}});
  const std::vector<C3dFrame> frames = example_frames(info);
  write_frames(folder / "a.c3d", info, frames);
  const auto analog = read_analog(folder / "a.c3d");
  ASSERT_TRUE(analog) << analog.error().message();
  EXPECT_EQ(analog->rate.hz, 480.0);
  EXPECT_DOUBLE_EQ(analog->start_s, 6.0 / 120.0);
  ASSERT_EQ(analog->signals.size(), 2U);
  EXPECT_EQ(analog->signals[0].label, "EMG1");
  EXPECT_EQ(analog->signals[1].label, "");
  EXPECT_EQ(analog->signals[1].unit, "mV");
  ASSERT_EQ(analog->signals[1].samples.size(), 20U);
  EXPECT_EQ(analog->signals[1].samples[5],
            2.0 * static_cast<double>(frames[1].analog[3]));
}

struct RealPlate {
  const char* file;
  std::size_t plate;
  int type;
  double median_N;  ///< Median over samples above 100 N, from these files' readings; 1 %.
};

// The centre of pressure is within the plate and near the markers of the feet.
TEST(ForcePlateSamples, FeetPressOnPlatesNextToTheirMarkers) {
  const fs::path mocap = marey::testing::shared_data() / "mocap";
  if (!fs::exists(mocap)) GTEST_SKIP() << mocap << " is not there";
  // A foot on the edge of a plate bends it, which moves the centre slightly outside.
  constexpr double kEdge_m = 0.02;
  const std::vector<RealPlate> known{
      {"bmclab/Gait.c3d", 0, 4, 555},
      {"c3d_org_samples/sample_00/Codamotion/codamotion_gaitwands_19970212.c3d",
       0,
       3,
       498},
      {"c3d_org_samples/sample_00/Innovative Sports Training/Gait with EMG.c3d",
       1,
       4,
       522},
      {"c3d_org_samples/sample_00/Motion Analysis Corporation/Walk1.c3d", 0, 4, 765},
      {"c3d_org_samples/sample_01/Eb015vi.c3d", 1, 2, 696},
      {"c3d_org_samples/sample_03/gait-pig.c3d", 1, 2, 512},
      {"c3d_org_samples/sample_26/Walking_Hybrid_1_1.c3d", 1, 3, 724},
      {"ezc3d/Qualisys.c3d", 0, 2, 563},
      {"opensim-core/Tests/shared/walking2.c3d", 0, 2, 565}};
  for (const RealPlate& real : known) {
    SCOPED_TRACE(real.file);
    const auto markers = read_markers(mocap / real.file);
    ASSERT_TRUE(markers);
    const auto plates = read_force_plates(mocap / real.file, markers->axes);
    ASSERT_TRUE(plates);
    ASSERT_GT(plates->plates.size(), real.plate);
    const ForcePlate& plate = plates->plates[real.plate];
    EXPECT_EQ(plate.type, real.type);
    glm::dvec3 low = plate.corners_in_world[0];
    glm::dvec3 high = low;
    for (const glm::dvec3& corner : plate.corners_in_world) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    std::vector<double> loads;
    double distance_m = 0.0;
    for (std::size_t i = 0; i < plate.samples.size(); ++i) {
      const PlateSample& sample = plate.samples[i];
      if (sample.force_in_world.y < 100.0) continue;
      loads.push_back(sample.force_in_world.y);
      ASSERT_TRUE(sample.centre_in_world);
      const glm::dvec3 p = *sample.centre_in_world;
      EXPECT_TRUE(p.x > low.x - kEdge_m && p.x < high.x + kEdge_m &&
                  p.z > low.z - kEdge_m && p.z < high.z + kEdge_m)
          << i;
      const MarkerTracks& tracks = markers->tracks;
      const std::size_t frame = i * tracks.frames() / plate.samples.size();
      double nearest_m = 1.0;
      for (std::size_t m = 0; m < tracks.markers(); ++m) {
        const auto& marker = tracks.at(frame, m);
        if (!marker || marker->p_in_world.y > 0.3) continue;
        nearest_m =
            std::min(nearest_m,
                     std::hypot(marker->p_in_world.x - p.x, marker->p_in_world.z - p.z));
      }
      distance_m += nearest_m;
    }
    ASSERT_GT(loads.size(), 100U);
    std::sort(loads.begin(), loads.end());
    EXPECT_NEAR(loads[loads.size() / 2], real.median_N, 0.01 * real.median_N);
    // Half a foot's length at most.
    EXPECT_LT(distance_m / static_cast<double>(loads.size()), 0.1);
  }
}

}  // namespace
}  // namespace marey::recordings
