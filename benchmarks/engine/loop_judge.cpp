// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/loop_judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "edit/find/planar_match.h"
#include "edit/ops/cyclify.h"
#include "edit/state/edit_state.h"
#include "edit/state/resample_state.h"
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/base/degrees.h"
#include "core/transform.h"

namespace marey {
namespace {

using LoopPlaces = std::vector<glm::dvec3>;

edit::PlanarMove move_of(const LoopClip& loop, int cycles) {
  return edit::power({loop.turn_rad, loop.shift_xz_m}, cycles);
}

// Yaw of a rotation of the world.
double yaw_rad(const glm::dquat& rotation) {
  const glm::dquat yaw = twist_about(rotation, {0.0, 1.0, 0.0});
  return std::remainder(2.0 * std::atan2(yaw.y, yaw.w), 2.0 * 3.14159265358979323846);
}

LoopPlaces places_of(const Skeleton& skeleton, const Pose& pose) {
  const auto world_from_joint = world_from_joints(skeleton, pose);
  LoopPlaces out;
  for (const RigidTransform& joint : world_from_joint) out.push_back(joint.translation);
  for (std::size_t j = 0; j < world_from_joint.size(); ++j) {
    const auto& tip_in_joint = skeleton.joints[j].tip_in_joint;
    if (tip_in_joint) out.push_back(world_from_joint[j] * *tip_in_joint);
  }
  return out;
}

double acceleration_of(const LoopPlaces& before,
                       const LoopPlaces& now,
                       const LoopPlaces& after,
                       double hz) {
  double largest = 0.0;
  for (std::size_t j = 0; j < now.size(); ++j) {
    largest =
        std::max(largest, glm::length(after[j] - 2.0 * now[j] + before[j]) * hz * hz);
  }
  return largest;
}

Pose loop_pose(const LoopClip& loop, int frame) {
  const int frames = loop.cycle_frames();
  Pose pose = loop.motion.poses[static_cast<std::size_t>(frame % frames)];
  edit::move_pose(move_of(loop, frame / frames), pose);
  return pose;
}

void compare_with_truth(const LoopClip& loop,
                        int frame,
                        const Pose& pose,
                        LoopFigures& out) {
  const Pose truth = loop_pose(loop, frame);
  const glm::dvec3 error_m = pose.root_in_world - truth.root_in_world;
  if (frame % loop.cycle_frames() == 0) {
    const glm::dquat turn =
        pose.parent_from_joint.front() * glm::conjugate(truth.parent_from_joint.front());
    out.path_error_mm =
        std::max(out.path_error_mm, 1e3 * std::hypot(error_m.x, error_m.z));
    out.heading_error_deg =
        std::max(out.heading_error_deg, kDegreesPerRadian * std::abs(yaw_rad(turn)));
  }
  if (frame < (out.cycles - 1) * loop.cycle_frames()) return;
  const LoopPlaces played = places_of(loop.motion.skeleton, pose);
  const LoopPlaces expected = places_of(loop.motion.skeleton, truth);
  const auto error_of_mm = [&](std::size_t j) {
    return 1e3 * glm::length(played[j] - expected[j] - error_m);
  };
  for (std::size_t j = 0; j < played.size(); ++j) {
    out.posture_error_mm = std::max(out.posture_error_mm, error_of_mm(j));
  }
  for (const auto& joint : loop.map.joint_of) {
    if (!joint) continue;
    out.bone_error_mm = std::max(out.bone_error_mm, error_of_mm(index(*joint)));
  }
}

}  // namespace

Result<LoopClip> make_loop_clip(const TransitionClip& clip) {
  auto state = edit::make_edit_state(clip.motion);
  if (!state) return state.error();
  CyclifyOp op;
  op.cycles = 2;
  EditOp common;
  common.parameters = op;
  const edit::EditInputs inputs;
  edit::OpReport report;
  const auto loop = edit::apply_cyclify(op, {common, 0, inputs}, *state, report);
  if (!loop) return loop.error();
  const int frames = loop->frame_count() / 2;
  const edit::EditState cycle = edit::slice_state(*loop, {0, frames});
  LoopClip out{clip.name, cycle.motion, cycle.map, cycle.contacts, 0.0, {}};
  const Pose& first = out.motion.poses.front();
  const Pose& last = out.motion.poses.back();
  out.turn_rad = yaw_rad(last.parent_from_joint.front() *
                         glm::conjugate(first.parent_from_joint.front()));
  const glm::dvec3 turned_in_world =
      edit::PlanarMove{out.turn_rad, {}}.rotation() * first.root_in_world;
  const glm::dvec3 shift = last.root_in_world - turned_in_world;
  out.shift_xz_m = {shift.x, shift.z};
  return out;
}

LoopFigures judge_loop(const LoopClip& loop, const LoopPlayer& player, int cycles) {
  MAREY_ASSERT(cycles >= 2);
  const int frames = loop.cycle_frames();
  LoopFigures out;
  out.cycles = cycles;
  const int last_seam = (cycles - 1) * frames;
  LoopPlaces before;
  LoopPlaces now;
  // The seam at the end of the last cycle is measured, too.
  for (int frame = 0; frame <= cycles * frames + 2; ++frame) {
    const Pose pose = player(frame);
    MAREY_ASSERT(pose.parent_from_joint.size() == loop.motion.skeleton.joints.size());
    compare_with_truth(loop, frame, pose, out);
    if (frame < last_seam - 2) continue;
    LoopPlaces after = places_of(loop.motion.skeleton, pose);
    if (!before.empty()) {
      const double size_m_s2 = acceleration_of(before, now, after, loop.motion.rate.hz);
      const int phase = (frame - 1) % frames;
      const bool is_seam = phase <= 1 || phase == frames - 1;
      double& largest = is_seam ? out.seam_m_s2 : out.inner_m_s2;
      largest = std::max(largest, size_m_s2);
    }
    before = std::move(now);
    now = std::move(after);
  }
  return out;
}

LoopPlayer exact_loop_player(const LoopClip& loop) {
  return [&loop](int frame) { return loop_pose(loop, frame); };
}

LoopPlayer float_loop_player(const LoopClip& loop) {
  struct Root {
    float x_m = 0.0F;
    float z_m = 0.0F;
  };
  const glm::dvec3 start = loop.motion.poses.front().root_in_world;
  auto root = std::make_shared<Root>(
      Root{static_cast<float>(start.x), static_cast<float>(start.z)});
  return [&loop, root](int frame) {
    Pose pose = loop_pose(loop, frame);
    if (frame > 0) {
      const glm::dvec3 step =
          pose.root_in_world - loop_pose(loop, frame - 1).root_in_world;
      root->x_m += static_cast<float>(step.x);
      root->z_m += static_cast<float>(step.z);
    }
    pose.root_in_world.x = static_cast<double>(root->x_m);
    pose.root_in_world.z = static_cast<double>(root->z_m);
    return pose;
  };
}

}  // namespace marey
