// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Can a push be derived while a parameter is dragged? Time of both laws of the push, of
// the search space, and allocations per call.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "dynamics/push/force_push.h"
#include "dynamics/push/thesis_push.h"
#include <benchmark/benchmark.h>

#include "tests/support/program/count_allocations.h"

namespace marey::dynamics {
namespace {

/// From rest to a take-off of 2.43 m/s in 0.7 s: figure 6.6 of the thesis.
PushEnds ends_of_figure() {
  PushEnds ends;
  ends.end_m = 0.08;
  ends.end_m_s = 2.43;
  ends.duration_s = 0.7;
  return ends;
}

/// Counts the allocations of the calls that follow.
class AllocationCounter {
 public:
  explicit AllocationCounter(benchmark::State& state) : state_(state) {}
  ~AllocationCounter() {
    state_.counters["allocations"] =
        static_cast<double>(testing::allocations() - before_) /
        static_cast<double>(state_.iterations());
  }
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;

 private:
  benchmark::State& state_;
  long before_ = testing::allocations();
};

/// Places of the lowest point that differ from call to call. [x]
double next_place(int& k) {
  return 0.45 + 0.3 * (k++ % 64) / 64.0;
}

void thesis_push_of_a_point(benchmark::State& state) {
  const PushEnds ends = ends_of_figure();
  const AllocationCounter counter(state);
  int k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(thesis_push(ends, next_place(k), -0.2));
}
BENCHMARK(thesis_push_of_a_point);

void allowed_heights_of_a_place(benchmark::State& state) {
  const PushEnds ends = ends_of_figure();
  const AllocationCounter counter(state);
  int k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(allowed_heights(ends, next_place(k)));
}
BENCHMARK(allowed_heights_of_a_place);

void search_space_of_96_columns(benchmark::State& state) {
  const PushEnds ends = ends_of_figure();
  const AllocationCounter counter(state);
  for (auto _ : state) benchmark::DoNotOptimize(search_space(ends));
}
BENCHMARK(search_space_of_96_columns)->Unit(benchmark::kMicrosecond);

void choose_push_inside(benchmark::State& state) {
  const PushEnds ends = ends_of_figure();
  const PushCost cost = near_point_cost(0.58, -0.25);
  const AllocationCounter counter(state);
  for (auto _ : state) benchmark::DoNotOptimize(choose_thesis_push(ends, cost));
}
BENCHMARK(choose_push_inside)->Unit(benchmark::kMicrosecond);

void choose_push_on_the_boundary(benchmark::State& state) {
  const PushEnds ends = ends_of_figure();
  const PushCost cost = near_point_cost(0.5, -0.3);
  const AllocationCounter counter(state);
  for (auto _ : state) benchmark::DoNotOptimize(choose_thesis_push(ends, cost));
}
BENCHMARK(choose_push_on_the_boundary)->Unit(benchmark::kMicrosecond);

void choose_push_of_an_empty_space(benchmark::State& state) {
  PushEnds ends = ends_of_figure();
  ends.end_m_s = 14.0;
  const PushCost cost = near_point_cost(0.5, -0.3);
  const AllocationCounter counter(state);
  for (auto _ : state) benchmark::DoNotOptimize(choose_thesis_push(ends, cost));
}
BENCHMARK(choose_push_of_an_empty_space)->Unit(benchmark::kMicrosecond);

/// The force of a member of the search space, 100 times a second.
PushReference reference_of_figure() {
  const PushEnds ends = ends_of_figure();
  const auto push = choose_thesis_push(ends, near_point_cost(0.58, -0.25));
  std::vector<double> force_m_s2;
  constexpr int kSamples = 70;
  for (int k = 0; k <= kSamples; ++k) {
    const double t_s = ends.duration_s * k / kSamples;
    force_m_s2.push_back(push ? std::max(push->force_m_s2(t_s), 0.0) : 0.0);
  }
  return make_push_reference(ends.duration_s, std::move(force_m_s2));
}

/// The argument is the wanted rise over the reference's, in per cent.
void derive_push_of_a_rise(benchmark::State& state) {
  const PushReference reference = reference_of_figure();
  PushEnds ends = ends_of_figure();
  ends.end_m_s *= std::sqrt(static_cast<double>(state.range(0)) / 100.0);
  ForceLimits limits;
  limits.max_force_m_s2 = 5.0 * kStandardGravity_m_s2;
  const AllocationCounter counter(state);
  bool is_found = false;
  for (auto _ : state) {
    const auto push = derive_push(reference, ends, limits);
    is_found = push.has_value();
    benchmark::DoNotOptimize(push);
  }
  state.counters["found"] = is_found ? 1.0 : 0.0;
}
BENCHMARK(derive_push_of_a_rise)->Arg(25)->Arg(50)->Arg(100)->Arg(150)->Arg(200);

}  // namespace
}  // namespace marey::dynamics

BENCHMARK_MAIN();
