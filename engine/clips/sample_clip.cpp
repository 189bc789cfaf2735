// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/sample_clip.h"

#include <algorithm>
#include <cmath>

#include "engine/blend/blend_postures.h"

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kTurn_rad = 2.0 * 3.14159265358979323846;

// A time of a clip as frames before and after it. For a clip that loops, in its first
// cycle, with the number of whole cycles before.
struct FrameTime {
  std::size_t frame = 0;  ///< At most the last but one.
  double at = 0.0;        ///< From `frame` to the next one, 0 to 1.
  double cycles = 0.0;
};

FrameTime frame_time(const MotionClip& clip, double time_s) {
  MAREY_ASSERT(clip.frames.size() >= 2);
  const double last = static_cast<double>(clip.frames.size() - 1);
  double position = time_s * static_cast<double>(clip.rate_hz);
  FrameTime out;
  if (clip.loops) {
    out.cycles = std::floor(position / last);
    position -= out.cycles * last;
  }
  position = std::clamp(position, 0.0, last);
  out.frame = std::min(static_cast<std::size_t>(position), clip.frames.size() - 2);
  out.at = position - static_cast<double>(out.frame);
  return out;
}

RootPlace place_of(const ClipRoot& root) {
  return {static_cast<double>(root.x_legs),
          static_cast<double>(root.z_legs),
          static_cast<double>(root.heading_rad)};
}

// Catmull-Rom weights of four equidistant values; the slope at the ends of a clip that
// does not loop is that of the adjacent interval.
double cubic(double before, double a, double b, double after, double at) {
  const double slope_a = 0.5 * (b - before);
  const double slope_b = 0.5 * (after - a);
  const double step = b - a;
  return a + at * (slope_a + at * (3.0 * step - 2.0 * slope_a - slope_b +
                                   at * (slope_a + slope_b - 2.0 * step)));
}

// Frames for cubic(), each with the displacement of the cycle that it is in.
struct Neighbours {
  std::size_t before = 0;
  std::size_t after = 0;
  bool has_before = true;
  bool has_after = true;
};

Neighbours neighbours_of(const MotionClip& clip, std::size_t frame) {
  const std::size_t last = clip.frames.size() - 1;
  Neighbours out;
  out.has_before = frame > 0 || clip.loops;
  out.has_after = frame + 2 <= last || clip.loops;
  out.before = frame > 0 ? frame - 1 : (clip.loops ? last - 1 : 0);
  out.after = frame + 2 <= last ? frame + 2 : (clip.loops ? 1 : last);
  return out;
}

glm::dquat heading_rotation(double heading_rad) {
  return {std::cos(0.5 * heading_rad), 0.0, std::sin(0.5 * heading_rad), 0.0};
}

glm::dquat rotation_at(const BlendPosture& posture, std::size_t i) {
  return {static_cast<double>(posture.w[i]),
          static_cast<double>(posture.x[i]),
          static_cast<double>(posture.y[i]),
          static_cast<double>(posture.z[i])};
}

void set_rotation(BlendPosture& posture, std::size_t i, const glm::dquat& q) {
  const glm::dquat unit = glm::normalize(q);
  posture.x[i] = static_cast<float>(unit.x);
  posture.y[i] = static_cast<float>(unit.y);
  posture.z[i] = static_cast<float>(unit.z);
  posture.w[i] = static_cast<float>(unit.w);
}

template <std::size_t N>
void set_curve(const BlendPosture& posture,
               std::size_t first,
               const std::array<float, N>& at,
               const glm::dquat& heading,
               retarget::RotationCurve& out) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0 && at[i] <= at[i - 1]) continue;
    out.at[count] = static_cast<double>(at[i]);
    out.rotation[count++] = heading * rotation_at(posture, first + i);
  }
  out.count = static_cast<int>(count);
}

template <std::size_t N>
void take_curve(const retarget::RotationCurve& curve,
                const glm::dquat& otherwise,
                const std::array<float, N>& at,
                std::size_t first,
                BlendPosture& posture) {
  for (std::size_t i = 0; i < N; ++i) {
    set_rotation(posture,
                 first + i,
                 curve.count > 0 ? retarget::sample(curve, static_cast<double>(at[i]))
                                 : otherwise);
  }
}

// The segment from which a missing one takes its rotation: its parent's.
std::size_t stand_in(std::size_t segment) {
  switch (kPostureSegments[segment]) {
    case HumanBone::kNeck:
    case HumanBone::kLeftShoulder:
    case HumanBone::kRightShoulder:
      return kTorsoRotation + kTorsoKnots - 1;
    case HumanBone::kHead:
      return kNeckRotation + kNeckKnots - 1;
    case HumanBone::kLeftToes:
      return kSegmentRotation + 7;
    case HumanBone::kRightToes:
      return kSegmentRotation + 8;
    default:
      return kSegmentRotation;
  }
}

}  // namespace

RootPlace path_at(const MotionClip& clip, double time_s) {
  const FrameTime t = frame_time(clip, time_s);
  const RootPlace first = place_of(clip.path.front());
  const RootPlace cycle = relative(first, place_of(clip.path.back()));
  const RootPlace a = place_of(clip.path[t.frame]);
  const RootPlace b = place_of(clip.path[t.frame + 1]);
  const Neighbours n = neighbours_of(clip, t.frame);
  // A neighbour across the seam is carried along by the displacement of a cycle.
  RootPlace before = a;
  RootPlace after = b;
  if (n.has_before) {
    before = place_of(clip.path[n.before]);
    if (t.frame == 0) {
      before = moved(first, relative(place_of(clip.path.back()), before));
    }
  } else {
    before = {
        2.0 * a.x_m - b.x_m, 2.0 * a.z_m - b.z_m, 2.0 * a.heading_rad - b.heading_rad};
  }
  if (n.has_after) {
    after = place_of(clip.path[n.after]);
    if (t.frame + 2 == clip.path.size()) {
      after = moved(place_of(clip.path.back()), relative(first, after));
    }
  } else {
    after = {
        2.0 * b.x_m - a.x_m, 2.0 * b.z_m - a.z_m, 2.0 * b.heading_rad - a.heading_rad};
  }
  RootPlace place{
      cubic(before.x_m, a.x_m, b.x_m, after.x_m, t.at),
      cubic(before.z_m, a.z_m, b.z_m, after.z_m, t.at),
      cubic(before.heading_rad, a.heading_rad, b.heading_rad, after.heading_rad, t.at)};
  if (t.cycles == 0.0) return place;
  // The place within the cycle, after `cycles` displacements of a whole one. All turns
  // are about Y, so that the sum of displacements has a closed form; a loop serves as
  // long as the engine takes deltas of neighbouring times only.
  RootPlace start = first;
  const double count = std::abs(t.cycles);
  const RootPlace step =
      t.cycles > 0.0 ? cycle : relative(place_of(clip.path.back()), first);
  for (double i = 0.0; i < count; i += 1.0) start = moved(start, step);
  return moved(start, relative(first, place));
}

RootPlace relative(const RootPlace& from, const RootPlace& to) {
  const double c = std::cos(from.heading_rad);
  const double s = std::sin(from.heading_rad);
  const double dx = to.x_m - from.x_m;
  const double dz = to.z_m - from.z_m;
  return {c * dx - s * dz, s * dx + c * dz, to.heading_rad - from.heading_rad};
}

RootPlace moved(const RootPlace& from, const RootPlace& by) {
  const double c = std::cos(from.heading_rad);
  const double s = std::sin(from.heading_rad);
  return {from.x_m + c * by.x_m + s * by.z_m,
          from.z_m - s * by.x_m + c * by.z_m,
          from.heading_rad + by.heading_rad};
}

void sample_clip(const MotionClip& clip, double time_s, BlendPosture& out) {
  const FrameTime t = frame_time(clip, time_s);
  const BlendPosture& a = clip.frames[t.frame];
  const BlendPosture& b = clip.frames[t.frame + 1];
  interpolate(a, b, static_cast<float>(t.at), out);
  const Neighbours n = neighbours_of(clip, t.frame);
  const BlendPosture& before = clip.frames[n.before];
  const BlendPosture& after = clip.frames[n.after];
  const auto smooth = [&](float p, float q, float r, float s) {
    const double from = static_cast<double>(q);
    const double to = static_cast<double>(r);
    const double x = n.has_before ? static_cast<double>(p) : 2.0 * from - to;
    const double y = n.has_after ? static_cast<double>(s) : 2.0 * to - from;
    return static_cast<float>(cubic(x, from, to, y, t.at));
  };
  out.height_legs =
      smooth(before.height_legs, a.height_legs, b.height_legs, after.height_legs);
  for (std::size_t i = 0; i < 4; ++i) {
    out.fold_rad[i] = std::max(
        smooth(before.fold_rad[i], a.fold_rad[i], b.fold_rad[i], after.fold_rad[i]),
        0.0F);
  }
}

unsigned bearing_at(const MotionClip& clip, double time_s) {
  double t = time_s;
  if (clip.loops) {
    const double duration = clip.duration_s();
    t -= std::floor(t / duration) * duration;
  }
  unsigned bits = 0;
  for (std::size_t part = 0; part < clip.contacts.size(); ++part) {
    for (const ClipSpan& span : clip.contacts[part]) {
      if (t >= static_cast<double>(span.start_s) && t < static_cast<double>(span.end_s)) {
        bits |= 1U << part;
      }
    }
  }
  return bits;
}

void to_normalized(const BlendPosture& posture,
                   const PostureLayout& layout,
                   const RootPlace& root,
                   double leg_length_m,
                   retarget::NormalizedPose& out) {
  const glm::dquat heading = heading_rotation(root.heading_rad);
  out.root_normalization = retarget::RootNormalization::kLegLength;
  out.root = {root.x_m / leg_length_m,
              static_cast<double>(posture.height_legs),
              root.z_m / leg_length_m};
  for (std::size_t i = 0; i < 4; ++i) {
    if (!out.limbs[i]) out.limbs[i].emplace();
    retarget::NormalizedLimb& limb = *out.limbs[i];
    limb.extension = std::cos(static_cast<double>(posture.fold_rad[i]));
    limb.world_from_limb = heading * rotation_at(posture, kLimbRotation + i);
    limb.mid_offset = {static_cast<double>(posture.mid_x[i]),
                       static_cast<double>(posture.mid_y[i])};
    limb.upper_twist_rad = static_cast<double>(posture.upper_twist_rad[i]);
    limb.lower_twist_rad = static_cast<double>(posture.lower_twist_rad[i]);
  }
  for (std::size_t i = 0; i < kPostureSegments.size(); ++i) {
    out.segments[index(kPostureSegments[i])] =
        heading * rotation_at(posture, kSegmentRotation + i);
  }
  set_curve(posture, kAbdomenRotation, layout.abdomen_at, heading, out.abdomen);
  set_curve(posture, kTorsoRotation, layout.torso_at, heading, out.torso);
  set_curve(posture, kNeckRotation, layout.neck_at, heading, out.neck);
  out.spine.reset();
  if (posture.torso_share > 0.0F) {
    out.spine = retarget::SpineShares{static_cast<double>(posture.abdomen_share),
                                      static_cast<double>(posture.torso_share)};
  }
}

void from_normalized(const retarget::NormalizedPose& pose,
                     const PostureLayout& layout,
                     double leg_length_m,
                     double near_heading_rad,
                     BlendPosture& posture,
                     RootPlace& root) {
  const glm::dquat hips = *pose.segments[index(HumanBone::kHips)];
  const double yaw = 2.0 * std::atan2(hips.y, hips.w);
  root.heading_rad = near_heading_rad + std::remainder(yaw - near_heading_rad, kTurn_rad);
  root.x_m = pose.root.x * leg_length_m;
  root.z_m = pose.root.z * leg_length_m;
  const glm::dquat to_heading = glm::conjugate(heading_rotation(root.heading_rad));
  posture = {};
  posture.height_legs = static_cast<float>(pose.root.y);
  for (std::size_t i = 0; i < kPostureRotations; ++i) posture.w[i] = 1.0F;
  for (std::size_t i = 0; i < 4; ++i) {
    MAREY_ASSERT(pose.limbs[i].has_value());
    const retarget::NormalizedLimb& limb = *pose.limbs[i];
    set_rotation(posture, kLimbRotation + i, to_heading * limb.world_from_limb);
    posture.fold_rad[i] = static_cast<float>(std::acos(std::min(limb.extension, 1.0)));
    posture.mid_x[i] = static_cast<float>(limb.mid_offset.x);
    posture.mid_y[i] = static_cast<float>(limb.mid_offset.y);
    posture.upper_twist_rad[i] = static_cast<float>(limb.upper_twist_rad);
    posture.lower_twist_rad[i] = static_cast<float>(limb.lower_twist_rad);
  }
  retarget::RotationCurve abdomen = pose.abdomen;
  retarget::RotationCurve torso = pose.torso;
  retarget::RotationCurve neck = pose.neck;
  for (retarget::RotationCurve* curve : {&abdomen, &torso, &neck}) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(curve->count); ++i) {
      curve->rotation[i] = to_heading * curve->rotation[i];
    }
  }
  const glm::dquat level = to_heading * hips;
  take_curve(abdomen, level, layout.abdomen_at, kAbdomenRotation, posture);
  take_curve(torso, level, layout.torso_at, kTorsoRotation, posture);
  const glm::dquat torso_end = torso.count > 0 ? retarget::sample(torso, 1.0) : level;
  take_curve(neck, torso_end, layout.neck_at, kNeckRotation, posture);
  for (std::size_t i = 0; i < kPostureSegments.size(); ++i) {
    const auto& segment = pose.segments[index(kPostureSegments[i])];
    set_rotation(posture,
                 kSegmentRotation + i,
                 segment ? to_heading * *segment : rotation_at(posture, stand_in(i)));
  }
  posture.abdomen_share = pose.spine ? static_cast<float>(pose.spine->abdomen) : 0.0F;
  posture.torso_share = pose.spine ? static_cast<float>(pose.spine->torso) : 0.0F;
}

}  // namespace marey::engine
