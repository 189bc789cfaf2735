// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::retarget {

// The shape of an average foot, for skeletons that tell of nothing but ankle and toe
// joint. Lengths after Drillis and Contini 1966 (Winter 2009, figure 4.1), in statures:
// a foot is 0.152 long, 0.055 broad, its ankle 0.039 high.

/// Toes beyond the ball, in lengths from ankle to ball.
inline constexpr double kToesInBall = 0.5;
/// How far a heel's round end bears behind the ankle, in lengths from ankle to ball. What
/// a foot rolls over: less than the heel sticks out.
inline constexpr double kBearingHeelInBall = 0.25;
/// How far a heel sticks out behind the ankle, in lengths from ankle to toe tip: what
/// average_proportions() leaves of the foot's length. Where masses are told by it.
inline constexpr double kHeelInFoot = 0.267;
/// How broad a foot is, in its lengths: near the table's 0.055 of 0.152.
inline constexpr double kBreadthInFoot = 0.38;

}  // namespace marey::retarget
