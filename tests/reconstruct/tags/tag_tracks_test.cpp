// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_tracks.h"

#include <algorithm>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Film;
using marey::testing::tagged_person;

struct TrackScene {
  Body body = tagged_person();
  std::vector<Camera> cameras = marey::testing::ring_of_cameras();
  marey::testing::Movement movement = marey::testing::walking(body);
  Film film{20, 30.0, "walk", {}, {}, {}};
  SolveMotionOptions options;

  [[nodiscard]] Result<SolvedTrial> solve() const {
    return solve_motion(
        body, cameras, marey::testing::film(body, movement, cameras, film), options);
  }
};

std::size_t tag_on(const Body& body, HumanBone segment) {
  const auto found =
      std::find_if(body.tags.begin(), body.tags.end(), [&](const PlacedTag& placed) {
        return placed.tag.segment == segment;
      });
  return static_cast<std::size_t>(found - body.tags.begin());
}

TEST(TagTracks, AreWhereTheCornersWere) {
  const TrackScene scene;
  const auto trial = scene.solve();
  ASSERT_TRUE(trial);
  const MarkerTracks tracks = tag_tracks(scene.body, *trial);
  ASSERT_EQ(tracks.markers(), 4 * scene.body.tags.size());
  ASSERT_EQ(tracks.frames(), 20U);
  EXPECT_EQ(tracks.rate.hz, 30.0);
  EXPECT_EQ(tracks.first_frame, 1);
  EXPECT_EQ(tracks.start_s, 0.0);
  const Skeleton skeleton = make_humanoid(scene.body.proportions);
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    const auto world =
        world_from_joints(skeleton, scene.movement(static_cast<double>(f) / 30.0));
    for (std::size_t t = 0; t < scene.body.tags.size(); ++t) {
      const PlacedTag& placed = scene.body.tags[t];
      for (int c = 0; c < 4; ++c) {
        const auto& sample = tracks.at(f, 4 * t + static_cast<std::size_t>(c));
        ASSERT_TRUE(sample);
        const glm::dvec3 truth = world[index(placed.tag.segment)] *
                                 placed.segment_from_tag *
                                 corner_in_tag(c, placed.tag.size_m);
        // Accuracy of the solver, which ends at a hundred-thousandth of the cost.
        EXPECT_LT(glm::distance(sample->p_in_world, truth), 0.001 /* m */)
            << tracks.labels[4 * t];
        EXPECT_GT(sample->sigma_m, 0.0F);
        EXPECT_LT(sample->sigma_m, 0.01F /* m */);
      }
    }
  }
}

TEST(TagTracks, AreNamedAfterSegmentTagAndCorner) {
  const TrackScene scene;
  const auto trial = scene.solve();
  ASSERT_TRUE(trial);
  const MarkerTracks tracks = tag_tracks(scene.body, *trial);
  const std::size_t foot = tag_on(scene.body, HumanBone::kLeftFoot);
  const std::string tag = std::to_string(number(scene.body.tags[foot].tag.id));
  EXPECT_EQ(tracks.labels[4 * foot], "leftFoot_tag" + tag + "_c0");
  EXPECT_EQ(tracks.labels[4 * foot + 3], "leftFoot_tag" + tag + "_c3");
  EXPECT_EQ(std::set<std::string>(tracks.labels.begin(), tracks.labels.end()).size(),
            tracks.markers());
}

TEST(TagTracks, ReportSeenAndBridgedFrames) {
  TrackScene scene;
  const std::size_t hidden = tag_on(scene.body, HumanBone::kLeftFoot);
  scene.film.hidden = [](const TagOnSegment& tag, int frame) {
    return tag.segment == HumanBone::kLeftFoot && frame >= 5 && frame < 10;
  };
  const auto trial = scene.solve();
  ASSERT_TRUE(trial);
  const MarkerTracks tracks = tag_tracks(scene.body, *trial);
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    const bool seen = f < 5 || f >= 10;
    const auto& sample = tracks.at(f, 4 * hidden);
    ASSERT_TRUE(sample) << f;
    EXPECT_EQ(sample->source, seen ? Source::kMeasured : Source::kRepaired) << f;
    EXPECT_EQ(sample->cameras != 0, seen) << f;
  }
  // A hidden foot has a larger sigma than a seen one.
  EXPECT_GT(tracks.at(7, 4 * hidden)->sigma_m, 3.0F * tracks.at(2, 4 * hidden)->sigma_m);
}

TEST(TagTracks, AreEmptyWhereTheSegmentIsOnlyInferred) {
  TrackScene scene;
  const std::size_t hidden = tag_on(scene.body, HumanBone::kLeftFoot);
  scene.film.hidden = [](const TagOnSegment& tag, int frame) {
    return tag.segment == HumanBone::kLeftFoot && frame < 8;
  };
  const auto trial = scene.solve();
  ASSERT_TRUE(trial);
  const MarkerTracks tracks = tag_tracks(scene.body, *trial);
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    EXPECT_EQ(tracks.at(f, 4 * hidden).has_value(), f >= 8) << f;
  }
}

TEST(TagTracks, AreEmptyForATagThatIsNeverSeen) {
  TrackScene scene;
  const std::size_t lost = tag_on(scene.body, HumanBone::kHips);
  const TagId id = scene.body.tags[lost].tag.id;
  scene.film.hidden = [id](const TagOnSegment& tag, int /*frame*/) {
    return tag.id == id;
  };
  const auto trial = scene.solve();
  ASSERT_TRUE(trial);
  const MarkerTracks tracks = tag_tracks(scene.body, *trial);
  for (std::size_t f = 0; f < tracks.frames(); ++f) {
    EXPECT_FALSE(tracks.at(f, 4 * lost)) << f;
  }
}

}  // namespace
}  // namespace marey::reconstruct
