// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/lift_skin.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/pose.h"
#include "retarget/base/smooth_cover.h"
#include "retarget/body/arm_shift.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

constexpr double kNoLift_m = 1e-9;
// Number of passes in which bearing feet stay in place. After them, skin that the legs of
// held feet keep in the floor rises with the feet.
constexpr int kPassesWithFeet = 4;
double allowed_at(std::span<const double> allowed_m, std::size_t t) {
  return allowed_m.empty() ? 0.0 : allowed_m[t];
}

double depth_of(const SkinLows& lows, SkinPart part, double allowed_m) {
  return std::max(0.0, -lows[index(part)] - allowed_m);
}

void keep_deeper(const SkinLows& lows,
                 double allowed_m,
                 std::size_t frame,
                 SkinDepth& deepest) {
  for (std::size_t p = 0; p < lows.size(); ++p) {
    const double depth_m = depth_of(lows, static_cast<SkinPart>(p), allowed_m);
    if (depth_m <= deepest.depth_m) continue;
    deepest = {depth_m, static_cast<SkinPart>(p), static_cast<int>(frame)};
  }
}

// Required rise of each movable part, frame by frame. [m]
struct Needs {
  std::vector<double> body;
  std::array<std::vector<double>, 2> shank;
  std::array<std::vector<double>, 2> foot;
  std::array<std::vector<double>, 2> hand;

  explicit Needs(std::size_t count)
      : body(count, 0.0), shank{body, body}, foot{body, body}, hand{body, body} {}
};

class Lifting {
 public:
  Lifting(const Skin& skin,
          const BodyMap& map,
          const Contacts& contacts,
          std::span<const double> allowed_m,
          const LiftSkinOptions& options,
          Motion& motion)
      : skin_(skin),
        map_(map),
        allowed_m_(allowed_m),
        options_(options),
        motion_(motion),
        world_from_joint_(motion.skeleton.joints.size()),
        rows_(motion.skeleton.joints.size()),
        lows_(motion.poses.size()),
        raised_(motion.poses.size()) {
    half_ = frames(0.5 * options.anticipation_s);
    half_foot_ = frames(0.5 * options.foot_anticipation_s);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto bears = frame_marks(contacts.feet[side].stance, motion.poses.size());
      pinned_[side] =
          smooth_cover(std::vector<double>(bears.begin(), bears.end()), half_);
    }
    for (std::size_t t = 0; t < motion.poses.size(); ++t) measure(t);
  }

  [[nodiscard]] SkinDepth deepest() const {
    SkinDepth deepest;
    for (std::size_t t = 0; t < lows_.size(); ++t) {
      keep_deeper(lows_[t], allowed_at(allowed_m_, t), t, deepest);
    }
    return deepest;
  }

  [[nodiscard]] Needs needs() const {
    Needs out(lows_.size());
    const double max_worn_m = options_.max_worn_in_legs * map_.leg_length_m;
    for (std::size_t t = 0; t < lows_.size(); ++t) {
      const auto depth_m = [&](SkinPart part) {
        const double m = depth_of(lows_[t], part, allowed_at(allowed_m_, t));
        return m > options_.slack_m ? m : 0.0;
      };
      for (const SkinPart part : lifting_parts()) {
        out.body[t] = std::max(out.body[t], depth_m(part));
      }
      const double worn_left_m = std::max(0.0, max_worn_m - raised_[t]);
      out.body[t] =
          std::max(out.body[t], std::min(depth_m(SkinPart::kWorn), worn_left_m));
      for (int side = 0; side < 2; ++side) {
        const auto s = static_cast<std::size_t>(side);
        out.shank[s][t] = depth_m(on_side(SkinPart::kLeftShank, side));
        out.foot[s][t] = depth_m(on_side(SkinPart::kLeftFoot, side));
        out.hand[s][t] = depth_m(on_side(SkinPart::kLeftHand, side));
      }
    }
    return out;
  }

  // Raises all parts that need it, over all frames. Unless feet are held, they rise with
  // the body.
  void raise(Needs needs, bool holds_feet, LiftSkinReport& report) {
    const std::size_t count = lows_.size();
    const std::vector<double> body = smooth_cover(needs.body, half_);
    std::array<std::vector<double>, 2> ankle;
    std::array<std::vector<double>, 2> wrist;
    for (std::size_t s = 0; s < 2; ++s) {
      // The rise of a foot or hand with the body reduces its own.
      const std::vector<double> shank = smooth_cover(needs.shank[s], half_);
      ankle[s].resize(count);
      for (std::size_t t = 0; t < count; ++t) {
        const double pinned = holds_feet ? pinned_[s][t] : 0.0;
        ankle[s][t] = (1.0 - pinned) * body[t] + pinned * std::min(shank[t], body[t]);
        needs.foot[s][t] = std::max(0.0, needs.foot[s][t] - ankle[s][t]);
        needs.hand[s][t] = std::max(0.0, needs.hand[s][t] - body[t]);
      }
      const std::vector<double> foot = smooth_cover(needs.foot[s], half_foot_);
      for (std::size_t t = 0; t < count; ++t) ankle[s][t] += foot[t];
      wrist[s] = smooth_cover(needs.hand[s], half_);
    }
    for (std::size_t t = 0; t < count; ++t) {
      const SkinLift lift{
          body[t], {ankle[0][t], ankle[1][t]}, {wrist[0][t], wrist[1][t]}};
      if (lift.is_zero()) continue;
      raised_[t] += body[t];
      report.max_root_m = std::max(report.max_root_m, raised_[t]);
      report.max_foot_m = std::max({report.max_foot_m, ankle[0][t], ankle[1][t]});
      lift_posture(
          motion_.skeleton, map_, lift, world_from_joint_, scratch_, motion_.poses[t]);
      measure(t);
    }
  }

 private:
  [[nodiscard]] int frames(double seconds) const {
    return static_cast<int>(
        std::lround(std::clamp(seconds * motion_.rate.hz,
                               1.0,
                               std::max(1.0, static_cast<double>(lows_.size())))));
  }

  void measure(std::size_t t) {
    world_from_joints(motion_.skeleton, motion_.poses[t], world_from_joint_);
    skin_.lows(world_from_joint_, 0.0, rows_, lows_[t]);
  }

  const Skin& skin_;
  const BodyMap& map_;
  std::span<const double> allowed_m_;
  const LiftSkinOptions& options_;
  Motion& motion_;
  std::vector<RigidTransform> world_from_joint_;
  std::vector<glm::dvec4> rows_;
  Pose scratch_;
  std::vector<SkinLows> lows_;
  std::vector<double> raised_;  // Rise of the root in each frame so far. [m]
  std::array<std::vector<double>, 2> pinned_;
  int half_ = 1;
  int half_foot_ = 1;
};

}  // namespace

std::span<const SkinPart> lifting_parts() {
  static constexpr std::array kParts{SkinPart::kHead,
                                     SkinPart::kTrunk,
                                     SkinPart::kLeftUpperArm,
                                     SkinPart::kLeftForearm,
                                     SkinPart::kLeftThigh,
                                     SkinPart::kLeftShank,
                                     SkinPart::kRightUpperArm,
                                     SkinPart::kRightForearm,
                                     SkinPart::kRightThigh,
                                     SkinPart::kRightShank};
  return kParts;
}

bool SkinLift::is_zero() const {
  return root_m < kNoLift_m && ankle_m[0] < kNoLift_m && ankle_m[1] < kNoLift_m &&
         wrist_m[0] < kNoLift_m && wrist_m[1] < kNoLift_m;
}

SkinDepth deepest_skin(const Motion& motion,
                       const Skin& skin,
                       std::span<const double> allowed_m) {
  MAREY_ASSERT(allowed_m.empty() || allowed_m.size() == motion.poses.size());
  SkinDepth deepest;
  SkinLows lows{};
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  std::vector<glm::dvec4> rows(world_from_joint.size());
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    world_from_joints(motion.skeleton, motion.poses[t], world_from_joint);
    const double allowed = allowed_at(allowed_m, t);
    skin.lows(world_from_joint, -allowed - deepest.depth_m, rows, lows);
    keep_deeper(lows, allowed, t, deepest);
  }
  return deepest;
}

void lift_posture(const Skeleton& body,
                  const BodyMap& map,
                  const SkinLift& lift,
                  std::span<RigidTransform> world_from_joint,
                  Pose& scratch,
                  Pose& pose) {
  world_from_joints(body, pose, world_from_joint);
  NormalizedPose posture;
  normalize(map, world_from_joint, posture, RootNormalization::kNone);
  const glm::dvec3 up(0.0, 1.0, 0.0);
  std::array<bool, 4> moved{};
  for (int side = 0; side < 2; ++side) {
    const auto s = static_cast<std::size_t>(side);
    if (map.limbs[s] && posture.limbs[s] && lift.wrist_m[s] > kNoLift_m) {
      const ArmPlaces now = arm_places(*map.limbs[s], world_from_joint);
      posture.limbs[s] = shifted_limb(
          *map.limbs[s], now, *posture.limbs[s], {lift.wrist_m[s] * up, 0.0});
      moved[s] = true;
    }
    const LimbMap& leg = map.leg(side);
    if (std::abs(lift.ankle_m[s] - lift.root_m) <= kNoLift_m) continue;
    const glm::dvec3 hip =
        world_from_joint[index(leg.upper)].translation + lift.root_m * up;
    const glm::dvec3 ankle =
        world_from_joint[index(leg.end)].translation + lift.ankle_m[s] * up;
    aim_leg(hip, ankle, leg.length_m(), *posture.limbs[2 + s]);
    moved[2 + s] = true;
  }
  pose.root_in_world.y += lift.root_m;
  if (std::ranges::find(moved, true) == moved.end()) return;
  posture.root += lift.root_m * up;
  expand(posture, body, map, world_from_joint, scratch);
  for (std::size_t limb = 0; limb < moved.size(); ++limb) {
    if (!moved[limb]) continue;
    const LimbMap& bones = *map.limbs[limb];
    for (const JointIndex joint : {bones.upper, bones.lower, bones.end}) {
      pose.parent_from_joint[index(joint)] = scratch.parent_from_joint[index(joint)];
    }
  }
}

LiftSkinReport lift_skin(const Skin& skin,
                         const BodyMap& map,
                         const Contacts& contacts,
                         std::span<const double> allowed_m,
                         const LiftSkinOptions& options,
                         Motion& motion) {
  MAREY_ASSERT(contacts.frame_count == static_cast<int>(motion.poses.size()));
  MAREY_ASSERT(allowed_m.empty() || allowed_m.size() == motion.poses.size());
  LiftSkinReport report;
  Lifting lifting(skin, map, contacts, allowed_m, options, motion);
  report.before = report.after = lifting.deepest();
  while (report.after.depth_m > options.slack_m && report.passes < options.max_passes) {
    lifting.raise(lifting.needs(), report.passes < kPassesWithFeet, report);
    report.after = lifting.deepest();
    ++report.passes;
  }
  return report;
}

}  // namespace marey::retarget
