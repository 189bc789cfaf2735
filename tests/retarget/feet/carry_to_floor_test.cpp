// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A planted walk moved to other floors: feet on them, the pelvis ahead of the feet.
#include "retarget/feet/carry_to_floor.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/plan_supports.h"
#include "retarget/adapt/support_slide.h"
#include "retarget/character/make_character.h"
#include "retarget/feet/floor_at.h"
#include "retarget/feet/plan_feet.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr int kFrames = 200;
constexpr double kRate_hz = 60.0;
// Tolerance for a standing foot. Single precision over some metres leaves 1e-5 m.
constexpr double kFirm_m = 1e-4;

// A walk of 3 m towards +Z, 1 m per stride, and its result on a floor.
struct Scene {
  testing::SyntheticWalk walk = testing::synthetic_walk(kFrames, kRate_hz);
  BodyMap map = mapped(walk.motion.skeleton);
  Contacts contacts;
  Motion planted;
  Character character;

  Scene() {
    auto retargeted = *retarget_motion(walk.motion, walk.motion.skeleton);
    contacts = retargeted.report.contacts;
    planted = std::move(retargeted.motion);
    character = *make_character("walker", walk.motion.skeleton, map, {});
  }
  struct Adapted {
    Motion reference;
    std::vector<SupportTrack> tracks;
    AdaptedMotion adapted;
    GroundReport ground;
  };
  [[nodiscard]] Adapted on(const Floor& floor) const {
    CarriedMotion carried = carry_to_floor(planted, map, contacts, floor);
    PlanSupportsOptions options;
    options.floor = &floor;
    Adapted out{std::move(carried.motion),
                plan_supports(planted, map, contacts, options),
                {},
                carried.ground};
    out.adapted = *adapt_motion(out.reference, character, {}, out.tracks);
    return out;
  }
  [[nodiscard]] glm::dvec3 place(const Motion& motion, int t, B bone) const {
    return world(motion, t)[index(*motion.skeleton.find(bone))].translation;
  }
  [[nodiscard]] std::vector<RigidTransform> world(const Motion& motion, int t) const {
    return world_from_joints(motion.skeleton, motion.poses[static_cast<std::size_t>(t)]);
  }
};

double max_pelvis_acceleration(const Scene& scene, const Motion& motion) {
  double greatest = 0.0;
  for (int t = 1; t + 1 < kFrames; ++t) {
    const glm::dvec3 bend = scene.place(motion, t - 1, B::kHips) -
                            2.0 * scene.place(motion, t, B::kHips) +
                            scene.place(motion, t + 1, B::kHips);
    greatest = std::max(greatest, glm::length(bend) * kRate_hz * kRate_hz);
  }
  return greatest;
}

// The ankle of a flat foot is as high above its part as it is above a level floor.
void expect_on_floor(const Scene& scene, const Floor& floor, const Scene::Adapted& on) {
  int looked_at = 0;
  for (const SupportTrack& track : on.tracks) {
    if (track.constraint.id.find("flat") == std::string::npos ||
        std::get<Support>(track.constraint.goal).turns) {
      continue;
    }
    const bool left = track.constraint.point.segment == "leftFoot";
    const double rest_m = scene.map.feet[left ? 0 : 1].ankle_height_m;
    for (const FloorStance& stance : track.stands) {
      for (int t = stance.frames.first; t <= stance.frames.last; ++t) {
        const glm::dvec3 ankle =
            scene.place(on.adapted.motion, t, left ? B::kLeftFoot : B::kRightFoot);
        const FloorSpot spot =
            plane_at(floor, stance.part, {ankle.x, ankle.z}, t / kRate_hz);
        const double above_m = (ankle.y - spot.height_m) * spot.normal_in_world.y;
        EXPECT_NEAR(above_m, rest_m, kFirm_m) << track.constraint.id << " at " << t;
        ++looked_at;
      }
    }
  }
  EXPECT_GT(looked_at, kFrames / 2);
}

void expect_no_slide(const Scene& scene, const Floor& floor, const Scene::Adapted& on) {
  for (const SupportTrack& track : on.tracks) {
    for (const SupportSlide& slide :
         slides_of(track, on.adapted.motion, scene.character, floor)) {
      EXPECT_LT(slide.slide_m, kFirm_m)
          << track.constraint.id << " from " << slide.stance.frames.first;
    }
  }
}

TEST(CarryToFloor, ALevelFloorAtZeroChangesNothing) {
  const Scene scene;
  Floor level;
  level.parts.push_back({"carpet", {-1, 0.7}, {1, 1.5}, 0.0, {0, 0}, {{0.0, {}}}});
  const auto on = carry_to_floor(scene.planted, scene.map, scene.contacts, level);
  PlanSupportsOptions options;
  options.floor = &level;
  const auto with = plan_supports(scene.planted, scene.map, scene.contacts, options);
  const auto without = plan_supports(scene.planted, scene.map, scene.contacts);
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].constraint.id, without[i].constraint.id);
    EXPECT_EQ(with[i].p_in_world, without[i].p_in_world);
    EXPECT_EQ(with[i].world_from_t_pose, without[i].world_from_t_pose);
  }
  for (std::size_t t = 0; t < kFrames; ++t) {
    EXPECT_EQ(on.motion.poses[t].root_in_world, scene.planted.poses[t].root_in_world);
    EXPECT_EQ(on.motion.poses[t].parent_from_joint,
              scene.planted.poses[t].parent_from_joint);
  }
}

// Figure 4.18: up a step of 15 cm, 1.4 m ahead.
TEST(CarryToFloor, ThePelvisAnticipatesAStep) {
  const Scene scene;
  Floor floor;
  floor.parts.push_back({"step", {-1, 1.35}, {1, 9}, 0.15, {0, 0}, {}});
  const auto on = scene.on(floor);
  EXPECT_EQ(on.ground.unreachable_frames, 0);
  expect_on_floor(scene, floor, on);
  expect_no_slide(scene, floor, on);
  // The actual landing: contacts are found a few frames around it.
  int lands = kFrames;
  for (const SupportTrack& track : on.tracks) {
    const bool is_left = track.constraint.point.segment == "leftFoot";
    const auto& truth = scene.walk.feet[is_left ? 0 : 1];
    for (const FloorStance& stance : track.stands) {
      if (!stance.part) continue;
      auto t = static_cast<std::size_t>(stance.frames.first);
      while (truth.heel[t] == 0 && truth.ball[t] == 0) ++t;
      lands = std::min(lands, static_cast<int>(t));
    }
  }
  ASSERT_LT(lands, kFrames - 60);
  const auto rise_m = [&](int t) {
    return scene.place(on.adapted.motion, t, B::kHips).y -
           scene.place(scene.planted, t, B::kHips).y;
  };
  EXPECT_NEAR(rise_m(lands - 40), 0.0, 1e-4) << "long before";
  EXPECT_GT(rise_m(lands - 8), 0.02) << "0.13 s before the foot lands";
  // Half the step, but for the 4 cm by which the trailing leg would be too short.
  EXPECT_GT(rise_m(lands), 0.03);
  EXPECT_NEAR(rise_m(kFrames - 10), 0.15, 1e-3) << "both feet are";
  // Half of 15 cm with each swing of 0.44 s: 5.8 * 0.075 / 0.44^2 = 2.2 m/s2, and sinking
  // for the trailing leg, in addition to the walk's own.
  const double was = max_pelvis_acceleration(scene, scene.planted);
  EXPECT_LT(max_pelvis_acceleration(scene, on.adapted.motion), 2.0 * was) << was;
}

// No ankle or ball is within the step while it swings over its edge.
TEST(CarryToFloor, SwingingFeetAreLiftedOverEdges) {
  const Scene scene;
  for (const double edge_m : {1.2, 1.3, 1.4}) {
    Floor floor;
    floor.parts.push_back({"kerb", {-1, edge_m}, {1, edge_m + 0.1}, 0.12, {0, 0}, {}});
    const auto feet = plan_feet(scene.planted, scene.map, scene.contacts, 0.0, &floor);
    for (std::size_t side = 0; side < 2; ++side) {
      const FootMap& foot = scene.map.feet[side];
      const auto& stances = feet[side].stances;
      for (std::size_t k = 1; k < stances.size(); ++k) {
        const int first = stances[k - 1].frames.last;
        const int last = stances[k].frames.first;
        // Next to its footprints a foot that straddles an edge is within it.
        for (int t = first + (last - first) / 5; t <= last - (last - first) / 5; ++t) {
          const FootPlace& place = feet[side].places[static_cast<std::size_t>(t)];
          const glm::dvec3 ankle = place.ankle_in_world;
          const glm::dvec3 ball = ankle + place.foot * foot.ball_from_ankle_in_t_pose;
          EXPECT_GT(ankle.y, floor_at(floor, {ankle.x, ankle.z}, 0.0).height_m) << t;
          EXPECT_GT(ball.y, floor_at(floor, {ball.x, ball.z}, 0.0).height_m) << t;
        }
      }
    }
  }
}

// Up a ramp of 10 degrees: the sole lies on it.
TEST(CarryToFloor, FeetTurnWithTheSlope) {
  const Scene scene;
  const double slope = std::tan(10.0 * 3.14159265358979 / 180.0);
  Floor floor;
  floor.parts.push_back({"ramp", {-2, -2}, {2, 8}, 5.0 * slope, {0, slope}, {}});
  const auto on = scene.on(floor);
  expect_on_floor(scene, floor, on);
  expect_no_slide(scene, floor, on);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0, 1, -slope));
  int looked_at = 0;
  for (const SupportTrack& track : on.tracks) {
    if (std::get<Support>(track.constraint.goal).turns) continue;
    const bool left = track.constraint.point.segment == "leftFoot";
    const JointIndex foot =
        *scene.planted.skeleton.find(left ? B::kLeftFoot : B::kRightFoot);
    for (const FloorStance& stance : track.stands) {
      const int t = (stance.frames.first + stance.frames.last) / 2;
      const glm::dquat turn =
          scene.world(on.adapted.motion, t)[index(foot)].rotation *
          glm::conjugate(scene.map.joints[index(foot)].t_pose_from_joint);
      // A limb's end is turned in single precision.
      EXPECT_LT(glm::distance(turn * glm::dvec3(0, 1, 0), normal), 1e-4) << t;
      ++looked_at;
    }
  }
  EXPECT_GE(looked_at, 5);
}

// A ramp of 60 degrees: no ankle bends that far.
TEST(CarryToFloor, FeetTurnNoFurtherThanAnklesBend) {
  const Scene scene;
  Floor floor;
  floor.parts.push_back({"wall", {-9, -9}, {9, 9}, 0.0, {std::sqrt(3.0), 0}, {}});
  const auto feet = plan_feet(scene.planted, scene.map, scene.contacts, 0.0, &floor);
  const FloorStance& stance = feet[0].stances[1];
  const glm::dvec3 up =
      feet[0].places[static_cast<std::size_t>(stance.frames.first)].foot *
      glm::dvec3(0, 1, 0);
  EXPECT_NEAR(std::acos(up.y), StandFeetOptions{}.max_foot_pitch_rad, 1e-6);
}

// A belt that runs sideways and rises while the walk is on it: the feet go with it, and
// the next steps are displaced by its movement.
TEST(CarryToFloor, AMovingFloorCarriesFeetAndBody) {
  const Scene scene;
  Floor floor;
  floor.parts.push_back({"belt", {-9, 0.2}, {9, 1.8}, 0.05, {0, 0}, {}});
  floor.parts[0].path = {{0.3, {0, 0, 0}},
                         {1.0, {0.15, 0.03, 0}},
                         {2.0, {0.45, 0.06, 0}},
                         {2.8, {0.6, 0, 0}}};
  const auto on = scene.on(floor);
  expect_on_floor(scene, floor, on);
  expect_no_slide(scene, floor, on);
  double on_belt_m = 0.0;
  for (const SupportTrack& track : on.tracks) {
    for (const FloorStance& stance : track.stands) {
      if (!stance.part) continue;
      const auto at = [&](int t) {
        return track.p_in_world[static_cast<std::size_t>(t)];
      };
      on_belt_m = std::max(
          on_belt_m, glm::distance(at(stance.frames.first), at(stance.frames.last)));
    }
  }
  EXPECT_GT(on_belt_m, 0.1) << "nothing stood on the belt while it moved";
  const int last = kFrames - 5;
  const double aside_m = scene.place(on.adapted.motion, last, B::kHips).x -
                         scene.place(scene.planted, last, B::kHips).x;
  EXPECT_GT(aside_m, 0.2);
  // Up, aside, and down 10 cm again at the same time: 4 m/s2.
  const double was = max_pelvis_acceleration(scene, scene.planted);
  EXPECT_LT(max_pelvis_acceleration(scene, on.adapted.motion), 3.0 * was) << was;
}

// A body in the air all the time still has a floor below it.
TEST(CarryToFloor, WithoutContactsTheBaseCounts) {
  const Scene scene;
  Contacts none;
  none.frame_count = kFrames;
  const Floor high{0.7, {}};
  const auto on = carry_to_floor(scene.planted, scene.map, none, high);
  EXPECT_NEAR(scene.place(on.motion, 50, B::kHead).y,
              scene.place(scene.planted, 50, B::kHead).y + 0.7,
              1e-9);
}

}  // namespace
}  // namespace marey::retarget
