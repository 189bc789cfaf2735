// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/solve_motion.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "reconstruct/body_model.h"
#include "reconstruct/initial_posture.h"
#include "reconstruct/locate_rigid.h"
#include "reconstruct/posture_doubt.h"
#include "reconstruct/posture_terms.h"
#include "reconstruct/tag_clusters.h"

namespace marey::reconstruct {
namespace {

// A frame whose median corner is further off than this is lost and looked for again.
constexpr double kLostPx = 3.0;
// How far a tracked frame may stray from the one before: a loose leash that matters only
// where nothing is seen.
constexpr double kLeashRad = 0.3;
constexpr double kLeashM = 0.1;
// Postures nearer than this, in every rotation, are one reading of the tags.
constexpr double kAgreeRad = 0.35;
constexpr double kOffsetSigmaS = 0.02;

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<TagCluster> clusters_of(const BodyModel& model) {
  std::map<HumanBone, TagCluster> by_bone;
  for (const auto& [tag, segment_from_tag] : model.segment_from_tag) {
    TagCluster& cluster = by_bone[model.bone(tag)];
    cluster.segment = model.bone(tag);
    cluster.cluster_from_tag[tag] = segment_from_tag;
  }
  std::vector<TagCluster> clusters;
  for (auto& [bone, cluster] : by_bone) clusters.push_back(std::move(cluster));
  return clusters;
}

class TrialSolver {
 public:
  TrialSolver(const Body& body,
              std::span<const Camera> cameras,
              std::span<const CameraDetections> detections,
              const SolveMotionOptions& options,
              const Progress& progress)
      : body_(body),
        cameras_(cameras),
        detections_(detections),
        options_(options),
        progress_(progress),
        model_(to_model(body)),
        clusters_(clusters_of(model_)),
        sightings_(group_sightings(detections, model_.tags)),
        offsets_s_(cameras.size(), 0.0) {
    for (std::size_t c = 0; c < detections.size(); ++c) {
      offsets_s_[c] = seconds(detections[c].offset);
      offset_given_.push_back(c == 0 || detections[c].offset != Timestamp{0});
    }
  }

  Result<SolvedTrial> run() {
    const std::size_t frames = sightings_.frames.size();
    const bool seen = std::any_of(sightings_.frames.begin(),
                                  sightings_.frames.end(),
                                  [](const auto& frame) { return !frame.empty(); });
    if (!seen) return not_found("no tag of the body is seen in any frame");
    postures_.resize(frames);
    if (!track()) return not_found("the body is not found: its hips are never seen");
    find_velocities();
    if (options_.estimate_offsets) {
      estimate_offsets();
      find_velocities();
    }
    solve_windows();
    return to_trial();
  }

 private:
  using Velocities = std::vector<std::array<glm::dvec2, 4>>;

  Error not_found(const char* cause) const {
    return bad_input(detections_.front().source,
                     cause,
                     "check that these are the videos of this trial and that [tags] in "
                     "session.toml names the family and ids that are worn");
  }

  void tell(std::size_t done) const {
    if (progress_) {
      progress_(static_cast<int>(done), 2 * static_cast<int>(postures_.size()));
    }
  }

  std::map<HumanBone, RigidTransform> locate(std::size_t frame) const {
    std::map<HumanBone, RigidTransform> found;
    for (const TagCluster& cluster : clusters_) {
      if (const auto pose =
              locate_cluster(cluster, cameras_, model_.tags, sightings_.frames[frame])) {
        found[cluster.segment] = *pose;
      }
    }
    return found;
  }

  double median_error_px(std::size_t frame, const Posture& posture) const {
    std::vector<double> errors;
    for (const TagSighting& s : sightings_.frames[frame]) {
      for (const double e : corner_errors_px(model_, s, cameras_, posture)) {
        errors.push_back(e);
      }
    }
    return median(std::move(errors));
  }

  /// Each frame on its own, kept near the one before.
  bool track() {
    std::size_t first = 0;
    while (first < postures_.size() && !locate(first).contains(HumanBone::kHips)) ++first;
    if (first == postures_.size()) return false;
    for (std::size_t f = first; f < postures_.size(); ++f) {
      const Posture* before = f > first ? &postures_[f - 1] : nullptr;
      const Posture* earlier = f > first + 1 ? &postures_[f - 2] : nullptr;
      track_frame(f, before, earlier);
      tell(f + 1);
    }
    for (std::size_t f = 0; f < first; ++f) postures_[f] = postures_[first];
    track_back();
    return true;
  }

  /// The way back, from what is known later: a lone tag at the start of a trial or after
  /// a gap may have been read the wrong way round, and only the future tells.
  void track_back() {
    for (std::size_t f = postures_.size() - 1; f-- > 0;) {
      const Posture* later = f + 2 < postures_.size() ? &postures_[f + 2] : nullptr;
      Posture predicted = postures_[f + 1];
      if (later) predicted = extrapolate(*later, predicted, 0.7);
      if (turn_between(predicted, postures_[f]) < kAgreeRad) continue;
      Posture candidate = predicted;
      refine_frame(f, &predicted, candidate);
      reconsider_extremities(
          model_, sightings_.frames[f], cameras_, &postures_[f + 1], candidate);
      Posture forward = postures_[f];
      if (refine_frame(f, &predicted, candidate) < refine_frame(f, &predicted, forward)) {
        postures_[f] = candidate;
      }
    }
  }

  /// Largest rotation between blocks of two postures. [rad]
  static double turn_between(const Posture& a, const Posture& b) {
    double most = 0.0;
    for (const Slot slot : kAllSlots) {
      if (!is_rotation(slot)) continue;
      most = std::max(most,
                      glm::length(rotation_vector(glm::conjugate(a.rotation(slot)) *
                                                  b.rotation(slot))));
    }
    return most;
  }

  void track_frame(std::size_t frame, const Posture* before, const Posture* earlier) {
    Posture predicted = before ? *before : Posture{};
    if (earlier) predicted = extrapolate(*earlier, *before, 0.7);
    const auto found = locate(frame);
    const Posture from_tags =
        posture_from_segments(found, model_.lengths, model_.body, predicted);
    const bool tags_are_nearer =
        !before || median_error_px(frame, from_tags) < median_error_px(frame, predicted);
    Posture posture = tags_are_nearer ? from_tags : predicted;
    refine_frame(frame, before ? &predicted : nullptr, posture);
    if (reconsider_extremities(
            model_, sightings_.frames[frame], cameras_, before, posture) > 0) {
      refine_frame(frame, before ? &predicted : nullptr, posture);
    }
    if (median_error_px(frame, posture) > kLostPx) {
      Posture other = tags_are_nearer ? predicted : from_tags;
      refine_frame(frame, before ? &predicted : nullptr, other);
      if (median_error_px(frame, other) < median_error_px(frame, posture)) {
        posture = other;
      }
    }
    retry_limbs(frame, found, before ? &predicted : nullptr, posture);
    postures_[frame] = posture;
  }

  /// Distance of the sighting's corners to their model, the median of the four. [px]
  double misfit_px(const TagSighting& sighting, const Posture& posture) const {
    const auto e = corner_errors_px(model_, sighting, cameras_, posture);
    return median({e.begin(), e.end()});
  }

  /// A limb whose tags do not fit has bent the wrong way, led there by a lone tag read
  /// the wrong way round. Starts it again from every reading of its bones' tags.
  void retry_limbs(std::size_t frame,
                   const std::map<HumanBone, RigidTransform>& found,
                   const Posture* predicted,
                   Posture& posture) const {
    for (const HumanLimb& limb : human_limbs()) {
      std::vector<const TagSighting*> of_limb;
      double worst_px = 0.0;
      for (const TagSighting& s : sightings_.frames[frame]) {
        const HumanBone bone = model_.bone(s.tag);
        if (bone != limb.upper && bone != limb.lower && bone != limb.end) continue;
        of_limb.push_back(&s);
        worst_px = std::max(worst_px, misfit_px(s, posture));
      }
      if (worst_px < kLostPx) continue;
      double least = refine_frame(frame, predicted, posture);
      const Posture start = posture;
      for (const TagSighting* s : of_limb) {
        for (const RigidTransform& world_from_tag : planar_candidates(
                 cameras_[index(s->camera)], *s->detection, model_.tags[s->tag].size_m)) {
          auto segments = found;
          segments[model_.bone(s->tag)] = world_from_tag * inverse(*model_.place(s->tag));
          Posture candidate =
              posture_from_segments(segments, model_.lengths, model_.body, start);
          const double cost = refine_frame(frame, predicted, candidate);
          if (cost >= least) continue;
          least = cost;
          posture = candidate;
        }
      }
    }
  }

  /// Returns the cost that is left.
  double refine_frame(std::size_t frame,
                      const Posture* predicted,
                      Posture& posture) const {
    ceres::Problem problem;
    for (const TagSighting& s : sightings_.frames[frame]) {
      add_sighting(model_, s, cameras_, posture, problem);
    }
    add_habits(posture, model_.lengths, problem);
    if (predicted) add_leash(*predicted, kLeashRad, kLeashM, posture, problem);
    set_manifolds(posture, problem);
    ceres::Solver::Options solver = solver_options(15);
    solver.function_tolerance = 1e-4;
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    return summary.final_cost;
  }

  /// How fast every sighted corner crosses its image, by the postures around it.
  void find_velocities() {
    velocities_.assign(sightings_.frames.size(), {});
    const std::size_t last = postures_.size() - 1;
    for (std::size_t f = 0; f < postures_.size(); ++f) {
      const std::size_t before = f > 0 ? f - 1 : 0;
      const std::size_t after = std::min(f + 1, last);
      const double dt = static_cast<double>(std::max<std::size_t>(1, after - before)) /
                        sightings_.rate.hz;
      for (const TagSighting& s : sightings_.frames[f]) {
        std::array<glm::dvec2, 4> v{};
        const auto a = predicted_corners_px(model_, s, cameras_, postures_[before]);
        const auto b = predicted_corners_px(model_, s, cameras_, postures_[after]);
        for (std::size_t c = 0; a && b && c < 4; ++c) v[c] = ((*b)[c] - (*a)[c]) / dt;
        velocities_[f].push_back(v);
      }
    }
  }

  /// A window's problem. The first `held` postures are the past: they do not move.
  void build(std::size_t first,
             std::size_t count,
             std::size_t held,
             ceres::Problem& problem) {
    for (std::size_t f = first; f < first + count; ++f) {
      for (std::size_t i = 0; i < sightings_.frames[f].size(); ++i) {
        const TagSighting& s = sightings_.frames[f][i];
        add_sighting(model_,
                     s,
                     cameras_,
                     postures_[f],
                     problem,
                     &offsets_s_[index(s.camera)],
                     velocities_[f][i]);
      }
      add_habits(postures_[f], model_.lengths, problem);
      if (f >= first + 2) {
        add_smoothness(
            postures_[f - 2], postures_[f - 1], postures_[f], sightings_.rate, problem);
      }
    }
    if (held == 0 && count > 1) {
      add_first_speed(postures_[first], postures_[first + 1], sightings_.rate, problem);
    }
    for (std::size_t f = first; f < first + count; ++f) {
      set_manifolds(postures_[f], problem);
      if (f < first + held) hold(postures_[f], problem);
    }
  }

  void hold_offsets(bool all, ceres::Problem& problem) {
    for (std::size_t c = 0; c < offsets_s_.size(); ++c) {
      if (!problem.HasParameterBlock(&offsets_s_[c])) continue;
      if (all || offset_given_[c]) {
        problem.SetParameterBlockConstant(&offsets_s_[c]);
      } else {
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ScalarPrior, 1, 1>(
                                     new ScalarPrior{0.0, kOffsetSigmaS}),
                                 nullptr,
                                 &offsets_s_[c]);
      }
    }
  }

  /// One constant per camera, from the windows with most movement.
  void estimate_offsets() {
    if (std::all_of(
            offset_given_.begin(), offset_given_.end(), [](bool g) { return g; })) {
      return;
    }
    const std::size_t count = std::min<std::size_t>(
        postures_.size(), 2 * static_cast<std::size_t>(options_.window_frames));
    const std::size_t first = liveliest(count);
    ceres::Problem problem;
    build(first, count, 0, problem);
    hold_offsets(false, problem);
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(15), &problem, &summary);
  }

  /// Start of the stretch of `count` frames in which corners move most.
  std::size_t liveliest(std::size_t count) const {
    std::vector<double> energy(velocities_.size() + 1, 0.0);
    for (std::size_t f = 0; f < velocities_.size(); ++f) {
      double here = 0.0;
      for (const auto& v : velocities_[f]) here += glm::dot(v[0], v[0]);
      energy[f + 1] = energy[f] + here;
    }
    std::size_t best = 0;
    for (std::size_t f = 0; f + count < energy.size(); ++f) {
      if (energy[f + count] - energy[f] > energy[best + count] - energy[best]) best = f;
    }
    return best;
  }

  void solve_windows() {
    const std::size_t frames = postures_.size();
    const auto window = static_cast<std::size_t>(options_.window_frames);
    const auto overlap = static_cast<std::size_t>(options_.overlap_frames);
    sigmas_.assign(frames, {});
    std::size_t first = 0;  // first frame not yet final
    while (first < frames) {
      const std::size_t held = std::min<std::size_t>(2, first);
      std::size_t count = std::min(window, frames - first);
      // A short rest is not worth a window of its own.
      if (frames - first - count < overlap) count = frames - first;
      ceres::Problem problem;
      build(first - held, count + held, held, problem);
      hold_offsets(true, problem);
      ceres::Solver::Summary summary;
      ceres::Solve(solver_options(25), &problem, &summary);
      const std::size_t end = first + count;
      const std::size_t final_count = end == frames ? count : count - overlap;
      const auto sigmas =
          bone_sigmas(model_, std::span(postures_).subspan(first, count), problem);
      for (std::size_t i = 0; i < final_count && i < sigmas.size(); ++i) {
        sigmas_[first + i] = sigmas[i];
      }
      first += final_count;
      tell(frames + first);
    }
  }

  /// Frames in which any tag of the segment is seen; empty if it has no tag.
  std::vector<bool> seen_frames(HumanBone bone) const {
    const bool tagged =
        std::any_of(model_.segment_from_tag.begin(),
                    model_.segment_from_tag.end(),
                    [&](const auto& t) { return model_.bone(t.first) == bone; });
    if (!tagged) return {};
    std::vector<bool> seen;
    for (const auto& frame : sightings_.frames) {
      seen.push_back(std::any_of(frame.begin(), frame.end(), [&](const TagSighting& s) {
        return model_.bone(s.tag) == bone;
      }));
    }
    return seen;
  }

  /// Sources of one segment over the trial, its gaps appended to `gaps`.
  std::vector<Source> sources_of(HumanBone bone, std::vector<Gap>& gaps) const {
    const std::vector<bool> seen = seen_frames(bone);
    std::vector<Source> sources(postures_.size(), Source::kInferred);
    const int longest =
        static_cast<int>(std::lround(options_.longest_repair_s * sightings_.rate.hz));
    for (std::size_t f = 0; f < seen.size();) {
      std::size_t end = f;
      while (end < seen.size() && seen[end] == seen[f]) ++end;
      Source source = Source::kMeasured;
      if (!seen[f]) {
        const bool bridged =
            f > 0 && end < seen.size() && static_cast<int>(end - f) <= longest;
        source = bridged ? Source::kRepaired : Source::kInferred;
        gaps.push_back({bone,
                        sightings_.first_frame + static_cast<int>(f),
                        sightings_.first_frame + static_cast<int>(end) - 1,
                        source});
      }
      std::fill(sources.begin() + static_cast<std::ptrdiff_t>(f),
                sources.begin() + static_cast<std::ptrdiff_t>(end),
                source);
      f = end;
    }
    return sources;
  }

  void measure_fit(SolvedTrial& trial) const {
    std::vector<std::vector<double>> by_camera(cameras_.size());
    std::vector<double> all;
    for (std::size_t f = 0; f < postures_.size(); ++f) {
      double sum = 0.0;
      int corners = 0;
      for (std::size_t i = 0; i < sightings_.frames[f].size(); ++i) {
        const TagSighting& s = sightings_.frames[f][i];
        const auto predicted = predicted_corners_px(model_, s, cameras_, postures_[f]);
        for (std::size_t c = 0; predicted && c < 4; ++c) {
          const glm::dvec2 shift = velocities_[f][i][c] * offsets_s_[index(s.camera)];
          const double e =
              glm::distance((*predicted)[c] + shift, s.detection->corners_px[c]);
          by_camera[index(s.camera)].push_back(e);
          all.push_back(e);
          sum += e * e;
          ++corners;
        }
      }
      trial.frame_rms_px.push_back(corners > 0 ? std::sqrt(sum / corners) : 0.0);
      trial.tags_seen.push_back(static_cast<int>(sightings_.frames[f].size()));
    }
    const auto rms = [](const std::vector<double>& errors) {
      double sum = 0.0;
      for (const double e : errors) sum += e * e;
      return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
    };
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      trial.cameras.push_back({rms(by_camera[c]),
                               median(by_camera[c]),
                               static_cast<int>(by_camera[c].size()),
                               offsets_s_[c],
                               static_cast<bool>(offset_given_[c])});
    }
    trial.rms_px = rms(all);
    trial.median_px = median(all);
  }

  /// Residuals larger than their sigmas say that the sigmas are too small.
  double sigma_scale(const SolvedTrial& trial) const {
    double sum = 0.0;
    int count = 0;
    for (const auto& frame : sightings_.frames) {
      for (const TagSighting& s : frame) {
        sum += s.detection->sigma_px;
        ++count;
      }
    }
    // The median length of a two-dimensional error of unit sigma is 1.177.
    return count == 0 ? 1.0 : std::max(1.0, trial.median_px * count / (1.177 * sum));
  }

  SolvedTrial to_trial() const {
    SolvedTrial trial;
    measure_fit(trial);
    Motion& motion = trial.estimate.motion;
    motion.skeleton = make_humanoid(body_.proportions);
    motion.rate = sightings_.rate;
    motion.first_frame = sightings_.first_frame;
    for (const Posture& posture : postures_) {
      motion.poses.push_back(
          to_pose(posture, motion.skeleton, model_.lengths, model_.body));
    }
    std::array<std::vector<Source>, kHumanBoneCount> sources;
    for (const HumanBone bone : human_bones()) {
      sources[index(bone)] = sources_of(bone, trial.gaps);
    }
    const double scale = sigma_scale(trial);
    for (std::size_t f = 0; f < postures_.size(); ++f) {
      std::vector<JointDoubt> doubts(kHumanBoneCount);
      for (const HumanBone bone : human_bones()) {
        JointDoubt& doubt = doubts[index(bone)];
        doubt.source = sources[index(bone)][f];
        doubt.sigma_m = std::hypot(scale * sigmas_[f][index(bone)],
                                   body_.joint_centre_sigma_m[index(bone)]);
      }
      const bool solved =
          doubts[index(HumanBone::kHips)].source != Source::kInferred ||
          doubts[index(HumanBone::kUpperChest)].source != Source::kInferred;
      trial.frames_solved += solved;
      trial.estimate.doubt.push_back(std::move(doubts));
    }
    return trial;
  }

  const Body& body_;
  std::span<const Camera> cameras_;
  std::span<const CameraDetections> detections_;
  const SolveMotionOptions& options_;
  const Progress& progress_;
  BodyModel model_;
  std::vector<TagCluster> clusters_;
  Sightings sightings_;
  std::vector<double> offsets_s_;
  std::vector<bool> offset_given_;
  std::vector<Posture> postures_;
  std::vector<Velocities> velocities_;  ///< Per frame, per sighting.
  std::vector<BoneSigmas> sigmas_;
};

}  // namespace

Result<SolvedTrial> solve_motion(const Body& body,
                                 std::span<const Camera> cameras,
                                 std::span<const CameraDetections> detections,
                                 const SolveMotionOptions& options,
                                 const Progress& progress) {
  return TrialSolver(body, cameras, detections, options, progress).run();
}

}  // namespace marey::reconstruct
