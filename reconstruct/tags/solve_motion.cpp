// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/solve_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "reconstruct/posture/point_sigma.h"
#include "reconstruct/tags/frame_solver.h"
#include "reconstruct/tags/resolve_planar_ambiguities.h"
#include "reconstruct/tags/window_solver.h"

namespace marey::reconstruct {
namespace {

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

ClockSource clock_of(std::size_t camera, const WindowSolver& windows) {
  if (camera == 0) return ClockSource::kReference;
  return windows.offset_given()[camera] ? ClockSource::kGiven : ClockSource::kEstimated;
}

void measure_fit(const WindowSolver& windows,
                 const Sightings& sightings,
                 std::size_t cameras,
                 std::span<const TagOnSegment> tags,
                 SolvedTrial& trial) {
  std::vector<std::vector<double>> by_camera(cameras);
  std::vector<std::vector<double>> by_tag(tags.size());
  std::vector<double> all;
  for (std::size_t f = 0; f < sightings.frames.size(); ++f) {
    std::vector<double> here;
    for (std::size_t i = 0; i < sightings.frames[f].size(); ++i) {
      const std::vector<double> errors = windows.errors_px(f, i);
      const TagSighting& s = sightings.frames[f][i];
      for (auto* of : {&by_camera[index(s.camera)], &by_tag[s.tag]}) {
        of->insert(of->end(), errors.begin(), errors.end());
      }
      here.insert(here.end(), errors.begin(), errors.end());
    }
    trial.frame_rms_px.push_back(root_mean_square(here));
    trial.tags_seen.push_back(static_cast<int>(sightings.frames[f].size()));
    all.insert(all.end(), here.begin(), here.end());
  }
  for (std::size_t c = 0; c < cameras; ++c) {
    trial.cameras.push_back({root_mean_square(by_camera[c]),
                             by_camera[c].empty() ? 0.0 : median(by_camera[c]),
                             static_cast<int>(by_camera[c].size()),
                             windows.offsets_s()[c],
                             clock_of(c, windows)});
  }
  for (std::size_t tag = 0; tag < tags.size(); ++tag) {
    const std::vector<double>& errors = by_tag[tag];
    trial.tag_fits.push_back({tags[tag].id,
                              root_mean_square(errors),
                              errors.empty() ? 0.0 : median(errors),
                              static_cast<int>(errors.size())});
  }
  trial.rms_px = root_mean_square(all);
  if (!all.empty()) trial.median_px = median(std::move(all));
}

/// Returns the frames in which any tag of the segment is seen; empty if it has no tag.
std::vector<bool> seen_frames(const BodyModel& model,
                              const Sightings& sightings,
                              HumanBone bone) {
  const bool tagged = std::any_of(
      model.segment_from_tag.begin(), model.segment_from_tag.end(), [&](const auto& t) {
        return model.bone(t.first) == bone;
      });
  if (!tagged) return {};
  std::vector<bool> seen;
  for (const auto& frame : sightings.frames) {
    seen.push_back(std::any_of(frame.begin(), frame.end(), [&](const TagSighting& s) {
      return model.bone(s.tag) == bone;
    }));
  }
  return seen;
}

/// Returns the sources of one segment over the trial and appends its gaps to `gaps`.
std::vector<Source> sources_of(const BodyModel& model,
                               const Sightings& sightings,
                               HumanBone bone,
                               int max_repair,
                               std::vector<Gap>& gaps) {
  const std::vector<bool> seen = seen_frames(model, sightings, bone);
  std::vector<Source> sources(sightings.frames.size(), Source::kInferred);
  for (std::size_t f = 0; f < seen.size();) {
    std::size_t end = f;
    while (end < seen.size() && seen[end] == seen[f]) ++end;
    Source source = Source::kMeasured;
    if (!seen[f]) {
      const bool bridged =
          f > 0 && end < seen.size() && static_cast<int>(end - f) <= max_repair;
      source = bridged ? Source::kRepaired : Source::kInferred;
      gaps.push_back({bone,
                      sightings.first_frame + static_cast<int>(f),
                      sightings.first_frame + static_cast<int>(end) - 1,
                      source});
    }
    std::fill(sources.begin() + static_cast<std::ptrdiff_t>(f),
              sources.begin() + static_cast<std::ptrdiff_t>(end),
              source);
    f = end;
  }
  return sources;
}

/// Returns the sigma of an instant that all cameras see, each with its own clock. [s]
double common_clock_sigma_s(const WindowSolver& windows) {
  const std::vector<double>& sigmas_s = windows.clock_sigmas_s();
  double sum = 0.0;
  for (const double s : sigmas_s) sum += s * s;
  return std::sqrt(sum) / static_cast<double>(sigmas_s.size());
}

/// Computes the speed of every bone's origin, root mean square over coordinates. [m/s]
std::vector<BoneSigmas> bone_speeds(const Motion& motion) {
  std::vector<std::vector<RigidTransform>> worlds;
  for (const Pose& pose : motion.poses) {
    worlds.push_back(world_from_joints(motion.skeleton, pose));
  }
  std::vector<BoneSigmas> speeds(worlds.size(), BoneSigmas{});
  for (std::size_t f = 0; f < worlds.size(); ++f) {
    const std::size_t before = f > 0 ? f - 1 : 0;
    const std::size_t after = std::min(f + 1, worlds.size() - 1);
    if (after == before) continue;
    const double rate_hz = motion.rate.hz / static_cast<double>(after - before);
    for (std::size_t b = 0; b < speeds[f].size(); ++b) {
      speeds[f][b] =
          rate_hz / std::sqrt(3.0) *
          glm::distance(worlds[after][b].translation, worlds[before][b].translation);
    }
  }
  return speeds;
}

/// Returns true if only one camera sees tags of the two segments.
bool one_camera_sees(const BodyModel& model,
                     std::span<const TagSighting> frame,
                     HumanBone one,
                     HumanBone other) {
  std::optional<CameraId> only;
  for (const TagSighting& s : frame) {
    const HumanBone bone = model.bone(s.tag);
    if (bone != one && bone != other) continue;
    if (only && *only != s.camera) return false;
    only = s.camera;
  }
  return only.has_value();
}

/// Share of a joint's sigma in the body that applies to a motion. Determined on simulated
/// sessions (seeds 280 to 399): with 1 for all, 98 to 99 % of the errors of elbows,
/// wrists and ankles were inside their 95 % radius, and 94 % of those of hips and knees.
/// The tags of both its segments determine an elbow, so errors along the bones, which the
/// body's sigma includes, affect it less. With 0.65, 95 % of its errors would be inside,
/// but single ones exceeded five sigmas.
double share_of_centre(HumanBone joint) {
  for (std::size_t limb = 0; limb < human_limbs().size(); ++limb) {
    const bool is_arm = limb < 2;
    if (joint == human_limbs()[limb].lower && is_arm) return 0.8;
    if (joint == human_limbs()[limb].lower) return 1.1;
    if (joint == human_limbs()[limb].upper && !is_arm) return 1.15;
    if (joint == human_limbs()[limb].end) return 0.85;
  }
  return 1.0;
}

/// Adds the depth error of a limb's middle joint that only one camera sees. Its depth is
/// determined from the limb's root, so it inherits a part of the root's error.
void add_depth(const BodyModel& model,
               std::span<const TagSighting> frame,
               std::span<JointUncertainty> uncertainties) {
  // Determined so that 95 % of the errors of elbows in 120 simulated sessions are inside.
  // At knees the addition is small, because hips have small sigmas.
  constexpr double kShare = 0.5;
  for (const HumanLimb& limb : human_limbs()) {
    if (!one_camera_sees(model, frame, limb.upper, limb.lower)) continue;
    double& sigma_m = uncertainties[index(limb.lower)].sigma_m;
    sigma_m = std::hypot(sigma_m, kShare * uncertainties[index(limb.upper)].sigma_m);
  }
}

void fill_uncertainties(const Body& body,
                        const BodyModel& model,
                        const Sightings& sightings,
                        const WindowSolver& windows,
                        const AmbiguitySigmas& ambiguity,
                        const SolveMotionOptions& options,
                        SolvedTrial& trial) {
  const std::vector<BoneSigmas>& sigmas = windows.sigmas();
  const int longest =
      static_cast<int>(std::lround(options.max_repair_s * sightings.rate.hz));
  const double clock_s = common_clock_sigma_s(windows);
  const std::vector<BoneSigmas> speeds = bone_speeds(trial.estimate.motion);
  std::array<std::vector<Source>, kHumanBoneCount> sources;
  BoneSigmas centres_m{};
  for (const HumanBone bone : human_bones()) {
    centres_m[index(bone)] = centre_sigma_in_motion_m(body, bone);
    sources[index(bone)] = sources_of(model, sightings, bone, longest, trial.gaps);
  }
  for (std::size_t f = 0; f < sigmas.size(); ++f) {
    std::vector<JointUncertainty> uncertainties(kHumanBoneCount);
    const auto known = [&](HumanBone bone) {
      return sources[index(bone)][f] != Source::kInferred;
    };
    trial.frames_solved += known(HumanBone::kHips) || known(HumanBone::kUpperChest);
    for (std::size_t b = 0; b < uncertainties.size(); ++b) {
      uncertainties[b].sigma_m =
          std::hypot(std::hypot(sigmas[f][b], centres_m[b]),
                     ambiguity.bones[f][b],
                     std::hypot(options.camera_sigma_m, clock_s * speeds[f][b]));
    }
    add_depth(model, sightings.frames[f], uncertainties);
    for (std::size_t b = 0; b < uncertainties.size(); ++b) {
      uncertainties[b].segment_source = sources[b][f];
      uncertainties[b].source =
          source_of_joint(human_bones()[b], sources[b][f], uncertainties[b].sigma_m);
    }
    trial.estimate.uncertainty.push_back(std::move(uncertainties));
  }
}

void fill_tags(const BodyModel& model,
               const Sightings& sightings,
               const WindowSolver& windows,
               const AmbiguitySigmas& ambiguity,
               const SolveMotionOptions& options,
               SolvedTrial& trial) {
  constexpr std::size_t kCamerasInFiles = 7;
  const double clock_s = common_clock_sigma_s(windows);
  const std::vector<BoneSigmas> speeds = bone_speeds(trial.estimate.motion);
  for (std::size_t f = 0; f < sightings.frames.size(); ++f) {
    std::vector<TagUncertainty> tags(model.tags.size());
    for (const TagSighting& s : sightings.frames[f]) {
      tags[s.tag].seen = true;
      const std::size_t camera = index(s.camera);
      if (camera >= kCamerasInFiles) continue;
      tags[s.tag].cameras = static_cast<std::uint8_t>(tags[s.tag].cameras | 1U << camera);
    }
    for (std::size_t t = 0; t < tags.size(); ++t) {
      const std::size_t bone = index(model.bone(t));
      tags[t].sigma_m = static_cast<float>(
          std::hypot(std::hypot(windows.tag_sigmas()[f][t], windows.slips_m()[bone]),
                     ambiguity.tags[f][t],
                     std::hypot(options.camera_sigma_m, clock_s * speeds[f][bone])));
    }
    trial.tags.push_back(std::move(tags));
  }
}

Error not_found(std::span<const CameraDetections> detections, const char* cause) {
  return bad_input(
      detections.front().source,
      cause,
      "check the videos of this trial in session.toml, and that [tags] lists "
      "the family and the ids on the suit");
}

}  // namespace

double centre_sigma_in_motion_m(const Body& body, HumanBone joint) {
  return share_of_centre(joint) * body.joint_centre_sigma_m[index(joint)];
}

Result<SolvedTrial> solve_motion(const Body& body,
                                 std::span<const Camera> cameras,
                                 std::span<const CameraDetections> detections,
                                 const SolveMotionOptions& options,
                                 const Progress& progress) {
  MAREY_ASSERT(cameras.size() == detections.size());
  MAREY_ASSERT(options.overlap_frames >= 0 &&
               options.window_frames > options.overlap_frames + 2);
  const BodyModel model = to_model(body);
  const Sightings sightings = group_sightings(detections, model.tags);
  const bool seen = std::any_of(sightings.frames.begin(),
                                sightings.frames.end(),
                                [](const auto& frame) { return !frame.empty(); });
  if (!seen) return not_found(detections, "no tag of the body is seen in any frame");

  const int frames = static_cast<int>(sightings.frames.size());
  const auto progress_from = [&](int offset) {
    return [&progress, offset, frames](int done, int /*total*/) {
      if (progress) progress(offset + done, 2 * frames);
    };
  };
  const FrameSolver frame_solver(model, cameras);
  auto postures = track_postures(frame_solver, sightings, progress_from(0));
  if (!postures) {
    return not_found(detections, "the body is not found: its hips are never seen");
  }
  std::vector<double> offsets_s;
  std::vector<bool> given;
  for (std::size_t c = 0; c < detections.size(); ++c) {
    offsets_s.push_back(seconds(detections[c].offset.value_or(Timestamp{0})));
    // The first camera's clock is the trial's: no other clock defines time zero.
    given.push_back(c == 0 || detections[c].offset.has_value());
  }
  WindowSolver windows(
      model, cameras, sightings, std::move(offsets_s), std::move(given), *postures);
  if (options.estimate_offsets) windows.estimate_offsets();
  const bool solved = windows.solve({static_cast<std::size_t>(options.window_frames),
                                     static_cast<std::size_t>(options.overlap_frames)},
                                    progress_from(frames));
  if (!solved) {
    return not_found(detections, "the solver finds no motion that explains the tags");
  }

  const AmbiguitySigmas ambiguity =
      resolve_planar_ambiguities(model, cameras, sightings, windows, *postures);
  SolvedTrial trial;
  measure_fit(windows, sightings, cameras.size(), model.tags, trial);
  Motion& motion = trial.estimate.motion;
  motion.skeleton = make_humanoid(body.proportions);
  motion.rate = sightings.rate;
  motion.first_frame = sightings.first_frame;
  for (const Posture& posture : *postures) {
    motion.poses.push_back(to_pose(posture, motion.skeleton, model.lengths, model.body));
  }
  fill_uncertainties(body, model, sightings, windows, ambiguity, options, trial);
  fill_tags(model, sightings, windows, ambiguity, options, trial);
  return trial;
}

}  // namespace marey::reconstruct
