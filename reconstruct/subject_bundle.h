// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the joint refinement behind fit_subject().

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/body_model.h"

namespace marey::reconstruct {

/// One instant that the bundle looks at.
struct BundleFrame {
  std::span<const TagSighting> sightings;
  bool standing = false;
  Posture posture;
};

/// How well a tag's pose on its segment is known, root mean square over coordinates.
struct TagSigma {
  double m = 0.0;
  double rad = 0.0;
};

struct SubjectBundle {
  BodyModel model;
  Lengths usual{};  ///< Of an average person: the prior.
  std::vector<BundleFrame> frames;

  // Filled by adjust().
  Lengths length_sigma_m{};
  std::map<std::size_t, TagSigma> tag_sigma;
  /// Of each joint centre against the tags of its own bone or of its parent's, whichever
  /// knows it better, per coordinate; none where neither has tags. [m]
  std::array<std::optional<double>, kHumanBoneCount> centre_sigma_m{};
  double rms_px = 0.0;
  double median_px = 0.0;
};

/// Moves lengths, tag poses and postures to the least reprojection. With `sigmas`, also
/// fills the sigmas. False when the solver finds no usable minimum.
/// Precondition: every tag of the model is sighted in some frame of the bundle.
[[nodiscard]] bool adjust(SubjectBundle& bundle,
                          std::span<const Camera> cameras,
                          int max_iterations,
                          bool sigmas);

}  // namespace marey::reconstruct
