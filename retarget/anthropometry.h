// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/character_spec.h"
#include "core/humanoid.h"
#include "core/result.h"

namespace marey::retarget {

/// One segment of an anthropometric table.
struct SegmentRow {
  double mass_share = 0.0;  ///< Of the whole body's mass.
  /// Centre of mass from the proximal to the distal end point, over their distance.
  double com_at = 0.0;
};

/// A table by segment; both sides are alike. The end points are those that a skeleton
/// has: joint centres, the base of the neck, the ear canal or the vertex, the finger tip.
///
/// Dempster 1955 as in Kulpa 2005, table 5.1, to the digit. Doubtful is its trunk, from the
/// hip centres to the shoulders' with the centre at 0.66 of that: Winter ("Biomechanics
/// and Motor Control of Human Movement", table 4.1) has trunk, head and neck together
/// there, and the trunk alone at 0.5. With a head beside it, head and neck count twice: who
/// stands has the centre of mass at 0.59 of the stature, where 0.55 to 0.57 are measured.
///
/// de Leva 1996, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters",
/// J. Biomechanics 29(9), table 4, with the end points of its lower part where those are
/// joint centres: MIDS-MIDH, WJC-DAC3, KJC-AJC, VERT-CERV. Of living people; who stands has
/// the centre of mass at 0.56. The mean of its women and men is the default, since nobody
/// says whose body it is.
struct SegmentTable {
  SegmentRow head;   ///< Base of the neck to ear canal (Dempster) or vertex (de Leva).
  SegmentRow trunk;  ///< Between the hip centres to between the shoulder centres.
  SegmentRow upper_arm;  ///< Shoulder to elbow.
  SegmentRow forearm;    ///< Elbow to wrist.
  SegmentRow hand;       ///< Wrist to knuckles (Dempster) or finger tip (de Leva).
  SegmentRow thigh;      ///< Hip to knee.
  SegmentRow shank;      ///< Knee to ankle.
  SegmentRow foot;       ///< Ankle to ball (Dempster), heel to toe tip (de Leva).
  /// Of the trunk's mass, and of its height from the hip centres to the base of the neck:
  /// where the lower and the middle part end. Equal numbers: the same everywhere.
  double lower_mass = 0.5;
  double lower_height = 0.5;
  double middle_mass = 0.75;
  double middle_height = 0.75;
};

[[nodiscard]] const SegmentTable& segment_table(MassTable table);

/// What each segment of kMassSegments weighs, by its bone, in kg; zero elsewhere.
///
/// Errors (bad input): a mass is not finite or negative; the total is not above zero;
/// segments are given without a total, and not all of them; they weigh more than the
/// total, or, when all are given, anything else.
[[nodiscard]] Result<std::array<double, kHumanBoneCount>> weigh_segments(
    const MassSpec& spec);

}  // namespace marey::retarget
