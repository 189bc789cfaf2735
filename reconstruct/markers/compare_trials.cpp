// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/compare_trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "core/base/quantile.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "reconstruct/markers/estimate_stature.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

constexpr std::size_t kComparedFrames = 100;
constexpr std::size_t kMinPairs = 3;
// Frames in which posture or an exchanged marker shows the other side are fewer.
constexpr double kNearlyAll = 0.8;
// Depth of the landmarks' third dimension: for spines of the pelvis alone it is 0.01, for
// a trunk with front and back 0.07. [m at a stature of 1.75 m]
constexpr double kMinDepth_m = 0.03;
constexpr double kStature_m = 1.75;

enum class Part { kTrunk, kHead, kArms, kLegs };

Part part_of(B bone) {
  switch (bone) {
    case B::kHead:
    case B::kNeck:
      return Part::kHead;
    case B::kLeftUpperArm:
    case B::kLeftLowerArm:
    case B::kLeftHand:
    case B::kRightUpperArm:
    case B::kRightLowerArm:
    case B::kRightHand:
      return Part::kArms;
    case B::kHips:
    case B::kSpine:
    case B::kChest:
    case B::kUpperChest:
    case B::kLeftShoulder:
    case B::kRightShoulder:
      return Part::kTrunk;
    default:
      return Part::kLegs;
  }
}

bool is_below_knee(B bone) {
  return part_of(bone) == Part::kLegs && bone != B::kLeftUpperLeg &&
         bone != B::kRightUpperLeg;
}

/// A label with a place on the average body.
struct KnownMarker {
  std::size_t column = 0;
  const Landmark* landmark = nullptr;
  glm::dvec3 p_on_average{0.0};  ///< In the T-pose. [m]
};

std::vector<KnownMarker> known_markers(const MarkerTracks& tracks,
                                       std::span<const NamedMarker> labels) {
  static const auto kTPose = [] {
    const Skeleton average = make_humanoid(average_proportions(kStature_m));
    return world_from_joints(average, rest_pose(average));
  }();
  std::map<std::string, const Landmark*> landmarks;
  for (const NamedMarker& label : labels) landmarks[label.label] = label.landmark;
  std::vector<KnownMarker> known;
  for (std::size_t m = 0; m < tracks.markers(); ++m) {
    const auto at = landmarks.find(tracks.labels[m]);
    if (at == landmarks.end() || at->second == nullptr) continue;
    const Landmark& landmark = *at->second;
    known.push_back({m,
                     &landmark,
                     kTPose[index(landmark.segment)] *
                         (kStature_m * landmark.p_in_segment_per_stature)});
  }
  return known;
}

/// Pairs of places in known_markers(): left first.
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs side_pairs(std::span<const KnownMarker> known, Part part) {
  Pairs pairs;
  for (std::size_t l = 0; l < known.size(); ++l) {
    const std::string_view left = known[l].landmark->name;
    if (!left.starts_with("left_") || part_of(known[l].landmark->segment) != part) {
      continue;
    }
    for (std::size_t r = 0; r < known.size(); ++r) {
      const std::string_view right = known[r].landmark->name;
      if (right.starts_with("right_") && right.substr(6) == left.substr(5)) {
        pairs.emplace_back(l, r);
      }
    }
  }
  return pairs;
}

/// Counts of votes, and of those in favour.
struct Votes {
  std::size_t all = 0;
  std::size_t yes = 0;
  void add(bool vote) {
    ++all;
    yes += vote ? 1 : 0;
  }
  [[nodiscard]] bool nearly_all() const {
    return all > 0 && static_cast<double>(yes) >= kNearlyAll * static_cast<double>(all);
  }
};

Eigen::Vector3d eigen(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// One trial, sampled at some of its frames.
class TrialSides {
 public:
  TrialSides(const MarkerTracks& tracks, std::span<const NamedMarker> labels)
      : tracks_(tracks), known_(known_markers(tracks, labels)) {
    const std::size_t step = 1 + tracks.frames() / kComparedFrames;
    for (std::size_t f = 0; f < tracks.frames(); f += step) frames_.push_back(f);
  }

  [[nodiscard]] SideExchange sides() const {
    bool is_trunk_alone = true;
    Votes mirrored = mirrored_frames(false);
    if (mirrored.all < kMinFrames) {
      is_trunk_alone = false;
      mirrored = mirrored_frames(true);
    }
    const bool is_mirrored = mirrored.all >= kMinFrames && mirrored.nearly_all();
    // Relative to the left and right of the trunk after their correction.
    const Votes legs = turned_pairs(Part::kLegs, is_trunk_alone && is_mirrored);
    const Votes arms = turned_pairs(Part::kArms, is_trunk_alone && is_mirrored);
    if (!is_trunk_alone) {
      if (legs.nearly_all()) return SideExchange::kLegs;
      if (is_mirrored) return SideExchange::kAll;
    } else if (is_mirrored) {
      const bool is_any_limb = legs.all + arms.all > 0;
      const bool is_limb_turned = legs.nearly_all() || arms.nearly_all();
      return is_any_limb && !is_limb_turned ? SideExchange::kTrunk : SideExchange::kAll;
    } else if (legs.nearly_all()) {
      return SideExchange::kLegs;
    }
    return arms.nearly_all() ? SideExchange::kArms : SideExchange::kNone;
  }

  void find_up(TrialGeometry& out) const {
    glm::dvec3 sum(0.0);
    Votes upright;
    constexpr double kCosine45 = 0.7071;
    for (const std::size_t frame : frames_) {
      const auto up = up_in(frame);
      if (!up) continue;
      sum += *up;
      upright.add(up->y > kCosine45);
    }
    if (upright.all == 0 || glm::length(sum) < 0.5 * static_cast<double>(upright.all)) {
      return;
    }
    out.body_up = glm::normalize(sum);
    out.upright_share =
        static_cast<double>(upright.yes) / static_cast<double>(upright.all);
  }

 private:
  static constexpr std::size_t kMinFrames = 1;

  [[nodiscard]] std::optional<glm::dvec3> at(std::size_t frame,
                                             const KnownMarker& marker) const {
    const auto& sample = tracks_.at(frame, marker.column);
    return sample ? std::optional(sample->p_in_world) : std::nullopt;
  }

  /// Returns the sums of products of places on the average body, from their middle, and
  /// of markers. nullopt for fewer than four markers or for flat ones.
  [[nodiscard]] std::optional<Eigen::Matrix3d> products(std::size_t frame,
                                                        bool with_legs) const {
    std::vector<std::pair<glm::dvec3, glm::dvec3>> seen;
    glm::dvec3 middle(0.0);
    for (const KnownMarker& marker : known_) {
      const Part part = part_of(marker.landmark->segment);
      if (part != Part::kTrunk && !(with_legs && part == Part::kLegs)) continue;
      if (marker.landmark->sigma_per_stature >= kSomewhereSigma) continue;
      const auto p = at(frame, marker);
      if (!p) continue;
      seen.emplace_back(marker.p_on_average, *p);
      middle += marker.p_on_average;
    }
    if (seen.size() < 4) return std::nullopt;
    middle /= static_cast<double>(seen.size());
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
    for (const auto& [average, marker] : seen) {
      own += eigen(average - middle) * eigen(average - middle).transpose();
      // Relative to the first marker: for the sum the middle is equivalent, but large
      // coordinates lose precision.
      across += eigen(average - middle) * eigen(marker - seen[0].second).transpose();
    }
    const double depth2 =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(own).eigenvalues()[0] /
        static_cast<double>(seen.size());
    if (depth2 < kMinDepth_m * kMinDepth_m) return std::nullopt;
    return across;
  }

  [[nodiscard]] Votes mirrored_frames(bool with_legs) const {
    Votes votes;
    for (const std::size_t frame : frames_) {
      const auto across = products(frame, with_legs);
      if (across) votes.add(across->determinant() < 0.0);
    }
    return votes;
  }

  /// Returns the trunk's direction to the left, not normalized.
  [[nodiscard]] std::optional<glm::dvec3> left_of_trunk(std::size_t frame) const {
    if (const auto across = products(frame, false)) {
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
          *across, Eigen::ComputeFullU | Eigen::ComputeFullV);
      // A mirrored trunk is a rotated one with left and right exchanged, as is this
      // rotation.
      const Eigen::Matrix3d turn = svd.matrixV() * svd.matrixU().transpose();
      return glm::dvec3(turn(0, 0), turn(1, 0), turn(2, 0));
    }
    glm::dvec3 left(0.0);
    for (const auto& [l, r] : side_pairs(known_, Part::kTrunk)) {
      const auto from = at(frame, known_[r]);
      const auto to = at(frame, known_[l]);
      if (from && to) left += *to - *from;
    }
    if (glm::length(left) <= 0.0) return std::nullopt;
    return left;
  }

  /// Counts pairs of a limb's labels whose left is to the right of the right. With
  /// `is_mirrored` for a trunk whose labels are mirrored as well.
  [[nodiscard]] Votes turned_pairs(Part part, bool is_mirrored) const {
    Votes votes;
    const Pairs pairs = side_pairs(known_, part);
    if (pairs.size() < 2) return votes;
    for (const std::size_t frame : frames_) {
      const auto left = left_of_trunk(frame);
      if (!left) continue;
      for (const auto& [l, r] : pairs) {
        const auto from = at(frame, known_[r]);
        const auto to = at(frame, known_[l]);
        if (!from || !to) continue;
        const double along = glm::dot(*to - *from, *left);
        votes.add((is_mirrored ? -along : along) < 0.0);
      }
    }
    return votes;
  }

  [[nodiscard]] std::optional<glm::dvec3> up_in(std::size_t frame) const {
    struct Mean {
      glm::dvec3 sum{0.0};
      double count = 0.0;
      void add(const glm::dvec3& p) {
        sum += p;
        count += 1.0;
      }
      [[nodiscard]] glm::dvec3 value() const { return sum / count; }
    };
    Mean low;
    Mean hips;
    Mean high;
    for (const KnownMarker& marker : known_) {
      const auto p = at(frame, marker);
      if (!p) continue;
      const B bone = marker.landmark->segment;
      if (is_below_knee(bone)) low.add(*p);
      if (bone == B::kHips) hips.add(*p);
      if (part_of(bone) == Part::kTrunk || part_of(bone) == Part::kHead) high.add(*p);
    }
    if (high.count == 0.0) return std::nullopt;
    if (low.count == 0.0 && (hips.count == 0.0 || hips.count == high.count)) {
      return std::nullopt;
    }
    const glm::dvec3 up = high.value() - (low.count > 0.0 ? low : hips).value();
    if (glm::length(up) <= 0.0) return std::nullopt;
    return glm::normalize(up);
  }

  const MarkerTracks& tracks_;
  std::vector<KnownMarker> known_;
  std::vector<std::size_t> frames_;
};

/// Logarithms of the median distances of labels on one segment.
using Distances = std::map<std::pair<std::string, std::string>, double>;

Distances distances_of(const MarkerTracks& tracks, std::span<const NamedMarker> labels) {
  Distances out;
  const std::vector<KnownMarker> known = known_markers(tracks, labels);
  const std::size_t step = 1 + tracks.frames() / kComparedFrames;
  for (std::size_t a = 0; a < known.size(); ++a) {
    for (std::size_t b = a + 1; b < known.size(); ++b) {
      if (known[a].landmark->segment != known[b].landmark->segment) continue;
      std::vector<double> logs;
      for (std::size_t f = 0; f < tracks.frames(); f += step) {
        const auto& one = tracks.at(f, known[a].column);
        const auto& two = tracks.at(f, known[b].column);
        if (!one || !two) continue;
        const double distance_m = glm::distance(one->p_in_world, two->p_in_world);
        if (distance_m > 0.0) logs.push_back(std::log(distance_m));
      }
      if (logs.empty()) continue;
      auto names =
          std::minmax(tracks.labels[known[a].column], tracks.labels[known[b].column]);
      out[{names.first, names.second}] = median(std::move(logs));
    }
  }
  return out;
}

std::optional<double> log_scale(const Distances& of, const Distances& to) {
  std::vector<double> logs;
  for (const auto& [names, log] : of) {
    const auto at = to.find(names);
    if (at != to.end()) logs.push_back(log - at->second);
  }
  if (logs.size() < kMinPairs) return std::nullopt;
  return median(std::move(logs));
}

void find_scales(std::span<const MarkerTracks> trials,
                 std::span<const NamedMarker> labels,
                 std::vector<TrialGeometry>& out) {
  std::vector<Distances> distances;
  for (const MarkerTracks& trial : trials) {
    distances.push_back(distances_of(trial, labels));
  }
  // Ratio that means another unit of length: it exceeds all differences between two
  // people.
  const double other_unit = std::log(1.8);
  std::size_t best = 0;
  std::pair<int, double> minimum{std::numeric_limits<int>::max(), 0.0};
  for (std::size_t t = 0; t < trials.size(); ++t) {
    int disagreeing = 0;
    for (std::size_t other = 0; other < trials.size(); ++other) {
      const auto log = log_scale(distances[other], distances[t]);
      disagreeing += !log || std::abs(*log) > other_unit ? 1 : 0;
    }
    const auto stature = estimate_stature(trials.subspan(t, 1), labels);
    const double odd = stature && stature->stature_m > 0.0
                           ? std::abs(std::log(stature->stature_m / kStature_m))
                           : std::numeric_limits<double>::infinity();
    if (std::pair(disagreeing, odd) >= minimum) continue;
    minimum = {disagreeing, odd};
    best = t;
  }
  for (std::size_t t = 0; t < trials.size(); ++t) {
    out[t].scale_of = best;
    const auto log = log_scale(distances[t], distances[best]);
    if (log) out[t].scale = std::exp(*log);
  }
}

}  // namespace

std::vector<TrialGeometry> compare_trials(std::span<const MarkerTracks> trials,
                                          std::span<const NamedMarker> labels) {
  std::vector<TrialGeometry> out(trials.size());
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const TrialSides trial(trials[t], labels);
    out[t].sides = trial.sides();
    trial.find_up(out[t]);
  }
  if (trials.size() > 1) find_scales(trials, labels, out);
  return out;
}

}  // namespace marey::reconstruct
