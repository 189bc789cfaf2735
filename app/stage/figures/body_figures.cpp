// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/body_figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "app/stage/figures/mean_jerk.h"
#include "core/human/centre_of_mass.h"
#include "retarget/body/rotation_from_t_pose.h"

namespace marey::app {
namespace {

constexpr double kInMm = 1000.0;
constexpr double kFlatFoot_legs = 0.01;
constexpr double kWalks_m_s = 0.3;
constexpr double kLeastPiece_s = 4.0;
constexpr int kClipPlaces = 8;

glm::dvec2 xz(const glm::dvec3& p) {
  return {p.x, p.z};
}

/// Middle of both ankles.
glm::dvec2 feet_xz_m(const FigureBody& body, std::span<const RigidTransform> joints) {
  const glm::dvec3 left = joints[index(body.map->leg(0).end)].translation;
  const glm::dvec3 right = joints[index(body.map->leg(1).end)].translation;
  return 0.5 * (xz(left) + xz(right));
}

FootStep foot_step(const FigureBody& body,
                   std::span<const RigidTransform> joints,
                   std::size_t step,
                   int side) {
  const auto s = static_cast<std::size_t>(side);
  const retarget::FootMap& foot = body.map->feet[s];
  const JointIndex ankle = body.map->leg(side).end;
  FootStep out;
  out.time_s = body.times_s[step];
  out.world_from_t_pose = retarget::rotation_from_t_pose(*body.map, joints, ankle);
  const glm::dvec3 to_ball = out.world_from_t_pose * foot.ball_from_ankle_in_t_pose;
  out.ankle_on_floor = joints[index(ankle)].translation;
  out.ball_on_floor = out.ankle_on_floor + to_ball;
  const FigureFloor floor = body.floor.empty() ? FigureFloor{} : body.floor[step][s];
  out.ankle_on_floor -= floor.moved_m;
  out.ball_on_floor -= floor.moved_m;
  if (body.stands.empty() || !body.stands[step][s]) return out;
  const double pitched_m =
      glm::dot(to_ball, floor.normal_in_world) - foot.ball_from_ankle_in_t_pose.y;
  out.stance = stance_of(0.0, pitched_m, kFlatFoot_legs * body.map->leg_length_m);
  return out;
}

std::vector<PointMass> loaded_masses(const Character& character) {
  std::vector<PointMass> masses = character.masses;
  for (const Load& load : character.loads) masses.push_back(load.mass);
  return masses;
}

/// Lean and speed of the hips over the floor in each step.
struct SwayTrack {
  std::vector<double> lean_rad;
  std::vector<double> speed_m_s;
};

SwayTrack sway_track(const FigureBody& body, const FigureSpan& span, double step_s) {
  // The speed is that over half a second, so that a step's own rhythm does not count.
  const auto half = static_cast<std::size_t>(std::max(1.0, std::round(0.25 / step_s)));
  FigureFrames frames(body);
  SwayTrack track;
  std::vector<glm::dvec2> hips;
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const auto joints = frames.joints(body.poses[step]);
    const glm::dvec3 place = joints[index(body.map->hips())].translation;
    hips.push_back(xz(place));
    track.lean_rad.push_back(lateral_lean_rad(
        place, neck_in_world(joints, *body.map), hips_heading_rad(joints, *body.map)));
  }
  for (std::size_t i = 0; i < hips.size(); ++i) {
    const std::size_t from = i > half ? i - half : 0;
    const std::size_t to = std::min(i + half, hips.size() - 1);
    const double time_s =
        static_cast<double>(std::max<std::size_t>(to - from, 1)) * step_s;
    track.speed_m_s.push_back(glm::distance(hips[from], hips[to]) / time_s);
  }
  return track;
}

/// Pieces of a track, as first step and number of steps.
std::vector<std::pair<std::size_t, std::size_t>> walked_pieces(const SwayTrack& track,
                                                               double step_s) {
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= track.speed_m_s.size(); ++i) {
    if (i < track.speed_m_s.size() && track.speed_m_s[i] > kWalks_m_s) continue;
    if (static_cast<double>(i - first) * step_s >= kLeastPiece_s) {
      pieces.emplace_back(first, i - first);
    }
    first = i + 1;
  }
  return pieces;
}

}  // namespace

std::array<std::vector<FootStep>, 2> foot_steps(const FigureBody& body,
                                                const FigureSpan& span) {
  FigureFrames frames(body);
  std::array<std::vector<FootStep>, 2> feet;
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const auto joints = frames.joints(body.poses[step]);
    for (int side = 0; side < 2; ++side) {
      feet[static_cast<std::size_t>(side)].push_back(foot_step(body, joints, step, side));
    }
  }
  return feet;
}

WorstValue com_error_mm(const FigureBody& body, const FigureSpan& span) {
  const std::vector<PointMass> masses = loaded_masses(*body.character);
  FigureFrames frames(body);
  WorstValue worst;
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const auto before = frames.joints(body.references[step]);
    const glm::dvec2 wanted =
        xz(centre_of_mass(body.character->masses, before)) - feet_xz_m(body, before);
    const auto after = frames.joints(body.poses[step]);
    const glm::dvec2 is = xz(centre_of_mass(masses, after)) - feet_xz_m(body, after);
    worst.add(kInMm * glm::distance(is, wanted), body.times_s[step]);
  }
  return worst;
}

WorstValue pelvis_back_mm(const FigureBody& body, const FigureSpan& span) {
  FigureFrames frames(body);
  WorstValue worst;
  double sum_mm = 0.0;
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const auto before = frames.joints(body.references[step]);
    const double heading_rad = hips_heading_rad(before, *body.map);
    const glm::dvec2 ahead(std::sin(heading_rad), std::cos(heading_rad));
    const glm::dvec2 was =
        xz(before[index(body.map->hips())].translation) - feet_xz_m(body, before);
    const auto after = frames.joints(body.poses[step]);
    const glm::dvec2 is =
        xz(after[index(body.map->hips())].translation) - feet_xz_m(body, after);
    const double back_mm = -kInMm * glm::dot(is - was, ahead);
    worst.add(back_mm, body.times_s[step]);
    sum_mm += back_mm;
  }
  if (worst.count > 0) worst.value = sum_mm / static_cast<double>(worst.count);
  return worst;
}

double hips_distance_m(const FigureBody& body,
                       std::span<const glm::dvec3> targets_in_world,
                       double time_s) {
  const std::vector<glm::dvec3> path = point_path(body, {body.map->hips(), {}});
  const glm::dvec3 hips = place_at(body.times_s, path, time_s);
  const glm::dvec3 target = place_at(body.times_s, targets_in_world, time_s);
  return glm::distance(xz(hips), xz(target));
}

std::optional<double> body_jerk_m_s3(const FigureBody& body,
                                     const FigureSpan& span,
                                     double step_s) {
  const std::vector<JointIndex> joints = marked_joints(body.character->skeleton);
  std::vector<glm::dvec3> places(joints.size());
  FigureFrames frames(body);
  MeanJerk jerk(step_s);
  for (std::size_t step = 0; step < body.poses.size(); ++step) {
    if (!span.contains(body.times_s[step])) continue;
    const auto world = frames.joints(body.poses[step]);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      places[i] = world[index(joints[i])].translation;
    }
    jerk.add(places);
  }
  if (jerk.count() == 0) return std::nullopt;
  return jerk.mean_m_s3();
}

std::optional<double> jerk_ratio(const FigureBody& body,
                                 std::span<const PlayedClip> clips,
                                 const PostureLayout& layout,
                                 const FigureSpan& span,
                                 double step_s) {
  double sum = 0.0;
  double time_s = 0.0;
  for (const PlayedClip& played : clips) {
    ClipOnBody clip(*played.clip, layout, body.character->skeleton, *body.map);
    const auto jerk = clip_jerk_m_s3(clip, body.character->skeleton, step_s);
    if (!jerk) continue;
    sum += *jerk * played.played_s;
    time_s += played.played_s;
  }
  const std::optional<double> jerk = body_jerk_m_s3(body, span, step_s);
  if (!jerk || sum <= 0.0) return std::nullopt;
  return *jerk * time_s / sum;
}

std::optional<double> sway_deviation_percent(const FigureBody& body,
                                             const MotionClip& clip,
                                             const PostureLayout& layout,
                                             const FigureSpan& span,
                                             double step_s) {
  const SwayTrack track = sway_track(body, span, step_s);
  ClipOnBody on_body(clip, layout, body.character->skeleton, *body.map);
  SwaySpectrum of;
  SwaySpectrum from;
  for (const auto& [first, count] : walked_pieces(track, step_s)) {
    of.add(std::span(track.lean_rad).subspan(first, count), step_s);
    for (int place = 0; place < kClipPlaces; ++place) {
      const double from_s = place * clip.duration_s() / kClipPlaces;
      from.add(clip_lean_rad(on_body, *body.map, from_s, step_s, count), step_s);
    }
  }
  if (of.duration_s() <= 0.0) return std::nullopt;
  const SwayBands wanted = from.bands();
  if (wanted == SwayBands{}) return std::nullopt;
  return spectrum_deviation_percent(of.bands(), wanted);
}

}  // namespace marey::app
