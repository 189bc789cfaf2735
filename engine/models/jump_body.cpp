// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/jump_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dynamics/jumps/find_jumps.h"
#include "dynamics/jumps/plan_jump.h"
#include "dynamics/momentum/posed_masses.h"
#include "engine/clips/rig.h"
#include "engine/clips/sample_clip.h"
#include <glm/geometric.hpp>

#include "core/base/smooth_step.h"
#include "core/motion.h"
#include "retarget/body/body_track.h"
#include "retarget/body/normalized_skeleton.h"

namespace marey::engine {
namespace {

// Time before and after a contact in which a foot keeps part of its place.
constexpr double kFootFade_s = 0.1;
// Rounds in which root and legs are fitted to the centre of mass.
constexpr int kFitRounds = 4;

// The body in a clip at one time.
struct ClipPoser {
  const MotionClip* clip;
  const PostureLayout* layout;
  const Skeleton* skeleton;
  const retarget::BodyMap* map;
  RootPlace start;
  retarget::NormalizedPose normalized;
  std::vector<RigidTransform> joints;
  Pose pose;

  ClipPoser(const MotionClip& of,
            const PostureLayout& with,
            const Skeleton& on,
            const retarget::BodyMap& body)
      : clip(&of),
        layout(&with),
        skeleton(&on),
        map(&body),
        start(path_at(of, 0.0)),
        joints(on.joints.size()) {
    pose.parent_from_joint.resize(on.joints.size());
  }

  // Root in metres of this body, from the first frame.
  RootPlace root_at(double source_s) const {
    RootPlace root = relative(start, path_at(*clip, source_s));
    root.x_m *= map->leg_length_m;
    root.z_m *= map->leg_length_m;
    return root;
  }

  void put(double source_s, BlendPosture& posture) {
    sample_clip(*clip, source_s, posture);
    show(posture, root_at(source_s));
  }
  void show(const BlendPosture& posture, const RootPlace& root) {
    to_normalized(posture, *layout, root, map->leg_length_m, normalized);
    retarget::expand(normalized, *skeleton, *map, joints, pose);
  }
};

// Time of the plan at which an instant of the clip is shown.
double shown_at(const dynamics::JumpPlan& plan, double source_s, double end_s) {
  double low = 0.0;
  double high = end_s;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (plan.source_s(middle) < source_s ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void move_times(const dynamics::JumpPlan& plan, double end_s, MotionClip& clip) {
  const auto moved_time = [&](double source_s) {
    return shown_at(plan, source_s, end_s);
  };
  for (std::vector<ClipSpan>& spans : clip.contacts) {
    for (ClipSpan& span : spans) {
      span.start_s = static_cast<float>(moved_time(static_cast<double>(span.start_s)));
      span.end_s = static_cast<float>(moved_time(static_cast<double>(span.end_s)));
    }
    std::erase_if(spans, [](const ClipSpan& s) { return s.end_s - s.start_s < 1e-3F; });
  }
  for (Annotation& note : clip.notes) {
    note.start_s = moved_time(note.start_s);
    note.end_s = moved_time(note.end_s);
  }
}

// Share with which a foot is where the clip has it: 1 while it bears, faded before and
// after.
double foot_share(const MotionClip& clip, std::size_t side, double source_s) {
  double away_s = kFootFade_s;
  for (std::size_t part = 2 * side; part < 2 * side + 2; ++part) {
    for (const ClipSpan& span : clip.contacts[part]) {
      away_s = std::min(away_s,
                        std::max({0.0,
                                  static_cast<double>(span.start_s) - source_s,
                                  source_s - static_cast<double>(span.end_s)}));
    }
  }
  return 1.0 - smooth_step(away_s / kFootFade_s);
}

// Moves the ankle of a leg from its hip, in the heading frame. [legs]
void move_ankle(const Rig& rig,
                std::size_t side,
                const glm::dvec3& by_legs,
                BlendPosture& posture) {
  const std::size_t at = kLimbRotation + 2 + side;
  const glm::dquat now(static_cast<double>(posture.w[at]),
                       static_cast<double>(posture.x[at]),
                       static_cast<double>(posture.y[at]),
                       static_cast<double>(posture.z[at]));
  const double whole = rig.leg_legs[side];
  const double length = whole * std::cos(static_cast<double>(posture.fold_rad[2 + side]));
  const glm::dvec3 from = length * (now * glm::dvec3(0.0, 0.0, 1.0));
  const glm::dvec3 to = from + by_legs;
  const double wanted =
      std::clamp(glm::length(to), 0.2 * whole, std::max(length, 0.995 * whole));
  const glm::dvec3 axis = glm::cross(from, to);
  const double sine = glm::length(axis);
  glm::dquat turned = now;
  if (sine > 1e-12) {
    turned = glm::angleAxis(std::atan2(sine, glm::dot(from, to)), axis / sine) * now;
  }
  posture.w[at] = static_cast<float>(turned.w);
  posture.x[at] = static_cast<float>(turned.x);
  posture.y[at] = static_cast<float>(turned.y);
  posture.z[at] = static_cast<float>(turned.z);
  posture.fold_rad[2 + side] =
      static_cast<float>(std::acos(std::min(1.0, wanted / whole)));
}

Error jump_error(const MotionClip& clip, std::string cause, std::string next) {
  return bad_input("jump \"" + clip.name + "\"", std::move(cause), std::move(next));
}

}  // namespace

Result<std::shared_ptr<const JumpBody>> JumpBody::make(const MotionClip& clip,
                                                       const PostureLayout& layout,
                                                       const Character& character,
                                                       const retarget::BodyMap& map,
                                                       int jump) {
  if (clip.loops) {
    return jump_error(clip, "the clip is a loop", "use a clip that plays once");
  }
  if (!(dynamics::total_mass_kg(character.masses) > 0.0)) {
    return jump_error(
        clip, "the body has no masses", "make the character with make_character()");
  }
  Motion motion;
  motion.skeleton = character.skeleton;
  motion.rate = {static_cast<double>(clip.rate_hz)};
  ClipPoser poser(clip, layout, character.skeleton, map);
  BlendPosture posture;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    poser.put(static_cast<double>(i) / motion.rate.hz, posture);
    motion.poses.push_back(poser.pose);
  }
  const auto track = retarget::body_track(motion, map, character.masses);
  dynamics::FindJumpsOptions options;
  const double scale = map.leg_length_m / static_cast<double>(clip.leg_length_m);
  // The motion falls at the scaled rate.
  options.expected_fall_m_s2 = options.gravity_m_s2 * scale;
  const std::vector<dynamics::Jump> jumps = dynamics::find_jumps(track, options);
  if (jump < 0 || static_cast<std::size_t>(jump) >= jumps.size()) {
    return jump_error(clip,
                      "the clip has " + std::to_string(jumps.size()) +
                          " jumps on this body, not one of number " +
                          std::to_string(jump),
                      "choose a clip with a flight of at least 0.05 s");
  }
  auto reference =
      dynamics::JumpReference::make(track, jumps[static_cast<std::size_t>(jump)]);
  if (!reference) {
    return jump_error(clip,
                      "the captured push does not lead to the take-off",
                      "filter the motion, or cut it before the push");
  }
  std::shared_ptr<JumpBody> out(new JumpBody(layout, character, map));
  out->reference_ = std::make_unique<dynamics::JumpReference>(std::move(*reference));
  return std::shared_ptr<const JumpBody>(std::move(out));
}

Result<dynamics::JumpPlan> JumpBody::plan(const dynamics::JumpWish& wish,
                                          const dynamics::JumpTraits& traits) const {
  return dynamics::plan_jump(*reference_, wish, traits);
}

MotionClip JumpBody::planned_clip(const MotionClip& clip,
                                  const dynamics::JumpPlan& plan) const {
  MotionClip out = clip;
  const double hz = static_cast<double>(clip.rate_hz);
  const double last_s = clip.duration_s();
  const double end_s = last_s + plan.delay_s();
  const auto count =
      std::max<std::size_t>(2, static_cast<std::size_t>(end_s * hz + 1e-6) + 1);
  out.frames.resize(count);
  out.path.resize(count);
  out.leg_length_m = static_cast<float>(map_->leg_length_m);
  ClipPoser poser(clip, layout_, character_->skeleton, *map_);
  dynamics::PosedMasses posed;
  posed.from_com_m.resize(character_->masses.size());
  posed.world_from_mass.resize(character_->masses.size());
  const double legs = 1.0 / map_->leg_length_m;
  const Rig rig = make_rig(character_->skeleton, *map_);
  for (std::size_t k = 0; k < count; ++k) {
    const double time_s = static_cast<double>(k) / hz;
    const double source_s = std::clamp(plan.source_s(time_s), 0.0, last_s);
    BlendPosture captured;
    sample_clip(clip, source_s, captured);
    const RootPlace from = poser.root_at(source_s);
    const glm::dquat to_heading =
        glm::angleAxis(-from.heading_rad, glm::dvec3(0.0, 1.0, 0.0));
    const bool has_landed = plan.touchdown() && time_s >= plan.apex_s();
    const glm::dvec3 feet_by = has_landed ? plan.landing_moved_m() : glm::dvec3(0.0);
    const std::array<double, 2> shares{foot_share(clip, 0, source_s),
                                       foot_share(clip, 1, source_s)};
    glm::dvec3 by(0.0);
    RootPlace root = from;
    for (int round = 0; round < kFitRounds; ++round) {
      out.frames[k] = captured;
      out.frames[k].height_legs += static_cast<float>(legs * by.y);
      for (std::size_t side = 0; side < 2; ++side) {
        move_ankle(rig,
                   side,
                   (legs * shares[side]) * (to_heading * (feet_by - by)),
                   out.frames[k]);
      }
      root = {from.x_m + by.x, from.z_m + by.z, from.heading_rad};
      poser.show(out.frames[k], root);
      dynamics::place_masses_of_pose(
          character_->skeleton, character_->masses, poser.pose, poser.joints, posed);
      if (round + 1 < kFitRounds) by += plan.com_in_world(time_s) - posed.com_in_world;
    }
    out.path[k] = {static_cast<float>(legs * root.x_m),
                   static_cast<float>(legs * root.z_m),
                   static_cast<float>(root.heading_rad)};
  }
  move_times(plan, end_s, out);
  out.constraints = {};
  return out;
}

}  // namespace marey::engine
