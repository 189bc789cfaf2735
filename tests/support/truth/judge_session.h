// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "core/motion.h"
#include "tests/support/simulation/simulated_session.h"

namespace marey::testing {

/// The result for a session: a body and the motion of its trial, or an error.
struct SessionAnswer {
  std::optional<Error> refusal;
  std::string refused_by;  ///< The step that ended with the error.
  /// Hands and feet whose tags the body does without, each with its reason.
  std::vector<HumanBone> left_out;
  Body body;
  EstimatedMotion motion;
  double fit_s = 0.0;
  double solve_s = 0.0;
};

/// Joints of the limbs, left and right together.
enum class JointKind : int { kShoulder, kElbow, kWrist, kHip, kKnee, kAnkle };
inline constexpr int kJointKinds = 6;
inline constexpr int kSources = 3;

/// Number of values, and of those inside their 95 % region.
struct Tally {
  int count = 0;
  int inside = 0;
};

/// A joint with gross errors: called measured, and off by more than 60 mm, or by more
/// than 20 mm and 5 of its sigmas.
struct GrossJoint {
  HumanBone joint{};
  int measured_frames = 0;
  int gross_frames = 0;
  int max_run = 0;  ///< Consecutive gross frames.
  /// More than three consecutive frames, or more than 5 % of the trial's frames. Other
  /// gross frames are spikes.
  bool is_persistent = false;
  double worst_m = 0.0;
  double sigma_m = 0.0;  ///< In the worst frame.
  /// "flip": a segment at the joint is turned by more than 60 degrees in half of the
  /// gross frames or more. "one-tag": the fit placed one tag of a segment at the joint
  /// more than 20 mm wrong, its others not. "fit": all of them. "motion": none.
  std::string cause;
  std::string details;
};

/// One joint centre over the frames of a trial in which it has one source.
struct JointFigures {
  HumanBone joint{};
  Source source = Source::kInferred;
  Tally honest;  ///< Inside the 95 % region of its sigma.
  double median_error_m = 0.0;
  double median_sigma_m = 0.0;
};

struct SessionVerdict {
  bool is_refused = false;
  bool is_silently_wrong = false;  ///< Accepted, with a persistent gross error.
  /// Accepted, with hands or feet left out. Refused and silently wrong ones are not.
  bool is_partial = false;
  std::vector<GrossJoint> gross;
  int spike_frames = 0;    ///< Gross frames of joints that are not persistently wrong.
  int flipped_frames = 0;  ///< Segments called measured, off by more than 60 degrees.
  /// Squared errors of joint centres over sigma squared, by source and joint.
  std::array<std::array<Tally, kJointKinds>, kSources> honest{};
  std::vector<JointFigures> joints;
  Tally lengths;                    ///< Limb segments' lengths, against 1.96 sigma.
  double worst_length_share = 0.0;  ///< Largest error of a limb segment's length over it.
  double median_m = 0.0;            ///< Error of measured limb joint centres.
  double p95_m = 0.0;
  double max_m = 0.0;
};

/// Compares an answer with the truth: joint centres of the limbs and the turns of
/// segments in all frames of the session's motion, lengths of limb segments.
[[nodiscard]] SessionVerdict judge(const SimulatedSession& session,
                                   const SessionAnswer& answer);

/// Returns the cause of an error without its particulars: digits become #, quoted names
/// "...".
[[nodiscard]] std::string message_class(const Error& error);

}  // namespace marey::testing
