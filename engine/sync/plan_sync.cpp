// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/plan_sync.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/sync/support_overlap.h"

#include "core/base/assert.h"

namespace marey::engine {
namespace {

/// Maximum step from one match to the next, in edges of either side: up to three edges
/// between two matches are skipped. Short phases are skipped so when that costs less.
constexpr std::size_t kMaxStep = 4;
/// First matches that are searched together. A clip with more edges is searched in parts.
constexpr std::size_t kFirstEdges = 16;
constexpr std::size_t kWindow = kFirstEdges + kMaxStep * kMaxLeadPhases;
/// Decides between entries that cost the same.
constexpr double kShiftCostPerS = 1e-9;
constexpr double kNegligible_s = 1e-9;

/// The best course so far in which edge i of the lead matches edge j of the follower.
struct SyncState {
  double cost = std::numeric_limits<double>::infinity();
  double incompatible_s = 0.0;
  double entry_s = 0.0;
  std::int16_t lead_before = -1;  ///< Match before; -1: the entry.
  std::int16_t follower_before = 0;
};

struct FollowerEdge {
  PhaseRing::Place place;  ///< The phase that begins here.
  double source_s = 0.0;
};

/// Places at which the follower may begin. [s]
struct EntryRange {
  double first_s = 0.0;
  double last_s = 0.0;
  bool anywhere = false;  ///< In a cycle.
};

class SyncSearch {
 public:
  SyncSearch(const SyncSide& lead, const SyncSide& follower, const SyncOptions& options)
      : follower_(follower),
        options_(options),
        ring_(follower.phases, follower.duration_s, follower.loops),
        lead_(lead_course(lead,
                          options.horizon_s,
                          std::min<std::size_t>(kMaxLeadPhases,
                                                static_cast<std::size_t>(
                                                    std::max(1, options.max_phases))))),
        entry_(entries()) {
    // Edge i of the lead is the start of part i; beyond the last part its end.
    lead_edges_ =
        std::isfinite(lead_.parts[lead_.count - 1].end_s) ? lead_.count : lead_.count - 1;
  }

  SyncPlan run() {
    try_rate_one(follower_.now_s);
    if (!entry_.anywhere) {
      try_rate_one(entry_.first_s);
      try_rate_one(entry_.last_s);
    }
    search_edges();
    return finished_plan();
  }

 private:
  [[nodiscard]] EntryRange entries() const {
    const double now_s = follower_.now_s;
    if (options_.entry_s <= 0.0) return {now_s, now_s, false};
    if (follower_.loops) return {now_s, now_s, true};
    return {std::max(0.0, now_s - options_.entry_s),
            std::min(follower_.duration_s, now_s + options_.entry_s),
            false};
  }

  [[nodiscard]] double edge_time_s(std::size_t i) const {
    return i < lead_.count ? lead_.parts[i].start_s : lead_.parts[i - 1].end_s;
  }

  [[nodiscard]] double shift_cost(double entry_s) const {
    const double shift_s = entry_s - follower_.now_s;
    return kShiftCostPerS * std::abs(entry_.anywhere
                                         ? std::remainder(shift_s, follower_.duration_s)
                                         : shift_s);
  }

  /// Cost of a change of rate over the part of a segment within the horizon.
  [[nodiscard]] double rate_cost(double start_s, double end_s, double ratio) const {
    const double log_rate = std::log(ratio);
    return std::max(0.0, std::min(end_s, lead_.horizon_s) - start_s) * log_rate *
           log_rate;
  }

  [[nodiscard]] bool is_rate(double ratio) const {
    constexpr double kRounding = 1e-9;
    return ratio >= options_.min_rate - kRounding &&
           ratio <= options_.max_rate + kRounding;
  }

  void try_rate_one(double entry_s);
  void search_edges();
  /// Searches all courses whose first match is one of `first_edges` of the edges.
  void search_window(std::size_t first_edges);
  /// Enters so that the follower's own speed leads to a match, or as near to that as
  /// permitted, or where asked.
  void enter(std::size_t i, std::size_t j);
  void enter_from(std::size_t i, std::size_t j, double entry_s, bool is_own_speed);
  void advance(std::size_t i, std::size_t j);
  /// Returns whether an edge is at most kMaxStep edges after a place in this phase.
  [[nodiscard]] bool is_near(PhaseRing::Place place, double edge_s) const;
  void offer(std::size_t i, std::size_t j, const SyncState& candidate);
  /// Completes the course to this match with the follower's own speed.
  void complete(std::size_t i, std::size_t j);
  void keep_knots(std::size_t i, std::size_t j);
  /// Adds a knot at the end of the horizon, or of a clip that ends sooner.
  void add_last_knot();
  [[nodiscard]] SyncPlan finished_plan();

  SyncState& state(std::size_t i, std::size_t j) { return states_[i * kWindow + j]; }

  SyncSide follower_;
  SyncOptions options_;
  PhaseRing ring_;
  LeadCourse lead_;
  EntryRange entry_;
  std::size_t lead_edges_ = 0;
  std::array<FollowerEdge, kWindow> edges_{};
  std::size_t edge_count_ = 0;
  std::array<SyncState, (kMaxLeadPhases + 1) * kWindow> states_{};
  SyncPlan plan_;
  double best_cost_ = std::numeric_limits<double>::infinity();
};

void SyncSearch::try_rate_one(double entry_s) {
  const double incompatible_s = incompatible_in(
      lead_,
      ring_,
      {0.0, lead_.horizon_s, entry_s, follower_.speed, 0, ring_.at(entry_s)});
  const double cost =
      options_.incompatible_cost_per_s * incompatible_s + shift_cost(entry_s);
  if (cost >= best_cost_) return;
  best_cost_ = cost;
  plan_.knots[0] = {0.0, entry_s};
  plan_.knot_count = 1;
  plan_.incompatible_s = incompatible_s;
}

void SyncSearch::search_edges() {
  if (ring_.edges() == 0) return;
  PhaseRing::Place place = ring_.at(entry_.first_s);
  std::size_t remaining = std::max(ring_.edges(), kMaxStep);
  if (!entry_.anywhere) {
    // Edges up to kMaxStep after the last entry.
    PhaseRing::Place end = ring_.at(entry_.last_s);
    remaining = 0;
    for (std::size_t i = 0; i < kMaxStep && std::isfinite(ring_.end_s(end)); ++i) {
      end = ring_.next(end);
    }
    for (PhaseRing::Place p = place; ring_.start_s(p) < ring_.start_s(end); ++remaining) {
      p = ring_.next(p);
    }
  }
  while (remaining > 0) {
    edge_count_ = 0;
    PhaseRing::Place next_place = place;
    while (edge_count_ < kWindow && std::isfinite(ring_.end_s(place))) {
      place = ring_.next(place);
      if (edge_count_ < kFirstEdges) next_place = place;
      edges_[edge_count_++] = {place, ring_.start_s(place)};
    }
    const std::size_t first_edges = std::min({remaining, kFirstEdges, edge_count_});
    search_window(first_edges);
    remaining -= first_edges;
    place = next_place;
  }
}

void SyncSearch::search_window(std::size_t first_edges) {
  std::fill(states_.begin(), states_.end(), SyncState{});
  for (std::size_t i = 0; i <= std::min(lead_edges_, kMaxStep); ++i) {
    for (std::size_t j = 0; j < first_edges; ++j) enter(i, j);
  }
  for (std::size_t i = 0; i <= lead_edges_; ++i) {
    for (std::size_t j = 0; j < edge_count_; ++j) {
      if (state(i, j).cost >= best_cost_) continue;
      complete(i, j);
      advance(i, j);
    }
  }
}

void SyncSearch::enter(std::size_t i, std::size_t j) {
  const double wanted_s = edges_[j].source_s - follower_.speed * edge_time_s(i);
  const double entry_s =
      entry_.anywhere ? wanted_s : std::clamp(wanted_s, entry_.first_s, entry_.last_s);
  if (i > 0 || entry_s == wanted_s) enter_from(i, j, entry_s, entry_s == wanted_s);
  if (i > 0 && entry_s != follower_.now_s) enter_from(i, j, follower_.now_s, false);
}

void SyncSearch::enter_from(std::size_t i,
                            std::size_t j,
                            double entry_s,
                            bool is_own_speed) {
  SyncState entered{.cost = shift_cost(entry_s), .entry_s = entry_s};
  if (i > 0) {
    const double time_s = edge_time_s(i);
    const double ratio =
        is_own_speed ? 1.0 : (edges_[j].source_s - entry_s) / (time_s * follower_.speed);
    if (!is_rate(ratio)) return;
    entered.cost += rate_cost(0.0, time_s, ratio);
    if (entered.cost >= std::min(best_cost_, state(i, j).cost)) return;
    const PhaseRing::Place place = ring_.at(entry_s);
    if (!is_near(place, edges_[j].source_s)) return;
    entered.incompatible_s = incompatible_in(
        lead_, ring_, {0.0, time_s, entry_s, ratio * follower_.speed, 0, place});
    entered.cost += options_.incompatible_cost_per_s * entered.incompatible_s;
  }
  offer(i, j, entered);
}

bool SyncSearch::is_near(PhaseRing::Place place, double edge_s) const {
  for (std::size_t step = 0; step < kMaxStep; ++step) {
    if (ring_.end_s(place) >= edge_s - kNegligible_s) return true;
    place = ring_.next(place);
  }
  return false;
}

void SyncSearch::offer(std::size_t i, std::size_t j, const SyncState& candidate) {
  if (candidate.cost < state(i, j).cost) state(i, j) = candidate;
}

void SyncSearch::advance(std::size_t i, std::size_t j) {
  const SyncState from = state(i, j);
  const double start_s = edge_time_s(i);
  const FollowerEdge& edge = edges_[j];
  for (std::size_t to = i + 1; to <= std::min(i + kMaxStep, lead_edges_); ++to) {
    const double end_s = edge_time_s(to);
    const double asked_s = (end_s - start_s) * follower_.speed;
    for (std::size_t follower_to = j + 1;
         follower_to <= std::min(j + kMaxStep, edge_count_ - 1);
         ++follower_to) {
      const double ratio = (edges_[follower_to].source_s - edge.source_s) / asked_s;
      if (!is_rate(ratio)) continue;
      SyncState next = from;
      next.cost += rate_cost(start_s, end_s, ratio);
      if (next.cost >= std::min(best_cost_, state(to, follower_to).cost)) continue;
      const double incompatible_s = incompatible_in(
          lead_,
          ring_,
          {start_s, end_s, edge.source_s, ratio * follower_.speed, i, edge.place});
      next.cost += options_.incompatible_cost_per_s * incompatible_s;
      next.incompatible_s += incompatible_s;
      next.lead_before = static_cast<std::int16_t>(i);
      next.follower_before = static_cast<std::int16_t>(j);
      offer(to, follower_to, next);
    }
  }
}

void SyncSearch::complete(std::size_t i, std::size_t j) {
  const SyncState& from = state(i, j);
  double incompatible_s = from.incompatible_s;
  double cost = from.cost;
  const double start_s = edge_time_s(i);
  if (start_s < lead_.horizon_s) {
    const double tail_s = incompatible_in(lead_,
                                          ring_,
                                          {start_s,
                                           lead_.horizon_s,
                                           edges_[j].source_s,
                                           follower_.speed,
                                           i,
                                           edges_[j].place});
    incompatible_s += tail_s;
    cost += options_.incompatible_cost_per_s * tail_s;
  }
  if (cost >= best_cost_) return;
  best_cost_ = cost;
  plan_.incompatible_s = incompatible_s;
  keep_knots(i, j);
}

void SyncSearch::keep_knots(std::size_t i, std::size_t j) {
  plan_.knot_count = 0;
  // From the last one to the entry, then reversed.
  while (true) {
    const SyncState& at = state(i, j);
    // A match at time 0 is the entry itself.
    if (i > 0) plan_.knots[plan_.knot_count++] = {edge_time_s(i), edges_[j].source_s};
    if (at.lead_before < 0) {
      plan_.knots[plan_.knot_count++] = {0.0, at.entry_s};
      break;
    }
    i = static_cast<std::size_t>(at.lead_before);
    j = static_cast<std::size_t>(at.follower_before);
  }
  std::reverse(plan_.knots.begin(),
               plan_.knots.begin() + static_cast<std::ptrdiff_t>(plan_.knot_count));
}

void SyncSearch::add_last_knot() {
  const WarpKnot last = plan_.knots[plan_.knot_count - 1];
  double time_s = lead_.horizon_s;
  if (!follower_.loops) {
    const double left_s = (follower_.duration_s - last.source_s) / follower_.speed;
    time_s = std::min(time_s, last.time_s + left_s);
  }
  constexpr double kMinInterval_s = 1e-6;
  if (time_s < last.time_s + kMinInterval_s) return;
  plan_.knots[plan_.knot_count++] = {
      time_s, last.source_s + follower_.speed * (time_s - last.time_s)};
}

SyncPlan SyncSearch::finished_plan() {
  add_last_knot();
  double log_worst = 0.0;
  plan_.cost = options_.incompatible_cost_per_s * plan_.incompatible_s;
  for (std::size_t k = 1; k < plan_.knot_count; ++k) {
    const WarpKnot& a = plan_.knots[k - 1];
    const WarpKnot& b = plan_.knots[k];
    const double ratio =
        (b.source_s - a.source_s) / ((b.time_s - a.time_s) * follower_.speed);
    plan_.cost += rate_cost(a.time_s, b.time_s, ratio);
    const double log_rate = std::log(ratio);
    if (std::abs(log_rate) <= std::abs(log_worst)) continue;
    log_worst = log_rate;
    plan_.worst_rate = ratio;
  }
  constexpr double kSameRate = 1e-9;
  plan_.only_inertial =
      std::abs(log_worst) < kSameRate && plan_.incompatible_s > kNegligible_s;
  if (entry_.anywhere) {
    // Into the cycle of now.
    const double cycle_s = follower_.duration_s;
    const double shift_s = (std::floor(follower_.now_s / cycle_s) -
                            std::floor(plan_.knots[0].source_s / cycle_s)) *
                           cycle_s;
    for (std::size_t k = 0; k < plan_.knot_count; ++k) plan_.knots[k].source_s += shift_s;
  }
  return plan_;
}

}  // namespace

SyncPlan plan_sync(const SyncSide& lead,
                   const SyncSide& follower,
                   const SyncOptions& options) {
  MAREY_ASSERT(lead.speed > 0.0 && follower.speed > 0.0);
  MAREY_ASSERT(!lead.phases.empty() && !follower.phases.empty());
  MAREY_ASSERT(options.min_rate > 0.0 && options.min_rate <= 1.0 &&
               options.max_rate >= 1.0);
  return SyncSearch(lead, follower, options).run();
}

double incompatible_time_s(const SyncSide& lead,
                           const SyncSide& follower,
                           double horizon_s) {
  MAREY_ASSERT(lead.speed > 0.0 && follower.speed > 0.0);
  const PhaseRing ring(follower.phases, follower.duration_s, follower.loops);
  double sum_s = 0.0;
  SyncSide from = lead;
  double start_s = 0.0;
  // A course has a limited number of phases.
  while (start_s < horizon_s) {
    const LeadCourse course = lead_course(from, horizon_s - start_s, kMaxLeadPhases);
    const double source_s = follower.now_s + follower.speed * start_s;
    sum_s += incompatible_in(
        course,
        ring,
        {0.0, course.horizon_s, source_s, follower.speed, 0, ring.at(source_s)});
    if (course.horizon_s <= 0.0) break;
    start_s += course.horizon_s;
    from.now_s = lead.now_s + lead.speed * start_s;
  }
  return sum_s;
}

}  // namespace marey::engine
