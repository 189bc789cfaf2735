// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/body_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/degrees.h"
#include "core/human/average_proportions.h"
#include "core/human/joint_ranges.h"
#include "core/transform.h"

namespace marey::library {
namespace {

using B = HumanBone;

constexpr double kMeanStature_m = 1.63;
constexpr double kStatureSigma = 0.10;
constexpr double kRatioSigma = 0.15;

double stature_m(const retarget::BodyMap& map) {
  const Proportions average = average_proportions(1.0);
  return map.leg_length_m /
         (glm::length(average[B::kLeftLowerLeg]) + glm::length(average[B::kLeftFoot]));
}

double proportions(const QualityFrames& frames, const retarget::BodyMap& map) {
  const BonePath& left = frames[B::kLeftUpperLeg];
  const BonePath& right = frames[B::kRightUpperLeg];
  if (!map.limbs[0] || !map.limbs[1] || !map.spine || left.empty() || right.empty()) {
    return 0.0;
  }
  const std::array length_m{map.leg(0).upper_length_m + map.leg(1).upper_length_m,
                            map.leg(0).lower_length_m + map.leg(1).lower_length_m,
                            map.limbs[0]->upper_length_m + map.limbs[1]->upper_length_m,
                            map.limbs[0]->lower_length_m + map.limbs[1]->lower_length_m,
                            map.spine->length_m,
                            glm::distance(left.p_in_world[0], right.p_in_world[0])};
  // Two persons have the same sum by chance only.
  constexpr std::array kWeights{1.0, -1.7, 2.3, -2.9, 3.1, -1.8};
  double sum = 0.0;
  for (std::size_t k = 0; k < length_m.size(); ++k) {
    if (length_m[k] <= 0.0) return 0.0;
    sum += kWeights[k] * std::log(length_m[k]);
  }
  return sum;
}

FoundFigure check_scale(const retarget::BodyMap& map, int count, double warn) {
  FoundFigure out{"scale_sigma"};
  const Proportions average = average_proportions(1.0);
  const auto length = [&](B bone) { return glm::length(average[bone]); };
  const auto compare = [&](double ratio, double sigma, std::optional<B> bone) {
    const double off = ratio > 0.0 ? std::abs(std::log(ratio)) / sigma : 0.0;
    if (off <= out.value) return;
    out.value = off;
    out.bone = bone;
  };
  const double leg = length(B::kLeftLowerLeg) + length(B::kLeftFoot);
  const double arm = length(B::kLeftLowerArm) + length(B::kLeftHand);
  compare(stature_m(map) / kMeanStature_m, kStatureSigma, std::nullopt);
  for (int side = 0; side < 2; ++side) {
    const auto& a = map.limbs[static_cast<std::size_t>(side)];
    const retarget::LimbMap& l = map.leg(side);
    compare(l.lower_length_m / l.upper_length_m * length(B::kLeftLowerLeg) /
                length(B::kLeftFoot),
            kRatioSigma,
            side == 0 ? B::kLeftLowerLeg : B::kRightLowerLeg);
    if (!a) continue;
    compare(a->lower_length_m / a->upper_length_m * length(B::kLeftLowerArm) /
                length(B::kLeftHand),
            kRatioSigma,
            side == 0 ? B::kLeftLowerArm : B::kRightLowerArm);
    compare(a->length_m() / map.leg_length_m * leg / arm,
            kRatioSigma,
            side == 0 ? B::kLeftUpperArm : B::kRightUpperArm);
  }
  if (out.value > warn) {
    out.frames = FrameRange{0, std::max(0, count - 1)};
    out.places.push_back({*out.frames, out.bone, out.value});
  }
  return out;
}

double outside_rad(const glm::dvec3& v, const BoneLimit& limit) {
  double worst = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    worst =
        std::max({worst, limit.min_rad[axis] - v[axis], v[axis] - limit.max_rad[axis]});
  }
  return worst;
}

// Excess of a rotation over its range. Near half a turn two vectors describe the same
// rotation; the one nearer to the range counts.
double excess_rad(const glm::dquat& rotation, const BoneLimit& limit) {
  const glm::dvec3 v = rotation_vector(rotation);
  const double angle = glm::length(v);
  const double one = outside_rad(v, limit);
  if (one <= 0.0 || angle < 1e-9) return one;
  return std::min(one, outside_rad(v * (1.0 - 2.0 * std::numbers::pi / angle), limit));
}

std::optional<B> present_parent(const QualityFrames& frames, B bone) {
  for (auto up = parent(bone); up; up = parent(*up)) {
    if (!frames[*up].empty()) return up;
  }
  return std::nullopt;
}

FoundFigure check_limits(const QualityFrames& frames, double warn_deg) {
  FoundFigure out{"limits_deg"};
  int vertebrae = 0;
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest}) {
    if (!frames[bone].empty()) ++vertebrae;
  }
  std::vector<double> excess_deg(static_cast<std::size_t>(frames.count));
  std::vector<double> scratch;
  for (const B bone : human_bones()) {
    const auto up = present_parent(frames, bone);
    if (frames[bone].empty() || !up) continue;
    const auto range = joint_range(bone);
    const BoneLimit limit = range ? *range : spine_range(vertebrae);
    const auto& outer = frames[*up].world_from_t_pose;
    const auto& inner = frames[bone].world_from_t_pose;
    for (std::size_t t = 0; t < excess_deg.size(); ++t) {
      excess_deg[t] =
          kDegreesPerRadian * excess_rad(glm::conjugate(outer[t]) * inner[t], limit);
    }
    scratch = excess_deg;
    const double most_deg = quantile_in_place(scratch, 0.99);
    if (most_deg > out.value) {
      out.value = most_deg;
      out.bone = bone;
    }
    if (most_deg <= warn_deg) continue;
    for (int t = 0; t < frames.count; ++t) {
      const double value = excess_deg[static_cast<std::size_t>(t)];
      if (value > warn_deg) add_place(out.places, {{t, t}, bone, value}, 2);
    }
  }
  for (const FoundPlace& place : out.places) {
    if (place.bone == out.bone && !out.frames) out.frames = place.frames;
  }
  return out;
}

FoundFigure check_self(const QualityFrames& frames, double warn_mm) {
  FoundFigure out{"self_mm"};
  for (std::size_t side = 0; side < 2; ++side) {
    const B hand = side == 0 ? B::kLeftHand : B::kRightHand;
    for (std::size_t t = 0; t < frames.hand_depth_m[side].size(); ++t) {
      const double depth_mm = 1000.0 * frames.hand_depth_m[side][t];
      const FrameRange now{static_cast<int>(t), static_cast<int>(t)};
      if (depth_mm > warn_mm) add_place(out.places, {now, hand, depth_mm}, 2);
      if (depth_mm <= out.value) continue;
      out.value = depth_mm;
      out.bone = hand;
      out.frames = now;
    }
  }
  return out;
}

}  // namespace

std::array<FoundFigure, 5> check_body(const QualityFrames& frames,
                                      const retarget::BodyMap& map,
                                      const QualityLimits& limits) {
  return {check_scale(map, frames.count, limits["scale_sigma"].warn),
          check_limits(frames, limits["limits_deg"].warn),
          check_self(frames, limits["self_mm"].warn),
          FoundFigure{"stature_m", stature_m(map)},
          FoundFigure{"proportions", proportions(frames, map)}};
}

}  // namespace marey::library
