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
class Crowd::Jobs final : public LaneJobs {
 public:
  /// Inputs of the whole crowd.
  struct Question {
    std::span<Adapter> members;
    std::span<const Pose> references;
    double time_s = 0.0;
    std::span<Pose> out;
    std::span<AdaptReport> reports;
  };

  Jobs(const Plan& plan, std::size_t max_count) : packed_(plan) {
    postponed_.reserve(max_count);
  }

  void begin(const Question& question, std::size_t first, std::size_t end) {
    question_ = question;
    next_ = first;
    end_ = end;
    postponed_.clear();
    again_ = false;
    handed_out_ = 0;
  }

  [[nodiscard]] bool next(LaneJob& job) override {
    while (next_ < end_) {
      const std::size_t i = next_++;
      call_ahead(i);
      if (prepare(i, job)) return true;
      // Constraints fade: the member is solved individually.
      const AdaptReport report = question_.members[i].adapt(
          question_.references[i], question_.time_s, question_.out[i]);
      if (!question_.reports.empty()) question_.reports[i] = report;
    }
    if (!again_ || handed_out_ == postponed_.size()) return false;
    return prepare(static_cast<std::size_t>(postponed_[handed_out_++]), job);
  }

  /// From now on next() returns the postponed jobs.
  void begin_again() { again_ = true; }

  void answer(int number, const float* result) override {
    const auto i = static_cast<std::size_t>(number);
    AdapterState& member = *question_.members[i].state_;
    member.write(*packed_.plan, result, question_.out[i]);
    if (!question_.reports.empty()) question_.reports[i] = member.report;
  }

  void postpone(int number) override { postponed_.push_back(number); }

 private:
  static constexpr std::size_t kStateAhead = 8;
  static constexpr std::size_t kNumbersAhead = 4;

  // Prefetches the memory of later members: first the pointers, then the data.
  void call_ahead(std::size_t i) const {
    if (i + kNumbersAhead < end_) {
      question_.members[i + kNumbersAhead].state_->prefetch_numbers();
      AdapterState::prefetch_pose(question_.references[i + kNumbersAhead]);
      AdapterState::prefetch_pose(question_.out[i + kNumbersAhead]);
    }
    if (i + kStateAhead < end_) {
      question_.members[i + kStateAhead].state_->prefetch_state();
    }
  }

  // Returns false if constraints fade.
  [[nodiscard]] bool prepare(std::size_t i, LaneJob& job) {
    AdapterState& member = *question_.members[i].state_;
    if (!member.prepare(question_.references[i], question_.time_s, packed_)) return false;
    job = {member.body.packed.data(),
           packed_.posture.data(),
           packed_.targets.data(),
           packed_.balance.data(),
           static_cast<int>(i)};
    return true;
  }

  Question question_;
  PackedProblem packed_;
  std::size_t next_ = 0;
  std::size_t end_ = 0;
  std::vector<int> postponed_;
  bool again_ = false;
  std::size_t handed_out_ = 0;  ///< Number of postponed jobs returned.
};

/// One per thread.
struct Crowd::Worker {
  std::unique_ptr<LaneKernel> kernel;
  std::unique_ptr<Jobs> jobs;
};

struct Crowd::State {
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
  for (std::size_t i = 1; i < members.size(); ++i) {
    const AdapterState& other = *members[i].state_;
    const bool same = other.plan == first.plan;
    if (same && same_options(other.options, first.options)) continue;
    return bad_input(
        other.character.name + " (member " + std::to_string(i) + ")",
        same ? "its options are not those of the crowd's first member"
             : "its joints, groups, limits or constraints differ in structure "
               "from those of the crowd's first member, " +
                   first.character.name,
        "put it into a separate crowd");
  }
  auto state = std::make_unique<State>();
  for (int t = 0; t < options.threads; ++t) {
    auto kernel = make_lane_kernel(options.width, first.plan);
    MAREY_ASSERT(kernel != nullptr);
    state->workers.push_back(
        {std::move(kernel), std::make_unique<Jobs>(first.plan, members.size())});
  }
  state->members = std::move(members);
  for (Adapter& member : state->members) member.state_->is_member = true;
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
  const AdapterState& first = *s.members[0].state_;
  const LaneTask task{&first.plan,
                      first.shape(),
                      first.settings(),
                      first.options.method == Method::kThesis,
                      &first.thesis};
  const auto work = [&](std::size_t t) {
    const std::size_t threads = s.workers.size();
    const Worker& worker = s.workers[t];
    Jobs& jobs = *worker.jobs;
    jobs.begin({s.members, references, time_s, out, reports},
               count * t / threads,
               count * (t + 1) / threads);
    // Members that limbs suffice for are solved first, so that all lanes of whole-body
    // steps are used. With balance there are none.
    if (!task.shape.rows.balance) worker.kernel->sift(task, jobs);
    jobs.begin_again();
    worker.kernel->solve(task, jobs);
  };
  std::vector<std::jthread> threads;
  for (std::size_t t = 1; t < s.workers.size(); ++t) threads.emplace_back(work, t);
  work(0);
}

}  // namespace marey::retarget
