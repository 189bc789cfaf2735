// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/assess_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "core/pose.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/markers/soft_tissue.h"

namespace marey::reconstruct {
namespace {

// The distance of right labels was at most 3.2 sigmas in 31 recordings of 20
// laboratories.
constexpr double kFarSigmas = 4.0;
// Length of the wands of gait sets.
constexpr double kOutsideSoftTissue_m = 0.10;
constexpr std::size_t kFrames = 200;
constexpr std::size_t kMinFrames = 3;
// Markers are put on again between trials, and skin slides. [m]
constexpr double kElsewhere_m = 0.025;
constexpr double kElsewhereStrays = 4.0;
// Largest ratio of the distances after and before an exchange.
constexpr double kFarBetter = 0.5;

/// Place of a marker on a bone in one trial.
struct TrialPlace {
  glm::dvec3 p_in_bone{0.0};
  std::size_t frames = 0;
};

/// Returns the bones with markers of their own, and those between two of them: a thigh
/// whose markers were all left out still lies between pelvis and shank.
std::array<bool, kHumanBoneCount> posed_bones(
    const std::vector<JointUncertainty>& uncertainty) {
  std::array<bool, kHumanBoneCount> measured{};
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    measured[b] = uncertainty[b].source == Source::kMeasured;
  }
  std::array<bool, kHumanBoneCount> posed = measured;
  for (const HumanBone bone : human_bones()) {
    const auto up = parent(bone);
    if (!up || !parent(*up)) continue;
    if (measured[index(bone)] && measured[index(*parent(*up))]) posed[index(*up)] = true;
  }
  return posed;
}

/// The sampled frames of one trial.
class TrialFrames {
 public:
  explicit TrialFrames(const CheckedTrial& trial) : tracks_(trial.tracks) {
    if (trial.solved == nullptr) return;
    const EstimatedMotion& estimate = trial.solved->estimate;
    const std::size_t step = 1 + tracks_->frames() / kFrames;
    for (std::size_t f = 0; f < tracks_->frames(); f += step) {
      if (trial.solved->frame_rms_m[f] <= 0.0) continue;
      frames_.push_back(f);
      world_.push_back(
          world_from_joints(estimate.motion.skeleton, estimate.motion.poses[f]));
      measured_.emplace_back();
      measured_.back() = posed_bones(estimate.uncertainty[f]);
    }
  }

  /// Returns the median place of a label's samples on a bone; nullopt for fewer than
  /// three.
  [[nodiscard]] std::optional<TrialPlace> place(const std::string& label,
                                                HumanBone bone) const {
    const auto at = std::find(tracks_->labels.begin(), tracks_->labels.end(), label);
    if (at == tracks_->labels.end()) return std::nullopt;
    const auto column = static_cast<std::size_t>(at - tracks_->labels.begin());
    std::array<std::vector<double>, 3> values;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const auto& sample = tracks_->at(frames_[i], column);
      if (!sample || sample->source != Source::kMeasured) continue;
      if (!measured_[i][index(bone)]) continue;
      const glm::dvec3 p = inverse(world_[i][index(bone)]) * sample->p_in_world;
      for (int axis = 0; axis < 3; ++axis) {
        values[static_cast<std::size_t>(axis)].push_back(p[axis]);
      }
    }
    TrialPlace place;
    place.frames = values[0].size();
    if (place.frames < kMinFrames) return std::nullopt;
    for (int axis = 0; axis < 3; ++axis) {
      place.p_in_bone[axis] = median(std::move(values[static_cast<std::size_t>(axis)]));
    }
    return place;
  }

 private:
  const MarkerTracks* tracks_;
  std::vector<std::size_t> frames_;
  std::vector<std::vector<RigidTransform>> world_;
  std::vector<std::array<bool, kHumanBoneCount>> measured_;
};

/// A label with its bone and its place there in every trial.
struct KnownLabel {
  const NamedMarker* marker = nullptr;
  const PlacedMarker* placed = nullptr;  ///< nullptr: the fit left it out.
  HumanBone bone{};
  double stray_m = 0.0;
  std::vector<std::optional<TrialPlace>> places;
};

class TrialChecker {
 public:
  TrialChecker(const Body& body,
               std::span<const NamedMarker> labels,
               std::span<const CheckedTrial> trials) {
    for (const CheckedTrial& trial : trials) frames_.emplace_back(trial);
    for (const NamedMarker& marker : labels) {
      KnownLabel known;
      known.marker = &marker;
      for (const PlacedMarker& placed : body.markers) {
        if (placed.label == marker.label) known.placed = &placed;
      }
      if (known.placed == nullptr && marker.landmark == nullptr) continue;
      known.bone = known.placed != nullptr ? known.placed->segment
                                           : solved_segment(marker.landmark->segment);
      known.stray_m = known.placed != nullptr ? known.placed->stray_m : 0.01;
      for (const TrialFrames& frames : frames_) {
        known.places.push_back(frames.place(marker.label, known.bone));
      }
      labels_.push_back(std::move(known));
    }
  }

  std::vector<FaultyLabel> check() {
    std::vector<FaultyLabel> findings;
    std::vector<std::vector<bool>> done(frames_.size(),
                                        std::vector<bool>(labels_.size(), false));
    for (std::size_t t = 0; t < frames_.size(); ++t) {
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        if (done[t][i] || !is_elsewhere(i, t)) continue;
        const auto partner = find_partner(i, t);
        if (!partner) continue;
        // With two trials either can be the wrong one: it is reported once.
        for (auto& trial : done) trial[i] = trial[*partner] = true;
        findings.push_back(exchange(i, *partner, t));
      }
    }
    for (std::size_t t = 0; t < frames_.size(); ++t) {
      for (std::size_t i = 0; i < labels_.size(); ++i) {
        if (done[t][i] || !is_elsewhere(i, t)) continue;
        // If two trials differ, both are off by the same distance.
        for (auto& trial : done) trial[i] = true;
        FaultyLabel finding;
        finding.fault = LabelFault::kStrays;
        finding.label = labels_[i].marker->label;
        finding.trial = t;
        if (frames_.size() == 2 && labels_[i].places[1 - t]) finding.or_trial = 1 - t;
        finding.off_m = glm::distance(labels_[i].places[t]->p_in_bone, *reference(i, t));
        findings.push_back(std::move(finding));
      }
    }
    return findings;
  }

 private:
  /// Returns the expected place of a label in a trial: that in the trial that agrees best
  /// with all, for two trials that in the other one, for a single one that in the fit.
  [[nodiscard]] std::optional<glm::dvec3> reference(std::size_t label,
                                                    std::size_t trial) const {
    const KnownLabel& known = labels_[label];
    std::vector<std::size_t> seen;
    for (std::size_t t = 0; t < known.places.size(); ++t) {
      if (known.places[t]) seen.push_back(t);
    }
    if (seen.size() < 2) {
      if (known.placed == nullptr) return std::nullopt;
      return known.placed->p_in_segment;
    }
    if (seen.size() == 2) {
      return known.places[seen[0] == trial ? seen[1] : seen[0]]->p_in_bone;
    }
    std::size_t best = seen[0];
    double min_m = std::numeric_limits<double>::infinity();
    for (const std::size_t t : seen) {
      double sum_m = 0.0;
      for (const std::size_t other : seen) {
        sum_m +=
            glm::distance(known.places[t]->p_in_bone, known.places[other]->p_in_bone);
      }
      if (sum_m >= min_m) continue;
      min_m = sum_m;
      best = t;
    }
    return known.places[best]->p_in_bone;
  }

  [[nodiscard]] bool is_elsewhere(std::size_t label, std::size_t trial) const {
    const KnownLabel& known = labels_[label];
    if (!known.places[trial]) return false;
    const auto should = reference(label, trial);
    if (!should) return false;
    const double off_m = glm::distance(known.places[trial]->p_in_bone, *should);
    // A marker that was exchanged in one of its trials has a large stray in the fit.
    const double usual_m = std::min(known.stray_m, 0.012);
    return off_m > kElsewhere_m && off_m > kElsewhereStrays * usual_m;
  }

  /// Returns the label that is at the expected place of this one, and the reverse.
  [[nodiscard]] std::optional<std::size_t> find_partner(std::size_t label,
                                                        std::size_t trial) const {
    const KnownLabel& one = labels_[label];
    const auto should = reference(label, trial);
    const double off_m = glm::distance(one.places[trial]->p_in_bone, *should);
    std::optional<std::size_t> best;
    double min_m = kFarBetter * off_m;
    for (std::size_t other = 0; other < labels_.size(); ++other) {
      if (other == label || !is_elsewhere(other, trial)) continue;
      const KnownLabel& two = labels_[other];
      const auto there = frames_[trial].place(one.marker->label, two.bone);
      const auto here = frames_[trial].place(two.marker->label, one.bone);
      if (!there || !here) continue;
      const auto other_should = reference(other, trial);
      const double other_off_m =
          glm::distance(two.places[trial]->p_in_bone, *other_should);
      const double as_other_m = glm::distance(there->p_in_bone, *other_should);
      const double as_this_m = glm::distance(here->p_in_bone, *should);
      if (as_other_m > kFarBetter * other_off_m || as_this_m > min_m) continue;
      best = other;
      min_m = as_this_m;
    }
    return best;
  }

  /// The finding names the trial that differs more from the fit.
  [[nodiscard]] FaultyLabel exchange(std::size_t a,
                                     std::size_t b,
                                     std::size_t trial) const {
    std::size_t worst = trial;
    double worst_m = 0.0;
    for (std::size_t t = 0; t < frames_.size(); ++t) {
      double off_m = 0.0;
      for (const std::size_t label : {a, b}) {
        const KnownLabel& known = labels_[label];
        if (!known.places[t] || known.placed == nullptr || !is_elsewhere(label, t)) {
          continue;
        }
        off_m += glm::distance(known.places[t]->p_in_bone, known.placed->p_in_segment);
      }
      if (off_m <= worst_m) continue;
      worst_m = off_m;
      worst = t;
    }
    FaultyLabel finding;
    finding.fault = LabelFault::kExchanged;
    finding.label = labels_[a].marker->label;
    finding.other = labels_[b].marker->label;
    finding.trial = worst;
    if (frames_.size() == 2) finding.or_trial = 1 - worst;
    finding.off_m =
        glm::distance(labels_[a].places[trial]->p_in_bone, *reference(a, trial));
    finding.exchanged_m = glm::distance(
        frames_[trial].place(labels_[b].marker->label, labels_[a].bone)->p_in_bone,
        *reference(a, trial));
    return finding;
  }

  std::vector<TrialFrames> frames_;
  std::vector<KnownLabel> labels_;
};

const Landmark* landmark_of(std::span<const NamedMarker> labels,
                            const std::string& label) {
  for (const NamedMarker& marker : labels) {
    if (marker.label == label) return marker.landmark;
  }
  return nullptr;
}

/// Returns true if markers can move from one bone to the other with the skin between
/// them.
bool are_near(HumanBone a, HumanBone b) {
  return a == b || parent(a) == b || parent(b) == a ||
         (parent(a) && parent(a) == parent(b));
}

}  // namespace

std::string_view name(LabelFault fault) {
  switch (fault) {
    case LabelFault::kOffLandmark:
      return "off-landmark";
    case LabelFault::kMoved:
      return "moved";
    case LabelFault::kLeftOut:
      return "left-out";
    case LabelFault::kStrays:
      return "strays";
    case LabelFault::kExchanged:
      return "exchanged";
  }
  return "strays";
}

std::optional<double> landmark_distance_sigmas(const PlacedMarker& marker,
                                               const Landmark& landmark,
                                               double stature_m) {
  if (landmark.segment != marker.segment ||
      landmark.sigma_per_stature >= kSomewhereSigma) {
    return std::nullopt;
  }
  return glm::distance(marker.p_in_segment,
                       stature_m * landmark.p_in_segment_per_stature) /
         (std::sqrt(3.0) * stature_m * landmark.sigma_per_stature);
}

std::vector<FaultyLabel> assess_fit_labels(const MarkersFit& fit,
                                           std::span<const NamedMarker> labels) {
  std::vector<FaultyLabel> findings;
  const Body& body = fit.body;
  for (const PlacedMarker& marker : body.markers) {
    const Landmark* landmark = landmark_of(labels, marker.label);
    if (landmark == nullptr) continue;
    const auto sigmas = landmark_distance_sigmas(marker, *landmark, body.stature_m);
    const double outside_m = outside_soft_tissue_m(
        marker.segment, marker.p_in_segment, body.proportions, body.stature_m);
    const bool is_off = sigmas && *sigmas > kFarSigmas;
    if (!is_off && outside_m < kOutsideSoftTissue_m) continue;
    FaultyLabel finding;
    finding.fault = LabelFault::kOffLandmark;
    finding.label = marker.label;
    finding.off_m =
        is_off ? glm::distance(marker.p_in_segment,
                               body.stature_m * landmark->p_in_segment_per_stature)
               : outside_m;
    findings.push_back(std::move(finding));
  }
  for (const LabelVerdict& verdict : fit.labels) {
    if (!verdict.named) continue;
    const bool far =
        verdict.use == LabelUse::kMoved && !are_near(verdict.segment, *verdict.named);
    if (!far && verdict.use != LabelUse::kLeftOut) continue;
    FaultyLabel finding;
    finding.fault = far ? LabelFault::kMoved : LabelFault::kLeftOut;
    finding.label = verdict.label;
    findings.push_back(std::move(finding));
  }
  return findings;
}

std::vector<FaultyLabel> assess_trial_labels(const Body& body,
                                             std::span<const NamedMarker> labels,
                                             std::span<const CheckedTrial> trials) {
  return TrialChecker(body, labels, trials).check();
}

}  // namespace marey::reconstruct
