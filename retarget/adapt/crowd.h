// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/pose.h"
#include "retarget/adapt/adapter.h"
#include "retarget/adapt/lane_dispatch.h"

namespace marey::retarget {

struct CrowdOptions {
  LaneWidth width = max_lanes();
  int threads = 1;
  /// Fewer postures in one call are adapted one after another, without lanes; a crowd
  /// with fewer members has no work arrays for lanes.
  std::size_t min_lane_jobs = 1;
};

/// A posture of one member.
struct CrowdJob {
  std::size_t member = 0;
  const Pose* reference = nullptr;
  Pose* out = nullptr;
  AdaptReport* report = nullptr;  ///< nullptr: not wanted.
};

/// Adapts many characters in parallel: one per SIMD lane; a lane that finishes is
/// refilled. The result of every member equals that of its own adapter to the bit, for
/// any width, number of threads and other members. Members share the structure; lengths,
/// masses, limits and targets may differ. Members with fading constraints are
/// solved in lanes, too. A member of 22 bones and four constraints takes 6.3 KiB
/// (measure_member_memory). Cost: docs/accuracy/README.md. adapt() allocates nothing
/// except its threads, which it starts in each call.
class Crowd {
 public:
  /// Creates a crowd. Errors (bad input): no members; less than one thread; a width that
  /// this processor does not support; a member that differs from the first in the
  /// structure of its skeleton, its groups, the set of joints with limits, the types and
  /// points of its constraints, or in one of the options method, control, balance,
  /// max_iterations and extremities_keep_orientation (other options may differ). The
  /// error names the difference.
  [[nodiscard]] static Result<Crowd> make(std::vector<Adapter> members,
                                          const CrowdOptions& options = {});
  /// Adds a member and returns its number. Numbers and handles of the others stay valid.
  /// Allocates. Errors (bad input): it differs from the first as in make().
  /// Precondition: adapt() is not running.
  [[nodiscard]] Result<std::size_t> add(Adapter member);
  /// Returns true if add() would take it.
  [[nodiscard]] bool takes(const Adapter& member) const;

  Crowd(Crowd&&) noexcept;
  Crowd& operator=(Crowd&&) noexcept;
  ~Crowd();

  [[nodiscard]] std::size_t size() const;
  /// Returns a member, to set its targets and loads or to read its outcomes. Its options
  /// must not change. A constrained point with an offset of zero keeps an offset of zero,
  /// and one with an offset keeps a nonzero offset. Precondition: member < size();
  /// adapt() is not running. Members share work arrays: the
  /// adapt() of one waits for that of another.
  [[nodiscard]] Adapter& operator[](std::size_t member);

  /// Adapts every member as Adapter::adapt() does. Precondition: one reference and one
  /// element of `out` per member; `reports` is empty or has one element per member.
  void adapt(std::span<const Pose> references,
             double time_s,
             std::span<Pose> out,
             std::span<AdaptReport> reports = {});
  /// Adapts some members, each at most once.
  void adapt(std::span<const CrowdJob> jobs, double time_s);

 private:
  class Jobs;
  struct Worker;
  struct State;
  [[nodiscard]] static Status check_like(const AdapterState& first,
                                         const AdapterState& other,
                                         std::size_t number);
  void adapt_jobs(const AdaptOptions& options, double time_s);
  explicit Crowd(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace marey::retarget
