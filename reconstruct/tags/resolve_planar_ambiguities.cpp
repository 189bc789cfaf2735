// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/resolve_planar_ambiguities.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <glm/geometric.hpp>

#include "core/humanoid.h"
#include "reconstruct/clusters/locate_rigid.h"
#include "reconstruct/posture/initial_posture.h"

namespace marey::reconstruct {
namespace {

// Frames that are solved again together: two seconds at 30 Hz.
constexpr std::size_t kMaxFrames = 60;
// Poses whose bones differ by less are the same. [rad]
constexpr double kSamePose_rad = 0.05;
// The errors of one camera's sightings of one tag are correlated over frames: this many
// sightings count as one when two poses are compared.
constexpr double kAlike = 4.0;

/// Sightings of the limb in one frame, only of tags with a place.
struct LimbSight {
  std::array<const TagSighting*, 3> of_bone{};  ///< Upper, lower, end; the last one seen.
  bool is_seen = false;
  bool is_single_view = true;  ///< Condition of an interval's frame.
};

LimbSight limb_sight(const BodyModel& model,
                     std::span<const TagSighting> frame,
                     const HumanLimb& limb) {
  const std::array<HumanBone, 3> bones{limb.upper, limb.lower, limb.end};
  LimbSight sight;
  std::optional<CameraId> camera;
  for (const TagSighting& s : frame) {
    const auto at = std::find(bones.begin(), bones.end(), model.bone(s.tag));
    if (at == bones.end() || !model.place(s.tag)) continue;
    const TagSighting*& own = sight.of_bone[static_cast<std::size_t>(at - bones.begin())];
    sight.is_single_view =
        sight.is_single_view && !own && (!camera || *camera == s.camera);
    sight.is_seen = true;
    camera = s.camera;
    own = &s;
  }
  return sight;
}

/// Returns the posture with one limb at the sighting's other planar pose; nullopt if both
/// poses agree.
std::optional<Posture> with_alternative_pose(const BodyModel& model,
                                             std::span<const Camera> cameras,
                                             const TagSighting& sighting,
                                             std::size_t limb,
                                             const Posture& posture) {
  const HumanBone bone = model.bone(sighting.tag);
  const RigidTransform now = world_from_bone(bone, posture, model.lengths, model.body);
  std::optional<RigidTransform> other;
  double max_rad = kSamePose_rad;
  for (const RigidTransform& world_from_tag :
       planar_candidates(cameras[index(sighting.camera)],
                         *sighting.detection,
                         model.tags[sighting.tag].size_m)) {
    const RigidTransform reading = world_from_tag * inverse(*model.place(sighting.tag));
    const double rad =
        glm::length(rotation_vector(glm::conjugate(now.rotation) * reading.rotation));
    if (rad < max_rad) continue;
    max_rad = rad;
    other = reading;
  }
  if (!other) return std::nullopt;
  const Posture read =
      posture_from_segments(std::map<HumanBone, RigidTransform>{{bone, *other}},
                            model.lengths,
                            model.body,
                            posture);
  Posture out = posture;
  const LimbParameters& parameters = kLimbParameters[limb];
  for (const PoseParameter parameter : {parameters.frame,
                                        parameters.flexion,
                                        parameters.upper_twist,
                                        parameters.lower_twist,
                                        parameters.extremity}) {
    std::copy_n(read.block(parameter), block_size(parameter), out.block(parameter));
  }
  return out;
}

/// Adds the distance between two places, weighted by the probability of the second.
void add_chance(double distance_m, double chance, double& sigma_m) {
  sigma_m = std::hypot(sigma_m, std::sqrt(chance) * distance_m);
}

void add_distances(const BodyModel& model,
                   const HumanLimb& limb,
                   const Posture& kept,
                   const Posture& other,
                   double chance,
                   BoneSigmas& bones,
                   TagSigmas& tags) {
  for (const HumanBone bone : {limb.upper, limb.lower, limb.end}) {
    const RigidTransform a = world_from_bone(bone, kept, model.lengths, model.body);
    const RigidTransform b = world_from_bone(bone, other, model.lengths, model.body);
    add_chance(glm::distance(a.translation, b.translation), chance, bones[index(bone)]);
    for (const auto& [tag, segment_from_tag] : model.segment_from_tag) {
      if (model.bone(tag) != bone) continue;
      add_chance(glm::distance(a * segment_from_tag.translation,
                               b * segment_from_tag.translation),
                 chance,
                 tags[tag]);
    }
  }
}

/// Returns the interval's postures with one bone of its limb (0, 1, 2) at its other
/// planar pose; empty if there is none.
std::vector<Posture> alternative_postures(const BodyModel& model,
                                          std::span<const Camera> cameras,
                                          const Sightings& sightings,
                                          const SingleViewInterval& run,
                                          std::size_t bone,
                                          std::span<const Posture> now) {
  std::vector<Posture> other(now.begin(), now.end());
  bool differs = false;
  for (std::size_t i = 0; i < run.count; ++i) {
    const TagSighting* seen =
        limb_sight(model, sightings.frames[run.first + i], human_limbs()[run.limb])
            .of_bone[bone];
    if (!seen) continue;
    const auto read = with_alternative_pose(model, cameras, *seen, run.limb, other[i]);
    if (!read) continue;
    other[i] = *read;
    differs = true;
  }
  if (!differs) other.clear();
  return other;
}

}  // namespace

std::vector<SingleViewInterval> single_view_intervals(const BodyModel& model,
                                                      const Sightings& sightings,
                                                      std::size_t max_frames) {
  std::vector<SingleViewInterval> found;
  for (std::size_t l = 0; l < human_limbs().size(); ++l) {
    SingleViewInterval run{l, 0, 0};
    bool is_seen = false;
    const auto end_run = [&](std::size_t next) {
      if (run.count > 0 && is_seen) found.push_back(run);
      run = {l, next, 0};
      is_seen = false;
    };
    for (std::size_t f = 0; f < sightings.frames.size(); ++f) {
      const LimbSight sight = limb_sight(model, sightings.frames[f], human_limbs()[l]);
      if (!sight.is_single_view) {
        end_run(f + 1);
        continue;
      }
      is_seen = is_seen || sight.is_seen;
      if (++run.count == max_frames) end_run(f + 1);
    }
    end_run(sightings.frames.size());
  }
  return found;
}

AmbiguitySigmas resolve_planar_ambiguities(const BodyModel& model,
                                           std::span<const Camera> cameras,
                                           const Sightings& sightings,
                                           WindowSolver& windows,
                                           std::vector<Posture>& postures) {
  AmbiguitySigmas sigmas{
      std::vector<BoneSigmas>(postures.size(), BoneSigmas{}),
      std::vector<TagSigmas>(postures.size(), TagSigmas(model.tags.size(), 0.0))};
  for (const SingleViewInterval& run :
       single_view_intervals(model, sightings, kMaxFrames)) {
    const HumanLimb& limb = human_limbs()[run.limb];
    const std::span<Posture> own = std::span(postures).subspan(run.first, run.count);
    for (std::size_t bone = 0; bone < 3; ++bone) {
      auto other = alternative_postures(model, cameras, sightings, run, bone, own);
      if (other.empty()) continue;
      const std::optional<double> extra_cost = windows.solve_again(run.first, other);
      if (!extra_cost) continue;
      if (*extra_cost < 0.0) std::swap_ranges(other.begin(), other.end(), own.begin());
      // Half of the squares, of which kAlike count as one, is the log of the odds.
      const double chance = 1.0 / (1.0 + std::exp(std::abs(*extra_cost) / kAlike));
      for (std::size_t i = 0; i < run.count; ++i) {
        const std::size_t f = run.first + i;
        add_distances(
            model, limb, own[i], other[i], chance, sigmas.bones[f], sigmas.tags[f]);
      }
    }
  }
  return sigmas;
}

}  // namespace marey::reconstruct
