// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/solve_markers.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "reconstruct/markers/marker_columns.h"
#include "reconstruct/markers/marker_filter.h"
#include "reconstruct/posture/posture_output.h"

namespace marey::reconstruct {
namespace {

// Frames that are smoothed at once, and the length of their look-ahead: several time
// constants of joint rotations, one of the hips' travel.
constexpr std::size_t kWindowFrames = 256;
constexpr double kLookAhead_s = 1.0;

// Interval in which the first posture is searched, if markers appear late. [s]
constexpr double kStart_s = 2.0;

struct FilteredFrame {
  PostureEstimate predicted;
  PostureEstimate filtered;
  bool is_relocalized = false;
};

using Frame = std::span<const std::optional<MarkerSample>>;

Frame frame_of(const MarkerTracks& tracks, std::size_t frame) {
  return Frame(tracks.samples).subspan(frame * tracks.markers(), tracks.markers());
}

/// Filters one take window by window, and smooths it backward.
class Batch {
 public:
  Batch(const Body& body, const MarkerTracks& tracks)
      : body_(&body),
        tracks_(&tracks),
        model_(to_marker_model(body)),
        columns_(find_columns(body, tracks.labels)),
        filter_(model_, tracks.rate) {
    seen_.reserve(model_.markers.size());
  }

  [[nodiscard]] bool start();
  void solve(const Progress& progress, SolvedMarkers& out);

 private:
  void emit(std::size_t frame,
            const FilteredFrame& here,
            const PostureEstimate& smoothed,
            SolvedMarkers& out);
  void measure(std::size_t frame, const UnfoldedPosture& unfolded, SolvedMarkers& out);

  const Body* body_;
  const MarkerTracks* tracks_;
  MarkerModel model_;
  MarkerColumns columns_;
  MarkerFilter filter_;
  std::vector<SeenMarker> seen_;
  std::array<PostureEstimate, 2> estimates_;
  PosturePrior prior_;
  PostureCovariance covariance_;
};

bool Batch::start() {
  const auto first_seconds = static_cast<std::size_t>(kStart_s * tracks_->rate.hz) + 1;
  std::size_t best = 0;
  std::size_t maximum = 0;
  for (std::size_t f = 0; f < tracks_->frames(); ++f) {
    // If markers appear late, the search extends to the first frame with enough of them.
    if (f >= first_seconds && maximum >= 6) break;
    collect(frame_of(*tracks_, f), columns_, seen_);
    if (seen_.size() > maximum) {
      maximum = seen_.size();
      best = f;
    }
  }
  if (maximum < 6) return false;
  collect(frame_of(*tracks_, best), columns_, seen_);
  filter_.start(MarkerPoseRelocalizer(model_).find(seen_).posture);
  return true;
}

void Batch::measure(std::size_t frame,
                    const UnfoldedPosture& unfolded,
                    SolvedMarkers& out) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t m = 0; m < model_.markers.size(); ++m) {
    const Eigen::Vector3d p =
        unfolded.point(model_.markers[m].bone, model_.markers[m].p_in_bone);
    glm::dvec3& modelled = out.modelled_in_world[frame * model_.markers.size() + m];
    modelled = {p.x(), p.y(), p.z()};
    if (!columns_[m]) continue;
    const auto& sample = tracks_->at(frame, *columns_[m]);
    if (!sample || sample->source != Source::kMeasured) continue;
    const double off = glm::length(sample->p_in_world - modelled);
    MarkerFit& fit = out.markers[m];
    fit.rms_m += off * off;
    fit.worst_m = std::max(fit.worst_m, off);
    fit.frames += 1;
    sum += off * off;
    count += 1;
  }
  out.frame_rms_m[frame] = count > 0 ? std::sqrt(sum / count) : 0.0;
}

void Batch::emit(std::size_t frame,
                 const FilteredFrame& here,
                 const PostureEstimate& smoothed,
                 SolvedMarkers& out) {
  filter_.process().from_others(here.predicted, here.filtered, smoothed, prior_);
  collect(frame_of(*tracks_, frame), columns_, seen_);
  Posture posture = smoothed.posture;
  (void)filter_.solver().solve(seen_, &prior_, posture, filter_.limits());
  filter_.solver().factor().covariance(covariance_);
  const UnfoldedPosture& unfolded = filter_.solver().unfold(posture);
  measure(frame, unfolded, out);
  to_pose(unfolded, out.estimate.motion.skeleton, out.estimate.motion.poses[frame]);
  std::array<double, kHumanBoneCount> sigmas{};
  joint_sigmas(unfolded, *body_, covariance_, sigmas);
  const BoneSources sources = sources_of(model_, frame_of(*tracks_, frame), columns_);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    out.estimate.uncertainty[frame][b] = {sigmas[b], sources[b]};
  }
}

void Batch::solve(const Progress& progress, SolvedMarkers& out) {
  const std::size_t frames = tracks_->frames();
  const auto ahead = std::max<std::size_t>(
      16, static_cast<std::size_t>(std::lround(kLookAhead_s * tracks_->rate.hz)));
  std::vector<FilteredFrame> window(
      std::min(frames, std::max(kWindowFrames, ahead) + ahead));
  std::size_t first = 0;  // The frame of window[0].
  std::size_t held = 0;   // Number of filtered frames from there on.
  while (first < frames) {
    while (held < window.size() && first + held < frames) {
      collect(frame_of(*tracks_, first + held), columns_, seen_);
      filter_.step(seen_);
      window[held].predicted = filter_.predicted();
      window[held].filtered = filter_.filtered();
      window[held].is_relocalized = filter_.is_relocalized();
      ++held;
    }
    const bool last = first + held == frames;
    const std::size_t final_frames = last ? held : held - ahead;
    // Backward through the window; final frames are solved once more.
    PostureEstimate* later = &estimates_[0];
    PostureEstimate* here = &estimates_[1];
    for (std::size_t i = held; i-- > 0;) {
      // Frames after a relocalization carry no information on those before it.
      if (i + 1 == held || window[i + 1].is_relocalized) {
        *here = window[i].filtered;
      } else {
        filter_.process().smooth(
            window[i].filtered, window[i + 1].predicted, *later, *here);
      }
      if (i < final_frames) emit(first + i, window[i], *here, out);
      std::swap(later, here);
    }
    std::move(window.begin() + static_cast<std::ptrdiff_t>(final_frames),
              window.begin() + static_cast<std::ptrdiff_t>(held),
              window.begin());
    first += final_frames;
    held -= final_frames;
    if (progress) progress(static_cast<int>(first), static_cast<int>(frames));
  }
}

/// Marks short intervals without markers of a bone's own, between frames with some, as
/// repaired.
void bridge(double max_repair_s, EstimatedMotion& estimate) {
  const auto longest =
      static_cast<std::size_t>(std::lround(max_repair_s * estimate.motion.rate.hz));
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    for (std::size_t f = 0; f < estimate.uncertainty.size();) {
      std::size_t end = f;
      while (end < estimate.uncertainty.size() &&
             estimate.uncertainty[end][b].source == Source::kInferred) {
        ++end;
      }
      if (end > f && f > 0 && end < estimate.uncertainty.size() && end - f <= longest) {
        for (std::size_t i = f; i < end; ++i) {
          estimate.uncertainty[i][b].source = Source::kRepaired;
        }
      }
      f = end + 1;
    }
  }
}

}  // namespace

std::optional<SolvedMarkers> solve_markers(const Body& body,
                                           const MarkerTracks& tracks,
                                           const SolveMarkersOptions& options,
                                           const Progress& progress) {
  MAREY_ASSERT(tracks.rate.hz > 0.0);
  Batch batch(body, tracks);
  if (!batch.start()) return std::nullopt;
  const std::size_t frames = tracks.frames();
  SolvedMarkers out;
  Motion& motion = out.estimate.motion;
  motion.skeleton = make_humanoid(body.proportions);
  motion.rate = tracks.rate;
  motion.first_frame = tracks.first_frame;
  motion.poses.resize(frames);
  out.estimate.uncertainty.assign(frames, std::vector<JointUncertainty>(kHumanBoneCount));
  out.markers.resize(body.markers.size());
  out.frame_rms_m.resize(frames);
  out.modelled_in_world.resize(frames * body.markers.size());
  batch.solve(progress, out);
  bridge(options.max_repair_s, out.estimate);

  double sum = 0.0;
  int count = 0;
  for (MarkerFit& fit : out.markers) {
    sum += fit.rms_m;
    count += fit.frames;
    fit.rms_m = fit.frames > 0 ? std::sqrt(fit.rms_m / fit.frames) : 0.0;
  }
  out.rms_m = count > 0 ? std::sqrt(sum / count) : 0.0;
  for (const auto& frame : out.estimate.uncertainty) {
    const auto known = [&](HumanBone bone) {
      return frame[index(bone)].source != Source::kInferred;
    };
    out.frames_solved += known(HumanBone::kHips) || known(HumanBone::kUpperChest);
  }
  return out;
}

struct MarkerTracker::Inside {
  Inside(const Body& whose, std::span<const std::string> labels, FrameRate rate)
      : body(whose),
        model(to_marker_model(body)),
        columns(find_columns(body, labels)),
        skeleton(make_humanoid(body.proportions)),
        label_count(labels.size()),
        filter(model, rate) {
    seen.reserve(model.markers.size());
  }
  Body body;
  MarkerModel model;
  MarkerColumns columns;
  Skeleton skeleton;
  std::size_t label_count;
  MarkerFilter filter;
  std::vector<SeenMarker> seen;
};

MarkerTracker::MarkerTracker(const Body& body,
                             std::span<const std::string> labels,
                             FrameRate rate)
    : inside_(std::make_unique<Inside>(body, labels, rate)) {
  MAREY_ASSERT(rate.hz > 0.0);
}
MarkerTracker::~MarkerTracker() = default;
MarkerTracker::MarkerTracker(MarkerTracker&&) noexcept = default;
MarkerTracker& MarkerTracker::operator=(MarkerTracker&&) noexcept = default;

const Skeleton& MarkerTracker::skeleton() const {
  return inside_->skeleton;
}

bool MarkerTracker::step(std::span<const std::optional<MarkerSample>> frame,
                         Pose& pose,
                         std::vector<JointUncertainty>& uncertainty) {
  Inside& in = *inside_;
  MAREY_ASSERT(frame.size() == in.label_count);
  collect(frame, in.columns, in.seen);
  in.filter.step(in.seen);
  if (!in.filter.started()) return false;
  const UnfoldedPosture& unfolded =
      in.filter.solver().unfold(in.filter.filtered().posture);
  to_pose(unfolded, in.skeleton, pose);
  std::array<double, kHumanBoneCount> sigmas{};
  joint_sigmas(unfolded, in.body, in.filter.covariance(), sigmas);
  const BoneSources sources = sources_of(in.model, frame, in.columns);
  uncertainty.resize(kHumanBoneCount);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    uncertainty[b] = {sigmas[b], sources[b]};
  }
  return true;
}

}  // namespace marey::reconstruct
