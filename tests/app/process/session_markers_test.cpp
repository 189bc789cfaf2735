// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Marker files that contain the tag corners of a session, read by other commands.
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/detection.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/session/subject_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kWalk = marey::testing::sample_results() / "once/walk";

// Tolerance of a corner. segments.csv has six decimals of place and rotation, a tag is
// within 0.3 m of its segment's origin, and a C3D has 32-bit reals.
constexpr double kRoundingM = 2e-6;

/// Returns the number of samples, after it compared each with the motion.
std::size_t compare_with_motion(const MarkerTracks& tracks) {
  const auto body = recordings::read_subject(kWalk / "../subject.toml");
  const auto segments = recordings::read_segments_csv(kWalk / "segments.csv");
  EXPECT_TRUE(body);
  EXPECT_TRUE(segments);
  if (!body || !segments) return 0;
  std::map<std::pair<int, std::string>, RigidTransform> world_from_segment;
  for (const auto& row : *segments) {
    world_from_segment[{row.frame, row.segment}] = row.world_from_segment;
  }
  EXPECT_EQ(tracks.markers(), 4 * body->tags.size());
  std::size_t samples = 0;
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    for (std::size_t m = 0; m < tracks.markers(); ++m) {
      const auto& sample = tracks.at(f, m);
      if (!sample) continue;
      ++samples;
      const PlacedTag& placed = body->tags[m / 4];
      const glm::dvec3 expected =
          world_from_segment.at(
              {static_cast<int>(f), std::string(name(placed.tag.segment))}) *
          placed.segment_from_tag *
          corner_in_tag(static_cast<int>(m % 4), placed.tag.size_m);
      EXPECT_LT(glm::distance(sample->p_in_world, expected), kRoundingM)
          << tracks.labels[m] << " in frame " << f;
    }
  }
  return samples;
}

TEST(SessionMarkers, InC3dMatchTheTagsOfTheMotion) {
  const auto read = recordings::read_markers(kWalk / "markers.c3d");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->tracks.frames(), 90U);
  EXPECT_EQ(read->tracks.rate.hz, 30.0);
  EXPECT_EQ(read->axes.up, recordings::FileAxis::kPlusZ);
  EXPECT_EQ(read->axes.unit, "mm");
  const std::size_t samples = compare_with_motion(read->tracks);
  // At least half of the 116 corners in 90 frames have a sample.
  EXPECT_GT(samples, 116U * 90U / 2U);
  std::size_t measured = 0;
  for (const auto& sample : read->tracks.samples) {
    if (!sample || sample->source != Source::kMeasured) continue;
    ++measured;
    EXPECT_GT(sample->sigma_m, 0.0F);
    EXPECT_LT(sample->sigma_m, 0.05F /* m */);
    EXPECT_NE(sample->cameras, 0);
  }
  EXPECT_GT(measured, samples / 4);
  EXPECT_LT(measured, samples);
}

TEST(SessionMarkers, InTrcMatchTheC3d) {
  const auto c3d = recordings::read_markers(kWalk / "markers.c3d");
  const auto trc = recordings::read_markers(kWalk / "markers.trc");
  ASSERT_TRUE(c3d) << c3d.error().message();
  ASSERT_TRUE(trc) << trc.error().message();
  EXPECT_EQ(trc->axes.up, recordings::FileAxis::kPlusY);
  EXPECT_EQ(trc->tracks.labels, c3d->tracks.labels);
  EXPECT_EQ(compare_with_motion(trc->tracks), compare_with_motion(c3d->tracks));
}

TEST(SessionMarkers, CanBeInspectedAndRepaired) {
  const ScratchFolder folder;
  for (const std::string file : {"markers.c3d", "markers.trc"}) {
    const ProgramRun inspect = run_program(
        marey::testing::program(), {"inspect", (kWalk / file).string(), "--json"});
    ASSERT_EQ(inspect.exit_code, 0) << inspect.err;
    const auto inspected = nlohmann::json::parse(inspect.out, nullptr, false);
    EXPECT_EQ(inspected.at("frames"), 90) << file;
    EXPECT_EQ(inspected.at("markers").size(), 116U) << file;
    const fs::path out = folder / file;
    const ProgramRun repair =
        run_program(marey::testing::program(),
                    {"repair", (kWalk / file).string(), "--out", out.string()});
    EXPECT_EQ(repair.exit_code, 0) << repair.err;
    EXPECT_TRUE(fs::exists(out)) << file;
  }
}

}  // namespace
}  // namespace marey::testing
