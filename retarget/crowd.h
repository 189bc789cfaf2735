// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "retarget/adapter.h"

namespace marey::retarget {

/// How many bodies are adapted side by side in a processor's vector registers.
enum class LaneWidth { kOne = 1, kFour = 4, kEight = 8, kSixteen = 16 };

/// The widest that the processor at hand has.
[[nodiscard]] LaneWidth widest_lanes();

struct CrowdOptions {
  LaneWidth width = widest_lanes();
  int threads = 1;
};

/// Many characters adapted at once: one per SIMD lane, lanes that are done filled again.
/// Every member's answer is its adapter's own, to the bit, whatever the width, the number
/// of threads and its neighbours. Members may differ in all but structure: lengths,
/// masses, limits, targets. Those whose constraints fade are solved by themselves.
/// Cost: docs/measurements.md. adapt() allocates nothing (threads apart, which it starts
/// anew each time).
class Crowd {
 public:
  /// Errors (bad input): no members; one that differs from the first in its skeleton's
  /// structure, its groups, which joints have limits, its constraints' types and places,
  /// or in one of these options: method, control, balance, max_iterations and
  /// extremities_keep_orientation (the others are each member's own): which, is told;
  /// less than one thread; a width that this processor does not have.
  [[nodiscard]] static Result<Crowd> make(std::vector<Adapter> members,
                                          const CrowdOptions& options = {});
  Crowd(Crowd&&) noexcept;
  Crowd& operator=(Crowd&&) noexcept;
  ~Crowd();

  [[nodiscard]] std::size_t size() const;
  /// To move its targets and loads, or to ask what became of them. Its options stay as
  /// they are, and a point at its joint's own place stays one, as one elsewhere does.
  /// Precondition: member < size(); not while adapt() runs.
  [[nodiscard]] Adapter& operator[](std::size_t member);

  /// As Adapter::adapt() of each. Precondition: one reference and one place in `out` per
  /// member; `reports` empty or likewise.
  void adapt(std::span<const Pose> references,
             double time_s,
             std::span<Pose> out,
             std::span<AdaptReport> reports = {});

 private:
  class Jobs;
  struct Worker;
  struct State;
  explicit Crowd(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace marey::retarget
