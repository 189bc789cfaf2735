// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/fit_markers.h"

#include <algorithm>
#include <cmath>

#include "core/base/quantile.h"
#include "core/human/average_proportions.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/markers/body_stature.h"
#include "reconstruct/markers/estimate_stature.h"
#include "reconstruct/markers/hip_regression.h"
#include "reconstruct/markers/joint_evidence.h"
#include "reconstruct/markers/marker_instants.h"
#include "reconstruct/markers/marker_places.h"
#include "reconstruct/markers/marker_priors.h"
#include "reconstruct/posture/length_terms.h"

namespace marey::reconstruct {
namespace {

using Eigen::Vector3d;

// Number of sampled frames, and of frames in the bundle: its cost grows with their
// number, its gain with their variety.
constexpr std::size_t kSnapshots = 240;
constexpr std::size_t kFirstInstants = 24;
constexpr std::size_t kInstants = 60;
// Strays before the bundle: of markers with exact places, and of those with rough ones.
constexpr double kFirstStray_m = 0.014;
constexpr double kRoughStray_m = 0.04;
// Used if landmarks do not determine the stature.
constexpr double kAverageStature_m = 1.70;
// A marker with a larger stray from its expected place moves with another segment.
constexpr double kOffSegment_m = 0.035;
constexpr double kSureSegment_m = 0.02;  // A smaller stray is certain evidence for a
                                         // segment.
constexpr double kFoundPlaceSigma_m = 0.05;
constexpr std::size_t kMinLabels = 6;
constexpr double kTrunkSigma_m = 0.03;
constexpr double kHeldLength_m = 1e-4;

/// A label before its marker is added to the body.
struct Candidate {
  std::size_t label = 0;  ///< Position in the given list.
  HumanBone bone{};
  MarkerPlacePrior place_prior;
  bool somewhere = false;  ///< Its landmark determines the bone, not the place.
  LabelUse use = LabelUse::kNamed;
};

/// State of the fit.
class Fit {
 public:
  Fit(const MarkerSubject& subject,
      std::span<const MarkerTracks> trials,
      std::span<const NamedMarker> labels)
      : subject_(&subject), trials_(trials), labels_(labels) {}

  [[nodiscard]] Result<MarkersFit> run(const Progress& progress);

 private:
  [[nodiscard]] Status check();
  void set_length_priors();
  void scale_to(double stature_m);
  void refine_stature();
  [[nodiscard]] std::optional<MeasuredStature> measured_stature() const;
  void begin();
  void use(const Candidate& candidate, const Vector3d& p_in_bone, double stray_m);
  [[nodiscard]] bool bundle(std::size_t instants, int iterations, bool sigmas);
  void place_candidates();
  [[nodiscard]] SegmentRules segment_rules() const;
  void move_misplaced();
  [[nodiscard]] MarkersFit result();

  const MarkerSubject* subject_;
  std::span<const MarkerTracks> trials_;
  std::span<const NamedMarker> labels_;
  StatureEstimate stature_;
  Proportions average_;
  std::optional<HipRegression> hips_;
  std::vector<Snapshot> snapshots_;
  MarkerBundle bundle_;
  ModelLabels model_labels_;        ///< Per marker of the bundle.
  std::vector<Candidate> used_;     ///< Per marker of the bundle.
  std::vector<Candidate> waiting_;  ///< Named for a segment, no place yet.
  std::vector<LabelVerdict> verdicts_;
  double rms_m_ = 0.0;
};

Status Fit::check() {
  std::size_t named = 0;
  bool trunk = false;
  for (const NamedMarker& marker : labels_) {
    if (!marker.landmark) continue;
    ++named;
    const HumanBone bone = marker.landmark->segment;
    trunk = trunk || bone == HumanBone::kHips || bone == HumanBone::kUpperChest ||
            bone == HumanBone::kChest || bone == HumanBone::kSpine;
  }
  if (named >= kMinLabels && trunk) return Done{};
  return bad_input(
      "",
      named < kMinLabels
          ? std::string("only ")
                .append(std::to_string(named))
                .append(" labels have a known place on the body")
          : std::string("no label is known to be on the hips or the trunk"),
      "define the meaning of the labels in a marker map (--markers MAP.toml, "
      "docs/formats/README.md)");
}

void Fit::use(const Candidate& candidate, const Vector3d& p_in_bone, double stray_m) {
  used_.push_back(candidate);
  model_labels_.push_back(candidate.label);
  bundle_.places.push_back(candidate.place_prior);
  bundle_.model.markers.push_back({candidate.bone, p_in_bone, stray_m});
}

/// Sets the priors of lengths. Hips vary less than limbs, and trunks more: the division
/// of their length is the model's own.
void Fit::set_length_priors() {
  bundle_.usual_sigma_m = usual_length_sigmas_m(bundle_.usual);
  for (const Length trunk :
       {Length::kSpine, Length::kChest, Length::kUpperChest, Length::kNeck}) {
    bundle_.usual_sigma_m[index(trunk)] = kTrunkSigma_m;
  }
  bundle_.usual_sigma_m[index(Length::kHalfHipWidth)] = kHipRegressionSigma_m;
  hips_ = hips_from_markers(trials_, labels_);
  if (hips_) bundle_.usual[index(Length::kHalfHipWidth)] = hips_->half_hip_width_m;
}

/// Sets the priors for a body of this stature.
void Fit::scale_to(double stature_m) {
  stature_.stature_m = stature_m;
  average_ = average_proportions(stature_m);
  bundle_.usual = lengths_of(average_);
  bundle_.model.body = body_constants(average_);
  set_length_priors();
}

std::optional<MeasuredStature> Fit::measured_stature() const {
  std::vector<const Landmark*> landmarks;
  for (const Candidate& candidate : used_) {
    if (candidate.somewhere || candidate.use != LabelUse::kNamed) continue;
    landmarks.push_back(labels_[candidate.label].landmark);
  }
  return stature_of_body(
      to_proportions(bundle_.model.lengths, bundle_.model.body, average_),
      bones_between(landmarks));
}

/// Replaces the priors of the first bundle by those of the stature that it found, because
/// distances between single markers vary more between people than whole legs and trunks.
void Fit::refine_stature() {
  if (subject_->stature_m) return;
  const auto measured = measured_stature();
  if (!measured) return;
  const Lengths held = bundle_.usual;
  scale_to(measured->stature_m);
  for (std::size_t i = 0; i < held.size(); ++i) {
    // Lengths without measurements keep the average values.
    if (std::abs(bundle_.model.lengths[i] - held[i]) < kHeldLength_m) {
      bundle_.model.lengths[i] = bundle_.usual[i];
    }
  }
  for (std::size_t m = 0; m < used_.size(); ++m) {
    const Landmark* landmark = labels_[used_[m].label].landmark;
    used_[m].place_prior = landmark_prior(
        *landmark, stature_.stature_m, average_, hips_, bundle_.model.body);
    bundle_.places[m] = used_[m].place_prior;
  }
  for (Candidate& candidate : waiting_) {
    candidate.place_prior = landmark_prior(*labels_[candidate.label].landmark,
                                           stature_.stature_m,
                                           average_,
                                           hips_,
                                           bundle_.model.body);
  }
}

/// Initializes the average person of this stature, with the markers whose names determine
/// their places.
void Fit::begin() {
  const auto estimate = estimate_stature(trials_, labels_);
  stature_ = estimate.value_or(StatureEstimate{kAverageStature_m, 0});
  if (subject_->stature_m) stature_.stature_m = *subject_->stature_m;
  scale_to(stature_.stature_m);
  bundle_.model.lengths = bundle_.usual;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    verdicts_.push_back(
        {labels_[i].label, LabelUse::kLeftOut, HumanBone::kHips, 0.0, {}});
    const Landmark* landmark = labels_[i].landmark;
    if (!landmark) continue;
    verdicts_.back().named = solved_segment(landmark->segment);
    Candidate candidate;
    candidate.label = i;
    candidate.bone = solved_segment(landmark->segment);
    candidate.place_prior = landmark_prior(
        *landmark, stature_.stature_m, average_, hips_, bundle_.model.body);
    candidate.somewhere = landmark->sigma_per_stature >= kSomewhereSigma;
    if (candidate.somewhere) {
      waiting_.push_back(candidate);
    } else {
      use(candidate, candidate.place_prior.p_in_bone, kFirstStray_m);
    }
  }
  if (used_.size() >= kMinLabels) return;
  // For sets of clusters alone the rough places are used.
  for (const Candidate& candidate : waiting_) {
    use(candidate, candidate.place_prior.p_in_bone, kRoughStray_m);
  }
  waiting_.clear();
}

bool Fit::bundle(std::size_t instants, int iterations, bool sigmas) {
  pose_snapshots(bundle_.model, model_labels_, snapshots_);
  const std::vector<std::size_t> chosen = choose_instants(snapshots_, instants);
  if (chosen.empty()) return false;
  bundle_.instants.clear();
  for (const std::size_t i : chosen) {
    bundle_.instants.push_back(
        {snapshots_[i].posture, seen_in(snapshots_[i], model_labels_)});
  }
  if (!adjust(bundle_, iterations, sigmas)) return false;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    snapshots_[chosen[i]].posture = bundle_.instants[i].posture;
  }
  return true;
}

/// Only segments posed by named markers can be compared with the movement of others.
SegmentRules Fit::segment_rules() const {
  SegmentRules rules;
  rules.proportions = to_proportions(bundle_.model.lengths, bundle_.model.body, average_);
  rules.stature_m = stature_.stature_m;
  for (std::size_t m = 0; m < used_.size(); ++m) {
    if (used_[m].use != LabelUse::kNamed) continue;
    if (bundle_.model.markers[m].sigma_m < kOffSegment_m) {
      ++rules.named_markers[index(used_[m].bone)];
    }
  }
  return rules;
}

/// Places markers whose segment alone is known, or nothing, on a body posed by the other
/// markers.
void Fit::place_candidates() {
  for (const Candidate& candidate : waiting_) {
    const auto place =
        place_on(snapshots_, bundle_.model, candidate.label, candidate.bone);
    if (!place) continue;
    use(candidate, place->p_in_bone, std::max(kUsualStray_m, place->stray_m));
  }
  waiting_.clear();
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (labels_[i].landmark) continue;
    const auto best = best_segment(snapshots_, bundle_.model, i, segment_rules());
    if (!best || best->stray_m > kOffSegment_m) continue;
    Candidate candidate;
    candidate.label = i;
    candidate.bone = best->bone;
    candidate.somewhere = true;
    candidate.use = LabelUse::kFound;
    candidate.place_prior = {best->p_in_bone, kFoundPlaceSigma_m};
    use(candidate, best->p_in_bone, std::max(kUsualStray_m, best->stray_m));
  }
}

/// Assigns markers that do not move with the segment of their name to the one they move
/// with, or leaves them out.
void Fit::move_misplaced() {
  const SegmentRules rules = segment_rules();
  const std::vector<ModelMarker> markers = std::move(bundle_.model.markers);
  const std::vector<Candidate> used = std::move(used_);
  bundle_.model.markers.clear();
  bundle_.places.clear();
  used_.clear();
  model_labels_.clear();
  for (std::size_t m = 0; m < used.size(); ++m) {
    if (markers[m].sigma_m < kOffSegment_m) {
      use(used[m], markers[m].p_in_bone, markers[m].sigma_m);
      continue;
    }
    const auto best = best_segment(snapshots_, bundle_.model, used[m].label, rules);
    if (!best || best->stray_m > kSureSegment_m) continue;
    Candidate moved = used[m];
    if (moved.bone != best->bone) moved.use = LabelUse::kMoved;
    moved.bone = best->bone;
    moved.somewhere = true;
    moved.place_prior = {best->p_in_bone, kFoundPlaceSigma_m};
    use(moved, best->p_in_bone, std::max(kUsualStray_m, best->stray_m));
  }
}

MarkersFit Fit::result() {
  MarkersFit fit;
  Body& body = fit.body;
  body.name = subject_->name;
  fit.measured_stature = measured_stature();
  body.stature_m = !subject_->stature_m && fit.measured_stature
                       ? fit.measured_stature->stature_m
                       : stature_.stature_m;
  body.mass_kg = subject_->mass_kg;
  body.proportions = to_proportions(bundle_.model.lengths, bundle_.model.body, average_);
  // Soles keep the average thickness: the height of the hips follows the length of the
  // legs.
  const auto legs = [](const Proportions& p) {
    return p[HumanBone::kLeftUpperLeg].y +
           0.5 * (p[HumanBone::kLeftLowerLeg].y + p[HumanBone::kRightLowerLeg].y +
                  p[HumanBone::kLeftFoot].y + p[HumanBone::kRightFoot].y);
  };
  body.proportions[HumanBone::kHips].y += legs(average_) - legs(body.proportions);
  std::vector<bool> exact;
  for (const Candidate& candidate : used_) exact.push_back(!candidate.somewhere);
  fit.joints = joint_evidence(bundle_, snapshots_, average_, exact);
  for (const JointEvidence& joint : fit.joints) {
    body.joint_centre_sigma_m[index(joint.joint)] = joint.sigma_m;
  }
  for (std::size_t m = 0; m < used_.size(); ++m) {
    const ModelMarker& marker = bundle_.model.markers[m];
    const std::size_t label = model_labels_[m];
    const auto frames = std::count_if(
        snapshots_.begin(), snapshots_.end(), [&](const Snapshot& snapshot) {
          return snapshot.solved && snapshot.p_in_world[label];
        });
    body.markers.push_back(
        {labels_[label].label,
         marker.bone,
         {marker.p_in_bone.x(), marker.p_in_bone.y(), marker.p_in_bone.z()},
         bundle_.place_sigma_m[m],
         marker.sigma_m,
         static_cast<int>(frames)});
    verdicts_[label].use = used_[m].use;
    verdicts_[label].segment = marker.bone;
    verdicts_[label].stray_m = marker.sigma_m;
  }
  fit.labels = verdicts_;
  fit.rms_m = rms_m_;
  fit.stature_pairs = stature_.pairs;
  return fit;
}

Result<MarkersFit> Fit::run(const Progress& progress) {
  const auto report_step = [&](int done) {
    if (progress) progress(done, 4);
  };
  const auto no_body = [] {
    return bad_input(
        "",
        "no body explains these markers",
        "check that the labels are on the right landmarks and that left and right are "
        "not exchanged; correct them in a marker map (--markers MAP.toml)");
  };
  if (const Status ok = check(); !ok) return ok.error();
  begin();
  std::vector<std::string> names;
  for (const NamedMarker& marker : labels_) names.push_back(marker.label);
  snapshots_ = take_snapshots(trials_, names, kSnapshots);
  if (!bundle(kFirstInstants, 15, false)) {
    return bad_input("",
                     "no frame shows six markers whose places are known",
                     "check the labels with `marey inspect FILE`");
  }
  report_step(1);
  refine_stature();
  pose_snapshots(bundle_.model, model_labels_, snapshots_);
  place_candidates();
  rms_m_ = measure_strays(snapshots_, model_labels_, bundle_.model);
  if (!bundle(kInstants, 15, false)) return no_body();
  report_step(2);
  pose_snapshots(bundle_.model, model_labels_, snapshots_);
  rms_m_ = measure_strays(snapshots_, model_labels_, bundle_.model);
  move_misplaced();
  if (used_.size() < kMinLabels || !bundle(kInstants, 15, false)) return no_body();
  report_step(3);
  pose_snapshots(bundle_.model, model_labels_, snapshots_);
  rms_m_ = measure_strays(snapshots_, model_labels_, bundle_.model);
  if (!bundle(kInstants, 20, true)) return no_body();
  pose_snapshots(bundle_.model, model_labels_, snapshots_);
  rms_m_ = measure_strays(snapshots_, model_labels_, bundle_.model);
  report_step(4);
  return result();
}

}  // namespace

Result<MarkersFit> fit_markers(const MarkerSubject& subject,
                               std::span<const MarkerTracks> trials,
                               std::span<const NamedMarker> labels,
                               const Progress& progress) {
  return Fit(subject, trials, labels).run(progress);
}

}  // namespace marey::reconstruct
