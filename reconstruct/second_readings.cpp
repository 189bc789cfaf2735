// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/second_readings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <glm/geometric.hpp>

#include "core/humanoid.h"
#include "reconstruct/initial_posture.h"
#include "reconstruct/locate_rigid.h"

namespace marey::reconstruct {
namespace {

// Frames that are solved again together: two seconds at 30 Hz.
constexpr std::size_t kMostFrames = 60;
// Readings whose bones are turned by less are one. [rad]
constexpr double kAgreeRad = 0.05;
// What one camera has of one tag errs alike in all frames: this many sightings count as
// one when two readings are compared.
constexpr double kAlike = 4.0;

/// Of the limb, in one frame, tags with a place alone.
struct LimbSight {
  std::array<const TagSighting*, 3> of_bone{};  ///< Upper, lower, end; the last seen.
  bool is_seen = false;
  bool is_lone = true;  ///< As lone_stretches() has it.
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
    const TagSighting*& own =
        sight.of_bone[static_cast<std::size_t>(at - bones.begin())];
    sight.is_lone = sight.is_lone && !own && (!camera || *camera == s.camera);
    sight.is_seen = true;
    camera = s.camera;
    own = &s;
  }
  return sight;
}

/// The posture with one limb as the sighting's other reading has it; nullopt where the
/// readings agree.
std::optional<Posture> with_other_reading(const BodyModel& model,
                                          std::span<const Camera> cameras,
                                          const TagSighting& sighting,
                                          std::size_t limb,
                                          const Posture& posture) {
  const HumanBone bone = model.bone(sighting.tag);
  const RigidTransform now = world_from_bone(bone, posture, model.lengths, model.body);
  std::optional<RigidTransform> other;
  double most_rad = kAgreeRad;
  for (const RigidTransform& world_from_tag :
       planar_candidates(cameras[index(sighting.camera)],
                         *sighting.detection,
                         model.tags[sighting.tag].size_m)) {
    const RigidTransform reading = world_from_tag * inverse(*model.place(sighting.tag));
    const double rad =
        glm::length(rotation_vector(glm::conjugate(now.rotation) * reading.rotation));
    if (rad < most_rad) continue;
    most_rad = rad;
    other = reading;
  }
  if (!other) return std::nullopt;
  const Posture read =
      posture_from_segments(std::map<HumanBone, RigidTransform>{{bone, *other}},
                            model.lengths,
                            model.body,
                            posture);
  Posture out = posture;
  const LimbSlots& slots = kLimbSlots[limb];
  for (const Slot slot : {slots.frame,
                          slots.flexion,
                          slots.upper_twist,
                          slots.lower_twist,
                          slots.extremity}) {
    std::copy_n(read.block(slot), block_size(slot), out.block(slot));
  }
  return out;
}

/// Adds the distance between two places, weighed with the chance of the second.
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
    add_chance(
        glm::distance(a.translation, b.translation), chance, bones[index(bone)]);
    for (const auto& [tag, segment_from_tag] : model.segment_from_tag) {
      if (model.bone(tag) != bone) continue;
      add_chance(glm::distance(a * segment_from_tag.translation,
                               b * segment_from_tag.translation),
                 chance,
                 tags[tag]);
    }
  }
}

/// The stretch's postures with one bone of its limb (0, 1, 2) as its other readings have
/// it; empty where there are none.
std::vector<Posture> other_readings(const BodyModel& model,
                                    std::span<const Camera> cameras,
                                    const Sightings& sightings,
                                    const LoneStretch& run,
                                    std::size_t bone,
                                    std::span<const Posture> now) {
  std::vector<Posture> other(now.begin(), now.end());
  bool differs = false;
  for (std::size_t i = 0; i < run.count; ++i) {
    const TagSighting* seen =
        limb_sight(model, sightings.frames[run.first + i], human_limbs()[run.limb])
            .of_bone[bone];
    if (!seen) continue;
    const auto read = with_other_reading(model, cameras, *seen, run.limb, other[i]);
    if (!read) continue;
    other[i] = *read;
    differs = true;
  }
  if (!differs) other.clear();
  return other;
}

}  // namespace

std::vector<LoneStretch> lone_stretches(const BodyModel& model,
                                        const Sightings& sightings,
                                        std::size_t most_frames) {
  std::vector<LoneStretch> found;
  for (std::size_t l = 0; l < human_limbs().size(); ++l) {
    LoneStretch run{l, 0, 0};
    bool is_seen = false;
    const auto end_run = [&](std::size_t next) {
      if (run.count > 0 && is_seen) found.push_back(run);
      run = {l, next, 0};
      is_seen = false;
    };
    for (std::size_t f = 0; f < sightings.frames.size(); ++f) {
      const LimbSight sight = limb_sight(model, sightings.frames[f], human_limbs()[l]);
      if (!sight.is_lone) {
        end_run(f + 1);
        continue;
      }
      is_seen = is_seen || sight.is_seen;
      if (++run.count == most_frames) end_run(f + 1);
    }
    end_run(sightings.frames.size());
  }
  return found;
}

ReadingSigmas try_second_readings(const BodyModel& model,
                                  std::span<const Camera> cameras,
                                  const Sightings& sightings,
                                  WindowSolver& windows,
                                  std::vector<Posture>& postures) {
  ReadingSigmas sigmas{std::vector<BoneSigmas>(postures.size(), BoneSigmas{}),
                       std::vector<TagSigmas>(postures.size(),
                                              TagSigmas(model.tags.size(), 0.0))};
  for (const LoneStretch& run : lone_stretches(model, sightings, kMostFrames)) {
    const HumanLimb& limb = human_limbs()[run.limb];
    const std::span<Posture> own = std::span(postures).subspan(run.first, run.count);
    for (std::size_t bone = 0; bone < 3; ++bone) {
      auto other = other_readings(model, cameras, sightings, run, bone, own);
      if (other.empty()) continue;
      const std::optional<double> dearer = windows.solve_again(run.first, other);
      if (!dearer) continue;
      if (*dearer < 0.0) std::swap_ranges(other.begin(), other.end(), own.begin());
      // Half of the squares, of which kAlike count as one, is the log of the odds.
      const double chance = 1.0 / (1.0 + std::exp(std::abs(*dearer) / kAlike));
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
