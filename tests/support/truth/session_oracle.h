// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "core/humanoid.h"
#include "tests/support/simulation/simulated_session.h"

namespace marey::testing {

/// Result of the test if a session suffices to measure its subject, from the truth.
struct Sufficiency {
  bool is_sufficient = false;
  std::string lacking;  ///< Missing parts; empty: none.
  /// Uncertainty of each joint between two needed segments after the range of motion and
  /// the static trial: standard deviation along the worst direction, in the frames of
  /// both segments, the larger one. [m]
  std::map<HumanBone, double> joint_sigma_m;
};

/// A session is sufficient when
/// - each of hips, upper chest, upper arms, forearms, thighs and shanks is located in at
///   least 15 frames of the range of motion, hips and upper chest in 3 of the static
///   trial. A segment is located when two cameras see a tag of it, or one camera sees
///   two tags of it, or one camera sees one tag and distinguishes its tilt from the
///   mirrored tilt by 4 standard deviations.
/// - hips, knees, shoulders and elbows are determined to 20 mm along the worst direction
///   by the Fisher information of the detections of these frames, taking the true
///   postures and the tags' true places: the joint's place in both segments is unknown,
///   corners err by their sigma, tags by their slide on the skin, and the line through a
///   tag along its normal passes the bone within 20 mm (standard deviation).
/// The bounds leave a margin, so that an imperfect method can solve these sessions.
[[nodiscard]] Sufficiency judge_sufficiency(const SimulatedSession& session);

}  // namespace marey::testing
