// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/constraint_projections.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

namespace marey::retarget {

/// Four floats in parallel, with the operations of a SIMD batch and no others: a formula
/// that branches on values does not compile with it.
struct FourMask {
  std::array<bool, 4> lane{};
};
struct Four {
  using value_type = float;
  Four() = default;
  explicit Four(float all) { lane.fill(all); }
  std::array<float, 4> lane{};
};

template <class Out, class Operation, class... In>
Out each(Operation operation, const In&... in) {
  Out out;
  for (std::size_t i = 0; i < 4; ++i) out.lane[i] = operation(in.lane[i]...);
  return out;
}
inline Four operator+(const Four& a, const Four& b) {
  return each<Four>([](float x, float y) { return x + y; }, a, b);
}
inline Four operator-(const Four& a, const Four& b) {
  return each<Four>([](float x, float y) { return x - y; }, a, b);
}
inline Four operator*(const Four& a, const Four& b) {
  return each<Four>([](float x, float y) { return x * y; }, a, b);
}
inline Four operator/(const Four& a, const Four& b) {
  return each<Four>([](float x, float y) { return x / y; }, a, b);
}
inline FourMask operator<(const Four& a, const Four& b) {
  return each<FourMask>([](float x, float y) { return x < y; }, a, b);
}
inline FourMask operator>(const Four& a, const Four& b) {
  return b < a;
}
inline FourMask operator<=(const Four& a, const Four& b) {
  return each<FourMask>([](float x, float y) { return x <= y; }, a, b);
}
inline FourMask operator&(const FourMask& a, const FourMask& b) {
  return each<FourMask>([](bool x, bool y) { return x && y; }, a, b);
}
inline FourMask operator!(const FourMask& a) {
  return each<FourMask>([](bool x) { return !x; }, a);
}
inline Four select(const FourMask& mask, const Four& a, const Four& b) {
  return each<Four>([](bool m, float x, float y) { return m ? x : y; }, mask, a, b);
}
inline Four sqrt(const Four& a) {
  return each<Four>([](float x) { return std::sqrt(x); }, a);
}
inline Four min(const Four& a, const Four& b) {
  return select(b < a, b, a);
}
inline Four max(const Four& a, const Four& b) {
  return select(a < b, b, a);
}

namespace {

using Single = Vec3<float>;

Vec3<Four> side_by_side(const std::array<Single, 4>& bodies) {
  Vec3<Four> all;
  for (std::size_t i = 0; i < 4; ++i) {
    all.x.lane[i] = bodies[i].x;
    all.y.lane[i] = bodies[i].y;
    all.z.lane[i] = bodies[i].z;
  }
  return all;
}

void expect_lane(const Vec3<Four>& all, std::size_t i, const Single& alone) {
  EXPECT_EQ(all.x.lane[i], alone.x);
  EXPECT_EQ(all.y.lane[i], alone.y);
  EXPECT_EQ(all.z.lane[i], alone.z);
}

// Each lane equals to the bit that body alone, for any neighbours: inside, outside, on a
// face, and where a direction does not exist.
TEST(ConstraintProjections, MatchTheResultOfEachBodyAloneInItsLane) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> coordinate(-2.0F, 2.0F);
  const Single low{-1.0F, -0.5F, -1.5F};
  const Single high{1.0F, 1.5F, 0.5F};
  const Single from{0.25F, 0.5F, -0.25F};
  const auto all_low = side_by_side({low, low, low, low});
  const auto all_high = side_by_side({high, high, high, high});
  const auto all_from = side_by_side({from, from, from, from});
  for (int round = 0; round < 500; ++round) {
    std::array<Single, 4> p{from, high};
    for (std::size_t i = 2; i < 4; ++i) {
      p[i] = {coordinate(random), coordinate(random), coordinate(random)};
    }
    std::swap(p[static_cast<std::size_t>(round % 4)], p[0]);
    const float d = std::abs(coordinate(random));
    const auto distant = at_distance(side_by_side(p), all_from, Four(d));
    const auto in = inside(side_by_side(p), all_low, all_high);
    const auto out = outside(side_by_side(p), all_low, all_high);
    for (std::size_t i = 0; i < 4; ++i) {
      expect_lane(distant, i, at_distance(p[i], from, d));
      expect_lane(in, i, inside(p[i], low, high));
      expect_lane(out, i, outside(p[i], low, high));
    }
  }
}

// From contact to 10 km, and below the resolution of float: the distance is kept to a few
// roundings, and nothing overflows.
TEST(ConstraintProjections, KeepTheirDistanceInSinglePrecision) {
  for (const float away : {0.0F, 1e-38F, 1e-20F, 1e-7F, 1e-5F, 1e-3F, 1.0F, 1e4F}) {
    for (const float d : {1e-3F, 0.5F, 1e4F}) {
      const Single place{away, -away, away};
      const Single target = at_distance(place, Single{}, d);
      EXPECT_NEAR(length(target), d, 4e-7F * d) << away << " " << d;
    }
    const Single contact = at_distance(Single{away, 0.0F, 0.0F}, Single{}, 0.0F);
    EXPECT_EQ(length(contact), 0.0F);
  }
}

// Beyond kNoDirection the direction is the point's own: two near points on either side
// have targets on either side.
TEST(ConstraintProjections, GoUpOnlyFromWithinAMicrometre) {
  EXPECT_EQ(at_distance(Vec3<double>{-2e-6, 0, 0}, {}, 1.0).x, -1.0);
  EXPECT_EQ(at_distance(Vec3<double>{-5e-7, 0, 0}, {}, 1.0).x, 0.0);
  EXPECT_EQ(at_distance(Vec3<double>{-5e-7, 0, 0}, {}, 1.0).y, 1.0);
}

}  // namespace
}  // namespace marey::retarget
