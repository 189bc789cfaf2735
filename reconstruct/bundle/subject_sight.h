// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: sightings of a subject's tags with derivatives by its unknowns,
// and the slide of skin.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "reconstruct/posture/posture_equations.h"
#include "reconstruct/tags/body_model.h"
#include "reconstruct/tags/tag_sight.h"

namespace marey::reconstruct {

/// Slip of the tags on each segment, standard deviation per coordinate. [m]
using BoneSlips = std::array<double, kHumanBoneCount>;

/// Angles of the posture that move the skin under a tag. [rad]
inline constexpr int kSlideAngles = 4;
using SlideAngles = std::array<double, kSlideAngles>;
[[nodiscard]] SlideAngles slide_angles(HumanBone bone,
                                       const Posture& posture,
                                       const UnfoldedPosture& unfolded);
inline constexpr int kSlideColumns = 3 * kSlideAngles;

/// Soft-tissue artefact: a tag's slide on its segment, linear in the joints' angles.
struct TagSlide {
  SlideAngles mean{};  ///< Mean angles, at which the slide is zero. [rad]
  /// Along the segment's axes, for a thigh's skin. [m/rad]
  Eigen::Matrix<double, 3, kSlideAngles> rate =
      Eigen::Matrix<double, 3, kSlideAngles>::Zero();
  /// Slide of the segment's skin relative to a thigh's: slide_share().
  double share = 1.0;

  /// Returns the shift from the tag's place, in the segment's frame. [m]
  [[nodiscard]] Eigen::Vector3d at(const SlideAngles& angles) const {
    Eigen::Vector3d slide = Eigen::Vector3d::Zero();
    for (int i = 0; i < kSlideAngles; ++i) {
      const auto place = static_cast<std::size_t>(i);
      slide += (angles[place] - mean[place]) * rate.col(i);
    }
    return share * slide;
  }
};

/// Returns a segment's slide of skin relative to a thigh's: less on upper arms and the
/// trunk, hardly any on hands, feet and the head (Leardini et al. 2005).
[[nodiscard]] double slide_share(HumanBone bone);

/// Parts of the body with separate variances of skin slide: trunk and head, arms, legs.
enum class SlideGroup : int { kTrunk, kArms, kLegs };
inline constexpr std::size_t kSlideGroups = 3;
[[nodiscard]] SlideGroup slide_group(HumanBone bone);

/// The columns of a subject's unknowns: kShapeCount of its shape [m, rad], then six of
/// each placed tag: a small turn of the tag in its segment's frame [rad], and its place
/// there [m]. With `slides` also kSlideColumns of each placed tag: the slide of the tag
/// along the segment's axes per radian of each of slide_angles(). [m/rad]
class SubjectColumns {
 public:
  explicit SubjectColumns(const BodyModel& model, bool slides = false);
  /// Returns the first of the tag's slide columns; nullopt without slides.
  [[nodiscard]] std::optional<int> of_slide(std::size_t tag) const {
    return of_slide_[tag];
  }
  /// Number of columns of shape and tags, which come first.
  [[nodiscard]] int without_slides() const { return without_slides_; }
  [[nodiscard]] int size() const { return size_; }
  /// Returns the first of the tag's six columns; nullopt for a tag without a place.
  [[nodiscard]] std::optional<int> of_tag(std::size_t tag) const { return of_tag_[tag]; }

 private:
  std::vector<std::optional<int>> of_tag_;
  std::vector<std::optional<int>> of_slide_;
  int without_slides_ = kShapeCount;
  int size_ = kShapeCount;
};

/// Scale of one sighting's residuals.
struct SightingNoise {
  double scale = 1.0;   ///< Factor on the corners' own sigma.
  double slip_m = 0.0;  ///< Slip of the tag on its segment, standard deviation per
                        ///< coordinate.
  Eigen::Vector3d slide_m = Eigen::Vector3d::Zero();  ///< In the segment's frame.
};

/// A sighting's eight residuals, of unit variance for inliers, and their derivatives by
/// the unknowns.
struct SightedTag {
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  Vector8 residual;
  int posture_columns = 0;
  std::array<int, SparseDerivative::kMax> posture_column{};
  Eigen::Matrix<double, 8, SparseDerivative::kMax> by_posture;
  int shape_columns = 0;
  std::array<int, SparseDerivative::kMax> shape_column{};
  Eigen::Matrix<double, 8, SparseDerivative::kMax> by_shape;
  Eigen::Matrix<double, 8, 6> by_tag;
  /// Common movement of the residuals when the tag slips: orthonormal columns, and the
  /// residual per metre along each before scaling. [1/m]
  Eigen::Matrix<double, 8, 3> slip_directions;
  Eigen::Vector3d slip_gains;
};

/// The body's tags in the cameras' images.
class SubjectSight {
 public:
  explicit SubjectSight(std::span<const Camera> cameras);

  /// Computes a sighting. False if a corner is not in front of the camera. Without
  /// `derivatives` only `residual` and the slip's members are filled. Precondition: the
  /// tag has a place.
  [[nodiscard]] bool look(const BodyModel& model,
                          const UnfoldedPosture& unfolded,
                          const TagSighting& sighting,
                          const SightingNoise& noise,
                          bool derivatives,
                          SightedTag& out) const;

 private:
  std::vector<TagSight> sights_;
};

}  // namespace marey::reconstruct
