// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/transition_rivals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "benchmarks/engine/heading_poses.h"
#include "core/base/assert.h"
#include "core/base/smooth_step.h"
#include "core/transform.h"

namespace marey {
namespace {

constexpr double kFade_s = 0.3;
constexpr double kInertialHalfLife_s = 0.1;
constexpr double kDeadHalfLife_s = 0.15;
constexpr double kEntry_s = 0.5;
constexpr double kLabelSmoothing_s = 0.06;
constexpr double kAnchorFade_s = 0.1;
constexpr double kLn2 = 0.69314718055994530942;

double mix(double a, double b, double share) {
  return a + (b - a) * share;
}

/// Value and rate of everything that is blended; rotations as vectors [rad].
struct PostureDifference {
  std::vector<glm::dvec3> rotations;
  double height_m = 0.0;
};

// The rotation from `b` to `a` the shorter way, joint by joint.
PostureDifference difference(const Pose& a, const Pose& b) {
  PostureDifference out;
  for (std::size_t j = 0; j < a.parent_from_joint.size(); ++j) {
    out.rotations.push_back(
        rotation_vector(a.parent_from_joint[j] * glm::conjugate(b.parent_from_joint[j])));
  }
  out.height_m = a.root_in_world.y - b.root_in_world.y;
  return out;
}

void add(PostureDifference& to, double scale, const PostureDifference& by) {
  for (std::size_t j = 0; j < to.rotations.size(); ++j) {
    to.rotations[j] += scale * by.rotations[j];
  }
  to.height_m += scale * by.height_m;
}

Pose moved_posture(const Pose& posture, double scale, const PostureDifference& by) {
  Pose out = posture;
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    out.parent_from_joint[j] = glm::normalize(
        rotation_from_vector(scale * by.rotations[j]) * out.parent_from_joint[j]);
  }
  out.root_in_world.y += scale * by.height_m;
  return out;
}

Pose mixed_postures(const Pose& a, const Pose& b, double share) {
  Pose out = a;
  out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, share);
  for (std::size_t j = 0; j < out.parent_from_joint.size(); ++j) {
    out.parent_from_joint[j] =
        glm::normalize(glm::slerp(a.parent_from_joint[j], b.parent_from_joint[j], share));
  }
  return out;
}

FloorStep mixed_steps(const FloorStep& a, const FloorStep& b, double share) {
  return {glm::mix(a.move_m, b.move_m, share), mix(a.turn_rad, b.turn_rad, share)};
}

/// One switch as a rival plays it. Frames k are counted from the switch.
class RivalPlayer {
 public:
  RivalPlayer(const SwitchCase& played, RivalMethod method);

  [[nodiscard]] Pose posture(int k) const;
  /// Movement of the root from frame k to the next one.
  [[nodiscard]] FloorStep step(int k) const;
  [[nodiscard]] TransitionFrame shown(int k) const;

 private:
  [[nodiscard]] const Pose& first(int k) const { return at(from_.postures, leave_ + k); }
  [[nodiscard]] const Pose& second(int k) const { return at(to_.postures, enter_ + k); }
  [[nodiscard]] double second_weight(double k) const;
  [[nodiscard]] Pose inertial_posture(int k) const;

  template <class T>
  static const T& at(const std::vector<T>& values, int frame) {
    const int last = static_cast<int>(values.size()) - 1;
    return values[static_cast<std::size_t>(std::clamp(frame, 0, last))];
  }

  RivalMethod method_;
  double hz_ = kTransitionRate_hz;
  int leave_ = 0;
  int enter_ = 0;
  HeadingClip from_;
  HeadingClip to_;
  PostureDifference gap_;       ///< First clip minus second one at the switch.
  PostureDifference gap_rate_;  ///< [1/s]
  PostureDifference velocity_;  ///< First clip at the switch. [1/s]
  FloorStep last_step_;         ///< First clip before the switch.
  FloorStep step_gap_;
};

int frame_at(double time_s) {
  return static_cast<int>(std::lround(time_s * kTransitionRate_hz));
}

RivalPlayer::RivalPlayer(const SwitchCase& played, RivalMethod method)
    : method_(method),
      leave_(frame_at(played.leave_s)),
      enter_(frame_at(played.enter_s)),
      from_(make_heading_clip(*played.from)),
      to_(make_heading_clip(*played.to)) {
  gap_ = difference(first(0), second(0));
  velocity_ = difference(first(0), first(-1));
  for (glm::dvec3& rotation : velocity_.rotations) rotation *= hz_;
  velocity_.height_m *= hz_;
  gap_rate_ = velocity_;
  add(gap_rate_, -hz_, difference(second(0), second(-1)));
  last_step_ = at(from_.steps, leave_ - 1);
  const FloorStep& other = at(to_.steps, enter_ - 1);
  step_gap_ = {last_step_.move_m - other.move_m, last_step_.turn_rad - other.turn_rad};
}

double decay_rate(double half_life_s) {
  return 2.0 * kLn2 / half_life_s;
}

double RivalPlayer::second_weight(double k) const {
  if (k <= 0.0) return 0.0;
  const double y = decay_rate(kInertialHalfLife_s);
  switch (method_) {
    case RivalMethod::kCut:
      return 1.0;
    case RivalMethod::kInertial:
      return 1.0 - (1.0 + y * k / hz_) * std::exp(-y * k / hz_);
    case RivalMethod::kCrossfade:
    case RivalMethod::kDead:
      break;
  }
  return smooth_step(k / hz_ / kFade_s);
}

Pose RivalPlayer::inertial_posture(int k) const {
  // Holden 2023: (x + (v + x y) t) e^(-y t).
  const double t_s = k / hz_;
  const double y = decay_rate(kInertialHalfLife_s);
  PostureDifference offset = gap_;
  add(offset, y * t_s, gap_);
  add(offset, t_s, gap_rate_);
  return moved_posture(second(k), std::exp(-y * t_s), offset);
}

Pose RivalPlayer::posture(int k) const {
  if (k <= 0) return first(k);
  switch (method_) {
    case RivalMethod::kCut:
      return second(k);
    case RivalMethod::kCrossfade:
      return mixed_postures(first(k), second(k), second_weight(k));
    case RivalMethod::kInertial:
      return inertial_posture(k);
    case RivalMethod::kDead:
      break;
  }
  const double rate = kLn2 / kDeadHalfLife_s;
  const double moved_s = (1.0 - std::exp(-rate * k / hz_)) / rate;
  return mixed_postures(
      moved_posture(first(0), moved_s, velocity_), second(k), second_weight(k));
}

FloorStep RivalPlayer::step(int k) const {
  if (k < 0) return at(from_.steps, leave_ + k);
  const FloorStep& next = at(to_.steps, enter_ + k);
  const double middle = k + 0.5;
  switch (method_) {
    case RivalMethod::kCut:
      return next;
    case RivalMethod::kCrossfade:
      return mixed_steps(at(from_.steps, leave_ + k), next, second_weight(middle));
    case RivalMethod::kInertial: {
      const double left = 1.0 - second_weight(middle);
      return {next.move_m + left * step_gap_.move_m,
              next.turn_rad + left * step_gap_.turn_rad};
    }
    case RivalMethod::kDead:
      break;
  }
  const double left = std::exp(-kLn2 / kDeadHalfLife_s * middle / hz_);
  return mixed_steps({left * last_step_.move_m, left * last_step_.turn_rad},
                     next,
                     second_weight(middle));
}

TransitionFrame RivalPlayer::shown(int k) const {
  TransitionFrame out;
  out.source_s = {(leave_ + k) / hz_, (enter_ + k) / hz_};
  double weight = second_weight(k);
  if (method_ == RivalMethod::kInertial) {
    out.arrived = weight;
    weight = k > 0 ? 1.0 : 0.0;
  }
  out.weight = {1.0 - weight, weight};
  return out;
}

/// Label of a point smoothed over 60 ms. In [0, 1].
double smooth_bearing(const TransitionClip& clip, std::size_t point, double time_s) {
  const int half =
      static_cast<int>(std::lround(0.5 * kLabelSmoothing_s * kTransitionRate_hz));
  double sum = 0.0;
  for (int k = -half; k <= half; ++k) {
    if (bears_at(clip, point, time_s + k / kTransitionRate_hz)) sum += 1.0;
  }
  return sum / (2 * half + 1);
}

// Share of the anchored root at a frame: faded in and out over 0.1 s.
double anchor_share(double k) {
  const double t_s = k / kTransitionRate_hz;
  return smooth_step(t_s / kAnchorFade_s) *
         (1.0 - smooth_step((t_s - kFade_s) / kAnchorFade_s));
}

// The step by which the bearing feet stand still, as far as feet bear.
FloorStep anchored_step(const SwitchCase& played,
                        const RivalPlayer& player,
                        int k,
                        const Pose& posture,
                        const Pose& next) {
  FloorStep step = player.step(k);
  const double share = anchor_share(k + 0.5);
  if (share <= 0.0) return step;
  const auto before = foot_points(*played.from, posture);
  const auto after = foot_points(*played.from, next);
  const TransitionFrame shown = player.shown(k + 1);
  glm::dvec2 sum_m(0.0);
  double bearing = 0.0;
  for (std::size_t point = 0; point < kFootPoints; ++point) {
    const double a =
        shown.weight[0] * smooth_bearing(*played.from, point, shown.source_s[0]) +
        shown.weight[1] * smooth_bearing(*played.to, point, shown.source_s[1]);
    const glm::dvec2 after_m{after[point].x, after[point].z};
    sum_m += a * (glm::dvec2(before[point].x, before[point].z) -
                  turned(after_m, step.turn_rad));
    bearing += a;
  }
  if (bearing <= 0.0) return step;
  step.move_m =
      glm::mix(step.move_m, sum_m / bearing, share * smooth_step(std::min(1.0, bearing)));
  return step;
}

/// Frames that every result has before and after the switch.
int played_frames() {
  return frame_at(kPlayedAround_s) + 2;
}

}  // namespace

std::string_view name(RivalMethod method) {
  constexpr std::array<std::string_view, 4> kNames{
      "cut", "crossfade 0.3 s", "inertialization 0.1 s", "dead blending 0.3 s"};
  return kNames[static_cast<std::size_t>(method)];
}

double synchronised_entry_s(const SwitchCase& played) {
  const int window = frame_at(kFade_s);
  const int last = played.to->frame_count() - 1 - played_frames();
  const int asked = frame_at(played.enter_s);
  const int reach = played.to->is_cyclic ? last : frame_at(kEntry_s);
  int best = asked;
  double least = 1e9;
  for (int entry = std::max(1, asked - reach); entry <= std::min(last, asked + reach);
       ++entry) {
    // Entries with the same supports: the one next to the requested time.
    double cost = 1e-3 * std::abs(entry - asked);
    for (int k = 0; k <= window; ++k) {
      for (std::size_t point = 0; point < kFootPoints; ++point) {
        const bool first =
            bears_at(*played.from, point, played.leave_s + k / kTransitionRate_hz);
        const bool second = bears_at(*played.to, point, (entry + k) / kTransitionRate_hz);
        if (first != second) cost += 1.0;
      }
    }
    if (cost >= least) continue;
    least = cost;
    best = entry;
  }
  return best / kTransitionRate_hz;
}

TransitionResult play_rival(const SwitchCase& played, const RivalOptions& options) {
  SwitchCase entered = played;
  if (options.is_synchronised) entered.enter_s = synchronised_entry_s(played);
  const int frames = played_frames();
  MAREY_ASSERT(frame_at(played.leave_s) >= frames);
  MAREY_ASSERT(frame_at(entered.enter_s) >= 1 &&
               frame_at(entered.enter_s) + frames < played.to->frame_count());
  const RivalPlayer player(entered, options.method);
  TransitionResult out{{played.from->motion.skeleton, {kTransitionRate_hz}, 0, {}},
                       frames / kTransitionRate_hz,
                       {},
                       {}};
  FloorPlace place;
  Pose posture = player.posture(-frames);
  for (int k = -frames; k <= frames; ++k) {
    out.motion.poses.push_back(placed(posture, place));
    out.frames.push_back(player.shown(k));
    Pose next = player.posture(k + 1);
    place = after_step(place,
                       options.is_anchored && k >= 0
                           ? anchored_step(entered, player, k, posture, next)
                           : player.step(k));
    posture = std::move(next);
  }
  return out;
}

}  // namespace marey
