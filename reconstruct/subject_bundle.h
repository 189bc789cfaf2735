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
#include "reconstruct/subject_equations.h"

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

/// Over a range-of-motion trial, elbows bend about one axis of the arm's skin; what turns
/// about the bone would otherwise hide where along that axis the elbow lies.
inline constexpr TwistHabits kFirstTwists{0.1, 0.1, 0.08};
/// Skin follows the turn of an upper arm only in part: once the joints are nearly right.
inline constexpr TwistHabits kTrialTwists{0.3, 0.1, 0.08};

struct SubjectBundle {
  BodyModel model;
  Lengths usual{};  ///< Of an average person: the prior.
  std::vector<BundleFrame> frames;
  /// Corners of all tags stray this many times farther than they claim.
  double noise_scale = 1.0;
  /// Weight of the priors, as if all sightings had less weight: errors of cameras, clocks
  /// and skin are common to many sightings, which so carry less information than as many
  /// independent ones.
  double prior_weight = 1.0;
  /// Share of the variance of corners' errors that is the same in all frames in which one
  /// camera sees one tag. That of simulated sessions until refine_slides() estimates it.
  double common_share = 0.08;
  BoneSlips slips_m{};  ///< Of the tags on each segment.
  TwistHabits twists = kFirstTwists;
  /// Of all tags with a place; empty while skin is assumed to be firm.
  std::map<std::size_t, TagSlide> slides;
  /// Prior of the slides' rates, standard deviation, by SlideGroup. [m/rad]
  std::array<double, kSlideGroups> slide_m_per_rad{};

  // Filled by measure() and fill_sigmas().
  Lengths length_sigma_m{};
  std::map<std::size_t, TagSigma> tag_sigma;
  /// Of each joint centre against the tags of its own bone or of its parent's, whichever
  /// knows it better, per coordinate (point_sigma.h); none where neither has tags. [m]
  std::array<std::optional<double>, kHumanBoneCount> centre_sigma_m{};
  double rms_px = 0.0;
  double median_px = 0.0;

  /// Returns the noise of a sighting of the tag in this posture.
  [[nodiscard]] SightingNoise noise(std::size_t tag,
                                    const Posture& posture,
                                    const UnfoldedPosture& unfolded) const;
};

/// Which unknowns a solve may move.
struct BundleFreedom {
  /// This limb's alone: its frame, bends, twists and extremity in every frame, its two
  /// lengths and its tags. All others are held. nullopt: everything.
  std::optional<std::size_t> limb;
  /// From a first guess: steps are held back, so that they stay in its valley.
  bool is_first = false;
};

/// Moves lengths, tag poses and postures to the least robust cost nearby (Levenberg and
/// Marquardt; a tag's eight residuals together have a Cauchy loss at 5 sigma), and
/// returns it; nullopt when the equations have no solution. Some 0.3 ms per frame and
/// iteration. Precondition: every tag of the model is sighted in some frame of the
/// bundle.
std::optional<double> adjust(SubjectBundle& bundle,
                             std::span<const Camera> cameras,
                             int max_iterations,
                             const BundleFreedom& freedom = {});

/// The cost of the bundle as it is: half the squares of all terms.
[[nodiscard]] double cost_of(const SubjectBundle& bundle,
                             std::span<const Camera> cameras);

/// Reprojection of all tag corners: rms_px and median_px.
void measure(SubjectBundle& bundle, std::span<const Camera> cameras);

/// Returns the factor by which covariances are too small: residuals may be larger than
/// expected, and many sightings of one tag by one camera are not as many independent
/// ones. At least 1. Before measure() by the number of sightings alone.
[[nodiscard]] double variance_scale(const SubjectBundle& bundle);

/// Frees the tags to slide with the adjacent joints: a slide in proportion to an angle
/// looks like a joint elsewhere, so that residuals hardly show it. The size of slides is
/// estimated as the variance of random effects (restricted maximum likelihood; Patterson
/// & Thompson 1971), with the corners' noise that the fit shows; the weight of the priors
/// also counts sightings of one tag by one camera as dependent. Some 2 s. False if the
/// equations have no solution. Preconditions: adjust() has converged, then measure().
[[nodiscard]] bool refine_slides(SubjectBundle& bundle, std::span<const Camera> cameras);

/// Covariances of lengths, tags and joint centres. False when the equations have no
/// solution. Precondition: refine_slides().
[[nodiscard]] bool fill_sigmas(SubjectBundle& bundle, std::span<const Camera> cameras);

}  // namespace marey::reconstruct
