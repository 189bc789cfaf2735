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

/// Maximum number of members for which memory is allocated ahead.
constexpr std::size_t kMaxChunk = 16;

bool same_options(const MemberHead& a_head, const MemberHead& b_head) {
  const AdaptOptions& a = a_head.options;
  const AdaptOptions& b = b_head.options;
  // Balance may be switched off at the moment.
  const auto balance = [](const MemberHead& head) {
    return std::max(head.options.balance, head.paused_balance);
  };
  return a.method == b.method && a.control == b.control &&
         balance(a_head) == balance(b_head) && a.max_iterations == b.max_iterations &&
         a.extremities_keep_orientation == b.extremities_keep_orientation;
}

}  // namespace

/// Jobs of one thread: a contiguous range of those of the crowd.
class Crowd::Jobs final : public LaneJobs, public FadeJobs {
 public:
  struct Question {
    std::span<const CrowdJob> jobs;
    double time_s = 0.0;
  };

  Jobs(const SharedPlan& shared, const MembersStore& store)
      : shared_(shared), store_(store), packed_(shared.plan), alone_(shared.plan) {}

  /// Makes place for this many jobs, and the lanes of a kernel.
  void reserve(std::size_t max_count, int width) {
    postponed_.reserve(max_count);
    fading_.reserve(max_count);
    while (fading_problems_.size() < static_cast<std::size_t>(width)) {
      fading_problems_.emplace_back(shared_.plan);
    }
    fading_lanes_.resize(fading_problems_.size());
  }

  /// Adapts all jobs from `first` to `end` one after another.
  void adapt_each(const Question& question, std::size_t first, std::size_t end) {
    question_ = question;
    for (std::size_t i = first; i < end; ++i) adapt_alone(i);
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
    return {store_.blocks[question_.jobs[i].member], shared_.layout};
  }

  void prefetch(std::size_t i) const {
    prefetch_member(member(i));
    prefetch_pose(*question_.jobs[i].reference);
    prefetch_pose(*question_.jobs[i].out);
  }

  // Prefetches the memory of later members: first the addresses, then the data.
  void call_ahead(std::size_t i) const {
    if (i + kNumbersAhead < end_) prefetch(i + kNumbersAhead);
    if (i + kAddressAhead < end_) {
      prefetch_address(*question_.jobs[i + kAddressAhead].reference);
      prefetch_address(*question_.jobs[i + kAddressAhead].out);
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
        shared_.plan, one, *question_.jobs[i].reference, question_.time_s, packed);
  }

  void write(std::size_t i, const float* result) const {
    const CrowdJob& job = question_.jobs[i];
    member(i).write(shared_.plan, result, *job.out);
    if (job.report != nullptr) *job.report = member(i).head().report;
  }

  void adapt_alone(std::size_t i) {
    const CrowdJob& job = question_.jobs[i];
    adapt_member(shared_, member(i), *job.reference, question_.time_s, *job.out, alone_);
    if (job.report != nullptr) *job.report = member(i).head().report;
  }

  const SharedPlan& shared_;
  const MembersStore& store_;
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
  CrowdOptions options;
  std::shared_ptr<const SharedPlan> shared;
  std::shared_ptr<MembersStore> store;
  std::vector<Adapter> members;
  std::vector<Worker> workers;
  std::vector<CrowdJob> jobs;  ///< As many as members at most.

  void reserve(std::size_t count);
};

void Crowd::State::reserve(std::size_t count) {
  if (jobs.capacity() < count) jobs.reserve(std::max(count, 2 * jobs.capacity()));
  const bool has_wide = count >= options.min_lane_jobs;
  for (Worker& worker : workers) {
    if (has_wide && worker.kernel == nullptr) {
      worker.kernel = make_lane_kernel(options.width, shared->plan);
      MAREY_ASSERT(worker.kernel != nullptr);
    }
    worker.jobs->reserve(jobs.capacity(), has_wide ? worker.kernel->width() : 0);
  }
  const std::size_t places = store->blocks.size();
  if (places < count) {
    store->grow(std::max(count - places, std::min(places, kMaxChunk)));
  }
}

Status Crowd::check_like(const AdapterState& first,
                         const AdapterState& other,
                         std::size_t number) {
  const bool same = other.shared->plan == first.shared->plan;
  if (same && same_options(other.member.head(), first.member.head())) {
    return Done{};
  }
  return bad_input(
      other.own->character.name + " (member " + std::to_string(number) + ")",
      same ? "its options are not those of the crowd's first member"
           : "its joints, groups, limits or constraints differ in structure "
             "from those of the crowd's first member" +
                 (first.own ? ", " + first.own->character.name : std::string()),
      "put it into a separate crowd");
}

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
    MAREY_ASSERT(!members[i].state_->is_member());
    const Status like = check_like(first, *members[i].state_, i);
    if (!like) return like.error();
  }
  auto state = std::make_unique<State>();
  state->options = options;
  state->shared = first.shared;
  state->store = std::make_shared<MembersStore>(*first.shared);
  for (int t = 0; t < options.threads; ++t) {
    state->workers.push_back(
        {nullptr, std::make_unique<Jobs>(*state->shared, *state->store)});
  }
  state->reserve(members.size());
  state->members = std::move(members);
  for (std::size_t i = 0; i < state->members.size(); ++i) {
    state->members[i].state_->join(*state->members[0].state_, state->store, i);
  }
  return Crowd(std::move(state));
}

Result<std::size_t> Crowd::add(Adapter member) {
  State& s = *state_;
  const std::size_t number = s.members.size();
  MAREY_ASSERT(!member.state_->is_member());
  const Status like = check_like(*s.members[0].state_, *member.state_, number);
  if (!like) return like.error();
  s.reserve(number + 1);
  member.state_->join(*s.members[0].state_, s.store, number);
  s.members.push_back(std::move(member));
  return number;
}

bool Crowd::takes(const Adapter& member) const {
  return check_like(*state_->members[0].state_, *member.state_, 0).has_value();
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
  for (std::size_t i = 0; i < count; ++i) {
    s.jobs.push_back(
        {i, &references[i], &out[i], reports.empty() ? nullptr : &reports[i]});
  }
  adapt_jobs(s.members[0].state_->member.head().options, time_s);
}

void Crowd::adapt(std::span<const CrowdJob> jobs, double time_s) {
  State& s = *state_;
  MAREY_ASSERT(jobs.size() <= s.members.size());
  // Members with balance are solved by another task than the others.
  for (const bool balance : {false, true}) {
    const AdaptOptions* options = nullptr;
    s.jobs.clear();
    for (const CrowdJob& job : jobs) {
      const MemberHead& head = s.members[job.member].state_->member.head();
      if ((head.options.balance != BalanceMode::kOff) != balance) continue;
      options = &head.options;
      s.jobs.push_back(job);
    }
    if (options != nullptr) adapt_jobs(*options, time_s);
  }
}

void Crowd::adapt_jobs(const AdaptOptions& options, double time_s) {
  State& s = *state_;
  const std::size_t count = s.jobs.size();
  const LaneTask task = task_of(*s.shared, options, options.control);
  const auto work = [&](std::size_t t) {
    const std::size_t threads = s.workers.size();
    const Worker& worker = s.workers[t];
    Jobs& jobs = *worker.jobs;
    const Jobs::Question question{s.jobs, time_s};
    const std::size_t first = count * t / threads;
    const std::size_t end = count * (t + 1) / threads;
    if (worker.kernel == nullptr || end - first < s.options.min_lane_jobs) {
      jobs.adapt_each(question, first, end);
      return;
    }
    jobs.begin(question, first, end);
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
