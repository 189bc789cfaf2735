// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_solve.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Cholesky>

#include "core/base/assert.h"
#include "reconstruct/tags/tag_loss.h"
#include "reconstruct/tags/tag_model.h"

namespace marey::reconstruct {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Priors of usual behaviour carry much the same information in all frames of a trial.
constexpr double kPriorShare = 0.05;

/// Returns the factors of the tag's slide rates in this frame. [rad]
SlideAngles slide_moves(const SubjectBundle& bundle,
                        std::size_t tag,
                        const BundleFrame& frame,
                        const UnfoldedPosture& unfolded) {
  const TagSlide& slide = bundle.slides.at(tag);
  SlideAngles angles = slide_angles(bundle.model.bone(tag), frame.posture, unfolded);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    angles[i] = slide.share * (angles[i] - slide.mean[i]);
  }
  return angles;
}

void add_slide_priors(const SubjectBundle& bundle,
                      const SubjectColumns& columns,
                      SubjectSystem& out) {
  for (const auto& [tag, slide] : bundle.slides) {
    const auto group = static_cast<std::size_t>(slide_group(bundle.model.bone(tag)));
    const double size = bundle.slide_m_per_rad[group];
    const double weight = 1.0 / (size * size);
    for (int i = 0; i < kSlideColumns; ++i) {
      const int column = *columns.of_slide(tag) + i;
      const double rate = slide.rate(i % 3, i / 3);
      out.hessian(column, column) += weight;
      out.gradient[column] += weight * rate;
      out.cost += 0.5 * weight * rate * rate;
    }
  }
}

}  // namespace

std::vector<int> columns_outside(std::size_t limb) {
  const LimbParameters& s = kLimbParameters[limb];
  std::set<int> own;
  for (const PoseParameter parameter :
       {s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}) {
    for (int i = 0; i < tangent_size(parameter); ++i)
      own.insert(column_of(parameter) + i);
  }
  std::vector<int> others;
  for (int column = 0; column < kPostureFreedom; ++column) {
    if (!own.contains(column)) others.push_back(column);
  }
  return others;
}

BundleSolver::BundleSolver(const SubjectBundle& bundle,
                           std::span<const Camera> cameras,
                           const BundleFreedom& freedom)
    : sight_(cameras),
      columns_(bundle.model, !bundle.slides.empty()),
      slides_(!bundle.slides.empty()) {
  MAREY_ASSERT(!bundle.frames.empty());
  frames_ = static_cast<double>(bundle.frames.size());
  standing_ = static_cast<double>(std::max<std::ptrdiff_t>(
      1, std::count_if(bundle.frames.begin(), bundle.frames.end(), [](const auto& f) {
        return f.standing;
      })));
  if (freedom.limb) hold_all_but(*freedom.limb, bundle.model);
}

void BundleSolver::hold_all_but(std::size_t limb, const BodyModel& model) {
  const LimbParameters& s = kLimbParameters[limb];
  const HumanLimb& bones = human_limbs()[limb];
  held_posture_ = columns_outside(limb);
  held_subject_.assign(static_cast<std::size_t>(columns_.size()), true);
  held_subject_[index(s.upper)] = false;
  held_subject_[index(s.lower)] = false;
  for (int i = 0; i < 3; ++i) {
    held_subject_[static_cast<std::size_t>(hinge_column(limb) + i)] = false;
  }
  for (const auto& [tag, pose] : model.segment_from_tag) {
    const HumanBone bone = model.bone(tag);
    if (bone != bones.upper && bone != bones.lower && bone != bones.end) continue;
    for (int i = 0; i < 6; ++i) {
      held_subject_[static_cast<std::size_t>(*columns_.of_tag(tag) + i)] = false;
    }
  }
}

void BundleSolver::linearise_frame(const SubjectBundle& bundle,
                                   const BundleFrame& frame,
                                   FrameEquations& out) const {
  std::vector<int> columns;
  for (int i = 0; i < kShapeCount; ++i) columns.push_back(i);
  UnfoldedPosture unfolded;
  unfolded.unfold(frame.posture, bundle.model.lengths, bundle.model.body);
  std::vector<FrameSlide> slides;
  std::optional<std::size_t> last;
  for (const TagSighting& s : frame.sightings) {
    // Sightings are in order of tags.
    if (!bundle.model.place(s.tag) || last == s.tag) continue;
    last = s.tag;
    for (int i = 0; i < 6; ++i) columns.push_back(*columns_.of_tag(s.tag) + i);
    if (!slides_) continue;
    slides.push_back({*columns_.of_tag(s.tag),
                      *columns_.of_slide(s.tag),
                      slide_moves(bundle, s.tag, frame, unfolded)});
  }
  out.begin(std::move(columns), std::move(slides), columns_.size());
  SightedTag sighted;
  for (const TagSighting& s : frame.sightings) {
    if (!bundle.model.place(s.tag)) continue;
    const SightingNoise noise = bundle.noise(s.tag, frame.posture, unfolded);
    if (!sight_.look(bundle.model, unfolded, s, noise, true, sighted)) {
      out.posture.cost += tag_cost(kBehind2);
      continue;
    }
    const double squared = sighted.residual.squaredNorm();
    out.posture.cost += tag_cost(squared);
    out.add(sighted, *columns_.of_tag(s.tag), tag_weight(squared));
  }
  // This person's collar bones can deviate from the usual rest attitude in all frames
  // alike: all frames together count as one, otherwise they would move the shoulders'
  // centres.
  out.posture.add_posture_priors(
      frame.posture, unfolded, bundle.twists, kPriorShare, std::sqrt(frames_));
  if (frame.standing) {
    out.posture.add_standing(frame.posture, unfolded, 1.0 / standing_);
  }
  if (!held_posture_.empty()) out.hold(held_posture_);
}

double BundleSolver::linearise(const SubjectBundle& bundle, Linear& out) const {
  out.frames.resize(bundle.frames.size());
  out.subject.hessian.setZero(columns_.size(), columns_.size());
  out.subject.gradient.setZero(columns_.size());
  out.subject.cost = 0.0;
  add_subject_priors(bundle.model, bundle.usual, columns_, out.subject);
  add_slide_priors(bundle, columns_, out.subject);
  out.subject.hessian *= bundle.prior_weight;
  out.subject.gradient *= bundle.prior_weight;
  out.subject.cost *= bundle.prior_weight;
  out.cost = out.subject.cost;
  for (std::size_t f = 0; f < bundle.frames.size(); ++f) {
    linearise_frame(bundle, bundle.frames[f], out.frames[f]);
    out.cost += out.frames[f].posture.cost;
  }
  return out.cost;
}

bool BundleSolver::reduce(Linear& linear, double damping, SubjectSystem& out) const {
  out = linear.subject;
  for (FrameEquations& frame : linear.frames) {
    if (!frame.eliminate(damping, out.hessian, out.gradient)) return false;
  }
  for (std::size_t i = 0; i < held_subject_.size(); ++i) {
    if (!held_subject_[i]) continue;
    const auto at = static_cast<Eigen::Index>(i);
    out.hessian.row(at).setZero();
    out.hessian.col(at).setZero();
    out.hessian(at, at) = 1.0;
    out.gradient[at] = 0.0;
  }
  return true;
}

bool BundleSolver::step(Linear& linear, double damping, Step& out) const {
  SubjectSystem system;
  if (!reduce(linear, damping, system)) return false;
  system.hessian.diagonal() *= 1.0 + damping;
  system.hessian.diagonal().array() += 1e-9;
  const Eigen::LLT<MatrixXd> factor(system.hessian);
  if (factor.info() != Eigen::Success) return false;
  out.subject = -factor.solve(system.gradient);
  out.postures.resize(linear.frames.size());
  for (std::size_t f = 0; f < linear.frames.size(); ++f) {
    linear.frames[f].step(out.subject, out.postures[f]);
  }
  return out.subject.allFinite();
}

void BundleSolver::move(const Step& step, SubjectBundle& bundle) const {
  for (int i = 0; i < kLengthCount; ++i) {
    double& length = bundle.model.lengths[static_cast<std::size_t>(i)];
    length += step.subject[i];
  }
  for (std::size_t limb = 0; limb < bundle.model.body.hinges.size(); ++limb) {
    HingeShape& hinge = bundle.model.body.hinges[limb];
    hinge.upper_rad += step.subject[hinge_column(limb)];
    hinge.lower_rad += step.subject[hinge_column(limb) + 1];
    hinge.rollback_m += step.subject[hinge_column(limb) + 2];
  }
  for (auto& [tag, pose] : bundle.model.segment_from_tag) {
    const auto own = step.subject.segment<6>(*columns_.of_tag(tag));
    pose.rotation =
        glm::normalize(rotation_from_vector({own[0], own[1], own[2]}) * pose.rotation);
    pose.translation += glm::dvec3(own[3], own[4], own[5]);
  }
  for (auto& [tag, slide] : bundle.slides) {
    for (int i = 0; i < kSlideColumns; ++i) {
      slide.rate(i % 3, i / 3) += step.subject[*columns_.of_slide(tag) + i];
    }
  }
  for (std::size_t f = 0; f < bundle.frames.size(); ++f) {
    reconstruct::move(bundle.frames[f].posture, step.postures[f]);
  }
}

std::optional<double> adjust(SubjectBundle& bundle,
                             std::span<const Camera> cameras,
                             int max_iterations,
                             const BundleFreedom& freedom) {
  // Consecutive steps that gain less than this share of the cost end the descent.
  constexpr double kGain = 1e-6;
  constexpr double kMaxDamping = 1e8;
  // The position of a limb's middle joint along its hinge hardly changes the cost:
  // damping in shares of the diagonal would hold it, so the last steps have almost none.
  constexpr double kNearlyFree = 1e-11;
  const double min_raised = freedom.is_first ? 1e-3 : 1e-9;
  const BundleSolver solver(bundle, cameras, freedom);
  BundleSolver::Linear now;
  BundleSolver::Linear next;
  BundleSolver::Step step;
  solver.linearise(bundle, now);
  double damping = freedom.is_first ? 1e-4 : 1e-6;
  double raise = 4.0;
  for (int i = 0; i < max_iterations; ++i) {
    bool better = solver.step(now, damping, step);
    SubjectBundle moved = bundle;
    if (better) {
      solver.move(step, moved);
      better = solver.linearise(moved, next) < now.cost;
    }
    if (!better) {
      damping = std::max(min_raised, damping) * raise;
      raise *= 2.0;
      if (damping > kMaxDamping) break;
      continue;
    }
    const bool last = now.cost - next.cost < kGain * now.cost && damping < 1e-9;
    bundle = std::move(moved);
    std::swap(now, next);
    damping = damping < kNearlyFree ? 0.0 : (freedom.is_first ? 0.2 : 0.1) * damping;
    raise = 4.0;
    if (last) break;
  }
  if (!std::isfinite(now.cost)) return std::nullopt;
  return now.cost;
}

double cost_of(const SubjectBundle& bundle, std::span<const Camera> cameras) {
  const BundleSolver solver(bundle, cameras, {});
  BundleSolver::Linear linear;
  return solver.linearise(bundle, linear);
}

}  // namespace marey::reconstruct
