// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/crowd.h"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include "core/assert.h"
#include "retarget/adapter_state.h"
#include "retarget/lane_kernel.h"

namespace marey::retarget {
namespace {

bool has(LaneWidth width) {
#if defined(__x86_64__)
  switch (width) {
    case LaneWidth::kOne:
    case LaneWidth::kFour:
      return true;
    case LaneWidth::kEight:
      return __builtin_cpu_supports("avx2") != 0;
    case LaneWidth::kSixteen:
      return __builtin_cpu_supports("avx512f") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0;
  }
#endif
  return width == LaneWidth::kOne;
}

std::unique_ptr<LaneKernel> make_kernel(LaneWidth width, const Plan& plan) {
  switch (width) {
    case LaneWidth::kOne:
      break;
    case LaneWidth::kFour:
      return make_narrow_kernel(plan);
    case LaneWidth::kEight:
      return make_wide_kernel(plan);
    case LaneWidth::kSixteen:
      return make_widest_kernel(plan);
  }
  return make_scalar_kernel(plan);
}

bool same_options(const AdaptOptions& a, const AdaptOptions& b) {
  return a.method == b.method && a.control == b.control && a.balance == b.balance &&
         a.max_iterations == b.max_iterations &&
         a.extremities_keep_orientation == b.extremities_keep_orientation;
}

}  // namespace

LaneWidth widest_lanes() {
  for (const LaneWidth width :
       {LaneWidth::kSixteen, LaneWidth::kEight, LaneWidth::kFour}) {
    if (has(width)) return width;
  }
  return LaneWidth::kOne;
}

struct Crowd::State {
  std::vector<Adapter> members;
  /// One per thread.
  std::vector<std::unique_ptr<LaneKernel>> kernels;
  std::vector<LaneJob> jobs;         ///< Of members that do not fade, in order.
  std::vector<std::size_t> job_of;   ///< Whose they are.
  std::vector<std::size_t> by_self;  ///< Members that fade.
};

Result<Crowd> Crowd::make(std::vector<Adapter> members, const CrowdOptions& options) {
  if (members.empty()) {
    return bad_input("crowd", "it has no members", "give at least one character");
  }
  if (options.threads < 1) {
    return bad_input("crowd", "less than one thread is asked for", "1 is enough");
  }
  if (!has(options.width)) {
    return bad_input("crowd",
                     "this processor has no vectors of " +
                         std::to_string(static_cast<int>(options.width)) + " lanes",
                     "leave the width to marey");
  }
  const Adapter::State& first = *members[0].state_;
  for (std::size_t i = 1; i < members.size(); ++i) {
    const Adapter::State& other = *members[i].state_;
    const bool same = other.plan == first.plan;
    if (same && same_options(other.options, first.options)) continue;
    return bad_input(other.character.name + " (member " + std::to_string(i) + ")",
                     same ? "its options are not those of the crowd's first member"
                          : "its joints, groups, limits or constraints are not arranged "
                            "as those of the crowd's first member, " +
                                first.character.name,
                     "make a crowd of its own for it");
  }
  auto state = std::make_unique<State>();
  const std::size_t count = members.size();
  for (int t = 0; t < options.threads; ++t) {
    auto kernel = make_kernel(options.width, first.plan);
    MAREY_ASSERT(kernel != nullptr);
    state->kernels.push_back(std::move(kernel));
  }
  state->members = std::move(members);
  state->jobs.reserve(count);
  state->job_of.reserve(count);
  state->by_self.reserve(count);
  return Crowd(std::move(state));
}

Crowd::Crowd(std::unique_ptr<State> state) : state_(std::move(state)) {}
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;
Crowd::~Crowd() = default;

std::size_t Crowd::size() const {
  return state_->members.size();
}

Adapter& Crowd::operator[](std::size_t member) {
  MAREY_ASSERT(member < state_->members.size());
  return state_->members[member];
}

void Crowd::adapt(std::span<const Pose> references,
                  double time_s,
                  std::span<Pose> out,
                  std::span<AdaptReport> reports) {
  State& s = *state_;
  const std::size_t count = s.members.size();
  MAREY_ASSERT(references.size() == count && out.size() == count);
  MAREY_ASSERT(reports.empty() || reports.size() == count);
  s.jobs.clear();
  s.job_of.clear();
  s.by_self.clear();
  for (std::size_t i = 0; i < count; ++i) {
    Adapter::State& member = *s.members[i].state_;
    if (!member.prepare(references[i], time_s)) {
      s.by_self.push_back(i);
      continue;
    }
    s.job_of.push_back(i);
    s.jobs.push_back({member.body.packed.data(),
                      member.packed_posture.data(),
                      member.packed_wishes.data(),
                      member.packed_balance.data(),
                      member.result.data()});
  }
  const Adapter::State& first = *s.members[0].state_;
  const LaneTask task{&first.plan,
                      first.shape(),
                      first.settings(),
                      first.options.method == Method::kThesis,
                      &first.thesis};
  const auto work = [&](std::size_t t) {
    const std::size_t threads = s.kernels.size();
    const std::size_t begin = s.jobs.size() * t / threads;
    const std::size_t end = s.jobs.size() * (t + 1) / threads;
    s.kernels[t]->solve(task, std::span(s.jobs).subspan(begin, end - begin));
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t i = s.job_of[n];
      Adapter::State& member = *s.members[i].state_;
      member.write(member.result.data(), out[i]);
      if (!reports.empty()) reports[i] = member.report;
    }
  };
  if (s.kernels.size() == 1) {
    work(0);
  } else {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < s.kernels.size(); ++t) threads.emplace_back(work, t);
  }
  for (const std::size_t i : s.by_self) {
    const AdaptReport report = s.members[i].adapt(references[i], time_s, out[i]);
    if (!reports.empty()) reports[i] = report;
  }
}

}  // namespace marey::retarget
