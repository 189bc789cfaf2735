// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a body with tags, and the posture of one frame of it, from
// where cameras see the tags' corners. What body_model.h is to Ceres, without it.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/posture_descent.h"
#include "reconstruct/tag_sight.h"

namespace marey::reconstruct {

/// A tag glued to a body.
struct ModelTag {
  TagOnSegment tag;
  HumanBone bone{};  ///< Whose motion it follows.
  RigidTransform bone_from_tag;
  std::array<Eigen::Vector3d, 4> corners_in_bone;  ///< [m]
};

struct TagModel {
  Lengths lengths{};
  BodyFrame body;
  TwistHabits twists;
  std::vector<ModelTag> tags;  ///< Ascending ids.
  std::vector<Camera> cameras;
  std::vector<TagSight> sights;  ///< Per camera.
};

[[nodiscard]] TagModel to_tag_model(const Body& body, std::span<const Camera> cameras);

/// Which of the four limbs a bone is of; nullopt of others.
[[nodiscard]] std::optional<std::size_t> limb_of(HumanBone bone);

/// A tag of the model in a picture.
struct SeenTag {
  std::size_t tag = 0;
  std::size_t camera = 0;
  TagDetection detection;
  /// How many cameras see it: of its slip they know no more together than one.
  double cameras = 1.0;
};

/// How far tags slip on a segment (tag_slip.h), per coordinate. [m]
using SegmentSlips = std::array<double, kHumanBoneCount>;

/// How the body moves while pictures are taken that are not taken at once.
struct Drift {
  /// Per camera: how much later than the posture's instant it sees, in frames.
  std::span<const double> late_frames;
  /// How well that is known, likewise, where it counts.
  std::span<const double> late_sigma_frames;
  /// By how much the body's speed is not what it seems to be. [m] per frame
  double speed_sigma_m = 0.0;
  /// The step per frame that is expected where the posture is as expected, and how it
  /// follows the posture: as in move_bones().
  const Posture* expected = nullptr;
  PostureVector step;
  std::array<Eigen::Matrix3d, kSlotCount> gain;
};

struct TagLimits : DescentLimits {
  /// Corners stray this many times farther than their sigma says: a start that is far off
  /// has to be brought near before any tag can be told from a wrong one.
  double sigma_scale = 1.0;
  double habit_share = 1.0;  ///< Of the habits' weight.
};

/// A sighting against the posture.
struct TagFit {
  double squared = 0.0;  ///< Of its eight residuals in sigmas, slip allowed for.
  double rms_px = 0.0;   ///< Of its corners' distances to where they should be.
};

/// Cauchy's loss of a tag starts here, in sigmas of its eight residuals together, whose
/// norm is near 2.8 when all is well.
inline constexpr double kDoubtfulTag = 5.0;

/// Levenberg and Marquardt's method on one frame: corners, habits, and what is known
/// beside. No allocation once it is made. Borrows the model.
class TagFrameSolver {
 public:
  explicit TagFrameSolver(const TagModel& model);

  /// What is known of the frame beside its sightings; all borrowed, any null.
  struct Beside {
    const PosturePrior* prior = nullptr;
    const Drift* drift = nullptr;
    const SegmentSlips* slips_m = nullptr;
  };

  /// Moves `posture` to the least cost nearby; returns that cost. Some 5 microseconds
  /// per sighting and iteration.
  double solve(std::span<const SeenTag> seen,
               const Beside& beside,
               Posture& posture,
               const TagLimits& limits = {});

  /// The cost of a posture as it is, and its equations.
  const PostureEquations& evaluate(std::span<const SeenTag> seen,
                                   const Beside& beside,
                                   const Posture& posture,
                                   const TagLimits& limits = {});

  /// How each sighting fits `posture`; `fits` has one entry per sighting.
  void fit(std::span<const SeenTag> seen,
           const Beside& beside,
           const Posture& posture,
           std::span<TagFit> fits);

  /// What the cameras' pictures say of how late each is, once the posture is solved:
  /// per camera the gradient of the cost by its lateness [1/frame], and how that follows
  /// the lateness and the posture's unknowns.
  struct Lateness {
    double gradient = 0.0;
    double information = 0.0;
    PostureVector by_posture = PostureVector::Zero();
  };
  void lateness(std::span<const SeenTag> seen,
                const Beside& beside,
                const Posture& posture,
                const TagLimits& limits,
                std::span<Lateness> out);
  /// Of the last lateness(): of the posture's equations, no lateness doubted.
  [[nodiscard]] const ArrowFactor& late_factor() const { return late_factor_; }

  /// What the sightings of one bone say of how far its tags slip (tag_slip.h): squares in
  /// excess of what their slip makes expect, and what that weighs, per squared slip.
  struct SlipScore {
    double excess = 0.0;       ///< [1/m^2]
    double information = 0.0;  ///< [1/m^4]
    double count = 0.0;        ///< Of sightings.
  };
  /// At a solved posture with this covariance; `out` has one entry per bone.
  void slips(std::span<const SeenTag> seen,
             const Beside& beside,
             const Posture& posture,
             const PostureCovariance& covariance,
             std::span<SlipScore> out);

  [[nodiscard]] const ArrowFactor& factor() const { return descent_.factor(); }
  /// The posture given, unfolded.
  const UnfoldedPosture& unfold(const Posture& posture);

 private:
  /// The body as a camera sees it: a little later.
  struct Seen {
    UnfoldedPosture unfolded;
    PostureVector follows;  ///< By how much of a step in the posture this one moves.
    bool late = false;
  };
  void unfold_all(const Posture& posture, const Drift* drift);
  void derive(const SeenTag& seen, const TagSighted& sighted);
  void scale_late(const SeenTag& seen);
  [[nodiscard]] const SparseDerivative& by_slip(const TagSighted& sighted);
  void accumulate(std::span<const SeenTag> seen,
                  const Beside& beside,
                  const Posture& posture,
                  const TagLimits& limits,
                  PostureEquations& out);
  [[nodiscard]] bool sight(const SeenTag& seen,
                           const Beside& beside,
                           double sigma_scale,
                           TagSighted& out) const;
  [[nodiscard]] double stray_m2(const SeenTag& seen, const Beside& beside) const;

  const TagModel* model_;
  UnfoldedPosture unfolded_;
  std::vector<Seen> by_camera_;
  UnfoldedPosture next_;  ///< A frame later.
  PostureVector step_;    ///< Of the body per frame, in the posture's unknowns.
  std::array<Eigen::Vector3d, 4> upper_by_flexion_;  ///< Per limb.
  SparseDerivative point_;
  TagDerivative derivative_;
  PostureDescent descent_;
  PostureEquations judged_;
  ArrowFactor late_factor_;
};

}  // namespace marey::reconstruct
