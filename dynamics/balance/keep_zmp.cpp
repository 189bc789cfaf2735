// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/keep_zmp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "dynamics/balance/banded_cholesky.h"
#include "dynamics/balance/local_cubic.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {
namespace {

// Price of a metre outside, per frame, against square metres of displacement.
constexpr double kPricePerM = 1e4;
constexpr double kPinned = 1e10;
constexpr double kMinFreedom = 1e-3;
constexpr double kWidthShare = 0.25;
constexpr double kMinWidth_m = 1e-6;
// Size of the first step of the interior-point method, and of its last. [m]
constexpr double kFirstSlack_m = 0.01;
constexpr double kFirstGap = 1e-2;
constexpr double kLastGap = 1e-11;
constexpr double kLastResidual = 1e-9;
constexpr double kToBoundary = 0.99;
// Smaller distances outside are rounding.
constexpr double kMet_m = 1e-7;

// One edge of a support area: normal . p <= bound + slack.
struct Edge {
  std::size_t frame = 0;
  glm::dvec2 normal{0.0};
  double bound_m = 0.0;
  // Distance to the edge, elastic part, and their multipliers: all above 0.
  double room = kFirstSlack_m;
  double slack = 0.0;
  double push = 0.0;
  double release = 0.0;
  // Newton step.
  double d_room = 0.0, d_slack = 0.0, d_push = 0.0, d_release = 0.0;
  // Work: residual of the constraint, elimination.
  double residual = 0.0, compliance = 0.0, offset = 0.0;
  // Products of the predictor's step.
  double correct_room = 0.0, correct_slack = 0.0;
};

double signed_area(std::span<const glm::dvec2> corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2& a = corners[i];
    const glm::dvec2& b = corners[(i + 1) % corners.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return 0.5 * sum;
}

// Adds the edges of a frame, moved inwards; returns false if the area has no inside.
bool add_edges(std::size_t frame,
               std::span<const glm::dvec2> corners,
               double margin_m,
               std::vector<Edge>& out) {
  if (corners.size() < 3) return false;
  const double sense = signed_area(corners) > 0.0 ? 1.0 : -1.0;
  const std::size_t first = out.size();
  double width_m = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 along = corners[(i + 1) % corners.size()] - corners[i];
    const double length_m = glm::length(along);
    if (length_m < kMinWidth_m) continue;
    Edge edge;
    edge.frame = frame;
    edge.normal = sense / length_m * glm::dvec2(along.y, -along.x);
    edge.bound_m = glm::dot(edge.normal, corners[i]);
    double across_m = 0.0;
    for (const glm::dvec2& p : corners) {
      across_m = std::max(across_m, edge.bound_m - glm::dot(edge.normal, p));
    }
    width_m = std::min(width_m, across_m);
    out.push_back(edge);
  }
  if (out.size() < first + 3 || width_m < kMinWidth_m) {
    out.resize(first);
    return false;
  }
  for (std::size_t k = first; k < out.size(); ++k) {
    out[k].bound_m -= std::min(margin_m, kWidthShare * width_m);
  }
  return true;
}

// The quadratic programme and its state.
class ZmpProgramme {
 public:
  ZmpProgramme(const KeepZmpInput& input, const KeepZmpOptions& options)
      : input_(input),
        frames_(input.com_in_world.size()),
        derive_(frames_, input.rate, options.zmp.smoothing_s),
        x_(2 * frames_, 0.0),
        step_(2 * frames_, 0.0),
        gradient_(2 * frames_, 0.0),
        matrix_(2 * frames_, std::max<std::size_t>(4 * derive_.half() + 1, 5)) {
    for (std::size_t t = 0; t < frames_; ++t) {
      const GroundReaction& reaction = input.reactions[t];
      const double height_m = input.com_in_world[t].y - options.zmp.floor_height_m;
      lever_s2_.push_back(reaction.zmp_xz_m ? height_m / reaction.force_m_s2.y : 0.0);
      const double freedom = input.freedom.empty() ? 1.0 : input.freedom[t];
      near_.push_back(freedom > kMinFreedom ? 1.0 / (freedom * freedom) : kPinned);
      const double bend = options.smoothness_s2 * input.rate.hz * input.rate.hz *
                          (reaction.zmp_xz_m ? 1.0 : options.flight_factor);
      smooth_.push_back(bend * bend);
      if (!reaction.zmp_xz_m || freedom <= kMinFreedom) continue;
      if (!add_edges(t, input.supports[t], options.margin_m, edges_)) ++without_area_;
    }
  }

  // Returns true if the reference itself meets all constraints.
  [[nodiscard]] bool is_met() const {
    return std::all_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
      return glm::dot(edge.normal, *input_.reactions[edge.frame].zmp_xz_m) <=
             edge.bound_m;
    });
  }

  int solve(int max_iterations) {
    start();
    for (int i = 0; i < max_iterations; ++i) {
      const double gap = evaluate();
      if (gap < kLastGap && residual_ < kLastResidual) return i;
      assemble();
      // Predictor: towards the solution; corrector: towards the central path.
      eliminate(0.0, false);
      const double predicted = std::pow(1.0 - longest_step(), 3.0);
      for (Edge& edge : edges_) {
        edge.correct_room = edge.d_room * edge.d_push;
        edge.correct_slack = edge.d_slack * edge.d_release;
      }
      eliminate(std::max(predicted, 1e-3) * gap, true);
      advance(kToBoundary * longest_step());
    }
    return max_iterations;
  }

  [[nodiscard]] glm::dvec2 shift(std::size_t t) const {
    return {x_[2 * t], x_[2 * t + 1]};
  }
  // Returns the predicted zero moment point. Precondition: the frame is loaded.
  [[nodiscard]] glm::dvec2 zmp(std::size_t t) const {
    return *input_.reactions[t].zmp_xz_m + moved(x_, t);
  }
  [[nodiscard]] int without_area() const { return without_area_; }

 private:
  // Returns the displacement of a zero moment point by displacements of the body.
  [[nodiscard]] glm::dvec2 moved(std::span<const double> x, std::size_t t) const {
    const auto weights = derive_.curvature(t);
    const std::size_t first = derive_.first(t);
    glm::dvec2 bend(0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      bend += weights[i] * glm::dvec2(x[2 * (first + i)], x[2 * (first + i) + 1]);
    }
    return glm::dvec2(x[2 * t], x[2 * t + 1]) - lever_s2_[t] * bend;
  }

  // Adds the transpose of moved(), applied to `force`.
  void add_transposed(const glm::dvec2& force,
                      std::size_t t,
                      std::span<double> out) const {
    const auto weights = derive_.curvature(t);
    const std::size_t first = derive_.first(t);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      out[2 * (first + i)] -= lever_s2_[t] * weights[i] * force.x;
      out[2 * (first + i) + 1] -= lever_s2_[t] * weights[i] * force.y;
    }
    out[2 * t] += force.x;
    out[2 * t + 1] += force.y;
  }

  void start() {
    for (Edge& edge : edges_) {
      const double room_m =
          edge.bound_m - glm::dot(edge.normal, *input_.reactions[edge.frame].zmp_xz_m);
      edge.room = std::max(room_m, kFirstSlack_m);
      edge.push = kFirstGap / edge.room;
      edge.release = kPricePerM - edge.push;
      edge.slack = kFirstGap / edge.release;
    }
  }

  [[nodiscard]] double displaced(std::size_t i) const {
    if (input_.displaced_xz_m.empty()) return x_[i];
    const glm::dvec2& before = input_.displaced_xz_m[i / 2];
    return x_[i] + (i % 2 == 0 ? before.x : before.y);
  }

  // Computes gradient and residuals; returns the mean complementarity gap.
  double evaluate() {
    residual_ = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      // Frames that may not move stay where they are.
      gradient_[i] = near_[i / 2] * (near_[i / 2] < kPinned ? displaced(i) : x_[i]);
    }
    for (std::size_t i = 2; i + 2 < x_.size(); ++i) {
      const double bend =
          smooth_[i / 2] * (displaced(i - 2) - 2.0 * displaced(i) + displaced(i + 2));
      gradient_[i - 2] += bend;
      gradient_[i] -= 2.0 * bend;
      gradient_[i + 2] += bend;
    }
    double gap = 0.0;
    for_each_frame([&](std::size_t t, std::span<Edge> edges) {
      const glm::dvec2 p = zmp(t);
      glm::dvec2 force(0.0);
      for (Edge& edge : edges) {
        edge.residual = glm::dot(edge.normal, p) - edge.slack + edge.room - edge.bound_m;
        residual_ = std::max(residual_, std::abs(edge.residual));
        force += edge.push * edge.normal;
        gap += edge.push * edge.room + edge.release * edge.slack;
      }
      add_transposed(force, t, gradient_);
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
    for_each_frame([&](std::size_t t, std::span<Edge> edges) {
      double xx = 0.0, xz = 0.0, zz = 0.0;
      for (Edge& edge : edges) {
        edge.compliance = edge.slack / edge.release + edge.room / edge.push;
        xx += edge.normal.x * edge.normal.x / edge.compliance;
        xz += edge.normal.x * edge.normal.y / edge.compliance;
        zz += edge.normal.y * edge.normal.y / edge.compliance;
      }
      add_frame(t, xx, xz, zz);
    });
    matrix_.factorize();
  }

  void add_frame(std::size_t t, double xx, double xz, double zz) {
    const auto weights = derive_.curvature(t);
    const std::size_t first = derive_.first(t);
    const auto row = [&](std::size_t i) {
      return (first + i == t ? 1.0 : 0.0) - lever_s2_[t] * weights[i];
    };
    for (std::size_t a = 0; a < weights.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        const double share = row(a) * row(b);
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
    for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
    for_each_frame([&](std::size_t t, std::span<Edge> edges) {
      glm::dvec2 force(0.0);
      for (Edge& edge : edges) {
        const auto [room_off, slack_off] = gaps(edge, target_gap, corrects);
        const double price_off = edge.push + edge.release - kPricePerM;
        edge.offset = edge.residual +
                      (slack_off - edge.slack * price_off) / edge.release -
                      room_off / edge.push;
        force += edge.offset / edge.compliance * edge.normal;
      }
      add_transposed(-force, t, step_);
    });
    matrix_.solve(step_);
    for_each_frame([&](std::size_t t, std::span<Edge> edges) {
      const glm::dvec2 p = moved(step_, t);
      for (Edge& edge : edges) {
        const auto [room_off, slack_off] = gaps(edge, target_gap, corrects);
        const double price_off = edge.push + edge.release - kPricePerM;
        edge.d_push = (glm::dot(edge.normal, p) + edge.offset) / edge.compliance;
        edge.d_release = -price_off - edge.d_push;
        edge.d_room = (-room_off - edge.room * edge.d_push) / edge.push;
        edge.d_slack = (-slack_off - edge.slack * edge.d_release) / edge.release;
      }
    });
  }

  // Returns the residuals of both complementarities.
  static std::array<double, 2> gaps(const Edge& edge, double target_gap, bool corrects) {
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
    for (const Edge& edge : edges_) {
      limit(edge.room, edge.d_room);
      limit(edge.slack, edge.d_slack);
      limit(edge.push, edge.d_push);
      limit(edge.release, edge.d_release);
    }
    return out;
  }

  void advance(double share) {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += share * step_[i];
    for (Edge& edge : edges_) {
      edge.room += share * edge.d_room;
      edge.slack += share * edge.d_slack;
      edge.push += share * edge.d_push;
      edge.release += share * edge.d_release;
    }
  }

  template <class Each>
  void for_each_frame(const Each& each) {
    for (std::size_t k = 0; k < edges_.size();) {
      const std::size_t t = edges_[k].frame;
      std::size_t end = k;
      while (end < edges_.size() && edges_[end].frame == t) ++end;
      each(t, std::span(edges_).subspan(k, end - k));
      k = end;
    }
  }

  const KeepZmpInput& input_;
  std::size_t frames_ = 0;
  LocalCubic derive_;
  std::vector<double> lever_s2_;  // Height over vertical force.
  std::vector<double> near_;      // Weights of displacements.
  std::vector<double> smooth_;    // Weights of second differences.
  std::vector<Edge> edges_;       // In the order of frames.
  std::vector<double> x_;         // Displacements, X and Z of each frame in turn.
  std::vector<double> step_;
  std::vector<double> gradient_;
  BandedCholesky matrix_;
  double residual_ = 0.0;
  int without_area_ = 0;
};

}  // namespace

KeepZmpResult keep_zmp(const KeepZmpInput& input, const KeepZmpOptions& options) {
  const std::size_t frames = input.com_in_world.size();
  MAREY_ASSERT(input.rate.hz > 0.0);
  MAREY_ASSERT(input.reactions.size() == frames && input.supports.size() == frames);
  MAREY_ASSERT(input.displaced_xz_m.empty() || input.displaced_xz_m.size() == frames);
  MAREY_ASSERT(input.freedom.empty() || input.freedom.size() == frames);
  KeepZmpResult out;
  out.shift_xz_m.assign(frames, glm::dvec2(0.0));
  ZmpProgramme programme(input, options);
  out.without_area_frames = programme.without_area();
  if (programme.is_met()) return out;
  out.iterations = programme.solve(options.max_iterations);
  for (std::size_t t = 0; t < frames; ++t) {
    out.shift_xz_m[t] = programme.shift(t);
    if (!input.reactions[t].zmp_xz_m || input.supports[t].size() < 3) continue;
    const auto outside_m = distance_outside(input.supports[t], programme.zmp(t));
    if (!outside_m || *outside_m <= kMet_m) continue;
    out.unmet_frames.push_back(static_cast<int>(t));
    out.worst_unmet_m = std::max(out.worst_unmet_m, *outside_m);
  }
  return out;
}

}  // namespace marey::dynamics
