// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a body with tags, and a solver of the posture of one frame from
// the corners of the tags in the cameras. The counterpart of body_model.h without Ceres.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/posture/posture_descent.h"
#include "reconstruct/tags/tag_sight.h"

namespace marey::reconstruct {

/// A tag fixed to a body.
struct ModelTag {
  TagOnSegment tag;
  HumanBone bone{};  ///< Bone that carries it.
  RigidTransform bone_from_tag;
  std::array<Eigen::Vector3d, 4> corners_in_bone;  ///< [m]
};

struct TagModel {
  Lengths lengths{};
  BodyConstants body;
  TwistPriors twists;
  std::vector<ModelTag> tags;  ///< Ascending ids.
  std::vector<Camera> cameras;
  std::vector<TagSight> sights;  ///< Per camera.
};

[[nodiscard]] TagModel to_tag_model(const Body& body, std::span<const Camera> cameras);

/// Returns the limb of a bone; nullopt if it belongs to none of the four.
[[nodiscard]] std::optional<std::size_t> limb_of(HumanBone bone);

/// A tag of the model in a picture.
struct SeenTag {
  std::size_t tag = 0;
  std::size_t camera = 0;
  TagDetection detection;
  /// Number of cameras that see it. Their errors share one slip of the tag.
  double cameras = 1.0;
};

/// Standard deviation of the slip of each segment's tags (soft_tissue_noise.h), per
/// coordinate. [m]
using SegmentSlips = std::array<double, kHumanBoneCount>;

/// Movement of the body between pictures that are not taken at the same time.
struct Drift {
  /// Per camera: delay of its picture after the posture's instant, in frames.
  std::span<const double> late_frames;
  /// Standard deviation of that delay per camera, in frames; used where it matters.
  std::span<const double> late_sigma_frames;
  /// Standard deviation of the body's speed. [m] per frame
  double speed_sigma_m = 0.0;
  /// Expected step per frame at the expected posture, and its derivative by the posture,
  /// as in move_bones().
  const Posture* expected = nullptr;
  PostureVector step;
  std::array<Eigen::Matrix3d, kPoseParameterCount> gain;
};

/// Fit of a sighting to the posture.
struct SightingFit {
  double squared = 0.0;  ///< Sum of its eight squared residuals in sigmas, slip included.
  double rms_px = 0.0;   ///< Root mean square distance of its corners to their expected
                         ///< positions.
};

/// Levenberg-Marquardt's method on one frame: corners, pose priors and SolveInputs. No
/// allocation after construction. Borrows the model.
class TagFrameSolver {
 public:
  explicit TagFrameSolver(const TagModel& model);

  /// Further information on the frame; all borrowed, any may be null.
  struct SolveInputs {
    const PosturePrior* prior = nullptr;
    const Drift* drift = nullptr;
    const SegmentSlips* slips_m = nullptr;
  };

  /// Moves `posture` to the nearest minimum of the cost; returns that cost. Some 5
  /// microseconds per sighting and iteration.
  double solve(std::span<const SeenTag> seen,
               const SolveInputs& inputs,
               Posture& posture,
               const FrameLimits& limits = {});

  /// Computes the cost of a posture without moving it, and its equations.
  const PostureEquations& evaluate(std::span<const SeenTag> seen,
                                   const SolveInputs& inputs,
                                   const Posture& posture,
                                   const FrameLimits& limits = {});

  /// Computes the fit of each sighting to `posture`; `fits` has one entry per sighting.
  void fit(std::span<const SeenTag> seen,
           const SolveInputs& inputs,
           const Posture& posture,
           std::span<SightingFit> fits);

  /// Information on the delay of each camera's pictures at a solved posture. Per camera:
  /// the gradient of the cost by its lateness [1/frame], and the derivatives of that
  /// gradient by the lateness and by the posture's unknowns.
  struct Lateness {
    double gradient = 0.0;
    double information = 0.0;
    PostureVector by_posture = PostureVector::Zero();
  };
  void lateness(std::span<const SeenTag> seen,
                const SolveInputs& inputs,
                const Posture& posture,
                const FrameLimits& limits,
                std::span<Lateness> out);
  /// Factored equations of the posture of the last lateness(), with all delays taken as
  /// exact.
  [[nodiscard]] const ArrowFactor& late_factor() const { return late_factor_; }

  /// Information of one bone's sightings on the slip of its tags (soft_tissue_noise.h):
  /// squares in excess of their expectation with the current slip, and their weight per
  /// squared slip.
  struct SlipScore {
    double excess = 0.0;       ///< [1/m^2]
    double information = 0.0;  ///< [1/m^4]
    double count = 0.0;        ///< Number of sightings.
  };
  /// Computes the scores at a solved posture with this covariance; `out` has one entry
  /// per bone.
  void slips(std::span<const SeenTag> seen,
             const SolveInputs& inputs,
             const Posture& posture,
             const PostureCovariance& covariance,
             std::span<SlipScore> out);

  [[nodiscard]] const ArrowFactor& factor() const { return descent_.factor(); }
  /// Computes the bones' frames of a posture.
  const UnfoldedPosture& unfold(const Posture& posture);

 private:
  /// The body at the time of a camera's picture, a little later.
  struct Seen {
    UnfoldedPosture unfolded;
    PostureVector follows;  ///< Derivative of this posture's step by the posture's step.
    bool late = false;
  };
  void unfold_all(const Posture& posture, const Drift* drift);
  void derive(const SeenTag& seen, const TagSighted& sighted);
  void scale_late(const SeenTag& seen);
  [[nodiscard]] const SparseDerivative& by_slip(const TagSighted& sighted);
  void accumulate(std::span<const SeenTag> seen,
                  const SolveInputs& inputs,
                  const Posture& posture,
                  const FrameLimits& limits,
                  PostureEquations& out);
  [[nodiscard]] bool sight(const SeenTag& seen,
                           const SolveInputs& inputs,
                           double sigma_scale,
                           TagSighted& out) const;
  [[nodiscard]] double stray_m2(const SeenTag& seen, const SolveInputs& inputs) const;

  const TagModel* model_;
  UnfoldedPosture unfolded_;
  std::vector<Seen> by_camera_;
  UnfoldedPosture next_;  ///< One frame later.
  PostureVector step_;    ///< Step of the body per frame, in the posture's unknowns.
  std::array<Eigen::Vector3d, 4> upper_by_flexion_;  ///< Per limb.
  SparseDerivative point_;
  TagDerivative derivative_;
  PostureDescent descent_;
  PostureEquations evaluated_;
  ArrowFactor late_factor_;
};

}  // namespace marey::reconstruct
