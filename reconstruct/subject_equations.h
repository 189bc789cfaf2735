// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the normal equations of a subject's fit. Frames share nothing
// but the subject, so each is eliminated by itself (Schur complement; Triggs et al. 2000,
// section 6.1), and within a frame each limb before the trunk.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/camera.h"
#include "reconstruct/body_model.h"
#include "reconstruct/posture_equations.h"
#include "reconstruct/tag_sight.h"

namespace marey::reconstruct {

/// How far tags slip on each segment, standard deviation per coordinate. [m]
using BoneSlips = std::array<double, kHumanBoneCount>;

/// The angles that pull at the skin under a tag, varying with the posture. [rad]
inline constexpr int kSlideAngles = 4;
using SlideAngles = std::array<double, kSlideAngles>;
[[nodiscard]] SlideAngles slide_angles(HumanBone bone,
                                       const Posture& posture,
                                       const UnfoldedPosture& unfolded);
inline constexpr int kSlideColumns = 3 * kSlideAngles;

/// Soft-tissue artefact: a tag's slide on its segment, linear in the joints' angles.
struct TagSlide {
  SlideAngles mean{};  ///< Angles at which the tag is in its place: their means. [rad]
  /// Along the segment's axes, as a thigh's skin would slide. [m/rad]
  Eigen::Matrix<double, 3, kSlideAngles> rate =
      Eigen::Matrix<double, 3, kSlideAngles>::Zero();
  /// Slide of the segment's skin over a thigh's: slide_share().
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

/// Returns a segment's slide of skin over a thigh's: less on upper arms and the trunk,
/// hardly any on hands, feet and the head (Leardini et al. 2005).
[[nodiscard]] double slide_share(HumanBone bone);

/// Parts of the body whose skin slides by sizes of their own: trunk and head, arms, legs.
enum class SlideGroup : int { kTrunk, kArms, kLegs };
inline constexpr std::size_t kSlideGroups = 3;
[[nodiscard]] SlideGroup slide_group(HumanBone bone);

/// The columns of a subject's unknowns: kShapeCount of its shape [m, rad], then six of
/// each placed tag: a small turn of the tag in its segment's frame [rad], and its place
/// there [m]. With `slides` then kSlideColumns of each placed tag: how far the tag slides
/// along the segment's axes per radian of each of slide_angles(). [m/rad]
class SubjectColumns {
 public:
  explicit SubjectColumns(const BodyModel& model, bool slides = false);
  /// First of the tag's slide columns; -1 without.
  [[nodiscard]] int of_slide(std::size_t tag) const { return of_slide_[tag]; }
  /// Of shape and tags, which come first.
  [[nodiscard]] int without_slides() const { return without_slides_; }
  [[nodiscard]] int size() const { return size_; }
  /// First of the tag's six columns; -1 of a tag without a place.
  [[nodiscard]] int of_tag(std::size_t tag) const { return of_tag_[tag]; }

 private:
  std::vector<int> of_tag_;
  std::vector<int> of_slide_;
  int without_slides_ = kShapeCount;
  int size_ = kShapeCount;
};

/// How one sighting's residuals are scaled.
struct SightingNoise {
  double scale = 1.0;   ///< Of the corners' own sigma.
  double slip_m = 0.0;  ///< Of the tag on its segment, standard deviation per coordinate.
  Eigen::Vector3d slide_m = Eigen::Vector3d::Zero();  ///< In the segment.
};

/// A sighting's eight residuals, of unit variance when all is well, and how they follow
/// the unknowns.
struct SightedTag {
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  Vector8 residual;
  int posture_columns = 0;
  std::array<int, SparseDerivative::kMost> posture_column{};
  Eigen::Matrix<double, 8, SparseDerivative::kMost> by_posture;
  int shape_columns = 0;
  std::array<int, SparseDerivative::kMost> shape_column{};
  Eigen::Matrix<double, 8, SparseDerivative::kMost> by_shape;
  Eigen::Matrix<double, 8, 6> by_tag;
  /// What moves together when the tag slips: orthonormal columns, and the residual per
  /// metre along each before it was scaled. [1/m]
  Eigen::Matrix<double, 8, 3> slip_directions;
  Eigen::Vector3d slip_gains;
};

/// The body's tags as cameras see them.
class SubjectSight {
 public:
  explicit SubjectSight(std::span<const Camera> cameras);

  /// False when a corner is not in front of the camera. Without `derivatives` only
  /// `residual` and the slip's members are filled. Precondition: the tag has a place.
  [[nodiscard]] bool look(const BodyModel& model,
                          const UnfoldedPosture& unfolded,
                          const TagSighting& sighting,
                          const SightingNoise& noise,
                          bool derivatives,
                          SightedTag& out) const;

 private:
  std::vector<TagSight> sights_;
};

/// How far a tag's place follows its slide rates in one frame.
struct FrameSlide {
  int tag_column = 0;
  int slide_column = 0;
  SlideAngles factors{};  ///< [rad]
};

/// One frame's equations over its posture and the subject's unknowns, and the frame's
/// elimination from them. In one frame a tag's slide is a shift of its place: its rates
/// come in only where the frame's equations are added to the subject's.
class FrameEquations {
 public:
  PostureEquations posture;

  /// Empties the equations; `columns` are the subject's that the frame's tags follow,
  /// slides aside.
  void begin(std::vector<int> columns, std::vector<FrameSlide> slides, int subject_size);
  void add(const SightedTag& sighted, int tag_column, double weight);
  /// Keeps these unknowns of the posture as they are.
  void hold(std::span<const int> posture_columns);

  /// Adds to `hessian` (lower triangle) and `gradient` of the subject what the frame says
  /// of it once its own posture is free. False where the posture is not determined.
  [[nodiscard]] bool eliminate(double damping,
                               Eigen::MatrixXd& hessian,
                               Eigen::VectorXd& gradient);
  /// The posture's step that goes with the subject's. After eliminate().
  void step(const Eigen::VectorXd& subject, PostureVector& out) const;

  /// Adds to `out`, a derivative by the subject's unknowns (three rows), how a point of
  /// the body follows them: by itself (`by_shape`), and as the frame's posture follows
  /// them while its sightings stay as they are. After eliminate().
  void add_response(const SparseDerivative& by_posture,
                    const SparseDerivative& by_shape,
                    Eigen::MatrixXd& out) const;
  /// Adds to `out`, three rows, the subject's gradient when the root of a limb is shifted
  /// by each column of `shifts_in_world` [m] while the model leaves it where it is. After
  /// eliminate().
  void add_root_shift(std::size_t limb,
                      const Eigen::Matrix3d& shifts_in_world,
                      Eigen::MatrixXd& out) const;

 private:
  /// What a local column adds to: columns of the subject, each with a factor.
  struct Target {
    int column = 0;
    double factor = 1.0;
  };
  struct Part {
    Eigen::LLT<Eigen::MatrixXd> own;
    std::vector<int> columns;  ///< Local ones, of columns_, that the part follows.
    Eigen::MatrixXd solved;    ///< L^-1 of [by trunk | by subject | gradient].
  };
  [[nodiscard]] bool eliminate_limb(std::size_t limb,
                                    double damping,
                                    Eigen::MatrixXd& trunk);
  void add_to(Eigen::MatrixXd& hessian, Eigen::VectorXd& gradient) const;
  using Pull = Eigen::Matrix<double, kPostureFreedom, 3>;
  void add_pull(const Pull& pull, Eigen::MatrixXd& local) const;
  void spread(const Eigen::MatrixXd& local, Eigen::MatrixXd& out) const;
  [[nodiscard]] std::span<const Target> targets_of(std::size_t local) const {
    return std::span(targets_).subspan(first_target_[local],
                                       first_target_[local + 1] - first_target_[local]);
  }

  std::vector<int> columns_;  ///< Of the subject.
  std::vector<FrameSlide> slides_;
  std::vector<Target> targets_;
  std::vector<std::size_t> first_target_;  ///< Of each of columns_, and the end.
  std::vector<int> local_;    ///< Of the subject's columns where in columns_; -1.
  Eigen::MatrixXd cross_;     ///< Posture's unknowns by columns_.
  Eigen::MatrixXd subject_;   ///< columns_ by columns_, lower triangle.
  Eigen::VectorXd gradient_;  ///< Of columns_.
  std::array<std::vector<bool>, 4> follows_;  ///< Which of columns_ each limb follows.
  /// How the posture's and the subject's gradients follow a shift of each limb's root.
  std::array<Pull, 4> posture_by_root_;
  std::array<Eigen::MatrixXd, 4> subject_by_root_;
  std::array<Part, 4> limbs_;
  Part trunk_;
};

}  // namespace marey::reconstruct
