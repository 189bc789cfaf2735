// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: what a posture's slots are expected to do from frame to frame.
//
// The speed of every slot is an Ornstein-Uhlenbeck process (posture_habits.h). Slots are
// followed each by itself (a Kalman filter, and back in time a Rauch-Tung-Striebel
// smoother); what couples them, the markers of a frame, is solved by MarkerFrameSolver
// with the filter's expectation as a prior. A batch and a live step share all of it.

#include <array>
#include <span>

#include <Eigen/Core>

#include "core/time.h"
#include "reconstruct/posture_equations.h"
#include "reconstruct/posture_habits.h"

namespace marey::reconstruct {

/// What is believed of a posture and its speed. Steps are those of move_bones(), per
/// frame.
struct PostureBelief {
  Posture posture;
  PostureVector step;
  /// Covariance of each slot's value and step: 6 x 6, or 2 x 2 in the corner of scalars.
  std::array<Eigen::Matrix<double, 6, 6>, kSlotCount> covariance;
};

/// What the filter believes of people.
struct Temper {
  /// How much brisker than the everyday movement of kAccelerations they are. Athletes
  /// are; markers, of which a frame has many, tell.
  double brisk = 5.0;
  /// After which they have changed what they do, and habits speak anew. [s]
  double habit_memory_s = 0.5;
};

/// The filter's constants at a frame rate.
class SlotProcess {
 public:
  SlotProcess(const Lengths& lengths, FrameRate rate, const Temper& temper = {});

  /// The frames to come are `rate` apart: what is believed of steps per frame follows.
  void change_rate(FrameRate rate, PostureBelief& belief);
  [[nodiscard]] FrameRate rate() const { return rate_; }

  /// A posture of which nothing is known but where `posture` has it, give or take: speeds
  /// are those that the process has on average.
  [[nodiscard]] PostureBelief start(const Posture& posture) const;

  /// One frame on.
  void predict(const PostureBelief& now, PostureBelief& next) const;

  /// The prior that a prediction is for its frame's markers.
  static void to_prior(const PostureBelief& predicted, PosturePrior& prior);

  /// What is believed after a frame: `solved` is where the posture was found from
  /// `predicted` and markers, with this covariance.
  void update(const PostureBelief& predicted,
              const Posture& solved,
              const PostureCovariance& covariance,
              PostureBelief& updated) const;

  /// Carries what is known later back: `later` the smoothed belief of the next frame,
  /// `predicted` what was predicted of it from `filtered`. Rauch, Tung & Striebel 1965.
  void smooth(const PostureBelief& filtered,
              const PostureBelief& predicted,
              const PostureBelief& later,
              PostureBelief& smoothed) const;

  /// What all other frames say of this one: `smoothed` without what the frame's own
  /// markers made of `predicted` (which gave `filtered`).
  void from_others(const PostureBelief& predicted,
                   const PostureBelief& filtered,
                   const PostureBelief& smoothed,
                   PosturePrior& prior) const;

  /// What share of habits' weight a frame has: said over and over again, they count once
  /// in the time in which people change what they do.
  [[nodiscard]] double habit_share() const { return habit_share_; }

 private:
  void set_rate(FrameRate rate);
  void add_flexion(Slot slot,
                   const Posture& posture,
                   const PostureCovariance& covariance,
                   Eigen::Matrix3d& found) const;

  std::array<StepProcess, kSlotCount> process_;
  Lengths lengths_;
  FrameRate rate_;
  Temper temper_;
  double habit_share_ = 1.0;
};

}  // namespace marey::reconstruct
