// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/blend_rotations.h"

#include <algorithm>
#include <cmath>

#include "engine/blend/lane_math.h"

namespace marey::engine {
namespace {

using Lanes = BlendPosture::Rotations;

// Cosine of half of 240 degrees: two rotations that come further apart than this on the
// side of the step before are blended on the other side.
constexpr float kMinKeptCosine = -0.5F;
// Tangent steps, as in mean_rotation().
constexpr int kMeanSteps = 2;
// Squared length of a weighted sum below which it has no direction.
constexpr float kMinSquaredSum = 1e-8F;

template <class Source>
[[gnu::always_inline]] inline LaneQuat lane(const Source& from, std::size_t i) {
  return {from.x[i], from.y[i], from.z[i], from.w[i]};
}

template <class Target>
[[gnu::always_inline]] inline void store_lane(const LaneQuat& q,
                                              std::size_t i,
                                              Target& to) {
  to.x[i] = q.x;
  to.y[i] = q.y;
  to.z[i] = q.z;
  to.w[i] = q.w;
}

[[gnu::always_inline]] inline LaneQuat select_lane(LaneMask first,
                                                   const LaneQuat& a,
                                                   const LaneQuat& b) {
  return {lane_select(first, a.x, b.x),
          lane_select(first, a.y, b.y),
          lane_select(first, a.z, b.z),
          lane_select(first, a.w, b.w)};
}

[[gnu::always_inline]] inline LaneQuat weighted_sum(float wa,
                                                    const LaneQuat& a,
                                                    float wb,
                                                    const LaneQuat& b) {
  return {
      wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w};
}

[[gnu::always_inline]] inline LaneQuat lane_product(const LaneQuat& a,
                                                    const LaneQuat& b) {
  return {a.w * b.x + a.x * b.w + (a.y * b.z - a.z * b.y),
          a.w * b.y + a.y * b.w + (a.z * b.x - a.x * b.z),
          a.w * b.z + a.z * b.w + (a.x * b.y - a.y * b.x),
          a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z)};
}

// Sign of a rotation relative to another one: as the side of the step before has it, as
// long as the two are within 240 degrees; else that of the shorter arc.
[[gnu::always_inline]] inline float sign_between(float dot,
                                                 float a_dot_side,
                                                 float b_dot_side) {
  const float shorter = std::copysign(1.0F, dot);
  const float kept = std::copysign(1.0F, a_dot_side * b_dot_side);
  return lane_select(lane_mask(kept * dot < kMinKeptCosine), shorter, kept);
}

// Sums of a mean of many rotations.
struct SumLanes {
  Lanes x{};
  Lanes y{};
  Lanes z{};
  Lanes w{};
};

// Heaviest rotation of each lane; the first one of equal ones.
void find_heaviest(std::span<const BlendPosture* const> sources,
                   const LaneWeights& weights,
                   SumLanes& __restrict heaviest) {
  Lanes greatest{};
  greatest.fill(-1.0F);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const BlendPosture& source = *sources[s];
    const Lanes& weight = weights.of_source[s];
    for (std::size_t i = 0; i < kPostureRotations; ++i) {
      const LaneMask is_heavier = lane_mask(weight[i] > greatest[i]);
      greatest[i] = lane_select(is_heavier, weight[i], greatest[i]);
      store_lane(
          select_lane(is_heavier, lane(source, i), lane(heaviest, i)), i, heaviest);
    }
  }
}

// Adds a source to the weighted sum and to the next side; returns its signed weights.
void add_source(const BlendPosture& source,
                const Lanes& weight,
                const SumLanes& heaviest,
                const BlendSides& side,
                Lanes& __restrict sign,
                SumLanes& __restrict sum,
                SumLanes& __restrict next_side) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneQuat q = lane(source, i);
    const LaneQuat h = lane(heaviest, i);
    const LaneQuat before = lane(side, i);
    sign[i] = sign_between(lane_dot(h, q), lane_dot(h, before), lane_dot(q, before));
    store_lane(weighted_sum(1.0F, lane(sum, i), sign[i] * weight[i], q), i, sum);
    const float counts = lane_select(lane_mask(weight[i] > 0.0F), sign[i], 0.0F);
    store_lane(weighted_sum(1.0F, lane(next_side, i), counts, q), i, next_side);
  }
}

// Adds the weighted logarithm of a source about the normalised sum, as half the rotation
// vector.
void add_logarithm(const BlendPosture& source,
                   const Lanes& weight,
                   const Lanes& sign,
                   const SumLanes& about,
                   SumLanes& __restrict logarithm) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneQuat m = lane(about, i);
    const LaneQuat inverse{-m.x, -m.y, -m.z, m.w};
    const LaneQuat r = lane_product(inverse, lane(source, i));
    const float u = 1.0F - sign[i] * r.w;
    const float angle2 = wide_squared_angle(lane_select(lane_mask(u < 1.5F), u, 1.5F));
    const float scale = sign[i] * weight[i] / sine_over_angle(angle2);
    logarithm.x[i] += scale * r.x;
    logarithm.y[i] += scale * r.y;
    logarithm.z[i] += scale * r.z;
  }
}

void normalise_sums(const SumLanes& heaviest, SumLanes& __restrict sum) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneQuat s = lane(sum, i);
    const float length2 = lane_dot(s, s);
    const LaneMask is_usable = lane_mask(length2 > kMinSquaredSum);
    const float k = inverse_root(lane_select(is_usable, length2, 1.0F));
    const LaneQuat unit{k * s.x, k * s.y, k * s.z, k * s.w};
    store_lane(select_lane(is_usable, unit, lane(heaviest, i)), i, sum);
  }
}

// Turns the normalised sum by the mean logarithm.
void turn_sums(const SumLanes& logarithm, SumLanes& __restrict mean) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const float x = logarithm.x[i];
    const float y = logarithm.y[i];
    const float z = logarithm.z[i];
    const float angle2 = x * x + y * y + z * z;
    const float k = sine_over_angle(angle2);
    const LaneQuat turn{k * x, k * y, k * z, cosine_of_root(angle2)};
    store_lane(nearly_unit(lane_product(lane(mean, i), turn)), i, mean);
  }
}

}  // namespace

void interpolate_rotations(const BlendPosture& a,
                           const BlendPosture& b,
                           float at,
                           BlendPosture& __restrict out) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneQuat p = lane(a, i);
    const LaneQuat q = lane(b, i);
    const float dot = lane_dot(p, q);
    const float sign = std::copysign(1.0F, dot);
    const SlerpWeights w = slerp_weights(squared_angle(1.0F - sign * dot), at);
    store_lane(nearly_unit(weighted_sum(w.first, p, sign * w.second, q)), i, out);
  }
}

void blend_two_rotations(const BlendPosture& a,
                         const BlendPosture& b,
                         const LanePlaces& at,
                         BlendSides& __restrict sides,
                         BlendPosture& __restrict out) {
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneQuat p = lane(a, i);
    const LaneQuat q = lane(b, i);
    const LaneQuat side = lane(sides, i);
    const LaneQuat old = lane(out, i);
    const float dot = lane_dot(p, q);
    const float sign = sign_between(dot, lane_dot(p, side), lane_dot(q, side));
    const SlerpWeights w = slerp_weights(wide_squared_angle(1.0F - sign * dot), at[i]);
    // The result has the sign of the heavier one.
    const LaneMask is_far = lane_mask(at[i] > 0.5F);
    const float of_p = lane_select(is_far, sign, 1.0F);
    const float of_q = lane_select(is_far, 1.0F, sign);
    const LaneQuat mean =
        nearly_unit(weighted_sum(of_p * w.first, p, of_q * w.second, q));
    const LaneQuat middle = weighted_sum(1.0F, p, sign, q);
    const LaneMask is_first = lane_mask(at[i] == 0.0F);
    const LaneMask is_second = lane_mask(at[i] == 1.0F);
    const LaneMask is_old = lane_mask(at[i] < 0.0F);
    const LaneQuat end = select_lane(is_first, p, select_lane(is_second, q, old));
    const LaneQuat end_side = select_lane(is_first, p, select_lane(is_second, q, side));
    const LaneMask is_end = is_first | is_second | is_old;
    store_lane(select_lane(is_end, end, mean), i, out);
    store_lane(select_lane(is_end, end_side, middle), i, sides);
  }
}

void blend_many_rotations(std::span<const BlendPosture* const> sources,
                          const LaneWeights& weights,
                          BlendSides& __restrict sides,
                          BlendPosture& __restrict out) {
  SumLanes heaviest;
  find_heaviest(sources, weights, heaviest);
  if (!sides.is_known) {
    sides = {heaviest.x, heaviest.y, heaviest.z, heaviest.w, true};
  }
  std::array<Lanes, kMaxBlended> signs;
  SumLanes mean;
  SumLanes next_side;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    add_source(
        *sources[s], weights.of_source[s], heaviest, sides, signs[s], mean, next_side);
  }
  normalise_sums(heaviest, mean);
  for (int step = 0; step < kMeanSteps; ++step) {
    SumLanes logarithm;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      add_logarithm(*sources[s], weights.of_source[s], signs[s], mean, logarithm);
    }
    turn_sums(logarithm, mean);
  }
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const LaneMask is_kept = lane_mask(weights.total[i] <= 0.0F);
    store_lane(select_lane(is_kept, lane(out, i), lane(mean, i)), i, out);
    store_lane(select_lane(is_kept, lane(sides, i), lane(next_side, i)), i, sides);
  }
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const BlendPosture& source = *sources[s];
    const Lanes& weight = weights.of_source[s];
    for (std::size_t i = 0; i < kPostureRotations; ++i) {
      const LaneMask is_alone = lane_mask(weight[i] == 1.0F);
      store_lane(select_lane(is_alone, lane(source, i), lane(out, i)), i, out);
    }
  }
}

}  // namespace marey::engine
