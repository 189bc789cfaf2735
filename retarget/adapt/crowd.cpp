// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/adapt/crowd.h"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include "core/base/assert.h"
#include "retarget/adapt/adapter_state.h"
#include "retarget/adapt/kernel/lane_kernel.h"

namespace marey::retarget {
namespace {

bool same_options(const AdaptOptions& a, const AdaptOptions& b) {
  return a.method == b.method && a.control == b.control && a.balance == b.balance &&
         a.max_iterations == b.max_iterations &&
         a.extremities_keep_orientation == b.extremities_keep_orientation;
}

}  // namespace

/// Jobs of one thread: a contiguous range of members.
class Crowd::Jobs final : public LaneJobs, public FadeJobs {
 public:
  /// Inputs of the whole crowd.
  struct Question {
    std::span<const Pose> references;
    double time_s = 0.0;
    std::span<Pose> out;
    std::span<AdaptReport> reports;
  };

  Jobs(const SharedPlan& shared, std::byte* blocks, std::size_t max_count, int width)
      : shared_(shared), blocks_(blocks), packed_(shared.plan), alone_(shared.plan) {
    postponed_.reserve(max_count);
    fading_.reserve(max_count);
    for (int lane = 0; lane < width; ++lane) fading_problems_.emplace_back(shared.plan);
    fading_lanes_.resize(fading_problems_.size());
  }

  void begin(const Question& question, std::size_t first, std::size_t end) {
    question_ = question;
    next_ = first;
    end_ = end;
    postponed_.clear();
    fading_.clear();
    again_ = false;
    handed_out_ = 0;
    faded_ = 0;
  }

  [[nodiscard]] bool next(LaneJob& job) override {
    while (next_ < end_) {
      const std::size_t i = next_++;
      call_ahead(i);
      if (is_fading(member(i), question_.time_s)) {
        fading_.push_back(static_cast<int>(i));
        continue;
      }
      if (prepare(i, packed_, job)) return true;
      // One control fades to the other.
      adapt_alone(i);
    }
    if (!again_ || handed_out_ == postponed_.size()) return false;
    const auto i = static_cast<std::size_t>(postponed_[handed_out_++]);
    return prepare(i, packed_, job);
  }

  /// From now on next() returns the postponed jobs.
  void begin_again() { again_ = true; }

  void answer(int number, const float* result) override {
    const auto i = static_cast<std::size_t>(number);
    write(i, result);
  }

  void postpone(int number) override { postponed_.push_back(number); }

  /// Solves members whose constraints fade, after all others.
  void fade(LaneKernel& kernel, const LaneTask& task) {
    task_ = task;
    // One lane of its own costs less than a few lanes of a wide kernel.
    const std::size_t min_batch = (fading_problems_.size() + 3) / 4;
    while (fading_.size() - faded_ >= min_batch && kernel.fade(*this)) {
    }
    while (faded_ < fading_.size()) {
      adapt_alone(static_cast<std::size_t>(fading_[faded_++]));
    }
  }

  [[nodiscard]] LaneTask task(int) override { return task_; }
  [[nodiscard]] bool next(int lane, LaneJob& job) override {
    const auto l = static_cast<std::size_t>(lane);
    while (faded_ < fading_.size()) {
      const auto i = static_cast<std::size_t>(fading_[faded_++]);
      if (faded_ + kFadingAhead < fading_.size()) {
        prefetch(static_cast<std::size_t>(fading_[faded_ + kFadingAhead]));
      }
      fading_lanes_[l] = i;
      static_cast<void>(prepare(i, fading_problems_[l], job));
      if (member(i).head().left_share <= 0.0) return true;
      adapt_alone(i);
    }
    return false;
  }
  [[nodiscard]] int passes(int lane) override {
    const auto l = static_cast<std::size_t>(lane);
    return fade_pass_count(member(fading_lanes_[l]).head(), fading_problems_[l]);
  }
  [[nodiscard]] FadeJobs::Pass pass(int lane, int number) override {
    const auto l = static_cast<std::size_t>(lane);
    const Member one = member(fading_lanes_[l]);
    PackedProblem& problem = fading_problems_[l];
    const FadePass pass = fade_pass(one.head(), problem, number);
    pack_pass(shared_.plan, one, pass, problem);
    return {problem.targets.data(), pass.share};
  }
  [[nodiscard]] FadeJobs::Mean mean(int lane) override {
    const auto l = static_cast<std::size_t>(lane);
    PackedProblem& problem = fading_problems_[l];
    pack_mean(shared_.plan, member(fading_lanes_[l]), problem);
    return {problem.targets.data(), problem.firmness.data()};
  }
  void answer_faded(int lane, const float* result) override {
    write(fading_lanes_[static_cast<std::size_t>(lane)], result);
  }

 private:
  static constexpr std::size_t kAddressAhead = 8;
  static constexpr std::size_t kNumbersAhead = 4;
  static constexpr std::size_t kFadingAhead = 2;

  [[nodiscard]] Member member(std::size_t i) const {
    return {blocks_ + i * shared_.layout.bytes, shared_.layout};
  }

  void prefetch(std::size_t i) const {
    prefetch_member(member(i));
    prefetch_pose(question_.references[i]);
    prefetch_pose(question_.out[i]);
  }

  // Prefetches the memory of later members: first the addresses, then the data.
  void call_ahead(std::size_t i) const {
    if (i + kNumbersAhead < end_) prefetch(i + kNumbersAhead);
    if (i + kAddressAhead < end_) {
      prefetch_address(question_.references[i + kAddressAhead]);
      prefetch_address(question_.out[i + kAddressAhead]);
    }
  }

  // Returns false if constraints or the control fade.
  [[nodiscard]] bool prepare(std::size_t i, PackedProblem& packed, LaneJob& job) const {
    const Member one = member(i);
    job = {one.numbers().data(),
           packed.posture.data(),
           packed.targets.data(),
           packed.balance.data(),
           static_cast<int>(i)};
    return prepare_member(
        shared_.plan, one, question_.references[i], question_.time_s, packed);
  }

  void write(std::size_t i, const float* result) const {
    member(i).write(shared_.plan, result, question_.out[i]);
    if (!question_.reports.empty()) question_.reports[i] = member(i).head().report;
  }

  void adapt_alone(std::size_t i) {
    adapt_member(shared_,
                 member(i),
                 question_.references[i],
                 question_.time_s,
                 question_.out[i],
                 alone_);
    if (!question_.reports.empty()) question_.reports[i] = member(i).head().report;
  }

  const SharedPlan& shared_;
  std::byte* blocks_;
  Question question_;
  PackedProblem packed_;
  AdapterWork alone_;
  std::size_t next_ = 0;
  std::size_t end_ = 0;
  std::vector<int> postponed_;
  bool again_ = false;
  std::size_t handed_out_ = 0;  ///< Number of postponed jobs returned.
  std::vector<int> fading_;     ///< Members whose constraints fade.
  std::size_t faded_ = 0;       ///< Number of these returned.
  LaneTask task_;
  std::vector<PackedProblem> fading_problems_;  ///< One per lane.
  std::vector<std::size_t> fading_lanes_;       ///< Member in each lane.
};

/// One per thread.
struct Crowd::Worker {
  std::unique_ptr<LaneKernel> kernel;
  std::unique_ptr<Jobs> jobs;
};

struct Crowd::State {
  std::shared_ptr<const SharedPlan> shared;
  std::shared_ptr<MembersStore> store;
  std::vector<Adapter> members;
  std::vector<Worker> workers;
};

Result<Crowd> Crowd::make(std::vector<Adapter> members, const CrowdOptions& options) {
  if (members.empty()) {
    return bad_input("crowd", "it has no members", "give at least one character");
  }
  if (options.threads < 1) {
    return bad_input("crowd", "the number of threads is below 1", "use at least 1");
  }
  if (!has_lanes(options.width)) {
    return bad_input("crowd",
                     "this processor has no vectors of " +
                         std::to_string(static_cast<int>(options.width)) + " lanes",
                     "use the default width");
  }
  const AdapterState& first = *members[0].state_;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const AdapterState& other = *members[i].state_;
    MAREY_ASSERT(!other.is_member());
    const bool same = other.shared->plan == first.shared->plan;
    if (same && same_options(other.member.head().options, first.member.head().options)) {
      continue;
    }
    return bad_input(
        other.own->character.name + " (member " + std::to_string(i) + ")",
        same ? "its options are not those of the crowd's first member"
             : "its joints, groups, limits or constraints differ in structure "
               "from those of the crowd's first member, " +
                   first.own->character.name,
        "put it into a separate crowd");
  }
  auto state = std::make_unique<State>();
  state->shared = first.shared;
  state->store = std::make_shared<MembersStore>(*first.shared, members.size());
  state->members = std::move(members);
  for (std::size_t i = 0; i < state->members.size(); ++i) {
    state->members[i].state_->join(*state->members[0].state_, state->store, i);
  }
  for (int t = 0; t < options.threads; ++t) {
    auto kernel = make_lane_kernel(options.width, state->shared->plan);
    MAREY_ASSERT(kernel != nullptr);
    auto jobs = std::make_unique<Jobs>(*state->shared,
                                       state->store->blocks.get(),
                                       state->members.size(),
                                       kernel->width());
    state->workers.push_back({std::move(kernel), std::move(jobs)});
  }
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
  const AdaptOptions& options = s.members[0].state_->member.head().options;
  const LaneTask task = task_of(*s.shared, options, options.control);
  const auto work = [&](std::size_t t) {
    const std::size_t threads = s.workers.size();
    const Worker& worker = s.workers[t];
    Jobs& jobs = *worker.jobs;
    jobs.begin({references, time_s, out, reports},
               count * t / threads,
               count * (t + 1) / threads);
    // Members that limbs suffice for are solved first, so that all lanes of whole-body
    // steps are used. With balance there are none.
    if (!task.shape.rows.balance) worker.kernel->sift(task, jobs);
    jobs.begin_again();
    worker.kernel->solve(task, jobs);
    jobs.fade(*worker.kernel, task);
  };
  std::vector<std::jthread> threads;
  for (std::size_t t = 1; t < s.workers.size(); ++t) threads.emplace_back(work, t);
  work(0);
}

}  // namespace marey::retarget
