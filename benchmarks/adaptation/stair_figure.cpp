// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "benchmarks/adaptation/adaptation_actor.h"
#include "benchmarks/adaptation/adaptation_figures.h"
#include "core/motion.h"
#include "core/transform.h"
#include "retarget/adapt/adapter.h"
#include "retarget/character/make_character.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey {
namespace {

using B = HumanBone;

constexpr double kStep_m = 0.12;
constexpr double kEdge_m = 1.3;  // World Z at which the step begins.
constexpr double kHz = 60.0;
constexpr int kFrames = 139;
constexpr int kFirstShown = 6;
constexpr int kShownEvery = 33;  // Half a cycle: a step.

/// The walk's arms are as in the T-pose: they hang, and swing against the legs.
void swing_arms(Motion& walk, const Character& actor) {
  for (std::size_t t = 0; t < walk.poses.size(); ++t) {
    Pose& pose = walk.poses[t];
    const double phase_rad =
        2.0 * std::numbers::pi * (static_cast<double>(t) / kHz / 1.1 + 0.05);
    const double swing_deg = 22.0 * std::cos(phase_rad);
    turn(pose, actor, B::kLeftLowerArm, -22, {0, 1, 0});
    turn(pose, actor, B::kRightLowerArm, 22, {0, 1, 0});
    turn(pose, actor, B::kLeftUpperArm, -80, {0, 0, 1});
    turn(pose, actor, B::kRightUpperArm, 80, {0, 0, 1});
    turn(pose, actor, B::kLeftUpperArm, swing_deg, {1, 0, 0});
    turn(pose, actor, B::kRightUpperArm, -swing_deg, {1, 0, 0});
  }
}

double smooth(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// By how much the floor under this foot's way is higher: while it swings onto the step
/// it rises early, as a foot does.
std::vector<double> rises_m(const testing::SyntheticWalk::Foot& foot,
                            const std::vector<double>& ankle_z_m) {
  std::vector<double> out(ankle_z_m.size(), 0.0);
  const std::size_t frames = out.size();
  std::size_t lands = 0;
  while (lands < frames && !(foot.heel[lands] && ankle_z_m[lands] > kEdge_m)) ++lands;
  std::size_t leaves = lands > 0 ? lands - 1 : 0;
  while (leaves > 0 && !foot.ball[leaves]) --leaves;
  for (std::size_t t = 0; t < frames; ++t) {
    const double share = (static_cast<double>(t) - static_cast<double>(leaves)) /
                         (0.75 * static_cast<double>(lands - leaves));
    out[t] = kStep_m * smooth(share);
  }
  return out;
}

std::vector<Pose> adapt_walk(const testing::SyntheticWalk& walk, const Character& actor) {
  constexpr std::array<B, 2> kFeet{B::kLeftFoot, B::kRightFoot};
  const std::size_t frames = walk.motion.poses.size();
  std::array<std::vector<glm::dvec3>, 2> footprints;
  std::array<std::vector<glm::dquat>, 2> turns;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<double> z_m;
    for (const Pose& pose : walk.motion.poses) {
      const auto joint = actor.skeleton.find(kFeet[side]);
      const RigidTransform world_from_foot =
          world_from_joints(actor.skeleton, pose)[index(*joint)];
      footprints[side].push_back(world_from_foot.translation);
      turns[side].push_back(world_from_foot.rotation);
      z_m.push_back(world_from_foot.translation.z);
    }
    const std::vector<double> rises = rises_m(walk.feet[side], z_m);
    for (std::size_t t = 0; t < frames; ++t) footprints[side][t].y += rises[t];
  }
  const ConstraintSet asked{
      {stance(B::kLeftFoot, footprints[0][0]), stance(B::kRightFoot, footprints[1][0])},
      {}};
  auto adapter = retarget::Adapter::make(actor, asked, {});
  if (!adapter) {
    std::fprintf(stderr, "%s\n", adapter.error().message().c_str());
    std::exit(1);
  }
  std::vector<Pose> out(frames);
  double worst_m = 0.0;
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t side = 0; side < 2; ++side) {
      auto foot = adapter->constraint(name(kFeet[side]));
      foot->set_target(footprints[side][t]);
      foot->set_orientation(turns[side][t]);
    }
    const auto report =
        adapter->adapt(walk.motion.poses[t], static_cast<double>(t) / kHz, out[t]);
    worst_m = std::max(worst_m, report.worst_error_m);
  }
  std::printf("%-28s worst %6.1f mm\n", "stair", 1e3 * worst_m);
  return out;
}

void show_walk(PictureScene& scene,
               const Character& actor,
               const std::vector<Pose>& poses,
               const glm::dvec3& place) {
  for (int t = kFirstShown; t < kFrames; t += kShownEvery) {
    scene.add_body(actor.skeleton, poses[static_cast<std::size_t>(t)], place);
  }
  // Clear of the bodies: above their heads.
  const glm::dvec3 above = place + glm::dvec3(0, 0.98, 0);
  for (std::size_t t = kFirstShown + 3; t < poses.size(); t += 3) {
    scene.add_rod(poses[t - 3].root_in_world + above,
                  poses[t].root_in_world + above,
                  0.012,
                  Paint::kPath);
  }
}

}  // namespace

PictureScene draw_stair() {
  PictureScene scene("stair", {-84.0, 5.0});
  testing::SyntheticWalk walk = testing::synthetic_walk(kFrames, kHz);
  const Character actor = make_actor();
  swing_arms(walk.motion, actor);
  const double end_m = walk.motion.poses.back().root_in_world.z + 0.6;
  const glm::dvec3 second_origin = scene.to_the_right(end_m + 0.9);
  show_walk(scene, actor, walk.motion.poses, {});
  scene.add_box({-0.35, -0.03, -0.7}, {0.35, 0.0, end_m}, Paint::kGround);
  show_walk(scene, actor, adapt_walk(walk, actor), second_origin);
  scene.add_box(second_origin + glm::dvec3(-0.35, -0.03, -0.7),
                second_origin + glm::dvec3(0.35, 0.0, end_m),
                Paint::kGround);
  scene.add_box(second_origin + glm::dvec3(-0.35, 0.0, kEdge_m),
                second_origin + glm::dvec3(0.35, kStep_m, end_m),
                Paint::kGround);
  const glm::dvec3 label(0.35, -0.12, 0.5 * end_m);
  scene.add_label("reference", label);
  scene.add_label("adapted", second_origin + label);
  return scene;
}

}  // namespace marey
