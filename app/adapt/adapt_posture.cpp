// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_posture.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "app/adapt/frame_time.h"
#include "core/base/format_text.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/constraints/activation.h"
#include "retarget/constraints/resolve_segment.h"
#include "retarget/feet/floor_at.h"

namespace marey::app {
namespace {

using Frames = std::vector<RigidTransform>;

/// Returns the unit vector from mid-hip to the neck, else to the head; zero without
/// either.
glm::dvec3 trunk_of(const retarget::BodyMap& map, const Frames& world) {
  for (const HumanBone bone : {HumanBone::kNeck, HumanBone::kHead}) {
    const auto& top = map.joint_of[index(bone)];
    if (!top) continue;
    const glm::dvec3 hips = 0.5 * (world[index(map.leg(0).upper)].translation +
                                   world[index(map.leg(1).upper)].translation);
    const glm::dvec3 way = world[index(*top)].translation - hips;
    const double length_m = glm::length(way);
    return length_m > 1e-6 ? way / length_m : glm::dvec3(0.0);
  }
  return glm::dvec3(0.0);
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

void measure_trunk(const glm::dvec3& was,
                   const glm::dvec3& is,
                   int frame,
                   AdaptPosture& out) {
  const glm::dvec3 up(0.0, 1.0, 0.0);
  if (was == glm::dvec3(0.0) || is == glm::dvec3(0.0)) return;
  const double source_deg = degrees_between(was, up);
  if (source_deg > kUprightTrunk_deg) return;
  const double tilt_deg = degrees_between(is, up);
  if (tilt_deg > kUpsideDown_deg && degrees_between(was, is) > kTurnedTrunk_deg) {
    ++out.upside_down_frames;
  }
  if (out.tilt_frame && tilt_deg <= out.trunk_tilt_deg) return;
  out.trunk_tilt_deg = tilt_deg;
  out.source_tilt_deg = source_deg;
  out.tilt_frame = frame;
}

/// Returns the deepest bone and its depth below the floor [m]; negative above it.
std::pair<double, JointIndex> deepest(const retarget::BodyMap& map,
                                      const Frames& world,
                                      const StandingFloor& floor,
                                      double time_s) {
  std::pair<double, JointIndex> out{-1e9, map.hips()};
  for (const HumanBone bone : human_bones()) {
    const auto& joint = map.joint_of[index(bone)];
    if (!joint) continue;
    const glm::dvec3& p = world[index(*joint)].translation;
    const double ground_m =
        floor.height_m + retarget::floor_at(floor.floor, {p.x, p.z}, time_s).height_m;
    if (ground_m - p.y > out.first) out = {ground_m - p.y, *joint};
  }
  return out;
}

/// Returns the constraints that are active at a time, those of this joint's limb first.
std::string active_targets(const ConstraintSet& constraints,
                           const Motion& motion,
                           int frame,
                           std::optional<JointIndex> joint) {
  std::vector<std::string> own;
  std::vector<std::string> others;
  for (const Constraint& c : constraints.constraints) {
    if (std::holds_alternative<Support>(c.goal)) continue;
    if (retarget::activation(c.activation, frame_time_s(motion, frame)) <= 0.0) continue;
    auto at = retarget::resolve_segment(motion.skeleton, c.point.segment);
    while (at && joint && *at != *joint) at = motion.skeleton[*at].parent;
    (joint && at ? own : others).push_back("\"" + c.id + "\"");
  }
  constexpr std::size_t kNamed = 3;
  std::string text;
  const auto& named = own.empty() ? others : own;
  for (std::size_t i = 0; i < named.size() && i < kNamed; ++i) {
    text += (i == 0 ? "" : ", ") + named[i];
  }
  if (named.size() > kNamed) text += " and others";
  return text.empty() ? "no constraint is active there" : "for " + text;
}

}  // namespace

AdaptPosture measure_adapt_posture(const Motion& source,
                                   const Motion& adapted,
                                   const retarget::BodyMap& map,
                                   const StandingFloor& floor) {
  AdaptPosture out;
  Frames was(source.skeleton.joints.size());
  Frames is(adapted.skeleton.joints.size());
  for (std::size_t t = 0; t < source.poses.size(); ++t) {
    world_from_joints(source.skeleton, source.poses[t], was);
    world_from_joints(adapted.skeleton, adapted.poses[t], is);
    const int frame = static_cast<int>(t);
    measure_trunk(trunk_of(map, was), trunk_of(map, is), frame, out);
    const double time_s = frame_time_s(adapted, frame);
    const double before_m = deepest(map, was, floor, time_s).first;
    const auto [depth_m, joint] = deepest(map, is, floor, time_s);
    const double beyond_mm = 1e3 * (depth_m - std::max(0.0, before_m));
    if (beyond_mm <= out.depth_mm) continue;
    out.depth_mm = beyond_mm;
    out.joint = joint;
    out.depth_frame = frame;
  }
  return out;
}

nlohmann::ordered_json posture_json(const AdaptPosture& posture, const Motion& motion) {
  nlohmann::ordered_json out{{"upside_down_frames", posture.upside_down_frames},
                             {"below_floor_mm", posture.depth_mm}};
  if (posture.tilt_frame) {
    out["trunk_tilt_deg"] = posture.trunk_tilt_deg;
    out["source_tilt_deg"] = posture.source_tilt_deg;
    out["tilt_frame"] = *posture.tilt_frame;
  }
  if (posture.depth_frame) {
    out["below_floor_joint"] = motion.skeleton[posture.joint].name;
    out["below_floor_frame"] = *posture.depth_frame;
  }
  return out;
}

std::optional<Finding> assess_posture(const std::string& where,
                                      const AdaptPosture& posture,
                                      const Motion& motion,
                                      const ConstraintSet& constraints) {
  const auto problem = [&](std::string cause, std::string next, bool is_poor) {
    return Finding{is_poor ? Severity::kPoor : Severity::kFair,
                   "posture",
                   where,
                   std::move(cause),
                   std::move(next)};
  };
  if (posture.upside_down_frames > 0) {
    const int frame = *posture.tilt_frame;
    return problem(
        format_text(
            "the trunk is upside down, %.0f degrees from upright (its source %.0f), "
            "in frame %d at %.2f s, and in %d frames in all, ",
            posture.trunk_tilt_deg,
            posture.source_tilt_deg,
            frame,
            frame_time_s(motion, frame),
            posture.upside_down_frames) +
            active_targets(constraints, motion, frame, std::nullopt),
        "move these targets nearer to the body and above the floor",
        true);
  }
  if (posture.depth_mm <= kDeepJoint_mm) return std::nullopt;
  const int frame = *posture.depth_frame;
  return problem(
      format_text(
          "%s is %.0f mm below the floor, where its source is not, in frame %d at "
          "%.2f s, ",
          motion.skeleton[posture.joint].name.c_str(),
          posture.depth_mm,
          frame,
          frame_time_s(motion, frame)) +
          active_targets(constraints, motion, frame, posture.joint),
      "move the target above the floor, or give a floor that is lower there with --floor",
      posture.depth_mm > kPoorJoint_mm);
}

}  // namespace marey::app
