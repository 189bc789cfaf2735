// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/turned_limbs.h"

#include <map>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/skeleton.h"
#include "reconstruct/bundle/subject_solve.h"
#include "reconstruct/posture/initial_posture.h"
#include "tests/support/bodies/synthetic_person.h"

namespace marey::reconstruct {
namespace {

/// A bundle of a synthetic person at the truth: observations by four cameras of standing
/// and of moving every joint.
struct TrueBundle {
  Body truth = marey::testing::tagged_person();
  std::vector<Camera> cameras = marey::testing::ring_of_cameras();
  std::vector<TagOnSegment> tags = marey::testing::tags_of(truth);
  std::vector<CameraDetections> seen_standing;  ///< Sightings point into them.
  std::vector<CameraDetections> seen_moving;
  Sightings stood;
  Sightings moved;
  SubjectBundle bundle;

  TrueBundle() {
    marey::testing::Film film;
    film.frames = 10;
    film.trial = "static";
    film.disturbance.noise_px = 0.2;
    const auto standing = marey::testing::standing(truth);
    const auto moving = marey::testing::range_of_motion(truth);
    seen_standing = marey::testing::film(truth, standing, cameras, film);
    stood = group_sightings(seen_standing, tags);
    film.frames = 60;
    film.hz = 6.0;
    film.trial = "rom";
    seen_moving = marey::testing::film(truth, moving, cameras, film);
    moved = group_sightings(seen_moving, tags);
    bundle.model.lengths = lengths_of(truth.proportions);
    bundle.model.body = body_constants(truth);
    bundle.model.tags = tags;
    bundle.usual = lengths_of(average_proportions(truth.stature_m));
    for (std::size_t tag = 0; tag < truth.tags.size(); ++tag) {
      bundle.model.segment_from_tag[tag] = truth.tags[tag].segment_from_tag;
    }
    add(stood, standing, 30.0, true);
    add(moved, moving, 6.0, false);
  }

  /// Turns a limb as an initial estimate with the wrong sign of its hinge does, and
  /// refines the fit from there.
  void turn(std::size_t limb) {
    const HumanLimb& bones = human_limbs()[limb];
    const RigidTransform half{rotation_from_vector(glm::pi<double>() * limb_axis(limb)),
                              glm::dvec3(0.0)};
    for (BundleFrame& frame : bundle.frames) {
      FoundSegments found;
      for (const HumanBone bone : human_bones()) {
        found[index(bone)] =
            world_from_bone(bone, frame.posture, bundle.model.lengths, bundle.model.body);
      }
      for (const HumanBone bone : {bones.upper, bones.lower}) {
        found[index(bone)] = *found[index(bone)] * half;
      }
      frame.posture = posture_from_segments(
          found, bundle.model.lengths, bundle.model.body, frame.posture);
    }
    for (auto& [tag, place] : bundle.model.segment_from_tag) {
      const HumanBone bone = bundle.model.bone(tag);
      if (bone == bones.upper || bone == bones.lower) place = half * place;
    }
  }

  /// Returns the distance of the worst tag of the limb's two bones from its true place.
  /// [m]
  [[nodiscard]] double worst_place_m(std::size_t limb) const {
    const HumanLimb& bones = human_limbs()[limb];
    double worst = 0.0;
    for (const auto& [tag, place] : bundle.model.segment_from_tag) {
      const HumanBone bone = bundle.model.bone(tag);
      if (bone != bones.upper && bone != bones.lower) continue;
      worst = std::max(
          worst,
          glm::distance(place.translation, truth.tags[tag].segment_from_tag.translation));
    }
    return worst;
  }

 private:
  void add(const Sightings& trial,
           const marey::testing::Movement& movement,
           double hz,
           bool is_standing) {
    const Skeleton skeleton = make_humanoid(truth.proportions);
    for (std::size_t f = 0; f < trial.frames.size(); ++f) {
      const auto world =
          world_from_joints(skeleton, movement(static_cast<double>(f) / hz));
      FoundSegments found;
      for (const HumanBone bone : human_bones()) {
        found[index(bone)] = world[index(bone)];
      }
      BundleFrame frame;
      frame.sightings = trial.frames[f];
      frame.standing = is_standing;
      frame.posture = posture_from_segments(
          found, bundle.model.lengths, bundle.model.body, Posture{});
      bundle.frames.push_back(frame);
    }
  }
};

TEST(TurnedLimbs, LeaveARightBodyAlone) {
  TrueBundle person;
  ASSERT_TRUE(adjust(person.bundle, person.cameras, 10));
  EXPECT_TRUE(turn_limbs(person.cameras, person.bundle).empty());
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    EXPECT_LT(person.worst_place_m(limb), 0.005) << limb;
    const auto turn_rad = standing_turn_rad(limb, person.bundle);
    ASSERT_TRUE(turn_rad) << limb;
    EXPECT_LT(std::abs(*turn_rad), glm::radians(20.0)) << limb;
  }
}

class TurnedLimb : public ::testing::TestWithParam<std::size_t> {};

TEST_P(TurnedLimb, IsTurnedBack) {
  const std::size_t limb = GetParam();
  TrueBundle person;
  person.turn(limb);
  ASSERT_TRUE(adjust(person.bundle, person.cameras, 15, {limb}));
  ASSERT_GT(person.worst_place_m(limb), 0.05) << "the false minimum holds";
  const auto turn_rad = standing_turn_rad(limb, person.bundle);
  ASSERT_TRUE(turn_rad);
  EXPECT_GT(std::abs(*turn_rad), glm::radians(150.0));
  EXPECT_EQ(turn_limbs(person.cameras, person.bundle), std::vector{limb});
  ASSERT_TRUE(adjust(person.bundle, person.cameras, 15));
  EXPECT_LT(person.worst_place_m(limb), 0.005);
}

INSTANTIATE_TEST_SUITE_P(Limbs, TurnedLimb, ::testing::Range<std::size_t>(0, 4));

}  // namespace
}  // namespace marey::reconstruct
