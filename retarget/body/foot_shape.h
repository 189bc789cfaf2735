// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace marey::retarget {

// The shape of an average foot, for skeletons that have only ankle and toe joint. Lengths
// after Drillis and Contini 1966 (Winter 2009, figure 4.1), in statures: a foot is 0.152
// long, 0.055 broad, its ankle 0.039 high.

/// Toes beyond the ball, in lengths from ankle to ball.
inline constexpr double kToesInBall = 0.5;
/// Distance of the heel's round end behind the ankle, in lengths from ankle to ball: the
/// point over which a foot rolls. It is smaller than the heel's full extent.
inline constexpr double kBearingHeelInBall = 0.25;
/// Full extent of the heel behind the ankle, in lengths from ankle to toe tip: the rest
/// of the foot's length in average_proportions(). Used to place masses.
inline constexpr double kHeelInFoot = 0.267;
/// Breadth of a foot, in its lengths: near the table's 0.055 of 0.152.
inline constexpr double kBreadthInFoot = 0.38;

}  // namespace marey::retarget
