// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/body/mannequin.h"

#include <map>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/recordings/wild_motion.h"

namespace marey::recordings {
namespace {

using B = HumanBone;

double top_of_head_m(const Proportions& p) {
  const Skeleton skeleton = make_humanoid(p);
  const auto joints = world_from_joints(skeleton, rest_pose(skeleton));
  return (joints[index(B::kHead)] * p.head_top_in_head).y;
}

/// Average, child, giant, and an asymmetric body.
std::vector<Proportions> bodies() {
  return {mannequin_proportions({}),
          mannequin_proportions({.stature_m = 1.1, .arm = 1.2, .head = 1.4}),
          mannequin_proportions({.stature_m = 2.6, .leg = 1.15, .shoulder_width = 1.3}),
          uneven(mannequin_proportions({}))};
}

TEST(MannequinProportions, HaveTheGivenStatureWithAnyRatios) {
  for (const double ratio : {0.7, 1.0, 1.3}) {
    const MannequinOptions options{
        .stature_m = 1.1, .arm = 1.2, .leg = ratio, .trunk = 2.0 - ratio, .head = ratio};
    EXPECT_NEAR(top_of_head_m(mannequin_proportions(options)), 1.1, 1e-12);
  }
}

TEST(MannequinProportions, AreTheAverageBodysWithoutRatios) {
  const Proportions p = mannequin_proportions({.stature_m = 1.75});
  const Proportions average = average_proportions(1.75);
  for (const B bone : human_bones()) {
    EXPECT_LT(glm::distance(p[bone], average[bone]), 1e-12) << name(bone);
  }
}

TEST(MannequinProportions, LengthenTheArmsAlone) {
  const Proportions p = mannequin_proportions({.arm = 1.2});
  const Proportions average = average_proportions(1.75);
  EXPECT_NEAR(p[B::kLeftLowerArm].x, 1.2 * average[B::kLeftLowerArm].x, 1e-12);
  EXPECT_NEAR(p.right_hand_tip_in_hand.x, 1.2 * average.right_hand_tip_in_hand.x, 1e-12);
  EXPECT_NEAR(p[B::kLeftFoot].y, average[B::kLeftFoot].y, 1e-12);
}

TEST(MannequinProportions, LengthenTheLegsAgainstTheTrunk) {
  const Proportions p = mannequin_proportions({.leg = 1.2});
  const Proportions average = average_proportions(1.75);
  EXPECT_NEAR((p[B::kLeftFoot].y / p[B::kChest].y) /
                  (average[B::kLeftFoot].y / average[B::kChest].y),
              1.2,
              1e-12);
}

TEST(MannequinMesh, StandsWithItsSolesOnTheFloor) {
  for (const Proportions& p : bodies()) {
    double lowest_m = 1.0;
    for (const glm::dvec3& v : make_mannequin_mesh(p).p_in_world) {
      lowest_m = std::min(lowest_m, v.y);
    }
    EXPECT_NEAR(lowest_m, 0.0, 1e-9);
  }
}

TEST(MannequinMesh, ReachesTheTopOfTheHead) {
  for (const Proportions& p : bodies()) {
    double highest_m = 0.0;
    for (const glm::dvec3& v : make_mannequin_mesh(p).p_in_world) {
      highest_m = std::max(highest_m, v.y);
    }
    // An uneven neck tilts the head's top off the highest vertex by its roundness.
    EXPECT_NEAR(highest_m, top_of_head_m(p), 0.002 * top_of_head_m(p));
  }
}

TEST(MannequinMesh, IsClosed) {
  for (const Proportions& p : bodies()) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const MeshPart& part : make_mannequin_mesh(p).parts) {
      const auto& t = part.triangles;
      for (std::size_t i = 0; i < t.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) ++edges[{t[i + k], t[i + (k + 1) % 3]}];
      }
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : edges) {
      const auto back = edges.find({edge.second, edge.first});
      if (count != 1 || back == edges.end()) ++open;
    }
    EXPECT_EQ(open, 0U);
  }
}

// Six times the signed volume is positive only when the triangles face outwards.
TEST(MannequinMesh, FacesOutwards) {
  for (const Proportions& p : bodies()) {
    const SkinnedMesh mesh = make_mannequin_mesh(p);
    for (const MeshPart& part : mesh.parts) {
      std::size_t against = 0;
      for (std::size_t i = 0; i < part.triangles.size(); i += 3) {
        const auto a = part.triangles[i];
        const auto b = part.triangles[i + 1];
        const auto c = part.triangles[i + 2];
        const glm::dvec3 face = glm::cross(mesh.p_in_world[b] - mesh.p_in_world[a],
                                           mesh.p_in_world[c] - mesh.p_in_world[a]);
        if (glm::dot(face, mesh.normal_in_world[a]) < 0.0) ++against;
      }
      EXPECT_EQ(against, 0U) << part.material.name;
    }
    double volume_m3 = 0.0;
    for (const MeshPart& part : mesh.parts) {
      for (std::size_t i = 0; i < part.triangles.size(); i += 3) {
        volume_m3 += glm::dot(mesh.p_in_world[part.triangles[i]],
                              glm::cross(mesh.p_in_world[part.triangles[i + 1]],
                                         mesh.p_in_world[part.triangles[i + 2]])) /
                     6.0;
      }
    }
    EXPECT_GT(volume_m3, 0.0);
  }
}

TEST(MannequinMesh, WeighsEveryVertexToOne) {
  for (const SkinWeights& skin : make_mannequin_mesh(mannequin_proportions({})).skin) {
    double sum = 0.0;
    for (const double weight : skin.weights) sum += weight;
    ASSERT_NEAR(sum, 1.0, 1e-12);
    ASSERT_GE(skin.weights[0], skin.weights[1]);
  }
}

TEST(MannequinMesh, HasFiveToFifteenThousandTriangles) {
  std::size_t corners = 0;
  for (const MeshPart& part : make_mannequin_mesh(mannequin_proportions({})).parts) {
    corners += part.triangles.size();
  }
  EXPECT_GT(corners / 3, 5000U);
  EXPECT_LE(corners / 3, 15000U);
}

TEST(MannequinMesh, MovesWithTheBodyAsAWhole) {
  const Proportions p = uneven(mannequin_proportions({}));
  const Skeleton skeleton = make_humanoid(p);
  const SkinnedMesh mesh = make_mannequin_mesh(p);
  Pose pose = rest_pose(skeleton);
  pose.root_in_world += glm::dvec3(1, 2, 3);
  const auto moved = posed_vertices(mesh, skeleton, pose);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    ASSERT_LT(glm::distance(moved[v], mesh.p_in_world[v] + glm::dvec3(1, 2, 3)), 1e-12);
  }
}

// Linear blending pulls a bent elbow's skin inwards; the ball in it must stay outside.
TEST(MannequinMesh, KeepsItsElbowRoundWhenBent) {
  const Proportions p = mannequin_proportions({});
  const Skeleton skeleton = make_humanoid(p);
  const SkinnedMesh mesh = make_mannequin_mesh(p);
  Pose pose = rest_pose(skeleton);
  pose.parent_from_joint[index(B::kLeftLowerArm)] = rotation_from_vector({0, -2.0, 0});
  const auto elbow = world_from_joints(skeleton, pose)[index(B::kLeftLowerArm)];
  const auto moved = posed_vertices(mesh, skeleton, pose);
  // The outside of the bend is away from both bones.
  const glm::dvec3 outside =
      glm::normalize(glm::dvec3(1, 0, 0) - elbow.rotation * glm::dvec3(1, 0, 0));
  double reach_m = 0.0;
  for (const glm::dvec3& v : moved) {
    const glm::dvec3 from_elbow = v - elbow.translation;
    const double along = glm::dot(from_elbow, outside);
    if (glm::length(from_elbow - along * outside) < 0.01) {
      reach_m = std::max(reach_m, along);
    }
  }
  EXPECT_GT(reach_m, 0.035);
}

TEST(MannequinMesh, IsTheSameAgain) {
  const Proportions p = uneven(mannequin_proportions({}));
  const SkinnedMesh one = make_mannequin_mesh(p);
  const SkinnedMesh other = make_mannequin_mesh(p);
  EXPECT_EQ(one.p_in_world, other.p_in_world);
}

}  // namespace
}  // namespace marey::recordings
