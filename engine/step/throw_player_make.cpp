// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/step/throw_player.h"
#include <glm/geometric.hpp>

// Requests of throws, their checks, and answers about them.

namespace marey::engine {
namespace {

constexpr double kMeasured_s = 1e-3;

bool is_finite_place(const glm::dvec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

Error throw_error(const ThrowWish& wish, std::string cause, std::string next) {
  return bad_input(
      "action \"" + wish.action.clip + "\"", std::move(cause), std::move(next));
}

std::optional<Error> check_throw_wish(const ThrowWish& wish) {
  if (wish.side != 0 && wish.side != 1) {
    return throw_error(wish,
                       "there is no hand " + std::to_string(wish.side),
                       "give 0 for the left hand or 1 for the right one");
  }
  if (wish.aim_in_world && !is_finite_place(*wish.aim_in_world)) {
    return throw_error(wish, "the aim is not finite", "give a point in metres");
  }
  if (wish.aim_in_world && (wish.asked.azimuth_rad || wish.asked.elevation_rad)) {
    return throw_error(wish,
                       "it has both an aim and a direction",
                       "give the aim, or azimuth and elevation");
  }
  if (wish.ball_in_hand_m && !is_finite_place(*wish.ball_in_hand_m)) {
    return throw_error(
        wish, "the ball's place in the hand is not finite", "give metres from the wrist");
  }
  const auto is_within = [](double x, double min, double max) {
    return std::isfinite(x) && x >= min && x <= max;
  };
  if (!is_within(wish.ball.gravity_m_s2, 0.0, 1e3) ||
      !is_within(wish.ball.drag_1_m, 0.0, 1e3) ||
      !is_within(wish.ball.max_time_s, 1e-3, 60.0)) {
    return throw_error(wish,
                       "an option of the ball is negative or not finite",
                       "give gravity and drag of 0 or more, and at most 60 s");
  }
  if (!is_within(wish.half_width_s, 0.05, 5.0)) {
    return throw_error(
        wish, "the half width is not in [0.05, 5] s", "give 0.35 s, for example");
  }
  return std::nullopt;
}

}  // namespace

ThrowPlayer::ThrowPlayer(const Skeleton& skeleton, const retarget::BodyMap& map)
    : skeleton_(&skeleton), map_(&map), rehearsal_(skeleton, map) {}

Result<ThrowPlayer> ThrowPlayer::make(const MotionBase& base,
                                      const Action& action,
                                      const ThrowWish& wish,
                                      const Skeleton& skeleton,
                                      const retarget::BodyMap& map) {
  if (const auto error = check_throw_wish(wish)) return *error;
  const MotionClip& clip = base.clip(action.clip);
  if (const Status good = check_throw(wish.asked, clip.duration_s()); !good) {
    return good.error();
  }
  const auto event =
      std::find_if(clip.notes.begin(), clip.notes.end(), [&](const Annotation& note) {
        return note.text == wish.release;
      });
  if (event == clip.notes.end()) {
    return throw_error(wish,
                       "the clip has no event \"" + wish.release + "\"",
                       "add it with the operation event of marey edit");
  }
  ThrowPlayer out(skeleton, map);
  out.action_ = action.id;
  out.wish_ = wish;
  out.rate_ = action.rate;
  out.event_s_ = event->start_s;
  out.lengths_ = reach_lengths(skeleton, map, wish.side);
  out.palm_in_t_pose_ = out.lengths_.palm_m *
                        map.limbs[static_cast<std::size_t>(wish.side)]->along_in_t_pose;
  out.lever_m_ = wish.ball_in_hand_m.value_or(out.palm_in_t_pose_);
  out.measure_captured(clip, base.layout());
  const ThrowParameters wanted = with_changes(out.captured_, wish.asked);
  const double entry_s = action.entry_s.value_or(0.0);
  const double mean_rate = (out.event_s_ - entry_s) / (wanted.release_s - entry_s);
  if (!(mean_rate * action.rate >= kMinWarpRate &&
        mean_rate * action.rate <= kMaxWarpRate)) {
    return throw_error(wish,
                       "the clip cannot be played so that the ball leaves at " +
                           std::to_string(wanted.release_s) + " s",
                       "give an instant nearer to that of the clip");
  }
  out.course_.start(0.0, out.captured_, wish.asked, wish.half_width_s);
  out.course_.want(wanted);
  return out;
}

void ThrowPlayer::measure_captured(const MotionClip& clip, const PostureLayout& layout) {
  std::array<RigidTransform, 3> wrist;
  for (std::size_t k = 0; k < 3; ++k) {
    rehearsal_.sample(event_s_ - kMeasured_s * static_cast<double>(2 - k), clip, layout);
    wrist[k] = posed_wrist(rehearsal_.joints(), *map_, wish_.side);
  }
  const auto joints = rehearsal_.joints();
  ThrowInstant instant;
  instant.wrist = hand_motion_until(wrist[0], wrist[1], wrist[2], kMeasured_s);
  instant.root = posed_root(joints, *map_);
  instant.lever_in_hand_m = lever_m_;
  captured_ = measure_throw(instant, event_s_);
  captured_root_ = instant.root;
  captured_wrist_ = wrist[2];
  captured_shoulder_ =
      joints[index(map_->limbs[static_cast<std::size_t>(wish_.side)]->upper)].translation;
  captured_hips_ = joints[index(map_->hips())].translation;
}

Status ThrowPlayer::aim(const glm::dvec3& p_in_world) {
  if (!wish_.aim_in_world) {
    return throw_error(wish_, "the throw has no aim", "request it with an aim");
  }
  if (!is_finite_place(p_in_world)) {
    return throw_error(wish_, "the aim is not finite", "give a point in metres");
  }
  if (result_ || phase_ == Phase::kOver) {
    return throw_error(wish_, "the ball has left the hand", "request another throw");
  }
  wish_.aim_in_world = p_in_world;
  return Done{};
}

ThrowFeasibility ThrowPlayer::ask(const RootPlace& root,
                                  const Action& action,
                                  double step_s) const {
  ThrowFeasibility out;
  out.captured = captured_;
  out.wanted = course_.wanted();
  const glm::dquat turn =
      glm::angleAxis(captured_root_.heading_rad, glm::dvec3(0.0, 1.0, 0.0));
  const glm::dvec3 wrist = glm::dvec3(captured_root_.x_m, 0.0, captured_root_.z_m) +
                           turn * out.wanted.wrist_in_heading_m;
  ReachLengths arm = lengths_;
  arm.palm_m = 0.0;
  const ReachBall ball =
      reach_ball(arm, ReachShare{}, captured_hips_, captured_shoulder_, wrist);
  out.missing_m =
      std::max(0.0, glm::distance(wrist, ball.centre_in_world) - ball.radius_m);
  const double entry_s = action.entry_s.value_or(0.0);
  out.duration_s = std::max(0.0, out.wanted.release_s - entry_s) / action.rate;
  out.steps = static_cast<int>(std::ceil(out.duration_s / step_s - 1e-9));
  if (wish_.aim_in_world) {
    // The clip's path from its start is added to the present place.
    const RootPlace there = moved(root, captured_root_);
    const glm::dquat heading =
        glm::angleAxis(there.heading_rad, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 from =
        glm::dvec3(there.x_m, 0.0, there.z_m) + heading * out.wanted.wrist_in_heading_m;
    const auto aim =
        aim_ball(from, *wish_.aim_in_world, out.wanted.speed_m_s, wish_.ball, wish_.arc);
    out.aim_in_range = aim.has_value();
    if (aim) {
      out.wanted.azimuth_rad =
          std::remainder(aim->azimuth_rad - there.heading_rad, 6.283185307179586);
      out.wanted.elevation_rad = aim->elevation_rad;
    }
  }
  out.reachable = out.missing_m <= 1e-3 && out.aim_in_range;
  return out;
}

}  // namespace marey::engine
