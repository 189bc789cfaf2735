// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/body_map.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/pose.h"
#include "retarget/body/foot_shape.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

// Minimum length of a bone that has a direction. [m]
constexpr double kMinBoneLength_m = 1e-6;
// Minimum share of the curve for coinciding vertebrae, so that none is lost. It is a
// share of the whole, so that bodies of all sizes divide the curve equally.
constexpr double kMinVertebra = 2e-3;
// Toe joint from ankle in leg lengths, after average_proportions().
constexpr double kFootLengthInLegs = 0.16;
constexpr double kAnkleHeightInLegs = 0.08;
constexpr double kBallHeightInLegs = 0.024;

struct BodyMapBuilder {
  const Skeleton& skeleton;
  std::vector<RigidTransform> world_from_joint;  // At rest.
  BodyMap map;

  [[nodiscard]] glm::dvec3 place(JointIndex joint) const {
    return world_from_joint[index(joint)].translation;
  }
  [[nodiscard]] std::optional<JointIndex> joint(B bone) const {
    return map.joint_of[index(bone)];
  }
};

Error bad_body(std::string cause, std::string next) {
  return bad_input("skeleton", std::move(cause), std::move(next));
}

void drive(BodyMapBuilder& b, JointIndex joint, JointRole role, const glm::dquat& align) {
  JointDrive& drive = b.map.joints[index(joint)];
  drive.role = role;
  drive.t_pose_from_joint =
      glm::normalize(align * b.world_from_joint[index(joint)].rotation);
}

Status find_bones(BodyMapBuilder& b) {
  const auto& joints = b.skeleton.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].bone) continue;
    auto& slot = b.map.joint_of[index(*joints[i].bone)];
    if (slot) {
      return bad_body("two joints are marked " + std::string(name(*joints[i].bone)),
                      "mark only one of them");
    }
    slot = JointIndex{static_cast<int>(i)};
  }
  for (const B bone : {B::kHips,
                       B::kLeftUpperLeg,
                       B::kLeftLowerLeg,
                       B::kLeftFoot,
                       B::kRightUpperLeg,
                       B::kRightLowerLeg,
                       B::kRightFoot}) {
    if (!b.joint(bone)) {
      return bad_body("no joint is marked " + std::string(name(bone)),
                      "map the bone to one of the skeleton's joints");
    }
  }
  return Done{};
}

void drive_segments(BodyMapBuilder& b) {
  for (const B bone : human_bones()) {
    const auto joint = b.joint(bone);
    if (!joint) continue;
    drive(b, *joint, JointRole::kSegment, glm::dquat(1, 0, 0, 0));
    b.map.joints[index(*joint)].bone = bone;
  }
}

Status map_limb(BodyMapBuilder& b, int which) {
  const HumanLimb& limb = human_limbs()[static_cast<std::size_t>(which)];
  const auto upper = b.joint(limb.upper);
  const auto lower = b.joint(limb.lower);
  const auto end = b.joint(limb.end);
  if (!upper || !lower || !end) return Done{};
  const glm::dvec3 upper_bone = b.place(*lower) - b.place(*upper);
  const glm::dvec3 lower_bone = b.place(*end) - b.place(*lower);
  LimbMap m;
  m.upper = *upper;
  m.lower = *lower;
  m.end = *end;
  m.upper_length_m = glm::length(upper_bone);
  m.lower_length_m = glm::length(lower_bone);
  if (m.upper_length_m < kMinBoneLength_m || m.lower_length_m < kMinBoneLength_m) {
    return bad_body("the limb of " + std::string(name(limb.upper)) + " has no length",
                    "mark joints that lie apart");
  }
  const double side = which % 2 == 0 ? 1.0 : -1.0;
  m.along_in_t_pose = which < 2 ? glm::dvec3(side, 0, 0) : glm::dvec3(0, -1, 0);
  m.hinge_in_t_pose = limb.hinge_axis;

  const glm::dquat align_upper = rotation_between(upper_bone, m.along_in_t_pose);
  const glm::dquat align_lower =
      rotation_between(align_upper * lower_bone, m.along_in_t_pose) * align_upper;
  drive(b, *upper, JointRole::kLimbBone, align_upper);
  drive(b, *lower, JointRole::kLimbBone, align_lower);
  b.map.joints[index(*upper)].limb = which;
  b.map.joints[index(*lower)].limb = which;
  if (which < 2) drive(b, *end, JointRole::kSegment, align_lower);
  b.map.limbs[static_cast<std::size_t>(which)] = m;
  return Done{};
}

// Returns the height of the floor, from the lowest point of the feet at rest. A BVH often
// rests with its root at the origin, and its floor is then nowhere near Y = 0.
double rest_floor_m(const BodyMapBuilder& b) {
  double lowest = b.place(*b.joint(B::kLeftFoot)).y;
  for (const B bone : {B::kLeftFoot, B::kLeftToes, B::kRightFoot, B::kRightToes}) {
    const auto joint = b.joint(bone);
    if (!joint) continue;
    lowest = std::min(lowest, b.place(*joint).y);
    if (const auto& tip = b.skeleton[*joint].tip_in_joint) {
      lowest = std::min(lowest, (b.world_from_joint[index(*joint)] * *tip).y);
    }
  }
  const double leg = b.map.leg_length_m;
  if (lowest > -0.005 * leg && lowest < 0.15 * leg) return 0.0;
  const bool has_toes = b.joint(B::kLeftToes) || b.joint(B::kRightToes);
  return lowest - (has_toes ? kBallHeightInLegs : kAnkleHeightInLegs) * leg;
}

// Sets the end of the sole, that of an average foot if no tip is given.
void map_sole(const BodyMapBuilder& b,
              const std::optional<JointIndex>& toes,
              const glm::dquat& align,
              FootMap& foot) {
  const glm::dvec3 ball = foot.ball_from_ankle_in_t_pose;
  constexpr double kMinTip_m = 1e-6;
  const double length_m = glm::length(glm::dvec2(ball.x, ball.z));
  foot.heel_from_ankle_in_t_pose = {
      0.0, -foot.ankle_height_m, -kBearingHeelInBall * length_m};
  glm::dvec3 tip(0.0, 0.0, kToesInBall * length_m);
  if (toes && b.skeleton[*toes].tip_in_joint) {
    const RigidTransform& at = b.world_from_joint[index(*toes)];
    const glm::dvec3 given =
        align * (at * *b.skeleton[*toes].tip_in_joint - at.translation);
    // A tip at its joint carries no information: files without a tip write it so.
    if (glm::length(glm::dvec2(given.x, given.z)) > kMinTip_m) tip = given;
  }
  foot.tip_from_ball_in_t_pose = {tip.x, -foot.ball_height_m, tip.z};
}

void map_foot(BodyMapBuilder& b, int side, double floor_m) {
  const JointIndex ankle = *b.joint(side == 0 ? B::kLeftFoot : B::kRightFoot);
  const auto toes = b.joint(side == 0 ? B::kLeftToes : B::kRightToes);
  FootMap& foot = b.map.feet[static_cast<std::size_t>(side)];
  foot.ankle_height_m = b.place(ankle).y - floor_m;
  glm::dquat align(1, 0, 0, 0);
  foot.ball_from_ankle_in_t_pose = {
      0, -foot.ankle_height_m, kFootLengthInLegs * b.map.leg_length_m};
  if (toes) {
    const glm::dvec3 bone = b.place(*toes) - b.place(ankle);
    const glm::dvec3 flat(bone.x, 0.0, bone.z);
    // A foot that rests pointing straight down has no heading to correct.
    if (glm::length(flat) > 0.2 * glm::length(bone) && flat.z > 0.0) {
      align = rotation_between(flat, {0, 0, 1});
    }
    foot.has_toes = true;
    foot.ball_height_m = b.place(*toes).y - floor_m;
    foot.ball_from_ankle_in_t_pose = align * bone;
    drive(b, *toes, JointRole::kSegment, align);
  }
  map_sole(b, toes, align, foot);
  drive(b, ankle, JointRole::kSegment, align);
}

// Returns the joints from just above the hips to just below the neck base, low to high.
std::vector<JointIndex> vertebrae(const BodyMapBuilder& b) {
  auto top = b.joint(B::kNeck);
  if (!top) top = b.joint(B::kHead);
  // Without neck and head, the highest marked vertebra ends the spine.
  bool keep_top = false;
  for (const B bone : {B::kUpperChest, B::kChest, B::kSpine}) {
    if (!top && b.joint(bone)) {
      top = b.joint(bone);
      keep_top = true;
    }
  }
  std::vector<JointIndex> chain;
  if (!top) return chain;
  auto joint = keep_top ? top : b.skeleton[*top].parent;
  while (joint && *joint != b.map.hips()) {
    chain.push_back(*joint);
    joint = b.skeleton[*joint].parent;
  }
  if (!joint) chain.clear();  // The neck is not below the hips.
  std::reverse(chain.begin(), chain.end());
  return chain;
}

void fill_section(BodyMapBuilder& b,
                  const std::vector<JointIndex>& chain,
                  const std::vector<double>& end_m,
                  std::size_t from,
                  std::size_t to,
                  const std::optional<JointIndex>& top,
                  SpineSection& section) {
  section.count = static_cast<int>(to - from);
  const double start = from == 0 ? 0.0 : end_m[from - 1];
  const double length = to > from ? end_m[to - 1] - start : 1.0;
  for (std::size_t i = from; i < to; ++i) {
    const auto next = i + 1 < chain.size() ? std::optional(chain[i + 1]) : top;
    section.joints[i - from] = chain[i];
    section.at[i - from] = (end_m[i] - start) / length;
    if (next) section.bone_in_t_pose[i - from] = b.place(*next) - b.place(chain[i]);
  }
}

// Returns the arc length at the far end of each joint of a chain that ends at `top`.
std::vector<double> arc_ends_m(const BodyMapBuilder& b,
                               const std::vector<JointIndex>& chain,
                               const std::optional<JointIndex>& top) {
  std::vector<double> end_m;
  double whole_m = 0.0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const auto next = i + 1 < chain.size() ? std::optional(chain[i + 1]) : top;
    end_m.push_back(next ? glm::length(b.place(*next) - b.place(chain[i])) : 0.0);
    whole_m += end_m.back();
  }
  const double min_m = kMinVertebra * (whole_m > kMinBoneLength_m ? whole_m : 1.0);
  double sum_m = 0.0;
  for (double& end : end_m) {
    sum_m += std::max(end, min_m);
    end = sum_m;
  }
  return end_m;
}

// Sets the points that the last vertebra carries: neck, collar bones, or arms without
// collar bones.
void map_girdle(const BodyMapBuilder& b,
                JointIndex last,
                JointIndex top,
                SpineLine& spine) {
  std::vector<glm::dvec3> places{b.place(top)};
  for (const B bone :
       {B::kLeftShoulder, B::kRightShoulder, B::kLeftUpperArm, B::kRightUpperArm}) {
    const auto joint = b.joint(bone);
    if (joint && b.skeleton[*joint].parent == last) places.push_back(b.place(*joint));
  }
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& place : places)
    mean += place / static_cast<double>(places.size());
  double squares = 0.0;
  for (const glm::dvec3& place : places) squares += glm::dot(place - mean, place - mean);
  spine.girdle_in_t_pose = mean - b.place(last);
  spine.girdle_radius_m = std::sqrt(squares / static_cast<double>(places.size()));
}

void map_spine_line(BodyMapBuilder& b,
                    const std::vector<JointIndex>& chain,
                    const std::vector<double>& end_m,
                    std::size_t split,
                    JointIndex top) {
  SpineLine spine;
  spine.hips_bone_in_t_pose = b.place(chain[0]) - b.place(b.map.hips());
  const double first_m = glm::length(spine.hips_bone_in_t_pose);
  spine.length_m = first_m + end_m.back();
  const double below_m = split > 0 ? end_m[split - 1] : 0.0;
  spine.shares = {first_m / spine.length_m, (first_m + below_m) / spine.length_m};
  map_girdle(b, chain.back(), top, spine);
  b.map.spine = spine;
}

Status map_spine(BodyMapBuilder& b) {
  const std::vector<JointIndex> chain = vertebrae(b);
  if (chain.empty()) return Done{};
  auto top = b.joint(B::kNeck);
  if (!top) top = b.joint(B::kHead);
  const std::vector<double> end_m = arc_ends_m(b, chain, top);
  std::size_t split = chain.size() / 2;
  const auto chest = b.joint(B::kChest);
  const auto at = chest ? std::find(chain.begin(), chain.end(), *chest) : chain.end();
  if (at != chain.end()) split = static_cast<std::size_t>(at - chain.begin());
  constexpr auto kMax = static_cast<std::size_t>(kMaxVertebrae);
  if (split > kMax || chain.size() - split > kMax) {
    return bad_body("the spine has " + std::to_string(chain.size()) + " vertebrae",
                    "use a skeleton with at most " + std::to_string(kMaxVertebrae) +
                        " below and above the chest");
  }
  fill_section(b, chain, end_m, 0, split, top, b.map.abdomen);
  fill_section(b, chain, end_m, split, chain.size(), top, b.map.torso);
  for (const JointIndex vertebra : chain) {
    drive(b, vertebra, JointRole::kVertebra, glm::dquat(1, 0, 0, 0));
  }
  if (top) map_spine_line(b, chain, end_m, split, *top);
  return Done{};
}

// Sets the joints from the neck to just below the head.
void map_neck(BodyMapBuilder& b) {
  const auto neck = b.joint(B::kNeck);
  const auto head = b.joint(B::kHead);
  if (!neck || !head) return;
  std::vector<JointIndex> chain;
  auto joint = b.skeleton[*head].parent;
  while (joint && *joint != *neck) {
    if (b.map.joints[index(*joint)].role != JointRole::kFree) return;
    chain.push_back(*joint);
    joint = b.skeleton[*joint].parent;
  }
  chain.push_back(*neck);
  if (!joint || chain.size() > static_cast<std::size_t>(kMaxVertebrae)) return;
  std::reverse(chain.begin(), chain.end());
  for (std::size_t i = 1; i < chain.size(); ++i) {
    drive(b, chain[i], JointRole::kNeck, glm::dquat(1, 0, 0, 0));
  }
  fill_section(b, chain, arc_ends_m(b, chain, head), 0, chain.size(), head, b.map.neck);
}

}  // namespace

Result<BodyMap> map_body(const Skeleton& skeleton) {
  if (skeleton.joints.empty()) {
    return bad_body("it has no joints", "choose a file with a skeleton");
  }
  BodyMapBuilder b{skeleton, world_from_joints(skeleton, rest_pose(skeleton)), {}};
  b.map.joints.resize(skeleton.joints.size());
  if (const Status found = find_bones(b); !found) return found.error();
  drive_segments(b);
  for (int limb = 0; limb < 4; ++limb) {
    if (const Status mapped = map_limb(b, limb); !mapped) return mapped.error();
  }
  b.map.leg_length_m = 0.5 * (b.map.leg(0).length_m() + b.map.leg(1).length_m());
  const int arms = (b.map.limbs[0] ? 1 : 0) + (b.map.limbs[1] ? 1 : 0);
  for (std::size_t i = 0; i < 2; ++i) {
    if (b.map.limbs[i]) b.map.arm_length_m += b.map.limbs[i]->length_m() / arms;
  }
  b.map.hip_drop_m = b.place(b.map.hips()).y - 0.5 * (b.place(b.map.leg(0).upper).y +
                                                      b.place(b.map.leg(1).upper).y);
  const double floor_m = rest_floor_m(b);
  for (int side = 0; side < 2; ++side) map_foot(b, side, floor_m);
  if (const Status mapped = map_spine(b); !mapped) return mapped.error();
  map_neck(b);
  return std::move(b.map);
}

}  // namespace marey::retarget
