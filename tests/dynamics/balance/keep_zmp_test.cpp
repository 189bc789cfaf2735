// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/keep_zmp.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

using testing::Dice;

constexpr FrameRate kKeepRate{100.0};

// A motion over support areas, with its reactions.
struct KeepScene {
  std::vector<glm::dvec3> com;
  std::vector<SupportPolygon> supports;
  std::vector<GroundReaction> reactions;

  void react() { reactions = ground_reactions(com, {}, kKeepRate); }
  [[nodiscard]] KeepZmpInput input() const {
    return {com, reactions, supports, kKeepRate};
  }
  // Returns the reactions after a displacement, computed from the motion itself.
  [[nodiscard]] std::vector<GroundReaction> after(const KeepZmpResult& kept) const {
    std::vector<glm::dvec3> moved = com;
    for (std::size_t t = 0; t < com.size(); ++t) {
      moved[t] += glm::dvec3(kept.shift_xz_m[t].x, 0.0, kept.shift_xz_m[t].y);
    }
    return ground_reactions(moved, {}, kKeepRate);
  }
};

SupportPolygon box(const glm::dvec2& centre, const glm::dvec2& half) {
  return {centre - half,
          centre + glm::dvec2(half.x, -half.y),
          centre + half,
          centre + glm::dvec2(-half.x, half.y)};
}

// Steps from foot to foot with both feet down between, under a centre of mass that sways
// too far.
KeepScene walking(std::uint64_t seed) {
  Dice dice(seed);
  KeepScene out;
  const double sway_m = dice.between(0.05, 0.12);
  const double phase = dice.between(0.0, 6.28);
  for (int t = 0; t < 240; ++t) {
    const double s = t / kKeepRate.hz;
    out.com.emplace_back(1.0 * s + 0.02 * std::sin(12 * s + phase),
                         0.95 + 0.02 * std::sin(12 * s),
                         sway_m * std::sin(6 * s + phase));
    const int step = t / 60;
    const auto foot = [&](int number) {
      return box({0.3 + 0.6 * number, number % 2 == 0 ? 0.08 : -0.08}, {0.13, 0.045});
    };
    SupportPolygon area = foot(step);
    if (t % 60 >= 45) {  // Both feet: hull of two boxes along X.
      const SupportPolygon other = foot(step + 1);
      area =
          step % 2 == 0
              ? SupportPolygon{area[0], other[0], other[1], other[2], area[2], area[3]}
              : SupportPolygon{area[0], area[1], other[1], other[2], other[3], area[3]};
    }
    out.supports.push_back(area);
  }
  out.react();
  return out;
}

TEST(KeepZmp, AMotionInsideIsNotMoved) {
  KeepScene scene;
  for (int t = 0; t < 60; ++t) {
    scene.com.emplace_back(0.0, 1.0, 0.01 * std::sin(0.1 * t));
    scene.supports.push_back(box({0, 0}, {0.2, 0.2}));
  }
  scene.react();
  const auto kept = keep_zmp(scene.input());
  for (const glm::dvec2& shift : kept.shift_xz_m) EXPECT_EQ(shift, glm::dvec2(0.0));
  EXPECT_TRUE(kept.unmet_frames.empty());
}

TEST(KeepZmp, AStandingBodyIsMovedToTheEdgeLessTheMargin) {
  KeepScene scene;
  for (int t = 0; t < 100; ++t) {
    scene.com.emplace_back(0.5, 1.0, 0.0);
    scene.supports.push_back(box({0.3, 0}, {0.1, 0.1}));
  }
  scene.react();
  const auto kept = keep_zmp(scene.input());
  for (const glm::dvec2& shift : kept.shift_xz_m) {
    EXPECT_NEAR(shift.x, -0.11, 7e-3);
    EXPECT_NEAR(shift.y, 0.0, 1e-7);
  }
}

TEST(KeepZmp, EveryFrameOfAWalkIsInsideAfterwards) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const KeepScene scene = walking(seed);
    const auto before = zmp_figures(scene.reactions, scene.supports);
    ASSERT_LT(before.inside_frames, before.supported_frames);
    const auto kept = keep_zmp(scene.input());
    EXPECT_TRUE(kept.unmet_frames.empty()) << seed;
    const auto after = scene.after(kept);
    for (std::size_t t = 0; t < after.size(); ++t) {
      const auto outside_m = distance_outside(scene.supports[t], *after[t].zmp_xz_m);
      EXPECT_LT(*outside_m, -0.010 + 1e-5) << seed << " frame " << t;
    }
  }
}

// Reference: one axis, intervals; dual coordinate ascent (Hildreth) on dense matrices.
std::vector<double> dense_reference(
    const std::vector<std::vector<double>>& hessian_inverse,
    const std::vector<std::vector<double>>& rows,
    const std::vector<double>& bounds) {
  const std::size_t n = hessian_inverse.size();
  const std::size_t m = rows.size();
  std::vector<std::vector<double>> back(m, std::vector<double>(n, 0.0));
  std::vector<std::vector<double>> gram(m, std::vector<double>(m, 0.0));
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        back[k][i] += hessian_inverse[i][j] * rows[k][j];
      }
    }
  }
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t l = 0; l < m; ++l) {
      for (std::size_t i = 0; i < n; ++i) gram[k][l] += rows[k][i] * back[l][i];
    }
  }
  std::vector<double> force(m, 0.0);
  for (int sweep = 0; sweep < 200000; ++sweep) {
    double change = 0.0;
    for (std::size_t k = 0; k < m; ++k) {
      double value = -bounds[k];
      for (std::size_t l = 0; l < m; ++l) value -= gram[k][l] * force[l];
      const double next = std::max(0.0, force[k] + value / gram[k][k]);
      change = std::max(change, std::abs(next - force[k]));
      force[k] = next;
    }
    if (change < 1e-12) break;
  }
  std::vector<double> out(n, 0.0);
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t i = 0; i < n; ++i) out[i] -= force[k] * back[k][i];
  }
  return out;
}

std::vector<std::vector<double>> inverse_of(std::vector<std::vector<double>> matrix) {
  const std::size_t n = matrix.size();
  std::vector<std::vector<double>> out(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) out[i][i] = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double pivot = matrix[i][i];
    for (std::size_t j = 0; j < n; ++j) {
      matrix[i][j] /= pivot;
      out[i][j] /= pivot;
    }
    for (std::size_t row = 0; row < n; ++row) {
      if (row == i) continue;
      const double share = matrix[row][i];
      for (std::size_t j = 0; j < n; ++j) {
        matrix[row][j] -= share * matrix[i][j];
        out[row][j] -= share * out[i][j];
      }
    }
  }
  return out;
}

TEST(KeepZmp, AgreesWithADenseReferenceOnSmallProblems) {
  constexpr std::size_t kSmall = 24;
  KeepZmpOptions options;
  options.smoothness_s2 = 0.003;  // So that the reference converges.
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Dice dice(seed);
    KeepScene scene;
    const double phase = dice.between(0.0, 6.0);
    for (std::size_t t = 0; t < kSmall; ++t) {
      scene.com.emplace_back(
          0.06 * std::sin(0.2 * static_cast<double>(t) + phase), 0.9, 0);
      scene.supports.push_back(box({0, 0}, {0.06, 0.5}));
    }
    scene.react();
    const auto kept = keep_zmp(scene.input(), options);
    ASSERT_TRUE(kept.unmet_frames.empty());
    // Rows by finite differences of the program's own definition: one unit at a time.
    std::vector<std::vector<double>> rows(2 * kSmall, std::vector<double>(kSmall));
    std::vector<double> bounds(2 * kSmall);
    for (std::size_t i = 0; i < kSmall; ++i) {
      std::vector<glm::dvec3> moved = scene.com;
      moved[i].x += 1.0;
      const auto reactions = ground_reactions(moved, {}, kKeepRate);
      for (std::size_t t = 0; t < kSmall; ++t) {
        rows[t][i] = reactions[t].zmp_xz_m->x - scene.reactions[t].zmp_xz_m->x;
        rows[kSmall + t][i] = -rows[t][i];
      }
    }
    for (std::size_t t = 0; t < kSmall; ++t) {
      bounds[t] = 0.05 - scene.reactions[t].zmp_xz_m->x;
      bounds[kSmall + t] = 0.05 + scene.reactions[t].zmp_xz_m->x;
    }
    std::vector<std::vector<double>> hessian(kSmall, std::vector<double>(kSmall, 0.0));
    const double bend =
        std::pow(options.smoothness_s2 * kKeepRate.hz * kKeepRate.hz, 2.0);
    for (std::size_t t = 0; t < kSmall; ++t) {
      hessian[t][t] += 1.0;
      if (t == 0 || t + 1 == kSmall) continue;
      const double d[3] = {1.0, -2.0, 1.0};
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          hessian[t - 1 + a][t - 1 + b] += bend * d[a] * d[b];
        }
      }
    }
    // The speed at both ends costs 100 times what stopping it does.
    const double end = 100.0 * bend / (kKeepRate.hz * std::sqrt(options.smoothness_s2));
    for (const std::size_t t : {std::size_t{0}, kSmall - 2}) {
      hessian[t][t] += end;
      hessian[t + 1][t + 1] += end;
      hessian[t][t + 1] -= end;
      hessian[t + 1][t] -= end;
    }
    const auto reference = dense_reference(inverse_of(hessian), rows, bounds);
    for (std::size_t t = 0; t < kSmall; ++t) {
      EXPECT_NEAR(kept.shift_xz_m[t].x, reference[t], 1e-4) << seed << " " << t;
    }
  }
}

TEST(KeepZmp, AreasThatCannotBeReachedAreReported) {
  KeepScene scene;
  for (int t = 0; t < 120; ++t) {
    scene.com.emplace_back(0.0, 1.0, 0.0);
    // The area is two metres away for a tenth of a second.
    scene.supports.push_back(box({t >= 60 && t < 70 ? 2.0 : 0.0, 0.0}, {0.1, 0.1}));
  }
  scene.react();
  const auto kept = keep_zmp(scene.input());
  ASSERT_FALSE(kept.unmet_frames.empty());
  for (const int frame : kept.unmet_frames) {
    EXPECT_GE(frame, 55);
    EXPECT_LT(frame, 75);
  }
  EXPECT_GT(kept.worst_unmet_m, 0.5);
  for (const glm::dvec2& shift : kept.shift_xz_m) {
    EXPECT_LE(std::abs(shift.x), 0.25 + 1e-4);
  }
}

TEST(KeepZmp, FramesWithoutFreedomStay) {
  KeepScene scene = walking(7);
  std::vector<double> freedom(scene.com.size(), 0.0);
  for (std::size_t t = 80; t < 160; ++t) {
    freedom[t] = std::min({1.0,
                           (static_cast<double>(t) - 79.0) / 20.0,
                           (160.0 - static_cast<double>(t)) / 20.0});
  }
  KeepZmpInput input = scene.input();
  input.freedom = freedom;
  const auto kept = keep_zmp(input);
  for (std::size_t t = 0; t < scene.com.size(); ++t) {
    if (freedom[t] > 0.0) continue;
    EXPECT_LT(glm::length(kept.shift_xz_m[t]), 1e-6) << t;
  }
  EXPECT_GT(glm::length(kept.shift_xz_m[120]), 1e-4);
}

TEST(KeepZmp, ATurnedAndMovedMotionIsMovedInTheSameWay) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    KeepScene scene = walking(seed);
    const auto kept = keep_zmp(scene.input());
    const glm::dvec2 way(3.0, -2.0);
    KeepScene turned = scene;
    for (std::size_t t = 0; t < scene.com.size(); ++t) {
      const glm::dvec3 p = scene.com[t];
      turned.com[t] = {-p.z + way.x, p.y, p.x + way.y};
      for (glm::dvec2& corner : turned.supports[t]) {
        corner = glm::dvec2(-corner.y, corner.x) + way;
      }
    }
    turned.react();
    const auto of_turned = keep_zmp(turned.input());
    for (std::size_t t = 0; t < scene.com.size(); ++t) {
      EXPECT_NEAR(of_turned.shift_xz_m[t].x, -kept.shift_xz_m[t].y, 1e-4);
      EXPECT_NEAR(of_turned.shift_xz_m[t].y, kept.shift_xz_m[t].x, 1e-4);
    }
  }
}

TEST(KeepZmp, EqualInputsGiveEqualBits) {
  const KeepScene scene = walking(1);
  EXPECT_EQ(keep_zmp(scene.input()).shift_xz_m, keep_zmp(scene.input()).shift_xz_m);
}

TEST(KeepZmp, FramesWithoutAnAreaAreCounted) {
  KeepScene scene = walking(2);
  scene.supports[30] = {};
  scene.supports[31] = {{0, 0}, {1, 0}};
  const auto kept = keep_zmp(scene.input());
  EXPECT_EQ(kept.without_area_frames, 2);
}

}  // namespace
}  // namespace marey::dynamics
