// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Marker files of many vendors and programs, in ../shared/data/mocap. Counts, rates and
// numbers of samples in the table come from an independent reader written for this
// purpose.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <set>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/extension.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/marker_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;

const fs::path kMocap = marey::testing::shared_data() / "mocap";

/// Content of a file. The upward axis is known from its screen parameters, its plates and
/// its subject. It is unknown for ezc3d/Optotrak and exampleFormat, where the default
/// applies.
struct Sample {
  const char* file;
  std::size_t markers;
  std::size_t frames;
  double rate_hz;
  std::size_t seen;
  FileAxis up;
};

void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.file;
}

constexpr FileAxis kY = FileAxis::kPlusY;
constexpr FileAxis kZ = FileAxis::kPlusZ;

// clang-format off
constexpr std::array kSamples{
    Sample{"addbiomechanics/Expert2/run0350cms.trc", 53, 836, 250, 44308, kY},
    Sample{"addbiomechanics/Expert2/run0900cms.trc", 53, 323, 250, 17119, kY},
    Sample{"bmclab/Gait.c3d", 33, 487, 100, 6389, kZ},
    Sample{"bmclab/walk.trc", 28, 184, 150, 5152, kY},
    Sample{"bmclab/walk1.trc", 28, 364, 150, 10192, kY},
    Sample{"c3d_org_samples/sample_00/Codamotion/codamotion_gaitwands_19970212.c3d", 24, 512, 200, 12203, kZ},
    Sample{"c3d_org_samples/sample_00/Innovative Sports Training/Gait with EMG.c3d", 24, 134, 60, 3192, kZ},
    Sample{"c3d_org_samples/sample_00/Innovative Sports Training/Static Pose.c3d", 30, 120, 60, 3600, kZ},
    Sample{"c3d_org_samples/sample_00/Motion Analysis Corporation/Sample_Jump2.c3d", 51, 264, 120, 13464, kZ},
    Sample{"c3d_org_samples/sample_00/Motion Analysis Corporation/Walk1.c3d", 49, 151, 60, 6191, kZ},
    Sample{"c3d_org_samples/sample_00/NexGen Ergonomics/test1.c3d", 40, 721, 128, 28840, kY},
    Sample{"c3d_org_samples/sample_00/Vicon Motion Systems/pyCGM2 lower limb CGM24 Walking01.c3d", 108, 493, 100, 50286, kZ},
    Sample{"c3d_org_samples/sample_01/Eb015pi.c3d", 26, 450, 50, 11474, kZ},
    Sample{"c3d_org_samples/sample_01/Eb015pr.c3d", 26, 450, 50, 11474, kZ},
    Sample{"c3d_org_samples/sample_01/Eb015si.c3d", 26, 450, 50, 11474, kZ},
    Sample{"c3d_org_samples/sample_01/Eb015sr.c3d", 26, 450, 50, 11474, kZ},
    Sample{"c3d_org_samples/sample_01/Eb015vi.c3d", 26, 450, 50, 11474, kZ},
    Sample{"c3d_org_samples/sample_01/Eb015vr.c3d", 26, 450, 50, 11474, kZ},
    Sample{"c3d_org_samples/sample_03/gait-pig-nz.c3d", 51, 301, 120, 14749, kZ},
    Sample{"c3d_org_samples/sample_03/gait-pig.c3d", 49, 142, 50, 5850, kZ},
    Sample{"c3d_org_samples/sample_03/gait-raw.c3d", 27, 142, 50, 1745, kZ},
    Sample{"c3d_org_samples/sample_07/16bitanalog.c3d", 27, 237, 60, 0, kZ},
    Sample{"c3d_org_samples/sample_15/FP1.C3D", 8, 480, 60, 3840, kZ},
    Sample{"c3d_org_samples/sample_15/FP2.C3D", 8, 480, 60, 3840, kZ},
    Sample{"c3d_org_samples/sample_16/basketball.c3d", 22, 34, 25, 748, kZ},
    Sample{"c3d_org_samples/sample_16/giant.c3d", 29, 355, 50, 8489, kZ},
    Sample{"c3d_org_samples/sample_16/golf.c3d", 21, 137, 200, 2877, kZ},
    Sample{"c3d_org_samples/sample_18/bad_parameter_section.c3d", 45, 332, 120, 8896, kZ},
    Sample{"c3d_org_samples/sample_24/MotionMonitorC3D.c3d", 8, 840, 140, 6720, kY},
    Sample{"c3d_org_samples/sample_26/Capture0008_Standing.c3d", 18, 2400, 240, 43200, kZ},
    Sample{"c3d_org_samples/sample_26/Standing_Hybrid_2.c3d", 37, 1200, 240, 44366, kZ},
    Sample{"c3d_org_samples/sample_26/Walking_Hybrid_1_1.c3d", 25, 672, 240, 12898, kZ},
    Sample{"c3d_org_samples/sample_26/Walking_Hybrid_2.c3d", 73, 541, 240, 35926, kZ},
    Sample{"ezc3d/Optotrak.c3d", 54, 29, 30, 1507, kZ},
    Sample{"ezc3d/Qualisys.c3d", 55, 340, 200, 18700, kZ},
    Sample{"ezc3d/Vicon.c3d", 51, 580, 100, 29275, kZ},
    Sample{"gaps/WalkL.trc", 37, 4300, 100, 159100, kZ},
    Sample{"mocaprecovery/03_rolling.c3d", 68, 2305, 175, 120775, kZ},
    Sample{"mocaprecovery/135_02.c3d", 41, 5202, 120, 213282, kZ},
    Sample{"mocaprecovery/85_02.c3d", 41, 810, 120, 33210, kZ},
    Sample{"nimblephysics/c3d/cmu_02_05.c3d", 41, 1854, 120, 76011, kZ},
    Sample{"nimblephysics/osim/LaiArnoldSubject5/DJ1.trc", 51, 289, 100, 14739, kY},
    Sample{"nimblephysics/osim/LaiArnoldSubject5/DJ2.trc", 51, 268, 100, 13668, kY},
    Sample{"nimblephysics/osim/WeirdFormatTests/markers.trc", 61, 281, 100, 17070, kY},
    Sample{"nimblephysics/osim/WeirdFormatTests/markers_Squat2.trc", 61, 460, 100, 27922, kY},
    Sample{"nimblephysics/osim/WeirdFormatTests/markers_StairUp3.trc", 61, 440, 100, 26770, kY},
    Sample{"nimblephysics/osim/welk007/c3d_Trimmed_RHJC1.c3d", 48, 1224, 100, 58752, kZ},
    Sample{"nimblephysics/osim/welk007/c3d_Trimmed_static1.c3d", 54, 297, 100, 16038, kZ},
    Sample{"opensim-core/Applications/IK/tests/resources/abdbonepin.trc", 11, 1991, 100, 21901, kY},
    Sample{"opensim-core/Applications/IK/tests/resources/subject01_synthetic_marker_data.trc", 31, 73, 60, 2263, kY},
    Sample{"opensim-core/Applications/Scale/tests/resources/init100.trc", 22, 120, 120, 2640, kZ},
    Sample{"opensim-core/Applications/Scale/tests/resources/subject01_static.trc", 49, 300, 60, 14700, kY},
    Sample{"opensim-core/Common/Test/dataWithBlanksForMissingMarkers.trc", 40, 464, 250, 3555, kZ},
    Sample{"opensim-core/Common/Test/dataWithEformat.trc", 14, 5, 119.88012, 70, kY},
    Sample{"opensim-core/Common/Test/dataWithNaNsOfDifferentCases.trc", 14, 5, 250, 65, kY},
    Sample{"opensim-core/Common/Test/dataWithNaNsWithSpaces.trc", 42, 427, 100, 17912, kY},
    Sample{"opensim-core/Common/Test/exampleFormat.trc", 3, 5, 100, 13, kY},
    Sample{"opensim-core/Common/Test/std_walking2_markers.trc", 44, 126, 25, 2735, kZ},
    Sample{"opensim-core/Common/Test/std_walking5_markers.trc", 40, 112, 25, 2403, kZ},
    Sample{"opensim-core/Tests/shared/gait10dof18musc_walk_CRLF_line_ending.trc", 41, 10, 60, 410, kY},
    Sample{"opensim-core/Tests/shared/walking2.c3d", 44, 1249, 250, 27389, kZ},
    Sample{"opensim-core/Tests/shared/walking5.c3d", 40, 1103, 250, 24038, kZ},
    Sample{"opensim-models/Hamner/subject02_running.trc", 41, 600, 60, 24000, kY},
    Sample{"opensim-models/Hamner/subject02_static.trc", 49, 300, 60, 14700, kY},
    Sample{"opensim-models/Rajagopal/ExpData/motion_capture_run.trc", 42, 510, 100, 21420, kY},
    Sample{"opensim-models/Rajagopal/ExpData/motion_capture_walk.trc", 41, 238, 100, 9758, kY},
    Sample{"opensim-models/Rajagopal/ExpData/static_run.trc", 64, 397, 100, 25408, kY},
    Sample{"opensim-models/Rajagopal/ExpData/static_walk_1.trc", 64, 287, 100, 18368, kY},
    Sample{"opensim-models/Rajagopal/ExpData/static_walk_2.trc", 41, 153, 100, 6273, kY},
};
// clang-format on

class MarkerSamples : public ::testing::TestWithParam<Sample> {};

TEST_P(MarkerSamples, AreRead) {
  const fs::path path = kMocap / GetParam().file;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto read = read_markers(path);
  ASSERT_TRUE(read) << read.error().message();
  const MarkerTracks& tracks = read->tracks;
  EXPECT_EQ(tracks.markers(), GetParam().markers);
  EXPECT_EQ(tracks.frames(), GetParam().frames);
  EXPECT_NEAR(tracks.rate.hz, GetParam().rate_hz, 1e-4);
  EXPECT_EQ(read->axes.up, GetParam().up) << name(read->axes.up);
  const auto seen = std::count_if(tracks.samples.begin(),
                                  tracks.samples.end(),
                                  [](const auto& sample) { return sample.has_value(); });
  EXPECT_EQ(static_cast<std::size_t>(seen), GetParam().seen);
}

INSTANTIATE_TEST_SUITE_P(Mocap, MarkerSamples, ::testing::ValuesIn(kSamples));

TEST(MarkerSampleFolders, HoldNoFileThatTheTableDoesNotKnow) {
  if (!fs::exists(kMocap)) GTEST_SKIP() << kMocap << " is not there";
  std::set<fs::path> known;
  for (const Sample& sample : kSamples) known.insert(sample.file);
  for (const char* folder : {"c3d_org_samples",
                             "ezc3d",
                             "bmclab",
                             "opensim-core",
                             "mocaprecovery",
                             "gaps",
                             "nimblephysics"}) {
    if (!fs::exists(kMocap / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(kMocap / folder)) {
      const std::string kind = kind_by_extension(entry.path());
      if (kind != ".c3d" && kind != ".trc") continue;
      const fs::path file = fs::relative(entry.path(), kMocap);
      EXPECT_TRUE(known.contains(file)) << file;
    }
  }
}

// One recording of 1989, written for three machines in integers and reals.
TEST(MarkerSampleSextet, AgreesWithinTheIntegersStep) {
  const fs::path folder = kMocap / "c3d_org_samples/sample_01";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto first = read_markers(folder / "Eb015pr.c3d");
  ASSERT_TRUE(first) << first.error().message();
  for (const char* other :
       {"Eb015pi.c3d", "Eb015si.c3d", "Eb015sr.c3d", "Eb015vi.c3d", "Eb015vr.c3d"}) {
    const auto read = read_markers(folder / other);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->tracks.labels, first->tracks.labels);
    ASSERT_EQ(read->tracks.samples.size(), first->tracks.samples.size());
    double largest_m = 0.0;
    for (std::size_t i = 0; i < first->tracks.samples.size(); ++i) {
      const auto& a = first->tracks.samples[i];
      const auto& b = read->tracks.samples[i];
      ASSERT_EQ(a.has_value(), b.has_value()) << other << " " << i;
      if (!a) continue;
      largest_m = std::max(largest_m, glm::distance(a->p_in_world, b->p_in_world));
      EXPECT_EQ(a->cameras, b->cameras);
      EXPECT_EQ(a->sigma_m, b->sigma_m);
      EXPECT_EQ(a->source, b->source);
    }
    // Reals converted from integers of 1/12 mm: equal to a 32-bit real's step.
    EXPECT_LT(largest_m, 1e-6) << other;
    EXPECT_EQ(read->events.size(), 3U);
  }
}

TEST(MarkerSampleOptotrak, ReadsWholeFramesAndReportsTheTruncation) {
  const fs::path path = kMocap / "ezc3d/Optotrak.c3d";
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto reader = C3dReader::open(path);
  ASSERT_TRUE(reader) << reader.error().message();
  EXPECT_EQ(reader->info().frames, 29);
  ASSERT_FALSE(reader->info().notes.empty());
  EXPECT_EQ(reader->info().notes[0],
            "the file ends early: of 1149 frames 29 are whole, up to byte 28640");
}

// The C3D of a walk and OpenSim's TRC of every tenth frame of it, which has five digits.
TEST(MarkerSampleTwins, AC3dAndItsTrcHoldTheSameMarkers) {
  const fs::path core = kMocap / "opensim-core";
  for (const std::string walk : {"walking2", "walking5"}) {
    const fs::path c3d_path = core / "Tests/shared" / (walk + ".c3d");
    if (!fs::exists(c3d_path)) GTEST_SKIP() << c3d_path << " is not there";
    const auto c3d = read_markers(c3d_path);
    const auto trc =
        read_markers(core / "Common/Test" / ("std_" + walk + "_markers.trc"));
    ASSERT_TRUE(c3d && trc);
    ASSERT_EQ(trc->tracks.labels, c3d->tracks.labels);
    double largest_m = 0.0;
    std::size_t compared = 0;
    // The last row is not at the step of the others.
    for (std::size_t f = 0; f + 1 < trc->tracks.frames(); ++f) {
      for (std::size_t m = 0; m < trc->tracks.markers(); ++m) {
        const auto& a = trc->tracks.at(f, m);
        const auto& b = c3d->tracks.at(10 * f, m);
        ASSERT_EQ(a.has_value(), b.has_value()) << f << " " << m;
        if (!a) continue;
        largest_m = std::max(largest_m, glm::distance(a->p_in_world, b->p_in_world));
        ++compared;
      }
    }
    EXPECT_GT(compared, 2000U);
    // Five digits of 4 m are 0.1 mm.
    EXPECT_LT(largest_m, 1.2e-4) << walk;
  }
}

// Every kind of file is read, written and read again.
TEST_P(MarkerSamples, AreKeptByWriting) {
  const fs::path path = kMocap / GetParam().file;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto read = read_markers(path);
  ASSERT_TRUE(read);
  const testing::ScratchFolder folder;
  const MarkerReadOptions same{.up = read->axes.up, .unit = read->axes.unit};
  for (const char* name : {"marey_again.c3d", "marey_again.trc"}) {
    const Status written = write_markers(folder / name, *read);
    ASSERT_TRUE(written) << written.error().message();
    const auto again = read_markers(folder / name, same);
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_EQ(again->tracks.labels, read->tracks.labels);
    ASSERT_EQ(again->tracks.samples.size(), read->tracks.samples.size());
    double largest_m = 0.0;
    for (std::size_t i = 0; i < read->tracks.samples.size(); ++i) {
      const auto& a = read->tracks.samples[i];
      const auto& b = again->tracks.samples[i];
      ASSERT_EQ(a.has_value(), b.has_value()) << i;
      if (a) largest_m = std::max(largest_m, glm::distance(a->p_in_world, b->p_in_world));
    }
    // 32-bit reals of up to 8 m in a C3D; a TRC's digits are exact.
    const bool from_text = kind_by_extension(path) == ".trc";
    const bool to_text = kind_by_extension(name) == ".trc";
    EXPECT_LE(largest_m, to_text ? (from_text ? 0.0 : 1e-14) : 1e-6) << name;
  }
}

}  // namespace
}  // namespace marey::recordings
