// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the state of a subject's bundle: model, frames, noise and
// sigmas.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/bundle/subject_equations.h"
#include "reconstruct/tags/body_model.h"

namespace marey::reconstruct {

/// One instant of the bundle.
struct BundleFrame {
  std::span<const TagSighting> sightings;
  bool standing = false;
  Posture posture;
};

/// Standard deviation of a tag's pose on its segment, root mean square over coordinates.
struct TagSigma {
  double m = 0.0;
  double rad = 0.0;
};

/// Twist priors of the first fit.
inline constexpr TwistPriors kFirstTwists{
    kFitTwistSigma_rad, kFitTwistSigma_rad, kLegTwistSigma_rad};
/// Twist priors once the joints are nearly right: skin follows the turn of an upper arm
/// only in part.
inline constexpr TwistPriors kTrialTwists{0.3, kFitTwistSigma_rad, kLegTwistSigma_rad};

struct SubjectBundle {
  BodyModel model;
  Lengths usual{};  ///< Lengths of an average person: the prior.
  std::vector<BundleFrame> frames;
  /// Factor on the declared sigmas of all tags' corners.
  double noise_scale = 1.0;
  /// Weight of the priors, equivalent to less weight of all sightings: errors of cameras,
  /// clocks and skin are common to many sightings, which therefore carry less information
  /// than as many independent ones.
  double prior_weight = 1.0;
  /// Share of the variance of corners' errors that is the same in all frames in which one
  /// camera sees one tag. The value of simulated sessions until refine_slides() estimates
  /// it.
  double correlated_error_share = 0.08;
  BoneSlips slips_m{};  ///< Slip of the tags on each segment.
  TwistPriors twists = kFirstTwists;
  /// Slides of all tags with a place; empty while skin is assumed to be firm.
  std::map<std::size_t, TagSlide> slides;
  /// Prior standard deviation of the slides' rates, by SlideGroup. [m/rad]
  std::array<double, kSlideGroups> slide_m_per_rad{};

  // Filled by measure() and fill_sigmas() (subject_sigmas.h).
  Lengths length_sigma_m{};
  std::map<std::size_t, TagSigma> tag_sigma;
  /// Sigma of each joint centre relative to the tags of its own bone or of its parent's,
  /// whichever is smaller, per coordinate (point_sigma.h); none if neither has tags. [m]
  std::array<std::optional<double>, kHumanBoneCount> centre_sigma_m{};
  double rms_px = 0.0;
  double median_px = 0.0;

  /// Returns the noise of a sighting of the tag in this posture.
  [[nodiscard]] SightingNoise noise(std::size_t tag,
                                    const Posture& posture,
                                    const UnfoldedPosture& unfolded) const;
};

/// Computes the reprojection error of all tag corners: rms_px and median_px.
void measure(SubjectBundle& bundle, std::span<const Camera> cameras);

}  // namespace marey::reconstruct
