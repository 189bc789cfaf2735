// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/crowd_movers.h"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <utility>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "benchmarks/adaptation/marey_posture_solver.h"
#include "retarget/adapt/crowd.h"

namespace marey {
namespace {

using retarget::Adapter;
using retarget::AdaptOptions;
using retarget::Crowd;
using retarget::CrowdOptions;
using retarget::LaneWidth;
using retarget::Method;

constexpr double kPrecision_m = 1e-3;  // Same as in marey's "one by one" columns.

class OneByOne final : public CrowdMover {
 public:
  OneByOne(const SolverKind& kind,
           const std::vector<CrowdMember>& crowd,
           const std::vector<PointGoal>& goals,
           bool with_balance) {
    for (const CrowdMember& member : crowd) {
      solvers_.push_back(kind.make({&member.character, goals, with_balance}));
    }
  }
  void move(const std::vector<CrowdMember>& crowd, std::vector<Pose>& out) override {
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      const PostureTask task = crowd[i].task();
      solvers_[i]->load(task);
      solvers_[i]->solve(task);
      solvers_[i]->store(out[i]);
    }
  }

 private:
  std::vector<std::unique_ptr<PostureSolver>> solvers_;
};

template <class T>
T expect(Result<T> made) {
  if (made) return *std::move(made);
  std::fprintf(stderr, "%s\n", made.error().message().c_str());
  std::exit(2);
}

class SideBySide final : public CrowdMover {
 public:
  SideBySide(Crowd crowd, const std::vector<CrowdMember>& members, std::size_t goals)
      : crowd_(std::move(crowd)) {
    for (std::size_t i = 0; i < members.size(); ++i) {
      references_.push_back(members[i].reference);
      for (std::size_t k = 0; k < goals; ++k) {
        handles_.push_back(*crowd_[i].constraint(goal_id(k)));
      }
    }
  }
  void move(const std::vector<CrowdMember>& crowd, std::vector<Pose>& out) override {
    auto handle = handles_.begin();
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      for (const glm::dvec3& target_in_world : crowd[i].targets_in_world) {
        (handle++)->set_target(target_in_world);
      }
      crowd_[i].set_balance_target(crowd[i].com_in_world);
    }
    crowd_.adapt(references_, 0.0, out);
  }

 private:
  Crowd crowd_;
  std::vector<Adapter::Handle> handles_;  // Goals of the members, in order.
  std::vector<Pose> references_;
};

std::unique_ptr<CrowdMover> make_side_by_side(const std::vector<CrowdMember>& crowd,
                                              const std::vector<PointGoal>& goals,
                                              const AdaptOptions& options,
                                              const CrowdOptions& how) {
  std::vector<Adapter> members;
  for (const CrowdMember& member : crowd) {
    const PostureProblem problem{&member.character, goals, false};
    members.push_back(expect(Adapter::make(
        member.character, marey_constraints(problem, kPrecision_m), options)));
  }
  return std::make_unique<SideBySide>(
      expect(Crowd::make(std::move(members), how)), crowd, goals.size());
}

double memory_KiB() {
#if defined(__GLIBC__)
  return static_cast<double>(mallinfo2().uordblks) / 1024.0;
#else
  return 0.0;
#endif
}

}  // namespace

std::vector<CrowdColumn> crowd_columns(const std::vector<CrowdMember>& crowd,
                                       const std::vector<PointGoal>& goals,
                                       bool with_balance) {
  std::vector<CrowdColumn> columns;
  const auto add = [&](const std::string& name,
                       bool has_threads,
                       const std::function<std::unique_ptr<CrowdMover>()>& make) {
    const double before_KiB = memory_KiB();
    auto mover = make();
    const double each_KiB =
        (memory_KiB() - before_KiB) / static_cast<double>(crowd.size());
    columns.push_back({name, std::move(mover), has_threads, each_KiB});
    columns.back().found.resize(crowd.size());
  };
  auto kinds = baseline_solvers();
  for (SolverKind& kind : marey_solvers()) kinds.push_back(std::move(kind));
  for (const SolverKind& kind : kinds) {
    add(kind.name + ", one by one", false, [&] {
      return std::make_unique<OneByOne>(kind, crowd, goals, with_balance);
    });
  }
  AdaptOptions options;
  if (with_balance) options.balance = retarget::BalanceMode::kHorizontal;
  const auto add_crowd = [&](const std::string& name, const CrowdOptions& how) {
    add(name, how.threads > 1, [&] {
      return make_side_by_side(crowd, goals, options, how);
    });
  };
  const LaneWidth widest = retarget::max_lanes();
  for (const LaneWidth width :
       {LaneWidth::kOne, LaneWidth::kFour, LaneWidth::kEight, LaneWidth::kSixteen}) {
    if (width > widest) continue;
    const std::string lanes = std::to_string(static_cast<int>(width));
    add_crowd("marey strict, crowd of " + lanes + " lanes", {width, 1});
  }
  add_crowd("the same, two threads", {widest, 2});
  options.method = Method::kThesis;
  add_crowd("marey thesis, crowd", {widest, 1});
  return columns;
}

}  // namespace marey
