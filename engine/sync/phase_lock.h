// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::engine {

struct PhaseLockOptions {
  /// Relative change of rate per cycle of phase error.
  double gain_per_cycle = 5.0;
  double max_change = 0.2;  ///< Maximum relative change of rate.
  /// Time constant of the estimate of the lead's tempo. [cycles]
  double tempo_cycles = 0.5;
  double min_rate = 0.5;  ///< Minimum rate of the follower, relative to its speed.
  double max_rate = 2.0;
};

/// The rate of a clip that follows a lead without a future, for example a performer: the
/// clip's cycle takes as long as the lead's recent one, and its rate changes by at most
/// max_change in proportion to the error of phase. Allocates nothing.
class PhaseLock {
 public:
  /// `cycle_s`: duration of the clip's cycle; `speed`: clip seconds per second that its
  /// user asked for, used until the lead's tempo is known. Precondition: both > 0.
  void start(double cycle_s, double speed, const PhaseLockOptions& options = {});

  /// Returns the rate of the clip for the time until the next call, in clip seconds per
  /// second; within kMinWarpRate and kMaxWarpRate. Phases in cycles, modulo 1, as
  /// observed at `now_s`. Precondition: started; now_s ascends.
  double step(double now_s, double lead_phase, double follower_phase);

 private:
  PhaseLockOptions options_;
  double cycle_s_ = 1.0;
  double speed_ = 1.0;
  double tempo_hz_ = 1.0;  ///< Tempo of the lead.
  double last_s_ = 0.0;
  double last_lead_phase_ = 0.0;
  double watched_cycles_ = 0.0;
  bool has_last_ = false;
};

}  // namespace marey::engine
