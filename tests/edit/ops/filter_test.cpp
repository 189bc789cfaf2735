// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/filter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "edit/find/find_impacts.h"
#include "edit/ops/place.h"
#include "edit/state/lineage.h"
#include "edit/state/plant_feet.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/edit/ops/op_scene.h"

namespace marey::edit {
namespace {

using testing::synthetic_walk;

constexpr double kFilterRate_hz = 120.0;
constexpr int kFilterFrames = 360;
constexpr int kFilterSeeds = 10;

Motion true_walk() {
  return synthetic_walk(kFilterFrames, kFilterRate_hz).motion;
}

EditState state_of(Motion motion) {
  auto state = make_edit_state(std::move(motion));
  EXPECT_TRUE(state);
  return *std::move(state);
}

EditState noisy_walk(std::uint64_t seed,
                     double noise_rad = 0.005,
                     double noise_m = 0.002) {
  Motion motion = true_walk();
  add_motion_noise(motion, seed, noise_rad, noise_m);
  return state_of(std::move(motion));
}

/// Root mean square distance of all joints from the truth.
double error_m(const Motion& motion, const Motion& truth) {
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const auto a = world_from_joints(motion.skeleton, motion.poses[t]);
    const auto b = world_from_joints(truth.skeleton, truth.poses[t]);
    for (std::size_t j = 0; j < a.size(); ++j, ++count) {
      const glm::dvec3 apart = a[j].translation - b[j].translation;
      squares += glm::dot(apart, apart);
    }
  }
  return std::sqrt(squares / static_cast<double>(count));
}

/// Displacements of the joints that bear, in contacts.
struct ContactMoves {
  double worst_m = 0.0;
  double rms_m = 0.0;
};

ContactMoves contact_moves(const EditState& before, const Motion& after) {
  ContactMoves out;
  double squares = 0.0;
  int frames = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& foot = before.contacts.feet[side];
    for (const bool heel : {true, false}) {
      const HumanBone ankle = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
      const HumanBone toes = side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes;
      const auto old = joint_way(before.motion, heel ? ankle : toes);
      const auto now = joint_way(after, heel ? ankle : toes);
      for (const FrameRange& run : heel ? foot.heel : foot.ball) {
        for (int frame = run.first; frame <= run.last; ++frame, ++frames) {
          const auto t = static_cast<std::size_t>(frame);
          const double moved_m = glm::distance(old[t], now[t]);
          out.worst_m = std::max(out.worst_m, moved_m);
          squares += moved_m * moved_m;
        }
      }
    }
  }
  out.rms_m = std::sqrt(squares / frames);
  return out;
}

/// A body that stamps its left foot: the foot comes down at 2 m/s and stops at frame 150.
EditState stamping_body(std::uint64_t seed) {
  const Skeleton body = make_humanoid(average_proportions(1.75));
  Motion motion{body, {kFilterRate_hz}, 0, {}};
  const auto thigh = index(HumanBone::kLeftUpperLeg);
  const auto shank = index(HumanBone::kLeftLowerLeg);
  const auto foot = index(HumanBone::kLeftFoot);
  const double l1 = glm::length(body.joints[shank].parent_from_joint.translation);
  const double l2 = glm::length(body.joints[foot].parent_from_joint.translation);
  for (int t = 0; t < 300; ++t) {
    Pose pose = rest_pose(body);
    pose.root_in_world.y -= 0.01;  // Knees are a little bent.
    const double lift = std::min(2.0 * std::max(150 - t, 0) / kFilterRate_hz, 0.25);
    for (const bool left : {true, false}) {
      const double d = l1 + l2 - 0.01 - (left ? lift : 0.0);
      const double hip = std::acos((l1 * l1 + d * d - l2 * l2) / (2.0 * l1 * d));
      const double ankle = std::acos((l2 * l2 + d * d - l1 * l1) / (2.0 * l2 * d));
      const std::size_t side = left ? 0 : 4;
      const auto about_x = [](double a) {
        return glm::angleAxis(a, glm::dvec3(1, 0, 0));
      };
      pose.parent_from_joint[thigh + side] = about_x(-hip);
      pose.parent_from_joint[shank + side] = about_x(hip + ankle);
      pose.parent_from_joint[foot + side] = about_x(-ankle);
    }
    motion.poses.push_back(std::move(pose));
  }
  add_motion_noise(motion, seed, 0.002, 0.0005);
  return state_of(std::move(motion));
}

TEST(ApplyFilter, BringsANoisyWalkNearerToTheTruth) {
  const Motion truth = true_walk();
  for (std::uint64_t seed = 1; seed <= kFilterSeeds; ++seed) {
    const EditState source = noisy_walk(seed);
    OpScene<FilterOp> scene({});
    auto made = scene.run(apply_filter, source);
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_LT(error_m(made->motion, truth), 0.4 * error_m(source.motion, truth)) << seed;
    // Contacts that were detected under noise still serve to plant the feet.
    plant_feet(*made);
    EXPECT_LT(error_m(made->motion, truth), 0.75 * error_m(source.motion, truth)) << seed;
  }
}

TEST(ApplyFilter, ReportsTheLargestDisplacementOfAJoint) {
  const EditState noisy = noisy_walk(3);
  OpReport report;
  const auto filtered = apply_filter({}, {EditOp{}, 0, {}}, noisy, report);
  ASSERT_TRUE(filtered) << filtered.error().message();
  double largest_m = 0.0;
  for (std::size_t t = 0; t < noisy.motion.poses.size(); ++t) {
    const auto a = world_from_joints(noisy.motion.skeleton, noisy.motion.poses[t]);
    const auto b = world_from_joints(noisy.motion.skeleton, filtered->motion.poses[t]);
    for (std::size_t j = 0; j < a.size(); ++j) {
      largest_m = std::max(largest_m, glm::distance(a[j].translation, b[j].translation));
    }
  }
  double reported_mm = -1.0;
  for (const auto& [name, value] : report.figures) {
    if (name == "displaced_mm") reported_mm = value;
  }
  EXPECT_GT(largest_m, 0.001);
  EXPECT_NEAR(reported_mm, 1e3 * largest_m, 1e-6);
}

TEST(ApplyFilter, FeetThatStandStillStayWhereTheyStood) {
  for (std::uint64_t seed = 1; seed <= kFilterSeeds; ++seed) {
    EditState source = noisy_walk(seed);
    plant_feet(source);
    OpScene<FilterOp> scene({});
    const auto made = scene.run(apply_filter, source);
    ASSERT_TRUE(made);
    EXPECT_LT(contact_moves(source, made->motion).worst_m, 1e-4 /* m */) << seed;
    EXPECT_LT(scene.figure("feet_moved_mm"), 0.1) << seed;
    EXPECT_LT(measure_slide(*made).worst_drift_mm, 0.1) << seed;
  }
}

TEST(ApplyFilter, StandingFeetLoseTheirNoise) {
  const Motion truth = true_walk();
  for (std::uint64_t seed = 1; seed <= kFilterSeeds; ++seed) {
    const EditState source = noisy_walk(seed);
    OpScene<FilterOp> scene({});
    const auto made = scene.run(apply_filter, source);
    ASSERT_TRUE(made);
    EditState known = source;
    known.motion = truth;
    EXPECT_LT(contact_moves(known, made->motion).rms_m,
              0.6 * contact_moves(known, source.motion).rms_m)
        << seed;
  }
}

TEST(ApplyFilter, AFilteredMotionCanBePlacedBeforeOrAfter) {
  const EditState source = noisy_walk(3);
  PlaceOp place;
  place.position_xz_m = {12.0, -7.0};
  place.heading_rad = 2.1;
  OpScene<PlaceOp> placing(place);
  OpScene<FilterOp> filtering({});
  const auto placed = placing.run(apply_place, source);
  ASSERT_TRUE(placed);
  const auto filtered_last = filtering.run(apply_filter, *placed);
  const auto filtered = filtering.run(apply_filter, source);
  ASSERT_TRUE(filtered_last && filtered);
  // The filter moves the hips on which place turns, so the move is that of the source.
  const glm::dquat turn = placed->motion.poses[0].parent_from_joint[0] *
                          glm::conjugate(source.motion.poses[0].parent_from_joint[0]);
  const glm::dvec3 shift =
      placed->motion.poses[0].root_in_world - turn * source.motion.poses[0].root_in_world;
  for (std::size_t t = 0; t < source.motion.poses.size(); ++t) {
    const auto a = world_from_joints(source.motion.skeleton, filtered->motion.poses[t]);
    const auto b =
        world_from_joints(source.motion.skeleton, filtered_last->motion.poses[t]);
    for (std::size_t j = 0; j < a.size(); ++j) {
      EXPECT_LT(glm::distance(turn * a[j].translation + shift, b[j].translation), 1e-9);
    }
  }
}

TEST(ApplyFilter, FramesOutsideTheSpanStayToTheBit) {
  const EditState source = noisy_walk(4);
  OpScene<FilterOp> scene({});
  scene.op.span = {AtFrame{120}, AtFrame{220}};
  scene.op.blend_s = 0.1;
  const auto made = scene.run(apply_filter, source);
  ASSERT_TRUE(made);
  for (std::size_t t = 0; t < source.motion.poses.size(); ++t) {
    if (t >= 108 && t <= 232) continue;
    const Pose& pose = made->motion.poses[t];
    EXPECT_EQ(pose.root_in_world, source.motion.poses[t].root_in_world) << t;
    EXPECT_TRUE(pose.parent_from_joint == source.motion.poses[t].parent_from_joint) << t;
  }
  EXPECT_TRUE(ops_of(made->lineage, 50).empty());
  EXPECT_EQ(ops_of(made->lineage, 170).size(), 1U);
}

TEST(ApplyFilter, OtherGroupsKeepTheirRotations) {
  const EditState source = noisy_walk(5);
  OpScene<FilterOp> scene({});
  scene.op.groups = {EditGroup::kLeftArm};
  const auto made = scene.run(apply_filter, source);
  ASSERT_TRUE(made);
  const auto elbow = index(*source.motion.skeleton.find(HumanBone::kLeftLowerArm));
  const auto other = index(*source.motion.skeleton.find(HumanBone::kRightLowerArm));
  EXPECT_NE(made->motion.poses[90].parent_from_joint[elbow],
            source.motion.poses[90].parent_from_joint[elbow]);
  EXPECT_EQ(made->motion.poses[90].parent_from_joint[other],
            source.motion.poses[90].parent_from_joint[other]);
  EXPECT_EQ(made->motion.poses[90].root_in_world, source.motion.poses[90].root_in_world);
}

TEST(ApplyFilter, EstimatesTheNoiseOfEachGroup) {
  const EditState source = noisy_walk(6, 0.005, 0.002);
  OpScene<FilterOp> scene({});
  ASSERT_TRUE(scene.run(apply_filter, source));
  const double noise_deg = 0.005 * 180.0 / std::numbers::pi;
  for (const char* group : {"trunk", "left_arm", "right_leg"}) {
    EXPECT_NEAR(
        scene.figure(std::string(group) + "_noise_deg"), noise_deg, 0.2 * noise_deg)
        << group;
  }
  EXPECT_NEAR(scene.figure("root_noise_mm"), 2.0, 0.5);
  EXPECT_GT(scene.figure("left_arm_removed_max_mm"),
            scene.figure("left_arm_removed_rms_mm"));
  EXPECT_GT(scene.figure("right_leg_cutoff_hz"), scene.figure("left_arm_cutoff_hz"));
}

TEST(ApplyFilter, AnImpactKeepsItsPeak) {
  for (std::uint64_t seed = 1; seed <= kFilterSeeds; ++seed) {
    const EditState source = stamping_body(seed);
    const auto impacts = find_impacts(source, 0);
    ASSERT_EQ(impacts.size(), 1U);
    EXPECT_NEAR(impacts[0], 150, 1);
    OpScene<FilterOp> scene({});
    const auto made = scene.run(apply_filter, source);
    ASSERT_TRUE(made);
    const auto peak = [](const Motion& motion) {
      const auto ankle = joint_way(motion, HumanBone::kLeftFoot);
      double largest = 0.0;
      for (std::size_t t = 144; t <= 156; ++t) {
        largest = std::max(largest,
                           std::abs(ankle[t + 1].y - 2.0 * ankle[t].y + ankle[t - 1].y));
      }
      return largest;
    };
    EXPECT_GT(peak(made->motion), 0.95 * peak(source.motion)) << seed;
  }
}

TEST(ApplyFilter, InferredFramesCountLess) {
  Motion motion = true_walk();
  add_motion_noise(motion, 7, 0.005, 0.002);
  const auto arm = index(*motion.skeleton.find(HumanBone::kLeftUpperArm));
  const Motion truth = true_walk();
  for (std::size_t t = 150; t < 160; ++t) {
    motion.poses[t].parent_from_joint[arm] =
        motion.poses[t].parent_from_joint[arm] * rotation_from_vector({0.2, 0.0, 0.0});
  }
  EditState source = state_of(std::move(motion));
  OpScene<FilterOp> scene({});
  const auto plain = scene.run(apply_filter, source);
  for (std::size_t t = 150; t < 160; ++t)
    source.lineage.frames[t].trust = Source::kInferred;
  const auto weighted = scene.run(apply_filter, source);
  ASSERT_TRUE(plain && weighted);
  const auto off_rad = [&](const EditState& state) {
    return glm::length(
        rotation_vector(glm::conjugate(truth.poses[155].parent_from_joint[arm]) *
                        state.motion.poses[155].parent_from_joint[arm]));
  };
  EXPECT_LT(off_rad(*weighted), 0.8 * off_rad(*plain));
}

TEST(ApplyFilter, AMotionWithoutNoiseIsHardlyChanged) {
  const Motion truth = true_walk();
  const EditState source = state_of(truth);
  OpScene<FilterOp> scene({});
  const auto made = scene.run(apply_filter, source);
  ASSERT_TRUE(made);
  EXPECT_LT(error_m(made->motion, truth), 2e-4 /* m */);
  EXPECT_TRUE(scene.has_finding("constant"));  // The arms hang still.
}

TEST(ApplyFilter, AShortMotionIsLeftAsItIs) {
  Motion motion = synthetic_walk(19, kFilterRate_hz, 0.01).motion;
  const EditState source = state_of(std::move(motion));
  OpScene<FilterOp> scene({});
  const auto made = scene.run(apply_filter, source);
  ASSERT_TRUE(made);
  EXPECT_TRUE(scene.has_finding("too_short"));
  EXPECT_EQ(made->motion.poses[7].root_in_world, source.motion.poses[7].root_in_world);
  EXPECT_TRUE(ops_of(made->lineage, 7).empty());
}

TEST(ApplyFilter, ButterworthFiltersAtItsCutoff) {
  const Motion truth = true_walk();
  const EditState source = noisy_walk(8);
  for (const CutoffRule rule :
       {CutoffRule::kGiven, CutoffRule::kYu, CutoffRule::kWinter}) {
    FilterOp op;
    op.method = FilterMethod::kButterworth;
    op.cutoff = rule;
    op.cutoff_hz = 10.0;
    OpScene<FilterOp> scene(op);
    const auto made = scene.run(apply_filter, source);
    ASSERT_TRUE(made);
    EXPECT_LT(error_m(made->motion, truth), 0.8 * error_m(source.motion, truth));
    if (rule == CutoffRule::kGiven) {
      EXPECT_EQ(scene.figure("head_cutoff_hz"), 10.0);
    }
  }
}

TEST(ApplyFilter, ImpossibleParametersAreRefused) {
  const EditState source = noisy_walk(9);
  FilterOp order;
  order.order = 4;
  EXPECT_FALSE(OpScene<FilterOp>(order).run(apply_filter, source));
  FilterOp cutoff;
  cutoff.method = FilterMethod::kButterworth;
  cutoff.cutoff = CutoffRule::kGiven;
  cutoff.cutoff_hz = 60.0;
  const auto refused = OpScene<FilterOp>(cutoff).run(apply_filter, source);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "cutoff_hz");
}

}  // namespace
}  // namespace marey::edit
