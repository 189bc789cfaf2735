// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/track_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/assert.h"
#include "reconstruct/clusters/sightings.h"
#include "reconstruct/posture/point_sigma.h"
#include "reconstruct/posture/posture_output.h"
#include "reconstruct/tags/tag_filter.h"

namespace marey::reconstruct {
namespace {

// Corners further out are ignored. [px]
constexpr double kMaxDistance_px = 1e5;

bool is_sane(const TagDetection& tag) {
  if (!std::isfinite(tag.sigma_px) || !(tag.sigma_px > 1e-3)) return false;
  return std::all_of(
      tag.corners_px.begin(), tag.corners_px.end(), [](const glm::dvec2& corner) {
        return std::abs(corner.x) < kMaxDistance_px &&
               std::abs(corner.y) < kMaxDistance_px;
      });
}

std::vector<bool> all_known(const TrackBodyOptions& options, std::size_t cameras) {
  std::vector<bool> known = options.lag_known;
  while (known.size() < cameras) known.push_back(known.empty());
  return known;
}

bool is_trunk(HumanBone bone) {
  return bone == HumanBone::kHips || bone == HumanBone::kSpine ||
         bone == HumanBone::kChest || bone == HumanBone::kUpperChest;
}

}  // namespace

struct BodyTracker::Inside {
  Inside(const Body& whose,
         std::span<const Camera> cameras,
         FrameRate frame_rate,
         const TrackBodyOptions& how)
      : body(whose),
        options(how),
        model(to_tag_model(body, cameras)),
        skeleton(make_humanoid(body.proportions)),
        filter(model, frame_rate, all_known(how, cameras.size())),
        late_s(cameras.size(), 0.0) {
    seen.reserve(model.tags.size() * cameras.size());
    unseen_s.fill(std::numeric_limits<double>::infinity());
  }

  void collect(std::span<const CameraView> views);
  void update_report(double since_s);
  void fill_uncertainty(const UnfoldedPosture& unfolded,
                        std::vector<JointUncertainty>& uncertainty) const;

  Body body;
  TrackBodyOptions options;
  TagModel model;
  Skeleton skeleton;
  TagFilter filter;
  std::vector<SeenTag> seen;
  std::vector<double> late_s;
  /// Per bone, the time since one of its tags was used. [s]
  std::array<double, kHumanBoneCount> unseen_s{};
  TrackReport report;
};

/// Collects the frame's tags of the body, by tag and camera.
void BodyTracker::Inside::collect(std::span<const CameraView> views) {
  seen.clear();
  for (std::size_t c = 0; c < views.size(); ++c) {
    late_s[c] = std::isfinite(views[c].late_s) ? views[c].late_s : 0.0;
    for (const TagDetection& detection : views[c].tags) {
      const auto tag =
          std::lower_bound(model.tags.begin(),
                           model.tags.end(),
                           detection.id,
                           [](const ModelTag& t, TagId id) { return t.tag.id < id; });
      if (tag == model.tags.end() || tag->tag.id != detection.id) continue;
      if (!is_sane(detection) || seen.size() == seen.capacity()) continue;
      seen.push_back(
          {static_cast<std::size_t>(tag - model.tags.begin()), c, detection, 1.0});
    }
  }
  for (SeenTag& one : seen) {
    one.cameras = static_cast<double>(std::count_if(
        seen.begin(), seen.end(), [&](const SeenTag& s) { return s.tag == one.tag; }));
  }
}

/// Updates the report and the tracking state from the fit of the frame's sightings.
void BodyTracker::Inside::update_report(double since_s) {
  const std::span<const SightingFit> fits = filter.fits();
  report = {};
  for (double& unseen : unseen_s) unseen += since_s;
  double squares_px2 = 0.0;
  double trunk_s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!TagFilter::is_used(fits[i])) {
      ++report.tags_rejected;
      continue;
    }
    ++report.tags_used;
    squares_px2 += fits[i].rms_px * fits[i].rms_px;
    unseen_s[index(model.tags[seen[i].tag].bone)] = 0.0;
  }
  if (report.tags_used > 0) report.rms_px = std::sqrt(squares_px2 / report.tags_used);
  for (const HumanBone bone : human_bones()) {
    if (is_trunk(bone)) trunk_s = std::min(trunk_s, unseen_s[index(bone)]);
  }
  const bool lost =
      trunk_s > options.max_repair_s || filter.unexplained_s() > options.max_repair_s;
  report.state = lost ? TrackState::kLost : TrackState::kTracked;
  if (lost) filter.relocalize();
}

void BodyTracker::Inside::fill_uncertainty(
    const UnfoldedPosture& unfolded, std::vector<JointUncertainty>& uncertainty) const {
  std::array<double, kHumanBoneCount> sigmas{};
  joint_sigmas(unfolded, body, filter.covariance(), sigmas);
  uncertainty.resize(kHumanBoneCount);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    Source source = Source::kInferred;
    if (unseen_s[b] <= options.max_repair_s) source = Source::kRepaired;
    if (unseen_s[b] == 0.0) source = Source::kMeasured;
    if (report.state == TrackState::kLost) source = Source::kInferred;
    const double sigma_m = std::hypot(sigmas[b], options.camera_sigma_m);
    uncertainty[b] = {
        sigma_m, source_of_joint(human_bones()[b], source, sigma_m), source};
  }
}

Result<BodyTracker> BodyTracker::create(const Body& body,
                                        std::span<const Camera> cameras,
                                        FrameRate rate,
                                        const TrackBodyOptions& options) {
  MAREY_ASSERT(rate.hz > 0.0);
  MAREY_ASSERT(options.lag_known.size() <= cameras.size());
  if (body.tags.empty()) {
    return bad_input(body.name,
                     "the body has no tags to track",
                     "fit the subject again from trials that show its tags");
  }
  if (cameras.empty()) {
    return bad_input(body.name, "there is no camera", "calibrate the cameras");
  }
  return BodyTracker(std::make_unique<Inside>(body, cameras, rate, options));
}

BodyTracker::BodyTracker(std::unique_ptr<Inside> inside) : inside_(std::move(inside)) {}
BodyTracker::~BodyTracker() = default;
BodyTracker::BodyTracker(BodyTracker&&) noexcept = default;
BodyTracker& BodyTracker::operator=(BodyTracker&&) noexcept = default;

const TrackReport& BodyTracker::last() const {
  return inside_->report;
}

std::span<const double> BodyTracker::lags_s() const {
  return inside_->filter.lags().lags_s();
}

const Skeleton& BodyTracker::skeleton() const {
  return inside_->skeleton;
}

bool BodyTracker::step(std::span<const CameraView> views,
                       double since_last_s,
                       Pose& pose,
                       std::vector<JointUncertainty>& uncertainty) {
  Inside& in = *inside_;
  MAREY_ASSERT(views.size() == in.late_s.size());
  MAREY_ASSERT(std::isfinite(since_last_s) && since_last_s > 0.0);
  in.collect(views);
  in.filter.step(in.seen, in.late_s, since_last_s);
  if (!in.filter.started()) return false;
  in.update_report(since_last_s);
  const UnfoldedPosture& unfolded = in.filter.unfold(in.filter.filtered().posture);
  to_pose(unfolded, in.skeleton, pose);
  in.fill_uncertainty(unfolded, uncertainty);
  return true;
}

}  // namespace marey::reconstruct
