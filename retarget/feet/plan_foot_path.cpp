// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/feet/plan_foot_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/frame_range.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"
#include "retarget/contacts/frame_marks.h"
#include "retarget/feet/footprint.h"
#include "retarget/feet/leg_placement.h"

namespace marey::retarget {
namespace {

// A quantity over time that some frames prescribe; bridge() computes the others.
using Prescribed = std::vector<std::optional<glm::dvec3>>;

// Value and speed at the edge of a run of prescribed frames, by one-sided differences;
// `step` is -1 at a run's last frame, +1 at its first. Time runs away from the run.
// Acceleration is not used: feet that land or leave change it at once, and following it
// makes the path less smooth.
struct Edge {
  glm::dvec3 value{0.0};
  glm::dvec3 speed{0.0};
};

Edge edge_of(const Prescribed& p, int at, int step, double hz) {
  const auto get = [&](int k) -> std::optional<glm::dvec3> {
    const int frame = at + k * step;
    if (frame < 0 || frame >= static_cast<int>(p.size())) return std::nullopt;
    return p[static_cast<std::size_t>(frame)];
  };
  Edge edge{*get(0)};
  const auto one = get(1);
  const auto two = get(2);
  if (one && two) {
    edge.speed = (3.0 * edge.value - 4.0 * *one + *two) * (0.5 * hz);
  } else if (one) {
    edge.speed = (edge.value - *one) * hz;
  }
  return edge;
}

// Returns the edge's own course, fading to its value over `fade_s`: it starts at the
// edge's speed, and ends at rest and without acceleration. Among curves with the same
// maximum acceleration, the ones that accelerate most at the edge deviate least: this one
// by 0.11 of speed times `fade_s`.
glm::dvec3 fading(const Edge& edge, double since_s, double fade_s) {
  const double left = std::max(0.0, 1.0 - since_s / fade_s);
  return left * left * left * since_s * edge.speed;
}

// Fills the frames first..last, whose neighbours are prescribed (or the motion's ends).
void bridge_gap(Prescribed& p, int first, int last, double hz, const FootPathOptions& o) {
  const int count = static_cast<int>(p.size());
  std::optional<Edge> before;
  std::optional<Edge> after;
  if (first > 0) before = edge_of(p, first - 1, -1, hz);
  if (last + 1 < count) after = edge_of(p, last + 1, +1, hz);
  const double gap_s = (last - first + 2) / hz;
  for (int t = first; t <= last; ++t) {
    const double since_s = (t - first + 1) / hz;
    const double until_s = gap_s - since_s;
    glm::dvec3 value(0.0);
    if (before && after) {
      value = glm::mix(before->value, after->value, smooth_step(since_s / gap_s));
    } else if (before || after) {
      value = before ? before->value : after->value;
    }
    if (before) value += fading(*before, since_s, std::min(o.blend_s, gap_s));
    if (after) value += fading(*after, until_s, std::min(o.blend_s, gap_s));
    p[static_cast<std::size_t>(t)] = value;
  }
}

// Fills all gaps with continuous speed across every edge, exact where prescribed; zero if
// nothing is prescribed.
std::vector<glm::dvec3> bridge(Prescribed p, double hz, const FootPathOptions& o) {
  const int count = static_cast<int>(p.size());
  const Prescribed given = p;
  const auto is_given = [&](int t) {
    return given[static_cast<std::size_t>(t)].has_value();
  };
  for (int t = 0; t < count; ++t) {
    if (is_given(t)) continue;
    int last = t;
    while (last + 1 < count && !is_given(last + 1)) ++last;
    bridge_gap(p, t, last, hz, o);
    t = last;
  }
  std::vector<glm::dvec3> out;
  for (const auto& value : p) out.push_back(*value);
  return out;
}

// Inputs that the steps below share about one foot.
struct FootPathTask {
  std::span<const FootPlace> reference;
  const FootMap& foot;
  double leg_length_m = 0.0;
  double hz = 0.0;
  const FootPathOptions& options;
  std::vector<char> heel;  // Per frame: 1 if it bears.
  std::vector<char> ball;
  std::vector<FrameRange> heel_up;  // Runs in which a foot on its ball does not move.
  std::vector<Footprint> print;     // Footprint of each frame in a stance.

  [[nodiscard]] bool bears(std::size_t t) const { return heel[t] || ball[t]; }
  [[nodiscard]] bool flat(std::size_t t) const { return heel[t] && ball[t]; }
};

// Returns the mean rotation of the reference foot, relative to the footprint's heading,
// over a run in which it turns only with its footprint.
glm::dquat mean_foot(const FootPathTask& task, const FrameRange& run) {
  const auto off_print = [&](int k) {
    const auto t = static_cast<std::size_t>(k);
    return glm::conjugate(task.print[t].heading) * task.reference[t].foot;
  };
  const glm::dquat first = off_print(run.first);
  glm::dvec3 turn(0.0);
  for (int k = run.first; k <= run.last; ++k) {
    turn += rotation_vector(off_print(k) * glm::conjugate(first));
  }
  return rotation_from_vector(turn / static_cast<double>(run.last - run.first + 1)) *
         first;
}

// Returns the yaw of the reference foot: the rotation that remains when the smallest
// rotation has made it level. Corrections of a foot are bridged relative to it. So a heel
// that is lowered by the same angle before and after a turn is lowered within it, too,
// and not rolled.
std::vector<glm::dquat> headings_of(std::span<const FootPlace> reference) {
  std::vector<glm::dquat> out;
  glm::dquat last(1.0, 0.0, 0.0, 0.0);
  for (const FootPlace& place : reference) {
    const glm::dquat twist(place.foot.w, 0.0, place.foot.y, 0.0);
    constexpr double kNone = 1e-6;  // Upside down.
    if (glm::length(twist) > kNone) last = glm::normalize(twist);
    out.push_back(last);
  }
  return out;
}

// Turns foot and toes flat where they must be, and as little as possible elsewhere.
void turn(const FootPathTask& task, std::vector<FootPlace>& out) {
  Prescribed foot_turn(out.size());
  Prescribed toes_turn(out.size());
  const std::vector<glm::dquat> headings = headings_of(task.reference);
  // Relative to the reference's heading.
  const auto turn_to =
      [&](std::size_t t, const glm::dquat& wanted, const glm::dquat& reference) {
        return glm::conjugate(headings[t]) *
               rotation_vector(wanted * glm::conjugate(reference));
      };
  for (std::size_t t = 0; t < out.size(); ++t) {
    const glm::dquat& heading = task.print[t].heading;
    const FootPlace& reference = task.reference[t];
    if (task.flat(t)) foot_turn[t] = turn_to(t, heading, reference.foot);
    if (task.ball[t]) toes_turn[t] = turn_to(t, heading, reference.toes);
  }
  for (const FrameRange& run : task.heel_up) {
    const glm::dquat still = mean_foot(task, run);
    for (int k = run.first; k <= run.last; ++k) {
      const auto t = static_cast<std::size_t>(k);
      foot_turn[t] = turn_to(t, task.print[t].heading * still, task.reference[t].foot);
    }
  }
  const auto foot = bridge(std::move(foot_turn), task.hz, task.options);
  const auto toes = bridge(std::move(toes_turn), task.hz, task.options);
  for (std::size_t t = 0; t < out.size(); ++t) {
    const FootPlace& reference = task.reference[t];
    out[t].foot =
        glm::normalize(rotation_from_vector(headings[t] * foot[t]) * reference.foot);
    out[t].toes =
        glm::normalize(rotation_from_vector(headings[t] * toes[t]) * reference.toes);
  }
}

// Returns the seconds from each frame to the nearest that bears; large if none does.
std::vector<double> distance_to_stance_s(const FootPathTask& task) {
  const std::size_t count = task.reference.size();
  std::vector<double> out(count, 1e9);
  for (std::size_t t = 0; t < count; ++t) {
    if (task.bears(t)) out[t] = 0.0;
    if (t > 0) out[t] = std::min(out[t], out[t - 1] + 1.0 / task.hz);
  }
  for (std::size_t t = count; t-- > 1;) {
    out[t - 1] = std::min(out[t - 1], out[t] + 1.0 / task.hz);
  }
  return out;
}

// Puts the bearing joint on its footprint, and the swinging foot in between.
void place_ankles(const FootPathTask& task, std::vector<FootPlace>& out) {
  Prescribed shift(out.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    if (!task.bears(t)) continue;
    const Footprint& print = task.print[t];
    if (!task.flat(t)) keep_other_joint_up(task.foot, task.heel[t] != 0, out[t]);
    out[t].ankle_in_world =
        task.heel[t]
            ? print.ankle_in_world
            : print.ball_in_world - out[t].foot * task.foot.ball_from_ankle_in_t_pose;
    if (!task.foot.has_toes && !task.heel[t]) keep_tip_up(task.foot, out[t]);
    // A foot that rolls over its heel rises on it.
    if (!task.flat(t)) lift_over_floor(task.foot, 0.0, out[t]);
    if (!task.ball[t]) keep_toes_up(task.foot, out[t]);
    shift[t] = out[t].ankle_in_world - task.reference[t].ankle_in_world;
  }
  const auto shifts = bridge(std::move(shift), task.hz, task.options);
  const auto away_s = distance_to_stance_s(task);
  for (std::size_t t = 0; t < out.size(); ++t) {
    if (task.bears(t)) continue;
    out[t].ankle_in_world = task.reference[t].ankle_in_world + shifts[t];
    constexpr double kSoftnessInLegs = 0.01;
    if (!task.foot.has_toes) keep_tip_up(task.foot, out[t]);
    lift_over_floor(task.foot,
                    kSoftnessInLegs * task.leg_length_m *
                        smooth_step(away_s[t] / task.options.blend_s),
                    out[t]);
    keep_toes_up(task.foot, out[t]);
  }
}

}  // namespace

std::vector<FootPlace> plan_foot_path(std::span<const FootPlace> reference,
                                      const FootContacts& contacts,
                                      const FootMap& foot,
                                      double leg_length_m,
                                      FrameRate rate,
                                      const FootPathOptions& options) {
  MAREY_ASSERT(rate.hz > 0.0 && options.blend_s > 0.0);
  const std::size_t count = reference.size();
  FootPathTask task{reference,
                    foot,
                    leg_length_m,
                    rate.hz,
                    options,
                    frame_marks(contacts.heel, count),
                    frame_marks(contacts.ball, count),
                    contacts.heel_up,
                    std::vector<Footprint>(count)};
  for (const FrameRange& run : contacts.stance) {
    const auto prints = footprints({reference, task.heel, task.ball}, run, foot, rate);
    std::ranges::copy(prints, task.print.begin() + run.first);
  }
  std::vector<FootPlace> out(count);
  turn(task, out);
  place_ankles(task, out);
  return out;
}

}  // namespace marey::retarget
