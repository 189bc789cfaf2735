// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/transition_judge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "retarget/contacts/measure_contacts.h"

namespace marey {
namespace {

constexpr double kSlideWindow_s = 0.3;
constexpr double kPeakWindow_s = 0.5;
constexpr double kSettledWeight = 0.9;

/// Places of all joints, then of all tips, in the world. [frame][point]
using JudgedPlaces = std::vector<std::vector<glm::dvec3>>;

JudgedPlaces judged_places(const Motion& motion, std::size_t stride = 1) {
  JudgedPlaces out;
  for (std::size_t t = 0; t < motion.poses.size(); t += stride) {
    const auto world_from_joint = world_from_joints(motion.skeleton, motion.poses[t]);
    std::vector<glm::dvec3> places;
    for (const RigidTransform& joint : world_from_joint) {
      places.push_back(joint.translation);
    }
    for (std::size_t j = 0; j < world_from_joint.size(); ++j) {
      const auto& tip_in_joint = motion.skeleton.joints[j].tip_in_joint;
      if (tip_in_joint) places.push_back(world_from_joint[j] * *tip_in_joint);
    }
    out.push_back(std::move(places));
  }
  return out;
}

/// A half-open range of frames.
struct JudgedFrames {
  int first = 0;
  int end = 0;
};

struct Largest {
  double value = 0.0;
  int frame = 0;
  std::size_t point = 0;
};

Largest largest_acceleration(const JudgedPlaces& places, JudgedFrames frames, double hz) {
  Largest largest;
  const int end = std::min(frames.end, static_cast<int>(places.size()) - 1);
  for (int frame = std::max(frames.first, 1); frame < end; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    for (std::size_t j = 0; j < places[t].size(); ++j) {
      const glm::dvec3 change = places[t + 1][j] - 2.0 * places[t][j] + places[t - 1][j];
      const double size_m_s2 = glm::length(change) * hz * hz;
      if (size_m_s2 > largest.value) largest = {size_m_s2, frame, j};
    }
  }
  return largest;
}

/// Third differences begin one frame before each frame of the range.
double mean_jerk_of(const JudgedPlaces& places, JudgedFrames frames, double hz) {
  double sum = 0.0;
  int count = 0;
  const int end = std::min(frames.end, static_cast<int>(places.size()) - 2);
  for (int frame = std::max(frames.first, 1); frame < end; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    for (std::size_t j = 0; j < places[t].size(); ++j) {
      const glm::dvec3 change = places[t + 2][j] - 3.0 * places[t + 1][j] +
                                3.0 * places[t][j] - places[t - 1][j];
      sum += glm::length(change) * hz * hz * hz;
      ++count;
    }
  }
  return count == 0 ? 0.0 : sum / count;
}

double horizontal_speed_cm_s(const glm::dvec3& from, const glm::dvec3& to, double hz) {
  return 100.0 * std::hypot(to.x - from.x, to.z - from.z) * hz;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

constexpr double kStill_cm_s = 15.0;

// Adds the slides of one step at a time of a clip. `speed_cm_s` is called with a point.
template <class Speed>
void add_slides(const TransitionClip& clip,
                double time_s,
                const Speed& speed_cm_s,
                SlideSamples& out) {
  for (std::size_t point = 0; point < kFootPoints; ++point) {
    if (!bears_at(clip, point, time_s)) continue;
    const double slide_cm_s = speed_cm_s(point);
    out.points.push_back(slide_cm_s);
    if (own_slide_cm_s(clip, point, time_s) > kStill_cm_s) continue;
    out.still.push_back(slide_cm_s);
  }
}

void measure_slides(const SwitchCase& played,
                    const TransitionResult& result,
                    const retarget::BodyMap& map,
                    JudgedFrames frames,
                    TransitionFigures& out) {
  const auto paths = retarget::contact_paths(result.motion, map);
  for (int frame = frames.first; frame < frames.end; ++frame) {
    const auto t = static_cast<std::size_t>(frame);
    const TransitionFrame& shown = result.frames[t];
    const std::size_t heavier = shown.weight[1] >= shown.weight[0] ? 1 : 0;
    const TransitionClip& clip = heavier == 1 ? *played.to : *played.from;
    const double time_s = shown.source_s[heavier];
    add_slides(
        clip,
        time_s,
        [&](std::size_t point) {
          const double slide_cm_s = horizontal_speed_cm_s(
              paths[point][t - 1], paths[point][t], result.motion.rate.hz);
          if (slide_cm_s > out.worst_slide_cm_s &&
              own_slide_cm_s(clip, point, time_s) <= kStill_cm_s) {
            out.worst_slide_cm_s = slide_cm_s;
            out.worst_slide_point = point;
            out.worst_slide_at_s = frame / result.motion.rate.hz - result.switch_s;
          }
          return slide_cm_s;
        },
        out.slides);
    add_slides(
        clip,
        time_s,
        [&](std::size_t point) { return own_slide_cm_s(clip, point, time_s); },
        out.own);
  }
}

double longest_leg(const Motion& motion,
                   const retarget::BodyMap& map,
                   JudgedFrames frames) {
  double longest = 0.0;
  for (int frame = frames.first; frame < frames.end; ++frame) {
    const Pose& pose = motion.poses[static_cast<std::size_t>(frame)];
    const auto world_from_joint = world_from_joints(motion.skeleton, pose);
    for (int side = 0; side < 2; ++side) {
      const retarget::LimbMap& leg = map.leg(side);
      const double length_m =
          glm::distance(world_from_joint[index(leg.upper)].translation,
                        world_from_joint[index(leg.end)].translation);
      longest = std::max(longest, length_m / leg.length_m());
    }
  }
  return longest;
}

Largest farthest_hips_cm(const TransitionResult& result) {
  Largest farthest;
  for (std::size_t t = 0; t < result.blend_hips_in_world.size(); ++t) {
    const double away_cm = 100.0 * glm::distance(result.blend_hips_in_world[t],
                                                 result.motion.poses[t].root_in_world);
    if (away_cm > farthest.value) farthest = {away_cm, static_cast<int>(t), 0};
  }
  return farthest;
}

double settled_after_s(const TransitionResult& result, int at) {
  int last_light = at - 1;
  for (int frame = at; frame < static_cast<int>(result.frames.size()); ++frame) {
    const TransitionFrame& shown = result.frames[static_cast<std::size_t>(frame)];
    if (shown.arrived.value_or(shown.weight[1]) < kSettledWeight - 1e-12)
      last_light = frame;
  }
  return std::min((last_light + 1 - at) / result.motion.rate.hz, kPlayedAround_s);
}

SourceFigures larger_of(const SourceFigures& a, const SourceFigures& b) {
  return {std::max(a.peak_acceleration_m_s2, b.peak_acceleration_m_s2),
          std::max(a.mean_jerk_m_s3, b.mean_jerk_m_s3)};
}

void append(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

// Switches in which no foot bears have no mean.
void summarize_slides(const std::vector<TransitionFigures>& all, MethodFigures& out) {
  SlideSamples slides;
  SlideSamples own;
  SlideSamples means;
  for (const TransitionFigures& one : all) {
    append(one.slides.points, slides.points);
    append(one.slides.still, slides.still);
    append(one.own.points, own.points);
    append(one.own.still, own.still);
    if (one.slides.points.empty()) continue;
    means.points.push_back(one.slide_cm_s);
    if (!one.slides.still.empty()) means.still.push_back(one.still_slide_cm_s);
  }
  out.slide_mean_cm_s = mean_of(slides.points);
  out.own_slide_mean_cm_s = mean_of(own.points);
  out.still_slide_mean_cm_s = mean_of(slides.still);
  out.own_still_slide_mean_cm_s = mean_of(own.still);
  if (!means.points.empty()) out.slide_p95_cm_s = quantile(means.points, 0.95);
  if (!means.still.empty()) out.still_slide_p95_cm_s = quantile(means.still, 0.95);
}

}  // namespace

SourceFigures source_figures(const TransitionClip& clip, double hz) {
  const auto stride = std::lround(clip.motion.rate.hz / hz);
  MAREY_ASSERT(stride >= 1 &&
               std::abs(static_cast<double>(stride) * hz - clip.motion.rate.hz) < 1e-9);
  const JudgedPlaces places =
      judged_places(clip.motion, static_cast<std::size_t>(stride));
  const JudgedFrames all{0, static_cast<int>(places.size())};
  return {largest_acceleration(places, all, hz).value, mean_jerk_of(places, all, hz)};
}

SourceFigures source_figures(const SwitchCase& played, double hz) {
  return larger_of(source_figures(*played.from, hz), source_figures(*played.to, hz));
}

SlideSamples own_slides(const TransitionClip& clip) {
  SlideSamples out;
  for (int frame = 1; frame < clip.frame_count(); ++frame) {
    const double time_s = frame / clip.motion.rate.hz;
    add_slides(
        clip,
        time_s,
        [&](std::size_t point) { return own_slide_cm_s(clip, point, time_s); },
        out);
  }
  return out;
}

TransitionFigures judge(const SwitchCase& played,
                        const TransitionResult& result,
                        const SourceFigures& sources) {
  const double hz = result.motion.rate.hz;
  const auto map = retarget::map_body(result.motion.skeleton);
  MAREY_ASSERT(map.has_value());
  for (const HumanBone bone : retarget::kContactBones) {
    // Bodies of results have the toes of the clips.
    MAREY_ASSERT(map->joint_of[index(bone)].has_value() ||
                 !played.from->map.joint_of[index(bone)].has_value());
  }
  MAREY_ASSERT(result.frames.size() == result.motion.poses.size());
  MAREY_ASSERT(result.blend_hips_in_world.empty() ||
               result.blend_hips_in_world.size() == result.motion.poses.size());
  const auto at = static_cast<int>(std::lround(result.switch_s * hz));
  const auto slide_steps = static_cast<int>(std::lround(kSlideWindow_s * hz));
  const auto peak_steps = static_cast<int>(std::lround(kPeakWindow_s * hz));
  MAREY_ASSERT(at > peak_steps);
  MAREY_ASSERT(at + peak_steps + 2 <= static_cast<int>(result.motion.poses.size()));
  const JudgedFrames after{at + 1, at + slide_steps + 1};
  const JudgedFrames around{at - peak_steps, at + peak_steps + 1};
  const JudgedPlaces places = judged_places(result.motion);
  TransitionFigures out;
  measure_slides(played, result, *map, after, out);
  out.slide_cm_s = mean_of(out.slides.points);
  out.still_slide_cm_s = mean_of(out.slides.still);
  const Largest acceleration = largest_acceleration(places, around, hz);
  out.acceleration = acceleration.value / sources.peak_acceleration_m_s2;
  out.acceleration_at_s = (acceleration.frame - at) / hz;
  out.acceleration_point = acceleration.point;
  out.jerk = mean_jerk_of(places, around, hz) / sources.mean_jerk_m_s3;
  out.jerk_after = mean_jerk_of(places, after, hz) / sources.mean_jerk_m_s3;
  out.settled_s = settled_after_s(result, at);
  const Largest hips = farthest_hips_cm(result);
  out.hips_beyond_cm = hips.value;
  out.hips_beyond_at_s = (hips.frame - at) / hz;
  out.leg_extension = longest_leg(result.motion, *map, around);
  return out;
}

MethodFigures summarize(const std::vector<TransitionFigures>& all) {
  MAREY_ASSERT(!all.empty());
  MethodFigures out;
  std::vector<double> accelerations;
  std::vector<double> settled_s;
  for (const TransitionFigures& one : all) {
    accelerations.push_back(one.acceleration);
    settled_s.push_back(one.settled_s);
    out.jerk_mean += one.jerk / static_cast<double>(all.size());
    out.jerk_after_mean += one.jerk_after / static_cast<double>(all.size());
    out.hips_beyond_worst_cm = std::max(out.hips_beyond_worst_cm, one.hips_beyond_cm);
    out.leg_extension_worst = std::max(out.leg_extension_worst, one.leg_extension);
  }
  summarize_slides(all, out);
  out.acceleration_median = median(accelerations);
  out.acceleration_worst = quantile(accelerations, 1.0);
  out.settled_median_s = median(settled_s);
  return out;
}

MethodFigures judge_method(const std::vector<SwitchCase>& cases,
                           const std::vector<TransitionResult>& results) {
  MAREY_ASSERT(cases.size() == results.size() && !cases.empty());
  std::vector<TransitionFigures> all;
  SourceFigures sources;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    // Cases of one pair share their sources, whose figures take longest.
    const bool is_same = k > 0 && cases[k].from == cases[k - 1].from &&
                         cases[k].to == cases[k - 1].to &&
                         results[k].motion.rate.hz == results[k - 1].motion.rate.hz;
    if (!is_same) sources = source_figures(cases[k], results[k].motion.rate.hz);
    all.push_back(judge(cases[k], results[k], sources));
  }
  return summarize(all);
}

}  // namespace marey
