// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "engine/sources/live_posture.h"
#include "engine/transition/inertial_offset.h"

#include "core/base/result.h"

namespace marey::engine {

struct LiveOptions {
  double max_sigma_m = 0.05;  ///< A group above it gives way.
  double max_age_s = 0.1;     ///< Data older than that have stopped.
  double good_s = 0.3;        ///< Good data for so long bring a group back.
  /// For the shares of the groups: 90 % of a change take 2.8 half-lives. [s]
  double share_half_life_s = 0.15;
  double extrapolate_half_life_s = 0.15;  ///< For velocities without data.
  /// Data that come after a gap longer than this are met smoothly.
  double gap_s = 0.04;
  double gap_half_life_s = 0.1;  ///< For the difference after a gap.
};

/// Errors (bad input): a number that is not finite; a limit or time that is not above 0.
[[nodiscard]] Status check_live_options(const LiveOptions& options);

/// State of a live source after a step.
struct LiveReport {
  bool is_lost = false;  ///< There are no data, or they are too old.
  double age_s = 0.0;    ///< For the newest data.
  PerGroup share{};      ///< Factor on the priorities of its groups, 0 to 1.
};

/// The motion of a performer: postures that the caller pushes, and one posture for each
/// step. The newest data are shown in the next step, extrapolated by their age only, so
/// no frame of delay is added. Without new data, velocities decay. Allocates nothing.
class LiveSource {
 public:
  explicit LiveSource(const LiveOptions& options = {}) : options_(options) {}

  /// Takes a posture. Errors: those of check_live_posture(); a time that is not after
  /// that of the posture before.
  [[nodiscard]] Status push(const LivePosture& posture);
  /// True after two postures that are not further apart than LiveOptions::max_age_s.
  [[nodiscard]] bool has_data() const { return has_data_; }

  /// Moves on from time_s - step_s to time_s. Precondition: has_data(); step_s > 0.
  void step(double time_s, double step_s);

  /// The posture at a time. At that of the last step it is exact; before and after it
  /// the velocity of that step continues, after it with decay.
  void sample(double time_s, BlendPosture& out) const;
  /// Displacement of the root between two such times, in its heading frame. [legs]
  [[nodiscard]] RootPlace root_step(double from_s, double to_s) const;
  [[nodiscard]] unsigned bears() const { return newest_.bears; }
  /// Time of the newest data.
  [[nodiscard]] double newest_s() const { return newest_.time_s; }
  [[nodiscard]] const LiveReport& report() const { return report_; }

 private:
  /// A root's velocity in its heading frame. [legs/s, rad/s]
  struct RootRate {
    double x = 0.0;
    double z = 0.0;
    double heading = 0.0;
  };
  void take_data(double time_s, double step_s);
  void move_root(double step_s);
  void rate_groups(double step_s);
  [[nodiscard]] double ahead_s(double time_s) const;

  LiveOptions options_;
  // Data.
  bool has_any_ = false;
  bool has_data_ = false;
  bool has_rates_ = false;  ///< The newest data have velocities.
  bool is_new_ = false;     ///< They were not yet shown.
  LivePosture newest_;
  PostureRates data_rates_;
  RootRate data_root_rate_;
  // The last step.
  bool is_shown_ = false;
  double now_s_ = 0.0;
  double shown_data_s_ = 0.0;  ///< Time of the data that are shown.
  BlendPosture posture_;       ///< Data, extrapolated.
  PostureRates rates_;
  InertialOffset offset_;  ///< From the data to the posture that is shown.
  BlendPosture out_;
  PostureRates out_rates_;
  RootPlace root_;  ///< Data, extrapolated.
  RootRate root_rate_;
  RootRate root_lag_;  ///< Velocity that remains of a gap, and its rate.
  RootRate root_lag_rate_;
  RootRate out_root_rate_;
  // Shares.
  PerGroup good_s_{};
  std::array<bool, kGroupCount> is_wanted_{};
  PerGroup share_rate_{};
  LiveReport report_;
};

}  // namespace marey::engine
