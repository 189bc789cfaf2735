// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/models/made_walker.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

constexpr double kCircle_rad = 2.0 * 3.14159265358979323846;

glm::dvec2 rotated(glm::dvec2 v, double a) {
  return {v.x * std::cos(a) + v.y * std::sin(a), v.y * std::cos(a) - v.x * std::sin(a)};
}

// Footprints of a gait: their times, middles of the path there, and its direction.
struct Track {
  std::vector<double> land_s, course_rad;
  std::vector<glm::dvec2> middle, print;
};

Track lay_track(const Gait& gait, int cycles) {
  MadeNumbers numbers(gait.seed);
  const auto n = static_cast<std::size_t>(gait.steps);
  std::vector<double> length, across, time_s;
  for (std::size_t i = 0; i < n; ++i) {
    const auto vary = [&] { return gait.irregular * numbers.next(-1.0, 1.0); };
    length.push_back(gait.step_legs * (1.0 + vary()));
    if (gait.stays && i % 2 == 1) length[i] = -length[i - 1];
    across.push_back(gait.step_legs * vary());
    time_s.push_back(gait.step_s * (1.0 + 0.5 * vary()));
  }
  Track track;
  double t = 0.0, course = 0.0;
  glm::dvec2 middle{0.0};
  const double side = gait.mirrored ? -1.0 : 1.0;
  for (std::size_t i = 0; i < n * static_cast<std::size_t>(cycles); ++i) {
    track.land_s.push_back(t);
    track.course_rad.push_back(course);
    track.middle.push_back(middle);
    const double to_foot = (i % 2 == 0 ? 0.5 : -0.5) * side * gait.width_legs;
    track.print.push_back(middle +
                          rotated({to_foot, 0.0}, course - side * gait.travel_rad));
    middle += rotated({side * across[i % n], length[i % n]}, course);
    course += side * gait.turn_rad;
    t += time_s[i % n];
  }
  return track;
}

// Catmull-Rom.
glm::dvec2 through(const std::vector<glm::dvec2>& p, std::size_t i, double x) {
  const glm::dvec2 m0 = 0.5 * (p[i + 1] - p[i - 1]);
  const glm::dvec2 m1 = 0.5 * (p[i + 2] - p[i]);
  const glm::dvec2 d = p[i + 1] - p[i];
  return p[i] + x * (m0 + x * (3.0 * d - 2.0 * m0 - m1 + x * (m0 + m1 - 2.0 * d)));
}

double smooth(double x) {
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace

double MadeNumbers::next(double low, double high) {
  state_ = state_ * 1664525U + 1013904223U;
  return low + (high - low) * static_cast<double>(state_ >> 8U) / 16777216.0;
}

MadeWalker::MadeWalker(const Gait& gait) {
  const auto n = static_cast<std::size_t>(gait.steps);
  const Track track = lay_track(gait, 7);
  // The clip begins with the landing of the first foot of the third cycle.
  const std::size_t first = 2 * n;
  const double start_s = track.land_s[first];
  const double cycle_s = track.land_s[first + n] - start_s;
  const double side = gait.mirrored ? -1.0 : 1.0;
  const std::size_t left = gait.mirrored ? 1 : 0;
  std::vector<glm::dvec2> root(track.print.size());
  for (std::size_t i = 1; i < root.size(); ++i) {
    root[i] = 0.5 * (track.print[i - 1] + track.print[i]);
  }
  for (std::size_t i = 0; i + 2 < track.land_s.size(); ++i) {
    const double step_s = track.land_s[i + 1] - track.land_s[i];
    const double next_s = track.land_s[i + 2] - track.land_s[i + 1];
    const double end_s = gait.runs
                             ? track.land_s[i] + gait.alone_share * step_s
                             : track.land_s[i + 1] + (1.0 - gait.alone_share) * next_s;
    stances_[i % 2 == 0 ? left : 1 - left].push_back(
        {track.land_s[i] - start_s, end_s - start_s, track.print[i]});
  }
  const auto frames = static_cast<std::size_t>(std::lround(cycle_s * 120.0));
  clip_.name = "made";
  clip_.loops = true;
  clip_.leg_length_m = 0.9F;
  // The rate is such that the cycle has whole frames.
  clip_.rate_hz = static_cast<float>(static_cast<double>(frames) / cycle_s);
  clip_.frames.resize(frames + 1);
  std::size_t i = first;
  for (std::size_t frame = 0; frame <= frames; ++frame) {
    const double t =
        start_s + cycle_s * static_cast<double>(frame) / static_cast<double>(frames);
    while (track.land_s[i + 1] <= t + 1e-9) ++i;
    const double x = (t - track.land_s[i]) / (track.land_s[i + 1] - track.land_s[i]);
    const double phase = kCircle_rad * (t - start_s) / cycle_s;
    const double course =
        track.course_rad[i] + x * (track.course_rad[i + 1] - track.course_rad[i]);
    const glm::dvec2 sway =
        rotated({side * gait.sway_legs * std::sin(phase), 0.0}, course);
    const glm::dvec2 place = through(root, i, x) + sway;
    clip_.path.push_back({static_cast<float>(place.x),
                          static_cast<float>(place.y),
                          static_cast<float>(course - side * gait.travel_rad +
                                             side * 0.08 * std::sin(phase))});
  }
  for (std::size_t foot = 0; foot < 2; ++foot) {
    std::vector<ClipSpan> spans;
    for (const Stance& stance : stances_[foot]) {
      const double from = std::max(stance.start_s, 0.0);
      const double to = std::min(stance.end_s, cycle_s);
      if (to > from) spans.push_back({static_cast<float>(from), static_cast<float>(to)});
    }
    clip_.contacts[2 * foot] = spans;
    clip_.contacts[2 * foot + 1] = spans;
  }
}

const MadeWalker::Stance& MadeWalker::stance_before(std::size_t foot,
                                                    double clip_s) const {
  const auto& all = stances_[foot];
  std::size_t i = 0;
  while (i + 1 < all.size() && all[i + 1].start_s <= clip_s + 1e-9) ++i;
  return all[i];
}

bool MadeWalker::bears(std::size_t foot, double clip_s) const {
  const double cycle_s = clip_.duration_s();
  const double t = clip_s - std::floor(clip_s / cycle_s) * cycle_s;
  return t < stance_before(foot, t).end_s;
}

double MadeWalker::until_edge_s(std::size_t foot, double clip_s) const {
  const double cycle_s = clip_.duration_s();
  const double t = clip_s - std::floor(clip_s / cycle_s) * cycle_s;
  const Stance& stance = stance_before(foot, t);
  return t < stance.end_s ? stance.end_s - t : (&stance + 1)->start_s - t;
}

glm::dvec2 MadeWalker::foot_from_root(std::size_t foot, double clip_s) const {
  const double cycle_s = clip_.duration_s();
  const double t = clip_s - std::floor(clip_s / cycle_s) * cycle_s;
  const Stance& a = stance_before(foot, t);
  const Stance& b = *(&a + 1);
  const double x = std::clamp((t - a.end_s) / (b.start_s - a.end_s), 0.0, 1.0);
  const glm::dvec2 place = a.place_legs + smooth(x) * (b.place_legs - a.place_legs);
  const RootPlace root = path_at(clip_, t);
  return rotated(place - glm::dvec2{root.x_m, root.z_m}, -root.heading_rad);
}

Walked walk(const MadeWalker& walker,
            SteerCourse& course,
            const GoalAt& goal,
            const WalkOptions& o) {
  Walked out;
  RootPlace root = o.start;
  double clip_s = o.start_clip_s;
  std::array<bool, 2> bore{};
  std::array<glm::dvec2, 2> held{}, offset{};
  std::array<double, 2> landed_turn{};
  double turn_sum = 0.0, alone_sum = 0.0;
  glm::dvec2 shift_sum{0.0};
  const ClipTravel travel = *travel_of_clip(walker.clip());
  const double mean_m = travel.mean_step_legs * o.leg_length_m;
  const double cycle_s = walker.clip().duration_s();
  for (int i = 0; i * o.step_s < o.max_s; ++i) {
    const double time_s = i * o.step_s;
    SteerInput in;
    if (i > 0) {
      const double from_s = clip_s - std::floor(clip_s / cycle_s) * cycle_s;
      RootPlace by = relative(path_at(walker.clip(), from_s),
                              path_at(walker.clip(), from_s + o.rate * o.step_s));
      clip_s += o.rate * o.step_s;
      root =
          moved(root, {by.x_m * o.leg_length_m, by.z_m * o.leg_length_m, by.heading_rad});
    }
    const glm::dvec2 aim = goal(time_s);
    if (!course.aim(aim)) break;
    const auto foot_at = [&](std::size_t foot, const RootPlace& at) {
      return glm::dvec2{at.x_m, at.z_m} +
             rotated(o.leg_length_m * walker.foot_from_root(foot, clip_s),
                     at.heading_rad);
    };
    for (std::size_t foot = 0; foot < 2; ++foot) {
      in.bears[foot] = walker.bears(foot, clip_s);
      in.until_edge_s[foot] = walker.until_edge_s(foot, clip_s) / o.rate;
      if (in.bears[foot] && !bore[foot]) {
        held[foot] = foot_at(foot, root);
        offset[foot] = {0.0, 0.0};
        landed_turn[foot] = turn_sum;
        if (i > 0) ++out.landings;
      }
      in.foot_xz_m[foot] = in.bears[foot] ? held[foot] : foot_at(foot, root);
    }
    const bool alone = in.bears[0] != in.bears[1];
    if (!alone || bore != in.bears) alone_sum = 0.0;
    if ((in.bears[0] && !bore[0]) || (in.bears[1] && !bore[1])) shift_sum = {0.0, 0.0};
    bore = in.bears;
    in.time_s = time_s;
    in.step_s = o.step_s;
    in.root = root;
    in.clip_s = clip_s;
    in.rate = o.rate;
    in.leg_length_m = o.leg_length_m;
    const SteerStep step = course.step(in);
    root = steered(root, step);
    turn_sum += step.turn_rad;
    alone_sum += step.turn_rad;
    shift_sum += rotated(step.shift_xz_m, -root.heading_rad);
    if (!alone) out.turn_with_both_rad += std::abs(step.turn_rad);
    out.max_turn_rad = std::max(out.max_turn_rad, std::abs(alone_sum));
    out.max_turn_rad_s = std::max(out.max_turn_rad_s, std::abs(step.turn_rad) / o.step_s);
    out.max_shift_of_step =
        std::max(out.max_shift_of_step, glm::length(shift_sum) / mean_m);
    for (std::size_t foot = 0; foot < 2; ++foot) {
      if (!in.bears[foot]) continue;
      offset[foot] = rotated(offset[foot], step.turn_rad) + step.shift_xz_m;
      const glm::dvec2 error = foot_at(foot, root) - offset[foot] - held[foot];
      // The foot of the clip itself is known to single precision.
      out.foot_error_m = std::max(out.foot_error_m, glm::length(error));
      const double twist = turn_sum - landed_turn[foot];
      out.max_twist_rad = std::max(out.max_twist_rad, std::abs(twist));
      out.twist_error_rad =
          std::max(out.twist_error_rad, std::abs(twist - step.twist_rad[foot]));
    }
    out.steps.push_back({time_s, root, step, in.bears});
    out.duration_s = time_s;
    out.distance_m = glm::length(glm::dvec2{root.x_m, root.z_m} - aim);
    out.arrived = step.arrived;
    if (step.state != SteerState::kUnderWay) break;
  }
  return out;
}

}  // namespace marey::engine
