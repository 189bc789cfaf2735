// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/keep_zmp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "dynamics/balance/banded_cholesky.h"
#include "dynamics/balance/local_cubic.h"
#include "dynamics/balance/zmp_edges.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

// Factors of the price of a distance outside. The first one leaves no frame outside if
// that is possible; the others are tried in turn where it is not, because large
// displacements would not help.
constexpr std::array<double, 3> kPriceFactors{1.0, 0.3, 0.1};
// Cost of a displacement that moves at an end of the motion, over that of stopping it
// there: a motion does not begin or end in a fall.
constexpr double kEndFactor = 100.0;
// Solutions this many times beyond the limit come from rounding.
constexpr double kDiverged = 2.0;
constexpr double kPinned = 1e10;
constexpr double kMinFreedom = 1e-3;
constexpr double kFirstSlack_m = 0.01;
constexpr double kFirstGap = 1e-2;
constexpr double kLastGap = 1e-10;
constexpr double kLastResidual = 1e-9;
constexpr double kToBoundary = 0.99;
// Smaller distances outside are rounding.
constexpr double kMet_m = 1e-7;

// The quadratic programme and its state.
class ZmpProgramme {
 public:
  ZmpProgramme(const KeepZmpInput& input, const KeepZmpOptions& options, double price_m)
      : input_(input),
        price_m_(price_m),
        frames_(input.com_in_world.size()),
        derive_(frames_, input.rate, options.zmp.smoothing_s),
        limited_(frames_, 0),
        x_(2 * frames_, 0.0),
        step_(2 * frames_, 0.0),
        gradient_(2 * frames_, 0.0),
        matrix_(2 * frames_, std::max<std::size_t>(4 * derive_.half() + 1, 5)) {
    const double stop = options.smoothness_s2 * input.rate.hz * input.rate.hz;
    end_ = kEndFactor * stop * stop / (input.rate.hz * std::sqrt(options.smoothness_s2));
    for (std::size_t t = 0; t < frames_; ++t) {
      const GroundReaction& reaction = input.reactions[t];
      const double height_m = input.com_in_world[t].y - options.zmp.floor_height_m;
      lever_s2_.push_back(reaction.zmp_xz_m ? height_m / reaction.force_m_s2.y : 0.0);
      const double freedom = input.freedom.empty() ? 1.0 : input.freedom[t];
      near_.push_back(freedom > kMinFreedom ? 1.0 / (freedom * freedom) : kPinned);
      const double bend = options.smoothness_s2 * input.rate.hz * input.rate.hz *
                          (reaction.zmp_xz_m ? 1.0 : options.flight_factor);
      smooth_.push_back(bend * bend);
      if (freedom <= kMinFreedom) continue;
      add_shift_limits(t, options.max_shift_m, edges_);
      if (!reaction.zmp_xz_m) continue;
      const bool has_area =
          add_support_edges(t, input.supports[t], options.margin_m, edges_);
      limited_[t] = has_area ? 1 : 0;
      if (!has_area) ++without_area_;
    }
  }

  [[nodiscard]] bool is_met() const {
    return std::all_of(edges_.begin(), edges_.end(), [&](const ZmpEdge& edge) {
      return glm::dot(edge.normal, reference(row_of(edge))) <= edge.bound_m;
    });
  }

  int solve(int max_iterations) {
    start();
    for (int i = 0; i < max_iterations; ++i) {
      const double gap = evaluate();
      if (gap < kLastGap && residual_ < kLastResidual) return i;
      assemble();
      eliminate(0.0, false);
      const double predicted = std::pow(1.0 - longest_step(), 3.0);
      for (ZmpEdge& edge : edges_) {
        edge.correct_room = edge.d_room * edge.d_push;
        edge.correct_slack = edge.d_slack * edge.d_release;
      }
      eliminate(std::max(predicted, 1e-3) * gap, true);
      // Rounding prevents a better solution.
      if (!std::isfinite(std::accumulate(step_.begin(), step_.end(), 0.0))) return i;
      advance(kToBoundary * longest_step());
    }
    return max_iterations;
  }

  [[nodiscard]] glm::dvec2 shift(std::size_t t) const {
    if (near_[t] >= kPinned) return glm::dvec2(0.0);
    return {x_[2 * t], x_[2 * t + 1]};
  }
  // Returns the predicted zero moment point. Precondition: the frame is loaded.
  [[nodiscard]] glm::dvec2 zmp(std::size_t t) const {
    return *input_.reactions[t].zmp_xz_m + moved(x_, {t, true, lever_s2_[t]});
  }
  [[nodiscard]] bool is_limited(std::size_t t) const { return limited_[t] != 0; }
  [[nodiscard]] int without_area() const { return without_area_; }

 private:
  // A point of one frame that edges limit: its zero moment point, or its displacement,
  // which has no lever.
  struct Row {
    std::size_t frame = 0;
    bool of_zmp = true;
    double lever_s2 = 0.0;
  };

  [[nodiscard]] Row row_of(const ZmpEdge& edge) const {
    return {edge.frame, edge.of_zmp, edge.of_zmp ? lever_s2_[edge.frame] : 0.0};
  }
  [[nodiscard]] glm::dvec2 reference(const Row& row) const {
    if (row.of_zmp) return *input_.reactions[row.frame].zmp_xz_m;
    return input_.displaced_xz_m.empty() ? glm::dvec2(0.0)
                                         : input_.displaced_xz_m[row.frame];
  }

  [[nodiscard]] glm::dvec2 moved(std::span<const double> x, const Row& row) const {
    const std::size_t t = row.frame;
    const auto weights = derive_.curvature(t);
    const std::size_t first = derive_.first(t);
    glm::dvec2 bend(0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      bend += weights[i] * glm::dvec2(x[2 * (first + i)], x[2 * (first + i) + 1]);
    }
    return glm::dvec2(x[2 * t], x[2 * t + 1]) - row.lever_s2 * bend;
  }

  void add_transposed(const glm::dvec2& force,
                      const Row& row,
                      std::span<double> out) const {
    const std::size_t t = row.frame;
    const auto weights = derive_.curvature(t);
    const std::size_t first = derive_.first(t);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      out[2 * (first + i)] -= row.lever_s2 * weights[i] * force.x;
      out[2 * (first + i) + 1] -= row.lever_s2 * weights[i] * force.y;
    }
    out[2 * t] += force.x;
    out[2 * t + 1] += force.y;
  }

  void start() {
    for (ZmpEdge& edge : edges_) {
      const double room_m = edge.bound_m - glm::dot(edge.normal, reference(row_of(edge)));
      edge.room = std::max(room_m, kFirstSlack_m);
      edge.push = kFirstGap / edge.room;
      edge.release = price_m_ - edge.push;
      edge.slack = kFirstGap / edge.release;
    }
  }

  [[nodiscard]] double displaced(std::size_t i) const {
    if (input_.displaced_xz_m.empty()) return x_[i];
    const glm::dvec2& before = input_.displaced_xz_m[i / 2];
    return x_[i] + (i % 2 == 0 ? before.x : before.y);
  }

  [[nodiscard]] std::vector<std::array<std::size_t, 2>> ends() const {
    const std::size_t n = x_.size();
    if (frames_ < 3) return {};
    return {{0, 2}, {1, 3}, {n - 2, n - 4}, {n - 1, n - 3}};
  }

  // Computes gradient and residuals; returns the mean complementarity gap.
  double evaluate() {
    residual_ = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      gradient_[i] = near_[i / 2] * (near_[i / 2] < kPinned ? displaced(i) : x_[i]);
    }
    for (std::size_t i = 2; i + 2 < x_.size(); ++i) {
      const double bend =
          smooth_[i / 2] * (displaced(i - 2) - 2.0 * displaced(i) + displaced(i + 2));
      gradient_[i - 2] += bend;
      gradient_[i] -= 2.0 * bend;
      gradient_[i + 2] += bend;
    }
    for (const auto& [i, j] : ends()) {
      const double way = end_ * (displaced(i) - displaced(j));
      gradient_[i] += way;
      gradient_[j] -= way;
    }
    double gap = 0.0;
    for_each_row([&](const Row& row, std::span<ZmpEdge> edges) {
      const glm::dvec2 p = reference(row) + moved(x_, row);
      glm::dvec2 force(0.0);
      for (ZmpEdge& edge : edges) {
        edge.residual = glm::dot(edge.normal, p) - edge.slack + edge.room - edge.bound_m;
        residual_ = std::max(residual_, std::abs(edge.residual));
        force += edge.push * edge.normal;
        gap += edge.push * edge.room + edge.release * edge.slack;
      }
      add_transposed(force, row, gradient_);
    });
    return gap / static_cast<double>(2 * edges_.size());
  }

  void assemble() {
    matrix_.clear();
    for (std::size_t i = 0; i < x_.size(); ++i) matrix_.add(i, i, near_[i / 2]);
    for (std::size_t i = 2; i + 2 < x_.size(); ++i) {
      const std::array<double, 3> d{1.0, -2.0, 1.0};
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
          matrix_.add(i + 2 * a - 2, i + 2 * b - 2, smooth_[i / 2] * d[a] * d[b]);
        }
      }
    }
    for (const auto& [i, j] : ends()) {
      matrix_.add(i, i, end_);
      matrix_.add(j, j, end_);
      matrix_.add(std::max(i, j), std::min(i, j), -end_);
    }
    for_each_row([&](const Row& row, std::span<ZmpEdge> edges) {
      double xx = 0.0, xz = 0.0, zz = 0.0;
      for (ZmpEdge& edge : edges) {
        edge.compliance = edge.slack / edge.release + edge.room / edge.push;
        xx += edge.normal.x * edge.normal.x / edge.compliance;
        xz += edge.normal.x * edge.normal.y / edge.compliance;
        zz += edge.normal.y * edge.normal.y / edge.compliance;
      }
      add_row(row, xx, xz, zz);
    });
    matrix_.factorize();
  }

  void add_row(const Row& row, double xx, double xz, double zz) {
    const std::size_t t = row.frame;
    const auto weights = derive_.curvature(t);
    const std::size_t first = derive_.first(t);
    const auto effect = [&](std::size_t i) {
      return (first + i == t ? 1.0 : 0.0) - row.lever_s2 * weights[i];
    };
    for (std::size_t a = 0; a < weights.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        const double share = effect(a) * effect(b);
        const std::size_t i = 2 * (first + a);
        const std::size_t j = 2 * (first + b);
        matrix_.add(i, j, share * xx);
        matrix_.add(i + 1, j + 1, share * zz);
        matrix_.add(i + 1, j, share * xz);
        if (b < a) matrix_.add(i, j + 1, share * xz);
      }
    }
  }

  // Computes the Newton step to a gap. With `corrects`, the predictor's products
  // are taken into account.
  void eliminate(double target_gap, bool corrects) {
    std::transform(gradient_.begin(), gradient_.end(), step_.begin(), std::negate<>());
    for_each_row([&](const Row& row, std::span<ZmpEdge> edges) {
      glm::dvec2 force(0.0);
      for (ZmpEdge& edge : edges) {
        const auto [room_off, slack_off] = gaps(edge, target_gap, corrects);
        const double price_off = edge.push + edge.release - price_m_;
        edge.offset = edge.residual +
                      (slack_off - edge.slack * price_off) / edge.release -
                      room_off / edge.push;
        force += edge.offset / edge.compliance * edge.normal;
      }
      add_transposed(-force, row, step_);
    });
    matrix_.solve(step_);
    for_each_row([&](const Row& row, std::span<ZmpEdge> edges) {
      const glm::dvec2 p = moved(step_, row);
      for (ZmpEdge& edge : edges) {
        const auto [room_off, slack_off] = gaps(edge, target_gap, corrects);
        const double price_off = edge.push + edge.release - price_m_;
        edge.d_push = (glm::dot(edge.normal, p) + edge.offset) / edge.compliance;
        edge.d_release = -price_off - edge.d_push;
        edge.d_room = (-room_off - edge.room * edge.d_push) / edge.push;
        edge.d_slack = (-slack_off - edge.slack * edge.d_release) / edge.release;
      }
    });
  }

  static std::array<double, 2> gaps(const ZmpEdge& edge,
                                    double target_gap,
                                    bool corrects) {
    const double room = edge.push * edge.room - target_gap;
    const double slack = edge.release * edge.slack - target_gap;
    if (!corrects) return {room, slack};
    return {room + edge.correct_room, slack + edge.correct_slack};
  }

  [[nodiscard]] double longest_step() const {
    double out = 1.0;
    const auto limit = [&](double value, double step) {
      if (step < 0.0) out = std::min(out, -value / step);
    };
    for (const ZmpEdge& edge : edges_) {
      limit(edge.room, edge.d_room);
      limit(edge.slack, edge.d_slack);
      limit(edge.push, edge.d_push);
      limit(edge.release, edge.d_release);
    }
    return out;
  }

  void advance(double share) {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += share * step_[i];
    for (ZmpEdge& edge : edges_) {
      edge.room += share * edge.d_room;
      edge.slack += share * edge.d_slack;
      edge.push += share * edge.d_push;
      edge.release += share * edge.d_release;
    }
  }

  template <class Each>
  void for_each_row(const Each& each) {
    for (std::size_t k = 0; k < edges_.size();) {
      const Row row = row_of(edges_[k]);
      std::size_t end = k;
      while (end < edges_.size() && edges_[end].frame == row.frame &&
             edges_[end].of_zmp == row.of_zmp) {
        ++end;
      }
      each(row, std::span(edges_).subspan(k, end - k));
      k = end;
    }
  }

  const KeepZmpInput& input_;
  double price_m_ = 0.0;
  std::size_t frames_ = 0;
  LocalCubic derive_;
  std::vector<double> lever_s2_;  // Height over vertical force.
  std::vector<double> near_;      // Weights of displacements.
  double end_ = 0.0;              // Weight of the speed at both ends.
  std::vector<char> limited_;
  std::vector<double> smooth_;  // Weights of second differences.
  std::vector<ZmpEdge> edges_;  // In the order of frames.
  std::vector<double> x_;       // Displacements, X and Z of each frame in turn.
  std::vector<double> step_;
  std::vector<double> gradient_;
  BandedCholesky matrix_;
  double residual_ = 0.0;
  int without_area_ = 0;
};

// Returns the displacement of a programme and the frames that it leaves outside.
KeepZmpResult solved(const KeepZmpInput& input,
                     const KeepZmpOptions& options,
                     double price_m) {
  KeepZmpResult out;
  out.price_m = price_m;
  const std::size_t frames = input.com_in_world.size();
  out.shift_xz_m.assign(frames, glm::dvec2(0.0));
  ZmpProgramme programme(input, options, price_m);
  out.without_area_frames = programme.without_area();
  if (!programme.is_met()) out.iterations = programme.solve(options.max_iterations);
  for (std::size_t t = 0; t < frames; ++t) {
    out.shift_xz_m[t] = programme.shift(t);
    const glm::dvec2 total =
        out.shift_xz_m[t] +
        (input.displaced_xz_m.empty() ? glm::dvec2(0.0) : input.displaced_xz_m[t]);
    out.max_shift_m = std::max(out.max_shift_m, glm::length(total));
    if (!programme.is_limited(t)) continue;
    const double outside_m = *distance_outside(input.supports[t], programme.zmp(t));
    if (outside_m <= kMet_m) continue;
    out.unmet_frames.push_back(static_cast<int>(t));
    out.worst_unmet_m = std::max(out.worst_unmet_m, outside_m);
  }
  return out;
}

}  // namespace

KeepZmpResult keep_zmp(const KeepZmpInput& input, const KeepZmpOptions& options) {
  const std::size_t frames = input.com_in_world.size();
  MAREY_ASSERT(input.rate.hz > 0.0 && options.smoothness_s2 > 0.0);
  MAREY_ASSERT(input.reactions.size() == frames && input.supports.size() == frames);
  MAREY_ASSERT(input.displaced_xz_m.empty() || input.displaced_xz_m.size() == frames);
  MAREY_ASSERT(input.freedom.empty() || input.freedom.size() == frames);
  KeepZmpResult out;
  for (const double factor : kPriceFactors) {
    out = solved(input, options, factor * options.price_m);
    if (!(out.max_shift_m < kDiverged * options.max_shift_m)) {  // Or not a number.
      out = KeepZmpResult{};
      out.shift_xz_m.assign(frames, glm::dvec2(0.0));
      continue;
    }
    if (out.unmet_frames.empty() || out.max_shift_m <= options.modest_shift_m) break;
  }
  return out;
}

}  // namespace marey::dynamics
