// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"
#include "core/character_spec.h"
#include "core/humanoid.h"

namespace marey::retarget {

/// Radii of gyration of a segment about its centre of mass, as shares of its length
/// between de Leva's end points. Axes of the anatomical position: sagittal is from back
/// to front, transverse from side to side. For a hand, sagittal is across the palm's
/// plane; for a foot, vertical.
struct GyrationRadii {
  double sagittal = 0.0;
  double transverse = 0.0;
  double longitudinal = 0.0;
};

/// One segment of an anthropometric table.
struct SegmentRow {
  double mass_share = 0.0;  ///< Share of the whole body's mass.
  /// Centre of mass from the proximal to the distal end point, over their distance.
  double com_at = 0.0;
  GyrationRadii gyration{};
};

/// A table by segment; both sides are alike. The end points exist in skeletons: joint
/// centres, the base of the neck, the ear canal or the vertex, the finger tip.
///
/// Dempster 1955 as in Kulpa 2005, table 5.1, to the digit. Its trunk is uncertain: it
/// reaches from the hip centres to the shoulders' with the centre at 0.66 of that. Winter
/// ("Biomechanics and Motor Control of Human Movement", table 4.1) has trunk, head and
/// neck together there, and the trunk alone at 0.5. With a separate head, head and neck
/// count twice: a standing body has the centre of mass at 0.59 of the stature; measured
/// values are 0.55 to 0.57.
///
/// de Leva 1996, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J.
/// Biomechanics 29(9), table 4, with the end points of its lower part where those are
/// joint centres: MIDS-MIDH, WJC-DAC3, KJC-AJC, VERT-CERV. Measured on living people; a
/// standing body has the centre of mass at 0.56. The mean of its women and men is the
/// default, since the sex of the subject is not known.
///
/// Radii of gyration: those of de Leva's table 4, between the end points named above. The
/// thesis gives none for Dempster's segments: that table has the mean of de Leva's women
/// and men, over the lengths between de Leva's end points.
struct SegmentTable {
  SegmentRow head;   ///< Base of the neck to ear canal (Dempster) or vertex (de Leva).
  SegmentRow trunk;  ///< Between the hip centres to between the shoulder centres.
  SegmentRow upper_arm;  ///< Shoulder to elbow.
  SegmentRow forearm;    ///< Elbow to wrist.
  SegmentRow hand;       ///< Wrist to knuckles (Dempster) or finger tip (de Leva).
  SegmentRow thigh;      ///< Hip to knee.
  SegmentRow shank;      ///< Knee to ankle.
  SegmentRow foot;       ///< Ankle to ball (Dempster), heel to toe tip (de Leva).
  /// Shares of the trunk's mass, and of its height from the hip centres to the base of
  /// the neck, at which the lower and the middle part end. Equal numbers: uniform
  /// density.
  double lower_mass = 0.5;
  double lower_height = 0.5;
  double middle_mass = 0.75;
  double middle_height = 0.75;
};

[[nodiscard]] const SegmentTable& segment_table(MassTable table);

/// Returns the mass of each segment of kMassSegments, by its bone, in kg; zero elsewhere.
///
/// Errors (bad input): a mass is not finite or negative; the total is not above zero;
/// segments are given without a total, and not all of them; their sum exceeds the total;
/// all segments are given, and their sum differs from the total.
[[nodiscard]] Result<std::array<double, kHumanBoneCount>> weigh_segments(
    const MassSpec& spec);

}  // namespace marey::retarget
