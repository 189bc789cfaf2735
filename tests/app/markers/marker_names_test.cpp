// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The landmarks that reconstruct derives from labels, and their places, in files that
// recordings reads:
// ../shared/data/mocap.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "reconstruct/labels/name_markers.h"
#include "recordings/markers/marker_file.h"
#include "tests/support/program/paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

const fs::path kMocapFolder = marey::testing::shared_data() / "mocap";

/// The number of a file's markers that have a name, and the set of these names. Markers
/// without a name are computed points, wands, devices, doubles, or points whose label has
/// no meaning.
struct Sample {
  const char* file;
  const char* set;
  int named;
  int markers;
};

void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.file;
}

// clang-format off
constexpr std::array kSamples{
    Sample{"addbiomechanics/Expert2/run0350cms.trc", "running with clusters", 51, 53},
    Sample{"addbiomechanics/Expert2/run0900cms.trc", "running with clusters", 51, 53},
    Sample{"bmclab/Gait.c3d", "Helen Hayes", 33, 33},
    Sample{"bmclab/walk.trc", "BMC lab", 28, 28},
    Sample{"bmclab/walk1.trc", "BMC lab", 28, 28},
    Sample{"c3d_org_samples/sample_00/Codamotion/codamotion_gaitwands_19970212.c3d", "Codamotion gait", 22, 24},
    Sample{"c3d_org_samples/sample_00/Innovative Sports Training/Gait with EMG.c3d", "The MotionMonitor", 24, 24},
    Sample{"c3d_org_samples/sample_00/Innovative Sports Training/Static Pose.c3d", "The MotionMonitor", 30, 30},
    Sample{"c3d_org_samples/sample_00/Motion Analysis Corporation/Sample_Jump2.c3d", "Helen Hayes", 29, 51},
    Sample{"c3d_org_samples/sample_00/Motion Analysis Corporation/Walk1.c3d", "Helen Hayes", 29, 49},
    Sample{"c3d_org_samples/sample_00/NexGen Ergonomics/test1.c3d", "Plug-in Gait", 40, 40},
    Sample{"c3d_org_samples/sample_00/Vicon Motion Systems/pyCGM2 lower limb CGM24 Walking01.c3d", "Plug-in Gait", 28, 108},
    Sample{"c3d_org_samples/sample_01/Eb015pi.c3d", "clusters", 26, 26},
    Sample{"c3d_org_samples/sample_01/Eb015pr.c3d", "clusters", 26, 26},
    Sample{"c3d_org_samples/sample_01/Eb015si.c3d", "clusters", 26, 26},
    Sample{"c3d_org_samples/sample_01/Eb015sr.c3d", "clusters", 26, 26},
    Sample{"c3d_org_samples/sample_01/Eb015vi.c3d", "clusters", 26, 26},
    Sample{"c3d_org_samples/sample_01/Eb015vr.c3d", "clusters", 26, 26},
    Sample{"c3d_org_samples/sample_03/gait-pig-nz.c3d", "Plug-in Gait", 13, 51},
    Sample{"c3d_org_samples/sample_03/gait-pig.c3d", "Plug-in Gait", 13, 49},
    Sample{"c3d_org_samples/sample_03/gait-raw.c3d", "Plug-in Gait", 23, 27},
    Sample{"c3d_org_samples/sample_07/16bitanalog.c3d", "Plug-in Gait", 15, 27},
    Sample{"c3d_org_samples/sample_15/FP1.C3D", "", 0, 8},
    Sample{"c3d_org_samples/sample_15/FP2.C3D", "", 0, 8},
    Sample{"c3d_org_samples/sample_16/basketball.c3d", "", 0, 22},
    Sample{"c3d_org_samples/sample_16/giant.c3d", "", 0, 29},
    Sample{"c3d_org_samples/sample_16/golf.c3d", "", 0, 21},
    Sample{"c3d_org_samples/sample_18/bad_parameter_section.c3d", "", 0, 45},
    Sample{"c3d_org_samples/sample_24/MotionMonitorC3D.c3d", "", 0, 8},
    Sample{"c3d_org_samples/sample_26/Capture0008_Standing.c3d", "", 18, 18},
    Sample{"c3d_org_samples/sample_26/Standing_Hybrid_2.c3d", "", 37, 37},
    Sample{"c3d_org_samples/sample_26/Walking_Hybrid_1_1.c3d", "", 25, 25},
    Sample{"c3d_org_samples/sample_26/Walking_Hybrid_2.c3d", "", 25, 73},
    Sample{"ezc3d/Optotrak.c3d", "", 0, 54},
    Sample{"ezc3d/Qualisys.c3d", "anatomical (van Sint Jan)", 47, 55},
    Sample{"ezc3d/Vicon.c3d", "", 7, 51},
    Sample{"gaps/WalkL.trc", "", 0, 37},
    Sample{"mocaprecovery/03_rolling.c3d", "anatomical (van Sint Jan)", 68, 68},
    Sample{"mocaprecovery/135_02.c3d", "CMU", 41, 41},
    Sample{"mocaprecovery/85_02.c3d", "CMU", 41, 41},
    Sample{"nimblephysics/c3d/cmu_02_05.c3d", "CMU", 41, 41},
    Sample{"nimblephysics/osim/LaiArnoldSubject5/DJ1.trc", "Lai-Arnold (OpenSim)", 47, 51},
    Sample{"nimblephysics/osim/LaiArnoldSubject5/DJ2.trc", "Lai-Arnold (OpenSim)", 47, 51},
    Sample{"nimblephysics/osim/WeirdFormatTests/markers.trc", "Plug-in Gait", 61, 61},
    Sample{"nimblephysics/osim/WeirdFormatTests/markers_Squat2.trc", "Plug-in Gait", 61, 61},
    Sample{"nimblephysics/osim/WeirdFormatTests/markers_StairUp3.trc", "Plug-in Gait", 61, 61},
    Sample{"nimblephysics/osim/welk007/c3d_Trimmed_RHJC1.c3d", "Lai-Arnold (OpenSim)", 48, 48},
    Sample{"nimblephysics/osim/welk007/c3d_Trimmed_static1.c3d", "Lai-Arnold (OpenSim)", 54, 54},
    Sample{"opensim-core/Applications/IK/tests/resources/abdbonepin.trc", "", 1, 11},
    Sample{"opensim-core/Applications/IK/tests/resources/subject01_synthetic_marker_data.trc", "gait2354 (OpenSim)", 31, 31},
    Sample{"opensim-core/Applications/Scale/tests/resources/init100.trc", "Helen Hayes", 22, 22},
    Sample{"opensim-core/Applications/Scale/tests/resources/subject01_static.trc", "gait2354 (OpenSim)", 49, 49},
    Sample{"opensim-core/Common/Test/dataWithBlanksForMissingMarkers.trc", "Rajagopal running (OpenSim)", 34, 40},
    Sample{"opensim-core/Common/Test/dataWithEformat.trc", "Rajagopal running (OpenSim)", 14, 14},
    Sample{"opensim-core/Common/Test/dataWithNaNsOfDifferentCases.trc", "", 4, 14},
    Sample{"opensim-core/Common/Test/dataWithNaNsWithSpaces.trc", "Rajagopal running (OpenSim)", 42, 42},
    Sample{"opensim-core/Common/Test/exampleFormat.trc", "", 0, 3},
    Sample{"opensim-core/Common/Test/std_walking2_markers.trc", "Rajagopal running (OpenSim)", 38, 44},
    Sample{"opensim-core/Common/Test/std_walking5_markers.trc", "Rajagopal running (OpenSim)", 34, 40},
    Sample{"opensim-core/Tests/shared/gait10dof18musc_walk_CRLF_line_ending.trc", "gait2354 (OpenSim)", 41, 41},
    Sample{"opensim-core/Tests/shared/walking2.c3d", "Rajagopal running (OpenSim)", 38, 44},
    Sample{"opensim-core/Tests/shared/walking5.c3d", "Rajagopal running (OpenSim)", 34, 40},
    Sample{"opensim-models/Hamner/subject02_running.trc", "gait2354 (OpenSim)", 41, 41},
    Sample{"opensim-models/Hamner/subject02_static.trc", "gait2354 (OpenSim)", 49, 49},
    Sample{"opensim-models/Rajagopal/ExpData/motion_capture_run.trc", "Rajagopal running (OpenSim)", 42, 42},
    Sample{"opensim-models/Rajagopal/ExpData/motion_capture_walk.trc", "Rajagopal walking (OpenSim)", 41, 41},
    Sample{"opensim-models/Rajagopal/ExpData/static_run.trc", "Rajagopal running (OpenSim)", 54, 64},
    Sample{"opensim-models/Rajagopal/ExpData/static_walk_1.trc", "Rajagopal walking (OpenSim)", 47, 64},
    Sample{"opensim-models/Rajagopal/ExpData/static_walk_2.trc", "Rajagopal walking (OpenSim)", 41, 41},
};
// clang-format on

class MarkerNameSamples : public ::testing::TestWithParam<Sample> {};

TEST_P(MarkerNameSamples, AreNamedAsFarAsTheyAreOnTheBody) {
  const fs::path path = kMocapFolder / GetParam().file;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto read = recordings::read_markers(path);
  ASSERT_TRUE(read) << read.error().message();
  const auto names = reconstruct::name_markers(read->tracks.labels);
  EXPECT_EQ(names.set, GetParam().set);
  EXPECT_EQ(read->tracks.markers(), static_cast<std::size_t>(GetParam().markers));
  const auto unnamed =
      std::count(names.landmarks.begin(), names.landmarks.end(), nullptr);
  EXPECT_EQ(GetParam().markers - static_cast<int>(unnamed), GetParam().named);
}

INSTANTIATE_TEST_SUITE_P(Mocap, MarkerNameSamples, ::testing::ValuesIn(kSamples));

/// A person who stands or walks. The stature is from the file's companions if they have
/// it. Otherwise it is the stature that fits the distances best.
struct Person {
  const char* file;
  double stature_m;
};

void PrintTo(const Person& person, std::ostream* out) {
  *out << person.file;
}

constexpr std::array kPeople{
    Person{"opensim-models/Hamner/subject02_static.trc", 1.83},
    Person{"opensim-core/Applications/Scale/tests/resources/subject01_static.trc", 1.80},
    Person{"opensim-models/Rajagopal/ExpData/static_run.trc", 1.80},
    Person{"opensim-models/Rajagopal/ExpData/static_walk_1.trc", 1.83},
    Person{"nimblephysics/osim/LaiArnoldSubject5/DJ1.trc", 1.85},
    Person{"nimblephysics/osim/welk007/c3d_Trimmed_static1.c3d", 1.73},
    Person{"nimblephysics/osim/WeirdFormatTests/markers_Squat2.trc", 1.72},
    Person{"nimblephysics/c3d/cmu_02_05.c3d", 1.74},
    Person{"opensim-core/Tests/shared/walking2.c3d", 1.75},
    Person{"addbiomechanics/Expert2/run0350cms.trc", 1.81},
    Person{"bmclab/Gait.c3d", 1.74},
    Person{"c3d_org_samples/sample_26/Standing_Hybrid_2.c3d", 1.67},
};

class LandmarksOnPeople : public ::testing::TestWithParam<Person> {};

// Compares the distance of two palpated landmarks of one segment with its expectation.
// The tolerance is three sigmas. There are some 300 pairs.
TEST_P(LandmarksOnPeople, AreSpacedWithinTheirUncertainty) {
  const fs::path path = kMocapFolder / GetParam().file;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto read = recordings::read_markers(path);
  ASSERT_TRUE(read) << read.error().message();
  const MarkerTracks& tracks = read->tracks;
  const auto names = reconstruct::name_markers(tracks.labels);
  int pairs = 0;
  for (std::size_t i = 0; i < tracks.markers(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const reconstruct::Landmark* a = names.landmarks[i];
      const reconstruct::Landmark* b = names.landmarks[j];
      if (a == nullptr || b == nullptr || a->segment != b->segment) continue;
      if (std::max(a->sigma_per_stature, b->sigma_per_stature) >= 0.02) continue;
      std::vector<double> seen_m;
      for (std::size_t f = 0; f < tracks.frames(); ++f) {
        const auto& p = tracks.at(f, i);
        const auto& q = tracks.at(f, j);
        if (p && q) seen_m.push_back(glm::distance(p->p_in_world, q->p_in_world));
      }
      if (seen_m.empty()) continue;
      const auto middle = seen_m.begin() + static_cast<std::ptrdiff_t>(seen_m.size() / 2);
      std::nth_element(seen_m.begin(), middle, seen_m.end());
      const double expected =
          glm::distance(a->p_in_segment_per_stature, b->p_in_segment_per_stature);
      const double sigma = std::hypot(a->sigma_per_stature, b->sigma_per_stature);
      EXPECT_NEAR(*middle / GetParam().stature_m, expected, 3.0 * sigma)
          << a->name << " and " << b->name;
      ++pairs;
    }
  }
  EXPECT_GE(pairs, 10);
}

INSTANTIATE_TEST_SUITE_P(Mocap, LandmarksOnPeople, ::testing::ValuesIn(kPeople));

}  // namespace
}  // namespace marey::app
