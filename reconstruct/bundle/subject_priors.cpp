// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_priors.h"

#include <array>
#include <cmath>
#include <optional>

#include <ceres/jet.h>

#include "core/base/assert.h"
#include "core/base/cross_matrix.h"
#include "core/human/posture_priors.h"
#include "reconstruct/posture/length_terms.h"

namespace marey::reconstruct {
namespace {

// A clavicle turns about one end, and its scapula slides on the rib cage: the effective
// pivot of a shoulder can be anywhere between.
constexpr double kShoulderBase_m = 0.05;
constexpr double kNeckForward_m = 0.012;

// A tag's plate lies on the flesh: at least the bone's own radius from its axis, on the
// side that it faces, at most the radius of a heavy limb and a plate on a strap.
constexpr double kMinRadius_m = 0.02;
constexpr double kRadiusSigma_m = 0.015;
/// Distance of a tag from a bone's axis.
struct UsualRadius {
  double usual_m = 0.0;  ///< An adult's flesh at half the bone's length, and a plate.
  double sigma_m = 0.0;  ///< Slim to stout, and along the bone.
  double max_m = 0.0;
};
/// Upper arm, forearm, thigh, shank.
constexpr std::array<UsualRadius, 4> kUsualRadius{{{0.058, 0.022, 0.11},
                                                   {0.045, 0.018, 0.09},
                                                   {0.090, 0.028, 0.14},
                                                   {0.062, 0.022, 0.11}}};
// Sine of the angle between a tag's normal and the bone: below it, the normal does not
// determine the side of the bone that the tag is on.
constexpr double kMinSine = 0.3;
// A hand's tag lies on a strap around wrist or palm, at most this far from the line
// through the hand. [m]
constexpr double kMaxHandRadius_m = 0.07;
constexpr double kPastEnd_m = 0.03;
constexpr double kAlongSigma_m = 0.03;
// Standard deviation of the distance between the bone's axis and the line along a limb
// tag's normal: kFacing_m, and kFacing_rad of the tag's distance, since skin tilts the
// tag.
constexpr double kFacing_rad = 0.2;
constexpr double kFacing_m = 0.004;

struct Usual {
  double value = 0.0;
  double sigma = 0.0;
};
/// Prior of HingeShape in people. [rad, m]
struct UsualHinge {
  Usual upper;
  Usual lower;
  Usual straight;  ///< The sum of both.
  Usual rollback;
};
// The carrying angle of elbows is 10 to 15 degrees in people (Paraskevas et al. 2004), 0
// in most models of bodies. Hip, knee and ankle are on a line to within some degrees.
// Knees roll back by some millimetres (Iwaki et al. 2000).
constexpr UsualHinge kElbow{{0.02, 0.10}, {0.04, 0.10}, {0.06, 0.09}, {0.0, 0.001}};
constexpr UsualHinge kKnee{{0.0, 0.07}, {0.0, 0.07}, {0.0, 0.045}, {0.002, 0.003}};

constexpr int kUnknowns = 7;  // Turn, place, the bone's length.
using Jet = ceres::Jet<double, kUnknowns>;
using JetVector = Eigen::Matrix<Jet, 3, 1>;

struct LimbBone {
  std::size_t limb = 0;
  Length length{};
  const UsualRadius* radius = nullptr;
};

std::optional<LimbBone> limb_bone_of(HumanBone bone) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const std::size_t first = limb < 2 ? 0 : 2;
    if (bone == human_limbs()[limb].upper) {
      return LimbBone{limb, kLimbParameters[limb].upper, &kUsualRadius[first]};
    }
    if (bone == human_limbs()[limb].lower) {
      return LimbBone{limb, kLimbParameters[limb].lower, &kUsualRadius[first + 1]};
    }
  }
  return std::nullopt;
}

/// Returns the largest distance from the joint of a tag on a segment that is not a
/// limb's. [m]
double max_reach_m(HumanBone bone) {
  switch (bone) {
    case HumanBone::kLeftHand:
    case HumanBone::kRightHand:
      return 0.2;
    case HumanBone::kLeftFoot:
    case HumanBone::kRightFoot:
      return 0.25;
    case HumanBone::kHead:
      return 0.3;
    default:
      return 0.4;
  }
}

Jet excess(const Jet& value, double limit, double sigma) {
  return value.a > limit ? (value - limit) / sigma : Jet(0.0);
}

struct TagTerms {
  /// Too far off, too near (for a hand: too far from its line), past an end, facing,
  /// distance from the axis.
  std::array<Jet, 5> residual{};
};

/// Returns the tag's normal, which points into the flesh.
JetVector normal_of(const RigidTransform& pose) {
  const Eigen::Vector3d n = eigen(pose.rotation * glm::dvec3(0, 0, 1));
  const Eigen::Matrix3d by_turn = -cross_matrix<Eigen::Matrix3d>(n);
  JetVector normal;
  for (int i = 0; i < 3; ++i) {
    normal[i] = Jet(n[i]);
    for (int k = 0; k < 3; ++k) normal[i].v[k] = by_turn(i, k);
  }
  return normal;
}

Jet length_of(const JetVector& v) {
  return sqrt(v.squaredNorm() + 1e-12);
}

TagTerms tag_terms(const BodyModel& model, std::size_t tag) {
  const RigidTransform& pose = *model.place(tag);
  const HumanBone bone = model.bone(tag);
  JetVector p;
  for (int i = 0; i < 3; ++i) p[i] = Jet(pose.translation[i], 3 + i);
  TagTerms terms;
  const auto limb = limb_bone_of(bone);
  if (!limb) {
    const Jet reach = length_of(p);
    terms.residual[0] = excess(reach, max_reach_m(bone), kAlongSigma_m);
    if (bone == HumanBone::kLeftHand || bone == HumanBone::kRightHand) {
      p[0] = Jet(0.0);
      terms.residual[1] = excess(length_of(p), kMaxHandRadius_m, kRadiusSigma_m);
    }
    return terms;
  }
  const glm::dvec3 axis = limb_axis(limb->limb);
  const JetVector along(Jet(axis.x), Jet(axis.y), Jet(axis.z));
  const Jet height = p.dot(along);
  const JetVector off_axis = p - height * along;
  const Jet radius = length_of(off_axis);
  const JetVector normal = normal_of(pose);
  const JetVector off_normal = normal - normal.dot(along) * along;
  const Jet sine = length_of(off_normal);
  // A tag that faces its bone is on the wrong side of it.
  const Jet outside = sine.a > kMinSine ? -off_axis.dot(off_normal) / sine : radius;
  terms.residual[0] = excess(radius, limb->radius->max_m, kRadiusSigma_m);
  terms.residual[1] = excess(-outside, -kMinRadius_m, kRadiusSigma_m);
  terms.residual[4] = (outside - limb->radius->usual_m) / limb->radius->sigma_m;
  const Jet length(model.lengths[index(limb->length)], 6);
  const Jet past = height.a < 0.5 * length.a ? -height : height - length;
  terms.residual[2] = excess(past, kPastEnd_m, kAlongSigma_m);
  // The line through the tag's middle along its normal passes near the bone's axis. A tag
  // that faces along the bone gives no information.
  terms.residual[3] =
      p.dot(along.cross(normal)) / ((sine + 0.05) * (kFacing_m + kFacing_rad * radius.a));
  return terms;
}

void add_tag(const BodyModel& model,
             std::size_t tag,
             const SubjectColumns& columns,
             SubjectSystem& out) {
  std::array<int, kUnknowns> where{};
  for (int i = 0; i < 6; ++i) {
    where[static_cast<std::size_t>(i)] = *columns.of_tag(tag) + i;
  }
  const auto limb = limb_bone_of(model.bone(tag));
  where[6] = limb ? static_cast<int>(limb->length) : 0;
  for (const Jet& residual : tag_terms(model, tag).residual) {
    if (residual.a == 0.0) continue;
    out.cost += 0.5 * residual.a * residual.a;
    for (int i = 0; i < kUnknowns; ++i) {
      const int row = where[static_cast<std::size_t>(i)];
      out.gradient[row] += residual.a * residual.v[i];
      for (int j = 0; j < kUnknowns; ++j) {
        const int column = where[static_cast<std::size_t>(j)];
        if (row >= column) out.hessian(row, column) += residual.v[i] * residual.v[j];
      }
    }
  }
}

void add_lengths(const BodyModel& model, const Lengths& usual, SubjectSystem& out) {
  Lengths sigmas_m = usual_length_sigmas_m(usual);
  for (const Length length :
       {Length::kShoulderOut, Length::kShoulderUp, Length::kShoulderForward}) {
    sigmas_m[index(length)] = kShoulderBase_m;
  }
  sigmas_m[index(Length::kNeckForward)] = kNeckForward_m;
  for (int i = 0; i < kLengthCount; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const double weight = 1.0 / (sigmas_m[place] * sigmas_m[place]);
    const double off = model.lengths[place] - usual[place];
    out.hessian(i, i) += weight;
    out.gradient[i] += weight * off;
    out.cost += 0.5 * weight * off * off;
  }
  constexpr double kWeight = 1.0 / (kSidesDifferSigma_m * kSidesDifferSigma_m);
  for (int left = static_cast<int>(Length::kLeftShoulder); left < kLengthCount;
       left += 2) {
    const auto place = static_cast<std::size_t>(left);
    const double off = model.lengths[place] - model.lengths[place + 1];
    out.hessian(left, left) += kWeight;
    out.hessian(left + 1, left + 1) += kWeight;
    out.hessian(left + 1, left) -= kWeight;
    out.gradient[left] += kWeight * off;
    out.gradient[left + 1] -= kWeight * off;
    out.cost += 0.5 * kWeight * off * off;
  }
}

void add_hinges(const BodyConstants& body, SubjectSystem& out) {
  const auto add = [&](int column, double value, const Usual& usual) {
    const double weight = 1.0 / (usual.sigma * usual.sigma);
    const double off = value - usual.value;
    out.hessian(column, column) += weight;
    out.gradient[column] += weight * off;
    out.cost += 0.5 * weight * off * off;
  };
  const auto add_sum =
      [&](std::size_t limb, const HingeShape& hinge, const Usual& usual) {
        const double weight = 1.0 / (usual.sigma * usual.sigma);
        const double off = hinge.upper_rad + hinge.lower_rad - usual.value;
        const int upper = hinge_column(limb);
        out.hessian(upper, upper) += weight;
        out.hessian(upper + 1, upper + 1) += weight;
        out.hessian(upper + 1, upper) += weight;
        out.gradient[upper] += weight * off;
        out.gradient[upper + 1] += weight * off;
        out.cost += 0.5 * weight * off * off;
      };
  for (std::size_t limb = 0; limb < body.hinges.size(); ++limb) {
    const UsualHinge& usual = limb < 2 ? kElbow : kKnee;
    add(hinge_column(limb), body.hinges[limb].upper_rad, usual.upper);
    add(hinge_column(limb) + 1, body.hinges[limb].lower_rad, usual.lower);
    add_sum(limb, body.hinges[limb], usual.straight);
    add(hinge_column(limb) + 2, body.hinges[limb].rollback_m, usual.rollback);
  }
}

}  // namespace

void add_subject_priors(const BodyModel& model,
                        const Lengths& usual,
                        const SubjectColumns& columns,
                        SubjectSystem& out) {
  add_lengths(model, usual, out);
  add_hinges(model.body, out);
  for (const auto& [tag, pose] : model.segment_from_tag) {
    add_tag(model, tag, columns, out);
  }
}

double off_flesh(const BodyModel& model, std::size_t tag) {
  MAREY_ASSERT(model.place(tag));
  const TagTerms terms = tag_terms(model, tag);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) sum += terms.residual[i].a * terms.residual[i].a;
  return std::sqrt(sum);
}

}  // namespace marey::reconstruct
