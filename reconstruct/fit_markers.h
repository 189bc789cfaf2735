// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/body.h"
#include "core/marker_tracks.h"
#include "core/progress.h"
#include "core/result.h"
#include "reconstruct/body_stature.h"
#include "reconstruct/landmarks.h"

namespace marey::reconstruct {

/// What is known of a subject before its markers are looked at.
struct MarkerSubject {
  std::string name;
  std::optional<double> stature_m;  ///< Estimated from the markers when not given.
  std::optional<double> mass_kg;
};

/// A label and the landmark it stands for; nullptr where nobody knows.
struct NamedMarker {
  std::string label;
  const Landmark* landmark = nullptr;
};

/// What became of a label.
enum class LabelUse {
  kNamed,    ///< Used as what it is called.
  kFound,    ///< Its name says nothing; it moves with `segment`.
  kMoved,    ///< Its name says another segment than the one it moves with.
  kLeftOut,  ///< Moves with no segment, or was seen too rarely.
};

/// "named", "found", "moved", "left-out": the words of reports.
[[nodiscard]] std::string_view name(LabelUse use);

struct LabelVerdict {
  std::string label;
  LabelUse use{};
  HumanBone segment{};   ///< Of what is used.
  double stray_m = 0.0;  ///< From its place there, per coordinate; 0 of what is unused.
  /// The segment that its name says, if it says any.
  std::optional<HumanBone> named;
};

/// What a joint centre was found from.
enum class JointOrigin {
  kMovement,     ///< How markers on both sides moved about it: functional.
  kLandmarks,    ///< Where it lies from landmarks near it: regression.
  kProportions,  ///< An average body of this size.
};

/// "movement", "landmarks", "proportions".
[[nodiscard]] std::string_view name(JointOrigin origin);

struct JointEvidence {
  HumanBone joint{};  ///< The bone that starts there.
  JointOrigin origin{};
  double sigma_m = 0.0;  ///< Of its place in its parent, per coordinate.
  double range_rad =
      0.0;  ///< How far it was turned over the trials, 5th to 95th percent.
};

struct MarkersFit {
  Body body;
  std::vector<LabelVerdict> labels;   ///< In the order given.
  std::vector<JointEvidence> joints;  ///< Every bone but the hips.
  double rms_m =
      0.0;  ///< Distance of markers from the body, over the instants looked at.
  /// How many pairs of markers the first estimate of the stature is the median of.
  int stature_pairs = 0;
  /// The stature that the markers show, whether or not one was given; nullopt where they
  /// show none: body.stature_m is then the given or an average one.
  std::optional<MeasuredStature> measured_stature;
};

/// Measures a person from labelled markers: segment lengths, joint centres, and where
/// each marker sits, all at once by one bundle over chosen instants of all trials
/// (Ceres), with landmarks, proportions, left and right alike, and human habits as soft
/// terms. A trial of standing still is enough, moving trials make it better; which joint
/// owes what to movement is told. Hip joint centres lie where the spines of the pelvis
/// say (Harrington et al. 2007) as far as movement does not say otherwise.
///
/// Labels without a landmark are given to the segment with which they move, if two named
/// markers show how it moves and the place is within its flesh; those of which several
/// segments are possible are left out. Markers that move with another segment than the
/// one they are named for are moved there by the same rules; those that move with none
/// are left out.
///
/// Deterministic. Cost: some seconds, whatever the trials' lengths, and more
/// with hundreds of trials. Errors (kBadInput,
/// `where` empty): fewer than six labels have landmarks, none of them the hips' or the
/// trunk's; never six of them seen at once; no body that explains them.
[[nodiscard]] Result<MarkersFit> fit_markers(const MarkerSubject& subject,
                                             std::span<const MarkerTracks> trials,
                                             std::span<const NamedMarker> labels,
                                             const Progress& progress = {});

/// How tall an average person would be in whom landmarks are as far from each other as
/// these: the weighted median over pairs on one segment and over pairs that a joint next
/// to one of them parts. nullopt without such pairs. [m]
struct StatureEstimate {
  double stature_m = 0.0;
  int pairs = 0;
};
[[nodiscard]] std::optional<StatureEstimate> estimate_stature(
    std::span<const MarkerTracks> trials, std::span<const NamedMarker> labels);

}  // namespace marey::reconstruct
