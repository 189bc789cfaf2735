// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/subject/turned_limbs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "reconstruct/bundle/bundle_frames.h"
#include "reconstruct/bundle/limb_bundle.h"
#include "reconstruct/bundle/subject_priors.h"
#include "reconstruct/bundle/subject_solve.h"
#include "reconstruct/posture/initial_posture.h"

namespace marey::reconstruct {
namespace {

// Enough of an exercise to determine the direction in which a joint bends.
constexpr std::size_t kFrames = 30;

bool is_of(const HumanLimb& bones, HumanBone bone) {
  return bone == bones.upper || bone == bones.lower;
}

/// Keeps frames that show both bones, evenly chosen, and the tags that they show.
void thin_out(std::size_t limb, LimbBundle& own) {
  const HumanLimb& bones = human_limbs()[limb];
  SubjectBundle& bundle = own.bundle;
  const auto shows = [&](const BundleFrame& frame, HumanBone bone) {
    return std::ranges::any_of(frame.sightings, [&](const TagSighting& s) {
      return bundle.model.place(s.tag) && bundle.model.bone(s.tag) == bone;
    });
  };
  std::vector<BundleFrame> both;
  for (const BundleFrame& frame : bundle.frames) {
    if (shows(frame, bones.upper) && shows(frame, bones.lower)) both.push_back(frame);
  }
  bundle.frames.clear();
  const std::size_t n = std::min(both.size(), kFrames);
  for (std::size_t i = 0; i < n; ++i) {
    bundle.frames.push_back(both[(2 * i + 1) * both.size() / (2 * n)]);
  }
  std::erase_if(bundle.model.segment_from_tag, [&](const auto& placed) {
    if (!is_of(bones, bundle.model.bone(placed.first))) return false;
    return std::ranges::none_of(bundle.frames, [&](const BundleFrame& frame) {
      return std::ranges::any_of(
          frame.sightings, [&](const TagSighting& s) { return s.tag == placed.first; });
    });
  });
}

/// Turns both bones by half a turn about their axes; the tags stay at their places.
void turn(std::size_t limb, SubjectBundle& bundle) {
  const HumanLimb& bones = human_limbs()[limb];
  const LimbParameters& s = kLimbParameters[limb];
  const RigidTransform half{rotation_from_vector(glm::pi<double>() * limb_axis(limb)),
                            glm::dvec3(0.0)};
  for (BundleFrame& frame : bundle.frames) {
    FoundSegments found;
    for (const HumanBone bone : {bones.upper, bones.lower}) {
      found[index(bone)] =
          world_from_bone(bone, frame.posture, bundle.model.lengths, bundle.model.body) *
          half;
    }
    const Posture turned = posture_from_segments(
        found, bundle.model.lengths, bundle.model.body, frame.posture);
    for (const PoseParameter parameter :
         {s.frame, s.flexion, s.upper_twist, s.lower_twist}) {
      std::copy_n(
          turned.block(parameter), block_size(parameter), frame.posture.block(parameter));
    }
  }
  for (auto& [tag, segment_from_tag] : bundle.model.segment_from_tag) {
    if (is_of(bones, bundle.model.bone(tag))) segment_from_tag = half * segment_from_tag;
  }
}

/// Returns half a square that limits solutions from few tags: no person stands with a
/// thigh turned about its axis by more than 60 degrees or an upper arm by more than 90.
double standing_cost(std::size_t limb, const SubjectBundle& bundle) {
  const double free_rad = glm::radians(limb < 2 ? 90.0 : 60.0);
  constexpr double kSigma_rad = 0.35;
  const auto turn_rad = standing_turn_rad(limb, bundle);
  if (!turn_rad) return 0.0;
  const double excess = std::max(0.0, std::abs(*turn_rad) - free_rad) / kSigma_rad;
  return 0.5 * excess * excess * bundle.prior_weight;
}

/// Solves from a loss that nearly all tags are inside of to the corners' own.
std::optional<double> solve(std::size_t limb,
                            std::span<const Camera> cameras,
                            SubjectBundle& bundle) {
  const double noise_scale = bundle.noise_scale;
  std::optional<double> cost;
  for (const double looser : {10.0, 3.0, 1.0}) {
    bundle.noise_scale = looser * noise_scale;
    cost = adjust(bundle, cameras, 12, {limb, true});
    if (!cost) break;
    const BundleFrameSolver solver(bundle, cameras, limb);
    for (BundleFrame& frame : bundle.frames) (void)solver.settle_limb(limb, frame);
  }
  bundle.noise_scale = noise_scale;
  if (cost) cost = adjust(bundle, cameras, 12, {limb});
  if (cost) *cost += standing_cost(limb, bundle);
  return cost;
}

/// Returns true for a limb that hangs in a usual attitude, with its tags on its skin; it
/// is not solved again.
bool is_plausible(std::size_t limb, const SubjectBundle& bundle) {
  constexpr double kUsualTurn_rad = 0.8;
  const auto turn_rad = standing_turn_rad(limb, bundle);
  if (!turn_rad || std::abs(*turn_rad) > kUsualTurn_rad) return false;
  return std::ranges::all_of(bundle.model.segment_from_tag, [&](const auto& placed) {
    return !is_of(human_limbs()[limb], bundle.model.bone(placed.first)) ||
           off_soft_tissue(bundle.model, placed.first) < 1.0;
  });
}

}  // namespace

std::optional<double> standing_turn_rad(std::size_t limb, const SubjectBundle& bundle) {
  const HumanBone upper = human_limbs()[limb].upper;
  const glm::dvec3 along = limb_axis(limb);
  std::vector<double> turns;
  for (const BundleFrame& frame : bundle.frames) {
    if (!frame.standing) continue;
    const glm::dquat parent =
        frame.posture.rotation(limb < 2 ? PoseParameter::kThorax : PoseParameter::kHips);
    const glm::dquat own =
        world_from_bone(upper, frame.posture, bundle.model.lengths, bundle.model.body)
            .rotation;
    turns.push_back(glm::dot(
        rotation_vector(twist_about(glm::conjugate(parent) * own, along)), along));
  }
  if (turns.empty()) return std::nullopt;
  const auto by_size = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto middle = turns.begin() + static_cast<std::ptrdiff_t>(turns.size() / 2);
  std::nth_element(turns.begin(), middle, turns.end(), by_size);
  return *middle;
}

std::vector<std::size_t> turn_limbs(std::span<const Camera> cameras,
                                    SubjectBundle& bundle) {
  std::vector<std::size_t> turned;
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    if (is_plausible(limb, bundle)) continue;
    LimbBundle now;
    cut_out(limb, bundle, now);
    LimbBundle some = now;
    thin_out(limb, some);
    if (some.bundle.frames.empty()) continue;
    SubjectBundle other = some.bundle;
    turn(limb, other);
    const auto cost = solve(limb, cameras, some.bundle);
    const auto other_cost = solve(limb, cameras, other);
    if (!cost || !other_cost || *other_cost >= *cost) continue;
    // The few frames are a screening; all frames decide.
    LimbBundle then = now;
    turn(limb, then.bundle);
    const auto now_cost = solve(limb, cameras, now.bundle);
    const auto then_cost = solve(limb, cameras, then.bundle);
    if (!now_cost || !then_cost || *then_cost >= *now_cost) continue;
    take_back(limb, then, bundle);
    turned.push_back(limb);
  }
  return turned;
}

}  // namespace marey::reconstruct
