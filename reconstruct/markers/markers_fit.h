// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/body.h"
#include "core/humanoid.h"
#include "reconstruct/labels/landmarks.h"
#include "reconstruct/markers/body_stature.h"

namespace marey::reconstruct {

/// Declared facts of a subject, independent of its markers.
struct MarkerSubject {
  std::string name;
  std::optional<double> stature_m;  ///< Estimated from the markers if not given.
  std::optional<double> mass_kg;
};

/// A label and the landmark it stands for; nullptr if unknown.
struct NamedMarker {
  std::string label;
  const Landmark* landmark = nullptr;
};

/// Result of the fit for one label.
enum class LabelUse {
  kNamed,    ///< Used according to its name.
  kFound,    ///< Its name has no known meaning; it moves with `segment`.
  kMoved,    ///< Its name means another segment than the one it moves with.
  kLeftOut,  ///< Moves with no segment, or was seen too rarely.
};

/// Returns "named", "found", "moved", "left-out": the words of reports.
[[nodiscard]] std::string_view name(LabelUse use);

struct LabelVerdict {
  std::string label;
  LabelUse use{};
  HumanBone segment{};   ///< If it is used.
  double stray_m = 0.0;  ///< From its place there, per coordinate; 0 if unused.
  /// The segment that its name means, if any.
  std::optional<HumanBone> named;
};

/// Source of a joint centre.
enum class JointOrigin {
  kMovement,     ///< Movement of markers on both sides about it: functional.
  kLandmarks,    ///< Landmarks near it: regression.
  kProportions,  ///< Average body of this size.
};

/// Returns "movement", "landmarks", "proportions".
[[nodiscard]] std::string_view name(JointOrigin origin);

struct JointEvidence {
  HumanBone joint{};  ///< The bone that starts there.
  JointOrigin origin{};
  double sigma_m = 0.0;  ///< Sigma of its place in its parent, per coordinate.
  double range_rad =
      0.0;  ///< Range of its rotation over the trials, 5th to 95th percentile.
};

struct MarkersFit {
  Body body;
  std::vector<LabelVerdict> labels;   ///< In the order given.
  std::vector<JointEvidence> joints;  ///< Every bone except the hips.
  double rms_m = 0.0;  ///< Distance of markers from the body, over the chosen instants.
  /// Number of pairs of markers whose median is the first estimate of the stature.
  int stature_pairs = 0;
  /// The stature measured from the markers, even if one was given; nullopt if the markers
  /// do not determine it: body.stature_m is then the given or an average one.
  std::optional<MeasuredStature> measured_stature;
};

}  // namespace marey::reconstruct
