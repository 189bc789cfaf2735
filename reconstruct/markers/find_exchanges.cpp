// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/find_exchanges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <glm/geometric.hpp>

#include "core/pose.h"
#include "reconstruct/markers/assess_labels.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// One right label in fifty is farther from its landmark.
constexpr double kSuspectSigmas = 2.0;
// The mean cost of right labels was 0.1 to 2.6, once 3.0, in recordings of twenty
// laboratories.
constexpr double kSuspectCost = 2.5;
constexpr double kMaxSigmas = 8.0;
constexpr double kUnusedCost = 50.0;
constexpr double kStray_m = 0.010;
constexpr std::size_t kSuspectsOfLimbs = 4;
constexpr std::size_t kMaxPairs = 6;
constexpr std::size_t kThinnedFrames = 24;
// An exchange is reported if it lowers the cost by both.
constexpr double kMinImprovement = 0.75;
constexpr double kBetterBy = 15.0;

/// A label that was fitted, or left out.
struct FittedLabel {
  std::size_t label = 0;
  std::optional<double> sigmas;  ///< Distance from its landmark.
  glm::dvec3 p_in_t_pose{0.0};   ///< Its place in the fit. [m]
  glm::dvec3 landmark_in_t_pose{0.0};
  double sigma_m = 0.0;
  bool is_used = false;
  bool is_moved = false;

  [[nodiscard]] bool is_suspect() const {
    return !is_used || is_moved || sigmas.value_or(0.0) > kSuspectSigmas;
  }
};

std::vector<FittedLabel> fitted_labels(const MarkersFit& fit,
                                       std::span<const NamedMarker> labels) {
  const Body& body = fit.body;
  const Skeleton skeleton = make_humanoid(body.proportions);
  const auto world = world_from_joints(skeleton, rest_pose(skeleton));
  std::vector<FittedLabel> out;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const Landmark* landmark = labels[i].landmark;
    if (landmark == nullptr || landmark->sigma_per_stature >= kSomewhereSigma) continue;
    FittedLabel one;
    one.label = i;
    one.landmark_in_t_pose = world[index(landmark->segment)] *
                             (body.stature_m * landmark->p_in_segment_per_stature);
    one.sigma_m = body.stature_m * landmark->sigma_per_stature;
    for (const PlacedMarker& placed : body.markers) {
      if (placed.label != labels[i].label) continue;
      one.is_used = true;
      one.p_in_t_pose = world[index(placed.segment)] * placed.p_in_segment;
      one.sigmas = glm::distance(one.p_in_t_pose, one.landmark_in_t_pose) /
                   (std::sqrt(3.0) * one.sigma_m);
    }
    for (const LabelVerdict& verdict : fit.labels) {
      if (verdict.label != labels[i].label) continue;
      one.is_moved = verdict.use == LabelUse::kMoved;
    }
    out.push_back(one);
  }
  return out;
}

bool is_of_leg(B bone) {
  switch (bone) {
    case B::kLeftUpperLeg:
    case B::kLeftLowerLeg:
    case B::kLeftFoot:
    case B::kLeftToes:
    case B::kRightUpperLeg:
    case B::kRightLowerLeg:
    case B::kRightFoot:
    case B::kRightToes:
      return true;
    default:
      return false;
  }
}

bool is_of_arm(B bone) {
  switch (bone) {
    case B::kLeftUpperArm:
    case B::kLeftLowerArm:
    case B::kLeftHand:
    case B::kRightUpperArm:
    case B::kRightLowerArm:
    case B::kRightHand:
      return true;
    default:
      return false;
  }
}

/// Returns "left_heel" for "right_heel"; names without a side are unchanged.
std::string mirrored_name(std::string_view name) {
  constexpr std::string_view kLeft = "left_";
  constexpr std::string_view kRight = "right_";
  if (name.starts_with(kLeft)) {
    return std::string(kRight).append(name.substr(kLeft.size()));
  }
  if (name.starts_with(kRight)) {
    return std::string(kLeft).append(name.substr(kRight.size()));
  }
  return std::string(name);
}

struct Hypothesis {
  std::vector<NamedMarker> labels;
  std::vector<std::pair<std::string, std::string>> exchanged;
  std::string limbs;
  double gain = 0.0;  ///< Expected gain before the candidate is fitted.
};

Hypothesis exchange_limbs(std::span<const NamedMarker> labels,
                          bool (*is_of)(B),
                          const char* limbs) {
  Hypothesis hypothesis;
  hypothesis.labels.assign(labels.begin(), labels.end());
  hypothesis.limbs = limbs;
  for (NamedMarker& marker : hypothesis.labels) {
    if (marker.landmark == nullptr || !is_of(marker.landmark->segment)) continue;
    if (const Landmark* other = find_landmark(mirrored_name(marker.landmark->name))) {
      marker.landmark = other;
    }
  }
  return hypothesis;
}

Hypothesis exchange_pair(std::span<const NamedMarker> labels,
                         std::size_t a,
                         std::size_t b) {
  Hypothesis hypothesis;
  hypothesis.labels.assign(labels.begin(), labels.end());
  std::swap(hypothesis.labels[a].landmark, hypothesis.labels[b].landmark);
  hypothesis.exchanged.emplace_back(labels[a].label, labels[b].label);
  return hypothesis;
}

/// Returns the reduction of the distances of two markers from their landmarks on this
/// body by an exchange, in squared sigmas. Labels that were left out can be anywhere.
double gain_of(const FittedLabel& a, const FittedLabel& b) {
  const auto cost = [](const FittedLabel& at, const FittedLabel& as) {
    if (!at.is_used) return 1.0;
    const double sigmas =
        glm::distance(at.p_in_t_pose, as.landmark_in_t_pose) / (1.7 * as.sigma_m);
    return std::min(sigmas, kMaxSigmas) * std::min(sigmas, kMaxSigmas);
  };
  const auto now = [&](const FittedLabel& one) {
    return one.is_used ? cost(one, one) : 20.0;
  };
  return now(a) + now(b) - cost(a, b) - cost(b, a);
}

std::vector<Hypothesis> hypotheses(const MarkersFit& fit,
                                   std::span<const NamedMarker> labels) {
  const std::vector<FittedLabel> fitted = fitted_labels(fit, labels);
  std::vector<Hypothesis> out;
  std::size_t of_legs = 0;
  std::size_t of_arms = 0;
  std::vector<Hypothesis> pairs;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!fitted[i].is_suspect()) continue;
    const Landmark* landmark = labels[fitted[i].label].landmark;
    of_legs += is_of_leg(landmark->segment) ? 1 : 0;
    of_arms += is_of_arm(landmark->segment) ? 1 : 0;
    for (std::size_t j = 0; j < fitted.size(); ++j) {
      if (j == i || (fitted[j].is_suspect() && j < i)) continue;
      const bool is_mirror =
          mirrored_name(landmark->name) == labels[fitted[j].label].landmark->name;
      const double gain = gain_of(fitted[i], fitted[j]) + (is_mirror ? 1.0 : 0.0);
      if (gain <= 0.0) continue;
      pairs.push_back(exchange_pair(labels, fitted[i].label, fitted[j].label));
      pairs.back().gain = gain;
    }
  }
  const double mean_cost = label_cost(fit, labels) / static_cast<double>(labels.size());
  const bool is_costly = mean_cost > kSuspectCost;
  if (is_costly || of_legs >= kSuspectsOfLimbs) {
    out.push_back(exchange_limbs(labels, is_of_leg, "the legs"));
  }
  if (is_costly || of_arms >= kSuspectsOfLimbs) {
    out.push_back(exchange_limbs(labels, is_of_arm, "the arms"));
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return a.gain > b.gain;
  });
  pairs.resize(std::min(pairs.size(), kMaxPairs));
  for (Hypothesis& pair : pairs) out.push_back(std::move(pair));
  return out;
}

/// Returns some frames of every trial, enough to distinguish exchanges.
std::vector<MarkerTracks> thinned(std::span<const MarkerTracks> trials) {
  const std::size_t maximum = std::max<std::size_t>(4, kThinnedFrames / trials.size());
  std::vector<MarkerTracks> out;
  for (const MarkerTracks& tracks : trials) {
    MarkerTracks few;
    few.labels = tracks.labels;
    const std::size_t step = 1 + tracks.frames() / maximum;
    few.rate.hz = tracks.rate.hz / static_cast<double>(step);
    for (std::size_t f = 0; f < tracks.frames(); f += step) {
      for (std::size_t m = 0; m < tracks.markers(); ++m) {
        few.samples.push_back(tracks.at(f, m));
      }
    }
    out.push_back(std::move(few));
  }
  return out;
}

}  // namespace

double label_cost(const MarkersFit& fit, std::span<const NamedMarker> labels) {
  double cost = 0.0;
  for (const FittedLabel& one : fitted_labels(fit, labels)) {
    if (!one.is_used || one.is_moved) {
      cost += kUnusedCost;
      continue;
    }
    const double sigmas = std::min(*one.sigmas, kMaxSigmas);
    cost += 3.0 * sigmas * sigmas;
  }
  for (const LabelVerdict& verdict : fit.labels) {
    const double strays = verdict.stray_m / kStray_m;
    cost += strays * strays;
  }
  return cost;
}

std::optional<LabelExchange> find_exchange(const MarkerSubject& subject,
                                           std::span<const MarkerTracks> trials,
                                           std::span<const NamedMarker> labels,
                                           const MarkersFit& fit) {
  const std::vector<Hypothesis> candidates = hypotheses(fit, labels);
  if (candidates.empty()) return std::nullopt;
  const std::vector<MarkerTracks> few = thinned(trials);
  const auto as_called = fit_markers(subject, few, labels);
  if (!as_called) return std::nullopt;
  const double before = label_cost(*as_called, labels);
  std::optional<LabelExchange> best;
  double minimum = std::min(kMinImprovement * before, before - kBetterBy);
  for (const Hypothesis& hypothesis : candidates) {
    const auto other = fit_markers(subject, few, hypothesis.labels);
    if (!other) continue;
    const double cost = label_cost(*other, hypothesis.labels);
    if (cost >= minimum) continue;
    minimum = cost;
    best = LabelExchange{hypothesis.exchanged, hypothesis.limbs, before, cost};
  }
  return best;
}

}  // namespace marey::reconstruct
