// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/adapter_state.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"

namespace marey::retarget {
namespace {

static_assert(kHomingSteps == kFirstSteps && kHomingStepsBalanced == kFirstStepsBalanced);

/// The only job of an adapter, with or without fading constraints.
class OneJob final : public LaneJobs, public FadeJobs {
 public:
  OneJob(const SharedPlan& shared,
         const Member& member,
         PackedProblem& problem,
         Pose& out)
      : shared_(shared), member_(member), problem_(problem), out_(out) {}

  [[nodiscard]] bool next(LaneJob& job) override {
    if (is_taken_) return false;
    is_taken_ = true;
    job = {member_.numbers().data(),
           problem_.posture.data(),
           problem_.targets.data(),
           problem_.balance.data(),
           0};
    return true;
  }
  void answer(int, const float* result) override {
    member_.write(shared_.plan, result, out_);
  }
  void postpone(int) override {}
  void answer_faded(int, const float* result) override { answer(0, result); }

  [[nodiscard]] LaneTask task(int pass) override {
    const MemberHead& head = member_.head();
    return task_of(shared_, head.options, fade_pass(head, problem_, pass).control);
  }
  [[nodiscard]] bool next(int, LaneJob& job) override { return next(job); }
  [[nodiscard]] int passes(int) override {
    return fade_pass_count(member_.head(), problem_);
  }
  [[nodiscard]] Pass pass(int, int number) override {
    const FadePass pass = fade_pass(member_.head(), problem_, number);
    pack_pass(shared_.plan, member_, pass, problem_);
    return {problem_.targets.data(), pass.share};
  }
  [[nodiscard]] Mean mean(int) override {
    pack_mean(shared_.plan, member_, problem_);
    return {problem_.targets.data(), problem_.firmness.data()};
  }

 private:
  const SharedPlan& shared_;
  const Member& member_;
  PackedProblem& problem_;
  Pose& out_;
  bool is_taken_ = false;
};

}  // namespace

AdapterWork::AdapterWork(const Plan& plan)
    : kernel(make_scalar_kernel(plan)), problem(plan) {}

MembersStore::MembersStore(const SharedPlan& shared)
    : work(shared.plan), block_bytes_(shared.layout.bytes) {}

void MembersStore::grow(std::size_t count) {
  chunks_.emplace_back(count * block_bytes_);
  for (std::size_t i = 0; i < count; ++i) {
    blocks.push_back(chunks_.back().get() + i * block_bytes_);
  }
}

void adapt_member(const SharedPlan& shared,
                  const Member& member,
                  const Pose& reference,
                  double time_s,
                  Pose& out,
                  AdapterWork& work) {
  const bool fades =
      !prepare_member(shared.plan, member, reference, time_s, work.problem);
  OneJob job(shared, member, work.problem, out);
  if (fades) {
    static_cast<void>(work.kernel->fade(job));
    return;
  }
  const MemberHead& head = member.head();
  work.kernel->solve(task_of(shared, head.options, head.control), job);
}

AdapterState::AdapterState(const Character& character,
                           const ConstraintSet& constraints,
                           const AdaptOptions& options)
    : shared(
          make_shared_plan(character, constraints, options.balance != BalanceMode::kOff)),
      names(make_names(character, constraints)),
      own(new AdapterOwn{character,
                         constraints,
                         MemberMemory(shared->layout.bytes),
                         AdapterWork(shared->plan)}) {
  member = Member(own->block.get(), shared->layout);
  begin_member(*shared, character, constraints, options, member);
}

void AdapterState::turn_passage(const AdaptOptions& to) {
  MemberHead& head = member.head();
  if (to.control != head.options.control) {
    head.left_control = head.options.control;
    // The ramp is symmetric, so the share is unchanged.
    head.passed = 1.0 - head.passed;
  } else if (to.control_change_s == head.options.control_change_s) {
    return;
  }
  head.passes_since_s.reset();
}

void AdapterState::replan() {
  MAREY_ASSERT(!is_member());
  shared = make_shared_plan(own->character,
                            own->constraints,
                            member.head().options.balance != BalanceMode::kOff);
  own->work = AdapterWork(shared->plan);
  // The arrays keep their sizes: they depend on the body and the count of constraints.
  member = Member(own->block.get(), shared->layout);
  replan_member(*shared, own->character, member);
}

AdaptReport AdapterState::adapt(const Pose& reference, double time_s, Pose& out) {
  if (own) {
    adapt_member(*shared, member, reference, time_s, out, own->work);
  } else {
    const std::scoped_lock lock(store->work_is_used);
    adapt_member(*shared, member, reference, time_s, out, store->work);
  }
  return member.head().report;
}

void AdapterState::join(const AdapterState& first,
                        const std::shared_ptr<MembersStore>& all,
                        std::size_t place) {
  const std::size_t bytes = shared->layout.bytes;
  std::byte* block = all->blocks[place];
  std::copy_n(member.block(), bytes, block);
  if (*names == *first.names) names = first.names;
  shared = first.shared;
  member = Member(block, shared->layout);
  store = all;
  own.reset();
}

}  // namespace marey::retarget
