// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/blend_postures.h"

#include <algorithm>
#include <array>

#include "engine/blend/blend_rotations.h"
#include "engine/blend/lane_math.h"

#include "core/base/assert.h"

namespace marey::engine {
namespace {

using LimbValues = std::array<float, 4>;

constexpr auto kRoot = static_cast<std::size_t>(EditGroup::kRoot);
constexpr auto kTrunk = static_cast<std::size_t>(EditGroup::kTrunk);

[[gnu::always_inline]] inline float linear_value(float a, float b, float at) {
  return a + at * (b - a);
}

[[gnu::always_inline]] inline float linear_angle(float a, float b, float at) {
  return a + at * wrapped_rad(b - a);
}

[[gnu::always_inline]] inline float exact_ends(
    float a, float b, float old, float at, float between) {
  const float end = at == 0.0F ? a : (at == 1.0F ? b : old);
  return at == 0.0F || at == 1.0F || at < 0.0F ? end : between;
}

// Sources that weigh something in a group, with weights of each group that sum to one.
struct Blended {
  std::array<const BlendPosture*, kMaxBlended> sources{};
  std::array<PerGroup, kMaxBlended> weights{};
  PerGroup total{};
  std::size_t count = 0;
};

Blended normalised(std::span<const BlendPosture* const> sources,
                   std::span<const PerGroup> weights) {
  Blended blended;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    bool counts = false;
    for (std::size_t g = 0; g < kGroupCount; ++g) {
      blended.total[g] += weights[s][g];
      counts = counts || weights[s][g] > 0.0F;
    }
    if (!counts) continue;
    blended.sources[blended.count] = sources[s];
    blended.weights[blended.count] = weights[s];
    ++blended.count;
  }
  for (std::size_t s = 0; s < blended.count; ++s) {
    for (std::size_t g = 0; g < kGroupCount; ++g) {
      const float total = blended.total[g];
      blended.weights[s][g] = total > 0.0F ? blended.weights[s][g] / total : 0.0F;
    }
  }
  return blended;
}

void blend_two_values(const BlendPosture& a,
                      const BlendPosture& b,
                      const PerGroup& at,
                      BlendPosture& out) {
  LimbValues limb_at;
  for (std::size_t i = 0; i < 4; ++i) limb_at[i] = at[group_of_limb()[i]];
  const auto blend = [&limb_at](const LimbValues& p, const LimbValues& q, LimbValues& r) {
    for (std::size_t i = 0; i < 4; ++i) {
      const float t = limb_at[i];
      r[i] = exact_ends(p[i], q[i], r[i], t, linear_value(p[i], q[i], t));
    }
  };
  const auto turn = [&limb_at](const LimbValues& p, const LimbValues& q, LimbValues& r) {
    for (std::size_t i = 0; i < 4; ++i) {
      const float t = limb_at[i];
      r[i] = exact_ends(p[i], q[i], r[i], t, linear_angle(p[i], q[i], t));
    }
  };
  blend(a.fold_rad, b.fold_rad, out.fold_rad);
  blend(a.mid_x, b.mid_x, out.mid_x);
  blend(a.mid_y, b.mid_y, out.mid_y);
  turn(a.upper_twist_rad, b.upper_twist_rad, out.upper_twist_rad);
  turn(a.lower_twist_rad, b.lower_twist_rad, out.lower_twist_rad);
  const auto blend_one = [](float p, float q, float t, float& r) {
    r = exact_ends(p, q, r, t, linear_value(p, q, t));
  };
  blend_one(a.height_legs, b.height_legs, at[kRoot], out.height_legs);
  blend_one(a.abdomen_share, b.abdomen_share, at[kTrunk], out.abdomen_share);
  blend_one(a.torso_share, b.torso_share, at[kTrunk], out.torso_share);
}

// Mean of one value of all sources: linear, or of angles within half a turn of the
// heaviest one's.
template <class Value>
void blend_many_value(const Blended& blended,
                      std::size_t group,
                      bool is_angle,
                      const Value& value_of,
                      float& out) {
  if (!(blended.total[group] > 0.0F)) return;
  std::size_t heaviest = 0;
  for (std::size_t s = 1; s < blended.count; ++s) {
    if (blended.weights[s][group] > blended.weights[heaviest][group]) heaviest = s;
  }
  const float reference = value_of(*blended.sources[heaviest]);
  float sum = 0.0F;
  for (std::size_t s = 0; s < blended.count; ++s) {
    const float difference = value_of(*blended.sources[s]) - reference;
    sum += blended.weights[s][group] * (is_angle ? wrapped_rad(difference) : difference);
  }
  out = blended.weights[heaviest][group] == 1.0F ? reference : reference + sum;
}

void blend_many_values(const Blended& blended, BlendPosture& out) {
  const auto blend = [&](std::size_t group, bool is_angle, const auto& value_of) {
    blend_many_value(blended, group, is_angle, value_of, value_of(out));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t group = group_of_limb()[i];
    blend(
        group, false, [i](auto& p) -> auto& { return p.fold_rad[i]; });
    blend(
        group, false, [i](auto& p) -> auto& { return p.mid_x[i]; });
    blend(
        group, false, [i](auto& p) -> auto& { return p.mid_y[i]; });
    blend(
        group, true, [i](auto& p) -> auto& { return p.upper_twist_rad[i]; });
    blend(
        group, true, [i](auto& p) -> auto& { return p.lower_twist_rad[i]; });
  }
  blend(
      kRoot, false, [](auto& p) -> auto& { return p.height_legs; });
  blend(
      kTrunk, false, [](auto& p) -> auto& { return p.abdomen_share; });
  blend(
      kTrunk, false, [](auto& p) -> auto& { return p.torso_share; });
}

void blend_two(const Blended& blended, BlendSides& sides, BlendPosture& out) {
  PerGroup at;
  for (std::size_t g = 0; g < kGroupCount; ++g) {
    at[g] = blended.total[g] > 0.0F ? blended.weights[1][g] : -1.0F;
  }
  LanePlaces lane_at;
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    lane_at[i] = at[group_of_rotation()[i]];
  }
  const BlendPosture& a = *blended.sources[0];
  const BlendPosture& b = *blended.sources[1];
  blend_two_rotations(a, b, lane_at, sides, out);
  blend_two_values(a, b, at, out);
}

void blend_many(const Blended& blended, BlendSides& sides, BlendPosture& out) {
  LaneWeights weights;
  for (std::size_t i = 0; i < kPostureRotations; ++i) {
    const std::size_t group = group_of_rotation()[i];
    weights.total[i] = blended.total[group];
    for (std::size_t s = 0; s < blended.count; ++s) {
      weights.of_source[s][i] = blended.weights[s][group];
    }
  }
  blend_many_rotations({blended.sources.data(), blended.count}, weights, sides, out);
  blend_many_values(blended, out);
}

void set_sides(const BlendPosture& posture, BlendSides& sides) {
  sides.x = posture.x;
  sides.y = posture.y;
  sides.z = posture.z;
  sides.w = posture.w;
  sides.is_known = true;
}

void blend_counted(Blended& blended, BlendSides& sides, BlendPosture& out) {
  if (blended.count > 2) {
    blend_many(blended, sides, out);
    return;
  }
  if (blended.count == 1) blended.sources[1] = blended.sources[0];
  // Sides of the first source: the shorter arcs decide.
  if (!sides.is_known) set_sides(*blended.sources[0], sides);
  blend_two(blended, sides, out);
}

}  // namespace

void interpolate(const BlendPosture& a,
                 const BlendPosture& b,
                 float at,
                 BlendPosture& out) {
  MAREY_ASSERT(at >= 0.0F && at <= 1.0F);
  if (at == 0.0F || at == 1.0F) {
    out = at == 0.0F ? a : b;
    return;
  }
  if (&out == &a || &out == &b) {
    BlendPosture made;
    interpolate(a, b, at, made);
    out = made;
    return;
  }
  interpolate_rotations(a, b, at, out);
  for (std::size_t i = 0; i < 4; ++i) {
    out.fold_rad[i] = linear_value(a.fold_rad[i], b.fold_rad[i], at);
    out.mid_x[i] = linear_value(a.mid_x[i], b.mid_x[i], at);
    out.mid_y[i] = linear_value(a.mid_y[i], b.mid_y[i], at);
    out.upper_twist_rad[i] = linear_angle(a.upper_twist_rad[i], b.upper_twist_rad[i], at);
    out.lower_twist_rad[i] = linear_angle(a.lower_twist_rad[i], b.lower_twist_rad[i], at);
  }
  out.height_legs = linear_value(a.height_legs, b.height_legs, at);
  out.abdomen_share = linear_value(a.abdomen_share, b.abdomen_share, at);
  out.torso_share = linear_value(a.torso_share, b.torso_share, at);
}

void blend_postures(std::span<const BlendPosture* const> sources,
                    std::span<const PerGroup> weights,
                    BlendSides* sides,
                    BlendPosture& out) {
  MAREY_ASSERT(sources.size() == weights.size() && sources.size() <= kMaxBlended);
  Blended blended = normalised(sources, weights);
  if (blended.count == 0) return;
  BlendSides unknown;
  BlendSides& known = sides != nullptr ? *sides : unknown;
  // The kernels read the sources after they write the result.
  const bool is_source = std::find(sources.begin(), sources.end(), &out) != sources.end();
  if (is_source) {
    BlendPosture made = out;
    blend_counted(blended, known, made);
    out = made;
  } else {
    blend_counted(blended, known, out);
  }
}

}  // namespace marey::engine
