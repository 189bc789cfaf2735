// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/clip_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "library/export/start_at_origin.h"

#include "core/resample.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

/// Returns the motion of the hips and the joints below them. A joint above the hips often
/// stays at the origin of the recording, far from the body.
Motion from_hips(const Motion& motion) {
  const auto hips = motion.skeleton.find(HumanBone::kHips);
  if (!hips || index(*hips) == 0) return motion;
  Motion out{{}, motion.rate, motion.first_frame, {}};
  std::vector<std::optional<JointIndex>> place_of(motion.skeleton.joints.size());
  std::vector<std::size_t> kept;
  for (std::size_t i = index(*hips); i < motion.skeleton.joints.size(); ++i) {
    Joint joint = motion.skeleton.joints[i];
    if (i == index(*hips)) {
      joint.parent.reset();
    } else if (!joint.parent || !place_of[index(*joint.parent)]) {
      continue;
    } else {
      joint.parent = place_of[index(*joint.parent)];
    }
    place_of[i] = JointIndex{static_cast<int>(kept.size())};
    kept.push_back(i);
    out.skeleton.joints.push_back(std::move(joint));
  }
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  world_from_joints(motion.skeleton, rest_pose(motion.skeleton), world);
  out.skeleton.joints.front().parent_from_joint = world[index(*hips)];
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    Pose& below = out.poses.emplace_back();
    below.root_in_world = world[index(*hips)].translation;
    for (const std::size_t i : kept) {
      below.parent_from_joint.push_back(pose.parent_from_joint[i]);
    }
    below.parent_from_joint.front() = world[index(*hips)].rotation;
  }
  return out;
}

/// Adds a joint at the end of a bone that has none, so that the page draws the bone.
void add_end(Motion& motion, HumanBone bone, const glm::dvec3& end_in_joint) {
  Skeleton& skeleton = motion.skeleton;
  const auto joint = skeleton.find(bone);
  if (!joint) return;
  for (const Joint& other : skeleton.joints) {
    if (other.parent == *joint) return;
  }
  Joint end;
  end.name = std::string(name(bone)) + " end";
  end.parent = *joint;
  end.parent_from_joint.translation = end_in_joint;
  skeleton.joints.push_back(std::move(end));
  for (Pose& pose : motion.poses) pose.parent_from_joint.emplace_back(1.0, 0.0, 0.0, 0.0);
}

/// Adds the ends of head and hands, which motion objects do not have. Sizes of an average
/// adult, as shares of the body's own lengths.
void add_ends(Motion& motion) {
  constexpr double kHeadShare = 0.13;  // Base to top of the skull; height of the base.
  constexpr double kHandShare = 0.6;   // Wrist to fingertips; forearm.
  const Skeleton& skeleton = motion.skeleton;
  const auto rest = world_from_joints(skeleton, rest_pose(skeleton));
  if (const auto head = skeleton.find(HumanBone::kHead)) {
    double low_m = rest[index(*head)].translation.y;
    const double high_m = low_m;
    for (const RigidTransform& joint : rest) low_m = std::min(low_m, joint.translation.y);
    add_end(motion, HumanBone::kHead, {0.0, kHeadShare * (high_m - low_m), 0.0});
  }
  for (const HumanBone bone : {HumanBone::kLeftHand, HumanBone::kRightHand}) {
    const auto hand = motion.skeleton.find(bone);
    if (!hand) continue;
    // Axes at rest are parallel to the world's.
    const glm::dvec3 forearm = motion.skeleton[*hand].parent_from_joint.translation;
    add_end(motion, bone, kHandShare * forearm);
  }
}

/// Keeps every `step`th pose.
void thin_out(Motion& motion, int step) {
  if (step == 1) return;
  std::vector<Pose> kept;
  for (std::size_t i = 0; i < motion.poses.size(); i += static_cast<std::size_t>(step)) {
    kept.push_back(std::move(motion.poses[i]));
  }
  motion.poses = std::move(kept);
  motion.rate.hz /= step;
}

/// Returns the motion from the start of its part on, `speed` times as fast, at `rate`.
Motion from_its_part(const ComparedMotion& other, double speed, FrameRate rate) {
  Motion out = from_hips(other.motion);
  const auto last = static_cast<long>(out.poses.size()) - 1;
  const long first = std::clamp(std::lround(other.start_s * out.rate.hz), 0L, last);
  out.poses.erase(out.poses.begin(), out.poses.begin() + first);
  out.first_frame = 0;
  out.rate.hz *= speed;
  return resample(out, rate);
}

ViewedFigure figure_of(std::string name, live::PageSkeletonKind kind, Motion motion) {
  // A body that cannot be mapped, which no build accepts, stays at its place.
  const auto map = retarget::map_body(motion.skeleton);
  if (map) library::start_at_origin(motion, *map);
  add_ends(motion);
  return {.name = std::move(name), .kind = kind, .motion = std::move(motion)};
}

}  // namespace

Result<ClipScene> make_clip_scene(const std::string& name,
                                  const Motion& clip,
                                  double compared_s,
                                  std::span<const ComparedMotion> others,
                                  std::size_t first_media) {
  ClipScene out;
  Motion shown = from_hips(clip);
  shown.first_frame = 0;
  out.frame_step = static_cast<int>((clip.poses.size() - 1) / kMaxSceneFrames) + 1;
  thin_out(shown, out.frame_step);
  ViewedRecording recording;
  recording.title = name;
  recording.rate = shown.rate;
  recording.frames = static_cast<int>(shown.poses.size());
  recording.figures.push_back(
      figure_of(name, live::PageSkeletonKind::kPerformer, std::move(shown)));
  for (const ComparedMotion& one : others) {
    // The search stretches at most twofold, and rounds to 0.1 s.
    const bool has_part = compared_s > 0.0 && one.end_s > one.start_s;
    const double speed =
        has_part ? std::clamp((one.end_s - one.start_s) / compared_s, 0.4, 2.5) : 1.0;
    recording.figures.push_back(figure_of(one.name,
                                          live::PageSkeletonKind::kMotion,
                                          from_its_part(one, speed, recording.rate)));
  }
  auto page = page_of_recording(recording, first_media);
  if (!page) return page.error();
  out.page = *std::move(page);
  return out;
}

}  // namespace marey::app
