// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/tag_clusters.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

using marey::testing::Film;
using marey::testing::ring_of_cameras;
using marey::testing::tagged_person;
using marey::testing::tags_of;

struct Scene {
  Body body = tagged_person();
  std::vector<Camera> cameras = ring_of_cameras();
  std::vector<TagOnSegment> tags = tags_of(body);
  std::vector<CameraDetections> detections;

  explicit Scene(const Film& how)
      : detections(marey::testing::film(
            body, marey::testing::range_of_motion(body), cameras, how)) {}

  [[nodiscard]] std::vector<TagCluster> clusters() const {
    const std::array<Sightings, 1> trials{group_sightings(detections, tags)};
    return cluster_tags(cameras, tags, trials);
  }

  /// Returns the true cluster_from_tag, relative to the tag that defines the frame.
  [[nodiscard]] RigidTransform truth(const TagCluster& cluster, std::size_t tag) const {
    const auto anchor = std::find_if(cluster.cluster_from_tag.begin(),
                                     cluster.cluster_from_tag.end(),
                                     [](const auto& t) {
                                       return t.second.translation == glm::dvec3(0.0) &&
                                              t.second.rotation.w == 1.0;
                                     });
    return inverse(body.tags[anchor->first].segment_from_tag) *
           body.tags[tag].segment_from_tag;
  }
};

/// Returns the largest errors of place and rotation of any tag in its cluster. [m], [rad]
std::pair<double, double> worst(const Scene& scene,
                                const std::vector<TagCluster>& clusters) {
  double place_m = 0.0;
  double turn_rad = 0.0;
  for (const TagCluster& cluster : clusters) {
    for (const auto& [tag, cluster_from_tag] : cluster.cluster_from_tag) {
      const RigidTransform truth = scene.truth(cluster, tag);
      place_m = std::max(place_m,
                         glm::distance(cluster_from_tag.translation, truth.translation));
      turn_rad =
          std::max(turn_rad,
                   glm::length(rotation_vector(glm::conjugate(cluster_from_tag.rotation) *
                                               truth.rotation)));
    }
  }
  return {place_m, turn_rad};
}

TEST(ClusterTags, PutsEveryTagInItsSegmentsCluster) {
  const Scene scene({60, 10.0, "rom", {}, {}, {}});
  std::size_t placed = 0;
  for (const TagCluster& cluster : scene.clusters()) {
    for (const auto& [tag, pose] : cluster.cluster_from_tag) {
      EXPECT_EQ(scene.tags[tag].segment, cluster.segment);
      ++placed;
    }
  }
  EXPECT_EQ(placed, scene.tags.size());
}

TEST(ClusterTags, RecoversExactPlaces) {
  const Scene scene({60, 10.0, "rom", {}, {}, {}});
  const auto [place_m, turn_rad] = worst(scene, scene.clusters());
  // All pairs of sightings agree to the last bits of the reprojection.
  EXPECT_LT(place_m, 1e-9);
  EXPECT_LT(turn_rad, 1e-9);
}

TEST(ClusterTags, IsAFairStartUnderNoise) {
  const Scene scene({60, 10.0, "rom", {0.2, {}, 0.0}, {}, {}});
  const auto [place_m, turn_rad] = worst(scene, scene.clusters());
  // The worst are two tags on opposite sides, each of which one camera sees in profile:
  // 0.2 px is 0.01 rad or more of such a tag's tilt and, over 0.2 m to the other, some
  // millimetres in every frame. The fit refines this.
  EXPECT_LT(place_m, 0.015);
  EXPECT_LT(turn_rad, 0.06);
}

TEST(ClusterTags, LeavesOutATagThatIsNeverSeenWithTheOthers) {
  // One of the two tags of the left shank is seen in the even frames only, the other one
  // in the odd ones.
  Film how{40, 10.0, "rom", {}, {}, {}};
  TagId first{0};
  for (const TagOnSegment& tag : tags_of(tagged_person())) {
    if (tag.segment == HumanBone::kLeftLowerLeg && first == TagId{0}) first = tag.id;
  }
  how.hidden = [first](const TagOnSegment& tag, int frame) {
    return tag.segment == HumanBone::kLeftLowerLeg &&
           (tag.id == first) != (frame % 2 == 0);
  };
  const Scene scene(how);
  for (const TagCluster& cluster : scene.clusters()) {
    if (cluster.segment == HumanBone::kLeftLowerLeg) {
      EXPECT_EQ(cluster.cluster_from_tag.size(), 1U);
    }
  }
}

TEST(LocateCluster, FindsAnExactClusterInEveryFrameThatShowsItTwice) {
  const Scene scene({20, 10.0, "rom", {}, {}, {}});
  const Sightings sightings = group_sightings(scene.detections, scene.tags);
  TagCluster hips{HumanBone::kHips, {}};
  for (std::size_t i = 0; i < scene.tags.size(); ++i) {
    if (scene.tags[i].segment == HumanBone::kHips) {
      hips.cluster_from_tag[i] = scene.body.tags[i].segment_from_tag;
    }
  }
  const auto movement = marey::testing::range_of_motion(scene.body);
  int found = 0;
  for (std::size_t f = 0; f < sightings.frames.size(); ++f) {
    const auto pose =
        locate_cluster(hips, scene.cameras, scene.tags, sightings.frames[f]);
    if (!pose) continue;
    ++found;
    const Pose truth = movement(static_cast<double>(f) / 10.0);
    EXPECT_LT(glm::distance(pose->translation, truth.root_in_world), 1e-5);
  }
  EXPECT_EQ(found, 20);
}

TEST(LocateCluster, DeclinesAFrameThatDoesNotShowIt) {
  const Scene scene({1, 10.0, "rom", {}, {}, {}});
  const TagCluster nowhere{HumanBone::kHips, {{0, {}}}};
  EXPECT_FALSE(locate_cluster(nowhere, scene.cameras, scene.tags, {}));
}

TEST(LocateCluster, DeclinesALoneTagThatCouldBeTiltedEitherWay) {
  // Four metres away, nearly from the front, a fifth of a pixel of noise.
  const Camera camera = marey::testing::webcam_at("far", {0, 1, 4}, {0, 1, 0});
  const RigidTransform world_from_tag{
      rotation_from_vector({0.0, 0.25, 0.0}) *
          rotation_from_vector({glm::radians(180.0), 0.0, 0.0}),
      {0.0, 1.0, 0.0}};
  const std::vector<TagOnSegment> tags{{TagId{1}, HumanBone::kHead, 0.075}};
  const TagCluster head{HumanBone::kHead, {{0, {}}}};
  marey::testing::Dice dice(8);
  int declined = 0;
  for (int run = 0; run < 20; ++run) {
    const auto exact = marey::testing::see_tag(camera, world_from_tag, TagId{1}, 0.075);
    ASSERT_TRUE(exact);
    const TagDetection tag = marey::testing::disturbed(*exact, {0.2, {}, 0.0}, dice);
    const std::array<TagSighting, 1> frame{TagSighting{CameraId{0}, 0, &tag}};
    declined += !locate_cluster(head, std::span(&camera, 1), tags, frame);
  }
  EXPECT_GT(declined, 10);
}

}  // namespace
}  // namespace marey::reconstruct
