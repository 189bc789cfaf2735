// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/motion/retarget_motion.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/pose.h"
#include "retarget/body/match_carriage.h"
#include "retarget/body/place_masses.h"
#include "retarget/body/rotation_from_t_pose.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/feet/leg_placement.h"
#include "retarget/feet/unroll_feet.h"
#include "retarget/hands/keep_heights.h"
#include "retarget/hands/keep_wrists.h"

namespace marey::retarget {
namespace {

// Returns the world positions of one joint over a motion. [m]
std::vector<glm::dvec3> path_of(const Motion& motion, JointIndex joint) {
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  std::vector<glm::dvec3> path;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    path.push_back(world_from_joint[index(joint)].translation);
  }
  return path;
}

struct Slide {
  double sum_m = 0.0;
  int steps = 0;
};

void add_slide(const std::vector<glm::dvec3>& path,
               const std::vector<FrameRange>& contacts,
               Slide& slide) {
  for (const FrameRange& run : contacts) {
    for (int t = run.first + 1; t <= run.last; ++t) {
      const glm::dvec3 step =
          path[static_cast<std::size_t>(t)] - path[static_cast<std::size_t>(t - 1)];
      slide.sum_m += glm::length(glm::dvec2(step.x, step.z));
      ++slide.steps;
    }
  }
}

Result<BodyMap> map_named_body(const Skeleton& skeleton, const char* who) {
  Result<BodyMap> map = map_body(skeleton);
  if (map) return map;
  Error error = map.error();
  error.where = who;
  return error;
}

Motion expand_all(const std::vector<NormalizedPose>& poses,
                  const Motion& source,
                  const Skeleton& avatar,
                  const BodyMap& map) {
  Motion motion{avatar, source.rate, source.first_frame, {}};
  motion.poses.resize(poses.size());
  std::vector<RigidTransform> world_from_joint(avatar.joints.size());
  for (std::size_t t = 0; t < poses.size(); ++t) {
    expand(poses[t], avatar, map, world_from_joint, motion.poses[t]);
  }
  return motion;
}

void keep_all_wrists(const Skeleton& avatar,
                     const BodyMap& map,
                     std::vector<NormalizedPose>& poses) {
  std::vector<RigidTransform> world_from_joint(avatar.joints.size());
  Pose scratch;
  for (NormalizedPose& pose : poses) {
    expand(pose, avatar, map, world_from_joint, scratch);
    keep_wrists(avatar, map, world_from_joint, pose);
  }
}

// Returns the maximum depth of the ends of both soles below the floor. [m]
double max_sole_depth_m(const Motion& motion, const BodyMap& map) {
  double max_depth_m = 0.0;
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world_from_joint);
    const auto end_m = [&](JointIndex joint, const glm::dvec3& from_joint_in_t_pose) {
      const glm::dquat turn = rotation_from_t_pose(map, world_from_joint, joint);
      return (world_from_joint[index(joint)].translation + turn * from_joint_in_t_pose).y;
    };
    for (int side = 0; side < 2; ++side) {
      const FootMap& foot = map.feet[static_cast<std::size_t>(side)];
      const JointIndex ankle = map.leg(side).end;
      const auto toes = map.joint_of[index(toes_bone(side))];
      // Without a toe joint the tip rotates with the ankle.
      const double tip_m =
          toes ? end_m(*toes, foot.tip_from_ball_in_t_pose)
               : end_m(ankle,
                       foot.ball_from_ankle_in_t_pose + foot.tip_from_ball_in_t_pose);
      max_depth_m =
          std::max({max_depth_m, -end_m(ankle, foot.heel_from_ankle_in_t_pose), -tip_m});
    }
  }
  return max_depth_m;
}

}  // namespace

Result<MappedBodies> map_bodies(const Skeleton& source,
                                const Skeleton& avatar,
                                RootNormalization root) {
  Result<BodyMap> from = map_named_body(source, "source skeleton");
  if (!from) return from.error();
  Result<BodyMap> to = map_named_body(avatar, "avatar");
  if (!to) return to.error();
  if (root == RootNormalization::kArmLength &&
      (from->arm_length_m <= 0.0 || to->arm_length_m <= 0.0)) {
    return bad_input(from->arm_length_m > 0.0 ? "avatar" : "source skeleton",
                     "it has no complete arm to measure the root's path in",
                     "normalize the root by leg length");
  }
  match_carriage(source, *from, avatar, *to);
  return MappedBodies{std::move(*from), std::move(*to)};
}

FootFigures measure_feet(const Motion& motion,
                         const BodyMap& map,
                         const Contacts& contacts) {
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(motion.poses.size()));
  FootFigures figures;
  figures.max_penetration_mm = 1e3 * max_sole_depth_m(motion, map);
  Slide slide;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto measure =
        [&](JointIndex joint, const std::vector<FrameRange>& runs, double height_m) {
          const std::vector<glm::dvec3> path = path_of(motion, joint);
          add_slide(path, runs, slide);
          for (const glm::dvec3& p : path) {
            figures.max_penetration_mm =
                std::max(figures.max_penetration_mm, 1e3 * (height_m - p.y));
          }
        };
    const FootMap& foot = map.feet[side];
    measure(map.leg(static_cast<int>(side)).end,
            contacts.feet[side].heel,
            foot.ankle_height_m);
    if (const auto toes = map.joint_of[index(toes_bone(static_cast<int>(side)))]) {
      measure(*toes, contacts.feet[side].ball, foot.ball_height_m);
    }
  }
  if (slide.steps > 0) {
    figures.mean_slide_cm_per_s = 100.0 * slide.sum_m / slide.steps * motion.rate.hz;
  }
  return figures;
}

namespace {

// Data of one retargeting run between two bodies.
struct Task {
  const Motion& source;
  const Skeleton& avatar;
  const BodyMap& from;
  const BodyMap& to;
  const RetargetOptions& options;
  double unit_m = 1.0;  // Unit of length of the avatar's root.
  WorldScale world;
};

// Returns the avatar's postures before ground adaptation.
std::vector<NormalizedPose> posed(const Task& task, const Contacts& contacts) {
  const Motion& source = task.source;
  const WorldScale& world = task.world;
  const std::array<double, 2> rest_m = ankles_rest_m(task.from, contacts);
  const double floor_m = floor_height_m(task.from, rest_m);
  // Height of the hips above each body's floor.
  const double stands_m = task.from.leg_length_m + task.from.hip_drop_m +
                          0.5 * (rest_m[0] + rest_m[1]) - floor_m;
  const double avatar_stands_m =
      world.scale * (stands_m + world.source_floor_m) + world.rise_m;
  // Nonzero only if feet are not moved to Y = 0.
  const double avatar_floor_m = floor_m - world.source_floor_m;
  std::vector<NormalizedPose> poses(source.poses.size());
  std::vector<RigidTransform> world_from_joint(source.skeleton.joints.size());
  FootUnroller unroller;
  for (std::size_t t = 0; t < poses.size(); ++t) {
    world_from_joints(source.skeleton, source.poses[t], world_from_joint);
    glm::dvec3& root = poses[t].root;
    normalize(task.from, world_from_joint, poses[t], task.options.root);
    unroller.step(task.from, world_from_joint, poses[t]);
    if (world.keeps_path) root = {root.x / world.scale, root.y, root.z / world.scale};
    if (world.keeps_heights) {
      const double y_m = world_from_joint[index(task.from.hips())].translation.y;
      root.y = (avatar_floor_m +
                kept_hips_height_m(y_m - floor_m, stands_m, avatar_stands_m)) /
               task.unit_m;
    } else {
      root.y += world.rise_m / task.unit_m;
    }
  }
  if (spines_differ(task.from, task.to)) keep_all_wrists(task.avatar, task.to, poses);
  if (world.keeps_heights) {
    keep_foot_heights(
        source, task.from, rest_m, task.avatar, task.to, avatar_floor_m, poses);
  }
  return poses;
}

// Returns the source on its own body, with feet on the floor as the avatar's are.
std::vector<NormalizedPose> grounded_source(const Task& task, const Contacts& contacts) {
  const RetargetOptions& options = task.options;
  const double rise_m = standing_rise_m(task.from, contacts, task.from, 1.0);
  const Task own{task.source,
                 task.source.skeleton,
                 task.from,
                 task.from,
                 options,
                 root_unit_m(task.from, options.root),
                 {1.0, rise_m}};
  std::vector<NormalizedPose> poses = posed(own, contacts);
  adapt_to_ground(
      task.source.skeleton, task.from, contacts, task.source.rate, poses, options.ground);
  return poses;
}

// Adapts the postures to the floor, in balance. Errors: those of place_masses().
Status settle_in_balance(const Task& task,
                         const BalanceOptions& options,
                         std::vector<NormalizedPose>& poses,
                         RetargetedMotion& out) {
  const Skeleton& body = task.source.skeleton;
  const FrameRate rate = task.source.rate;
  const auto source_masses = place_masses(body, task.from, options.source_masses);
  if (!source_masses) return source_masses.error();
  const auto masses = place_masses(task.avatar, task.to, options.avatar_masses);
  if (!masses) return masses.error();
  const Contacts& contacts = out.report.contacts;
  const BalanceReference reference = balance_reference(body,
                                                       task.from,
                                                       *source_masses,
                                                       contacts,
                                                       rate,
                                                       grounded_source(task, contacts),
                                                       options);
  std::vector<NormalizedPose> still = poses;
  adapt_to_ground(task.avatar, task.to, contacts, rate, still, task.options.ground);
  BalanceReport& report = out.report.balance.emplace();
  report.kept = keep_balance(reference,
                             {task.avatar, task.to, *masses},
                             contacts,
                             rate,
                             task.world.keeps_path ? 1.0 : task.world.scale,
                             poses,
                             options,
                             task.options.ground);
  out.report.ground = report.kept.ground;
  const BalanceTrack source =
      track_balance(task.source, task.from, *source_masses, contacts);
  report.source = balance_measures(source);
  const auto figures = [&](const Motion& motion) {
    return balance_measures(track_balance(motion, task.to, *masses, contacts), source);
  };
  report.before = figures(expand_all(still, task.source, task.avatar, task.to));
  report.after = figures(expand_all(poses, task.source, task.avatar, task.to));
  return Done{};
}

Status settle(const Task& task,
              std::vector<NormalizedPose>& poses,
              RetargetedMotion& out) {
  const RetargetOptions& options = task.options;
  if (options.balance) {
    const Status ok = settle_in_balance(task, *options.balance, poses, out);
    if (!ok) return ok;
  } else {
    out.report.ground = adapt_to_ground(task.avatar,
                                        task.to,
                                        out.report.contacts,
                                        task.source.rate,
                                        poses,
                                        options.ground);
  }
  out.motion = expand_all(poses, task.source, task.avatar, task.to);
  out.report.after = measure_feet(out.motion, task.to, out.report.contacts);
  return Done{};
}

// Computes RetargetReport::source_depth_m.
std::vector<double> source_depth_m(const Task& task, double floor_m) {
  std::vector<double> out;
  std::vector<RigidTransform> world_from_joint(task.source.skeleton.joints.size());
  for (const Pose& pose : task.source.poses) {
    world_from_joints(task.source.skeleton, pose, world_from_joint);
    double depth_m = 0.0;
    for (const HumanBone bone : human_bones()) {
      const auto joint = task.from.joint_of[index(bone)];
      const bool is_foot = bone == foot_bone(0) || bone == foot_bone(1) ||
                           bone == toes_bone(0) || bone == toes_bone(1);
      if (!joint || is_foot) continue;
      depth_m =
          std::max(depth_m, floor_m - world_from_joint[index(*joint)].translation.y);
    }
    out.push_back(task.world.scale * depth_m);
  }
  return out;
}

}  // namespace

Result<RetargetedMotion> retarget_motion(const Motion& source,
                                         const Skeleton& avatar,
                                         const RetargetOptions& options) {
  MAREY_ASSERT(source.rate.hz > 0.0);
  if (options.balance && !options.adapt_ground) {
    return bad_input("",
                     "balance needs ground adaptation, which is switched off",
                     "switch ground adaptation on, or balance off");
  }
  auto bodies = map_bodies(source.skeleton, avatar, options.root);
  if (!bodies) return bodies.error();
  apply_soles(options.soles, bodies->avatar);
  const BodyMap& from = bodies->source;
  const BodyMap& to = bodies->avatar;

  RetargetedMotion out;
  out.report.contacts = options.known_contacts
                            ? *options.known_contacts
                            : detect_contacts(source, from, options.contacts);
  MAREY_ASSERT(out.report.contacts.frame_count == static_cast<int>(source.poses.size()));
  const double unit_m = root_unit_m(to, options.root);
  WorldScale world{unit_m / root_unit_m(from, options.root)};
  world.keeps_path = options.path == WorldLengths::kKept;
  world.keeps_heights = options.heights == WorldLengths::kKept;
  if (options.adapt_ground) {
    const std::array<double, 2> rest_m = ankles_rest_m(from, out.report.contacts);
    world.rise_m = standing_rise_m(from, rest_m, to, world.scale);
    world.source_floor_m = floor_height_m(from, rest_m);
  }
  const Task task{source, avatar, from, to, options, unit_m, world};
  std::vector<NormalizedPose> poses = posed(task, out.report.contacts);
  out.motion = expand_all(poses, source, avatar, to);
  out.report.before = measure_feet(out.motion, to, out.report.contacts);
  out.report.after = out.report.before;
  const auto taken = [&](RetargetStep step) {
    if (!options.compare_steps) return;
    out.report.steps.emplace_back(step, compare_postures(source, from, out.motion, to));
  };
  taken(RetargetStep::kPosture);
  if (options.adapt_ground) {
    if (const Status ok = settle(task, poses, out); !ok) return ok.error();
    taken(RetargetStep::kGround);
  }
  if (options.hands) {
    RefineHandsOptions hands = *options.hands;
    hands.arms.over_floor = hands.arms.over_floor && options.adapt_ground;
    out.report.hands = refine_hands(source, from, to, world, hands, out.motion);
    taken(RetargetStep::kHands);
  }
  out.report.source_depth_m = source_depth_m(
      task, floor_height_m(from, ankles_rest_m(from, out.report.contacts)));
  if (options.adapt_ground && options.skin != nullptr && !options.skin->empty()) {
    out.report.skin = lift_skin(*options.skin,
                                to,
                                out.report.contacts,
                                out.report.source_depth_m,
                                options.lift,
                                out.motion);
    out.report.after = measure_feet(out.motion, to, out.report.contacts);
    taken(RetargetStep::kSkin);
  }
  return out;
}

}  // namespace marey::retarget
