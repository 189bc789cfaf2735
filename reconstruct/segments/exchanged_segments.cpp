// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/segments/exchanged_segments.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/in_quotes.h"
#include "core/base/quantile.h"
#include "reconstruct/clusters/find_joint_centres.h"
#include "reconstruct/segments/cluster_geometry.h"

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// A joint's two bones keep their centre to a centimetre or two, skin included; segments
// that are not neighbours drift by tens of centimetres, in proportion to their movement.
constexpr double kMaxDrift_m = 0.15;
constexpr double kSuspectDrift_m = 0.04;
// A renaming must lower the sum of the joints' drifts by this much, and to this share.
constexpr double kMinGain_m = 0.08;
constexpr double kMinShare = 0.7;
constexpr std::size_t kMaxPairs = 120;

using Edge = std::pair<B, B>;
constexpr std::array<Edge, 14> kJoints{{
    {B::kHips, B::kUpperChest},
    {B::kUpperChest, B::kHead},
    {B::kUpperChest, B::kLeftUpperArm},
    {B::kLeftUpperArm, B::kLeftLowerArm},
    {B::kLeftLowerArm, B::kLeftHand},
    {B::kUpperChest, B::kRightUpperArm},
    {B::kRightUpperArm, B::kRightLowerArm},
    {B::kRightLowerArm, B::kRightHand},
    {B::kHips, B::kLeftUpperLeg},
    {B::kLeftUpperLeg, B::kLeftLowerLeg},
    {B::kLeftLowerLeg, B::kLeftFoot},
    {B::kHips, B::kRightUpperLeg},
    {B::kRightUpperLeg, B::kRightLowerLeg},
    {B::kRightLowerLeg, B::kRightFoot},
}};

B renamed(const Renaming& names, B bone) {
  const auto found = names.find(bone);
  return found == names.end() ? bone : found->second;
}

/// Measures the drift between the common centres of two clusters. [m]
class Drifts {
 public:
  Drifts(std::span<const TagCluster> clusters, std::span<const ClusterPoses> frames)
      : frames_(frames) {
    for (const TagCluster& cluster : clusters) {
      inside_[cluster.segment] = place_inside(cluster);
    }
  }

  /// Returns nullopt if they are hardly seen together.
  std::optional<double> between(B a, B b) {
    const Edge key = std::minmax(a, b);
    const auto known = drifts_.find(key);
    if (known != drifts_.end()) return known->second;
    return drifts_[key] = measure(key.first, key.second);
  }

  /// Returns the sum over joints if segments declared as A are worn as names[A]. Joints
  /// that are not seen count as bad ones, so that hiding one is no gain.
  double cost(const Renaming& names) {
    Renaming declared_of;
    for (const auto& [declared, worn] : names) declared_of[worn] = declared;
    double sum = 0.0;
    for (const auto& [a, b] : kJoints) {
      const B from = renamed(declared_of, a);
      const B to = renamed(declared_of, b);
      if (!inside_.contains(from) || !inside_.contains(to)) continue;
      sum += std::min(between(from, to).value_or(kSuspectDrift_m), kMaxDrift_m);
    }
    return sum;
  }

  [[nodiscard]] bool has(B bone) const { return inside_.contains(bone); }

 private:
  std::optional<double> measure(B a, B b) const {
    if (!inside_.contains(a) || !inside_.contains(b)) return std::nullopt;
    std::vector<SegmentPair> pairs;
    for (const ClusterPoses& frame : frames_) {
      const auto in_a = frame.find(a);
      const auto in_b = frame.find(b);
      if (in_a == frame.end() || in_b == frame.end()) continue;
      pairs.push_back({in_a->second, in_b->second});
    }
    const std::size_t step = 1 + pairs.size() / kMaxPairs;
    std::vector<SegmentPair> some;
    for (std::size_t i = 0; i < pairs.size(); i += step) some.push_back(pairs[i]);
    const auto centre = find_joint_centre(some, inside_.at(a), inside_.at(b));
    if (!centre) return std::nullopt;
    std::vector<double> drifts;
    for (const SegmentPair& pair : some) {
      drifts.push_back(glm::distance(pair.world_from_a * centre->p_in_a,
                                     pair.world_from_b * centre->p_in_b));
    }
    return quantile(std::move(drifts), 0.8);
  }

  std::span<const ClusterPoses> frames_;
  std::map<B, glm::dvec3> inside_;
  std::map<Edge, std::optional<double>> drifts_;
};

/// Returns `names` with `a` and `b` exchanged afterwards.
Renaming with_exchanged(const Renaming& names, B a, B b) {
  Renaming out = names;
  for (const B bone : human_bones()) {
    const B now = renamed(names, bone);
    if (now == a) out[bone] = b;
    if (now == b) out[bone] = a;
  }
  return out;
}

/// Lists usual mistakes: any two segments exchanged, or parts of limbs between the sides.
std::vector<std::vector<Edge>> usual_exchanges(const Drifts& drifts) {
  std::set<B> worn;
  for (const auto& [a, b] : kJoints) {
    if (drifts.has(a)) worn.insert(a);
    if (drifts.has(b)) worn.insert(b);
  }
  std::vector<std::vector<Edge>> out;
  for (auto a = worn.begin(); a != worn.end(); ++a) {
    for (auto b = std::next(a); b != worn.end(); ++b) out.push_back({{*a, *b}});
  }
  for (const std::size_t limb : {0UL, 2UL}) {
    const HumanLimb& left = human_limbs()[limb];
    const HumanLimb& right = human_limbs()[limb + 1];
    out.push_back({{left.lower, right.lower}, {left.end, right.end}});
    out.push_back({{left.upper, right.upper}, {left.end, right.end}});
  }
  return out;
}

bool is_suspect(Drifts& drifts) {
  return std::any_of(kJoints.begin(), kJoints.end(), [&](const Edge& joint) {
    return drifts.between(joint.first, joint.second).value_or(0.0) > kSuspectDrift_m;
  });
}

/// Tags by declared segment and by the segment they are worn on.
using Moves = std::map<Edge, std::vector<std::size_t>>;

bool is_whole(const Moves& moves, std::span<const TagOnSegment> tags, const Edge& move) {
  const auto declared = std::count_if(tags.begin(), tags.end(), [&](const auto& tag) {
    return solved_segment(tag.segment) == move.first;
  });
  return declared == static_cast<std::ptrdiff_t>(moves.at(move).size());
}

/// Returns the limbs, such as "arms", if left and right of all of them are exchanged.
std::string whole_limbs(const Moves& moves, std::span<const TagOnSegment> tags) {
  const auto all = [&](std::size_t left_limb) {
    const HumanLimb& bones = human_limbs()[left_limb];
    std::size_t found = 0;
    for (const B bone : {bones.upper, bones.lower}) {
      for (const Edge& move : {Edge(bone, mirrored(bone)), Edge(mirrored(bone), bone)}) {
        found += moves.contains(move) && is_whole(moves, tags, move) ? 1 : 0;
      }
    }
    return found == 4;
  };
  const bool arms = all(0);
  const bool legs = all(2);
  const bool others = std::any_of(moves.begin(), moves.end(), [](const auto& move) {
    return move.first.second != mirrored(move.first.first);
  });
  if (others || (!arms && !legs)) return {};
  return arms && legs ? "arms and legs" : arms ? "arms" : "legs";
}

}  // namespace

bool are_neighbours(HumanBone a, HumanBone b) {
  return std::any_of(kJoints.begin(), kJoints.end(), [&](const Edge& joint) {
    return joint == Edge(a, b) || joint == Edge(b, a);
  });
}

Renaming exchanged_segments(std::span<const TagCluster> clusters,
                            std::span<const ClusterPoses> frames) {
  Drifts drifts(clusters, frames);
  if (!is_suspect(drifts)) return {};
  const double declared_m = drifts.cost({});
  Renaming best;
  double best_m = declared_m;
  const auto exchanges = usual_exchanges(drifts);
  for (bool is_better = true; is_better;) {
    is_better = false;
    const Renaming so_far = best;
    const double so_far_m = best_m;
    for (const auto& exchange : exchanges) {
      Renaming names = so_far;
      for (const auto& [a, b] : exchange) names = with_exchanged(names, a, b);
      const double cost_m = drifts.cost(names);
      if (cost_m > so_far_m - kMinGain_m || cost_m >= best_m) continue;
      best = std::move(names);
      best_m = cost_m;
      is_better = true;
    }
  }
  return best_m < kMinShare * declared_m ? best : Renaming();
}

void rename(const Renaming& names, std::vector<TagCluster>& clusters) {
  for (TagCluster& cluster : clusters) cluster.segment = renamed(names, cluster.segment);
}

void rename(const Renaming& names, std::vector<ClusterPoses>& frames) {
  for (ClusterPoses& frame : frames) {
    ClusterPoses out;
    for (const auto& [bone, pose] : frame) out[renamed(names, bone)] = pose;
    frame = std::move(out);
  }
}

std::optional<Error> exchange_error(std::span<const TagOnSegment> tags,
                                    std::span<const HumanBone> worn) {
  Moves moves;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const B declared = solved_segment(tags[i].segment);
    if (declared != worn[i]) moves[{declared, worn[i]}].push_back(i);
  }
  if (moves.empty()) return std::nullopt;
  if (const std::string limbs = whole_limbs(moves, tags); !limbs.empty()) {
    return bad_input("[[tags.tag]]",
                     "left and right look exchanged on the " + limbs +
                         ": worn as declared, they would face backward",
                     "exchange left and right in the `segment` of the tags on the " +
                         limbs + "; left is the subject's left");
  }
  std::string cause;
  for (const auto& [move, ids] : moves) {
    const Edge back(move.second, move.first);
    if (moves.contains(back) && is_whole(moves, tags, move) &&
        is_whole(moves, tags, back)) {
      if (move.second < move.first) continue;  // Reported in the other direction.
      cause += (cause.empty() ? "the tags of segments " : ", those of ") +
               in_quotes(name(move.first)) + " and " + in_quotes(name(move.second)) +
               " look exchanged";
      continue;
    }
    for (const std::size_t tag : ids) {
      cause += (cause.empty() ? "tag " : ", tag ") +
               std::to_string(number(tags[tag].id)) + " of segment " +
               in_quotes(name(move.first)) + " moves like segment " +
               in_quotes(name(move.second));
    }
  }
  return bad_input(
      "[[tags.tag]]", cause, "correct their `segment`, or their `id`, in session.toml");
}

}  // namespace marey::reconstruct
