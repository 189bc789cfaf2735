// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/trial_residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/base/quantile.h"
#include "core/pose.h"
#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {
namespace {

constexpr double kStretch_s = 0.5;

/// One corner of one sighting.
struct CornerError {
  std::size_t camera = 0;
  std::size_t tag = 0;
  std::size_t frame = 0;
  glm::dvec2 error_px{0.0};       ///< Seen minus solved.
  glm::dvec2 velocity_px_s{0.0};  ///< Image velocity of the solved corner.
  double m_per_px = 0.0;
};

using Corners = std::array<glm::dvec3, 4>;

/// Computes the corners of every tag in one frame of the motion.
std::vector<Corners> corners_of(const Body& body, const Motion& motion, std::size_t f) {
  const auto world = world_from_joints(motion.skeleton, motion.poses[f]);
  std::vector<Corners> all;
  for (const PlacedTag& tag : body.tags) {
    const RigidTransform world_from_tag =
        world[index(solved_segment(tag.tag.segment))] * tag.segment_from_tag;
    Corners& corners = all.emplace_back();
    for (int i = 0; i < 4; ++i) {
      corners[static_cast<std::size_t>(i)] =
          world_from_tag * corner_in_tag(i, tag.tag.size_m);
    }
  }
  return all;
}

std::vector<TagOnSegment> worn(const Body& body) {
  std::vector<TagOnSegment> tags;
  for (const PlacedTag& tag : body.tags) tags.push_back(tag.tag);
  return tags;
}

/// Image position and velocity of a moving point, at the camera's own time.
struct Seen {
  glm::dvec2 pixel_px{0.0};
  glm::dvec2 velocity_px_s{0.0};
  double m_per_px = 0.0;
};

std::optional<Seen> seen_point(const Camera& camera,
                               const glm::dvec3& before,
                               const glm::dvec3& now,
                               const glm::dvec3& after,
                               double span_s,
                               double offset_s) {
  const auto at_before = project(camera, before);
  const auto at_now = project(camera, now);
  const auto at_after = project(camera, after);
  if (!at_before || !at_now || !at_after) return std::nullopt;
  Seen seen;
  if (span_s > 0.0) seen.velocity_px_s = (*at_after - *at_before) / span_s;
  seen.pixel_px = *at_now + offset_s * seen.velocity_px_s;
  seen.m_per_px = (camera.camera_from_world * now).z / camera.intrinsics.focal_px.x;
  return seen;
}

std::vector<CornerError> corner_errors(const Body& body,
                                       std::span<const Camera> cameras,
                                       std::span<const CameraDetections> detections,
                                       const SolvedTrial& solved) {
  const Motion& motion = solved.estimate.motion;
  const std::vector<TagOnSegment> tags = worn(body);
  const Sightings sightings = group_sightings(detections, tags);
  std::vector<CornerError> errors;
  const std::size_t frames = motion.poses.size();
  MAREY_ASSERT(sightings.frames.size() == frames);
  std::vector<Corners> before;
  std::vector<Corners> now = corners_of(body, motion, 0);
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<Corners> after = f + 1 < frames ? corners_of(body, motion, f + 1) : now;
    if (f == 0) before = now;
    const int steps = static_cast<int>(f > 0) + static_cast<int>(f + 1 < frames);
    for (const TagSighting& s : sightings.frames[f]) {
      const std::size_t c = index(s.camera);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto seen = seen_point(cameras[c],
                                     before[s.tag][i],
                                     now[s.tag][i],
                                     after[s.tag][i],
                                     steps / motion.rate.hz,
                                     solved.cameras[c].offset_s);
        if (!seen) continue;
        errors.push_back({c,
                          s.tag,
                          f,
                          s.detection->corners_px[i] - seen->pixel_px,
                          seen->velocity_px_s,
                          seen->m_per_px});
      }
    }
    before = std::exchange(now, std::move(after));
  }
  return errors;
}

class Sizes {
 public:
  void add(const CornerError& error) {
    all_m_.push_back(glm::length(error.error_px) * error.m_per_px);
  }
  [[nodiscard]] ResidualSize size() const {
    if (all_m_.empty()) return {};
    double sum = 0.0;
    for (const double m : all_m_) sum += m * m;
    return {std::sqrt(sum / static_cast<double>(all_m_.size())),
            median(all_m_),
            static_cast<int>(all_m_.size())};
  }

 private:
  std::vector<double> all_m_;
};

/// Finds the delay that explains most of a camera's errors, with outlier tags weighted
/// down.
void find_delay(std::span<const CornerError> errors,
                std::size_t camera,
                CameraResidual& out) {
  if (out.size.corners == 0) return;
  constexpr int kRounds = 5;
  const double usual_m = std::max(out.size.median_m, 1e-6);
  for (int round = 0; round < kRounds; ++round) {
    double by_velocity = 0.0;
    double velocity = 0.0;
    double squares = 0.0;
    double left = 0.0;
    for (const CornerError& e : errors) {
      if (e.camera != camera) continue;
      const glm::dvec2 rest_m = (e.error_px - out.late_s * e.velocity_px_s) * e.m_per_px;
      const double far = glm::length(rest_m) / (3.0 * usual_m);
      const double weight = e.m_per_px * e.m_per_px / (1.0 + far * far);
      by_velocity += weight * glm::dot(e.error_px, e.velocity_px_s);
      velocity += weight * glm::dot(e.velocity_px_s, e.velocity_px_s);
      squares += weight * glm::dot(e.error_px, e.error_px);
      left += weight * glm::dot(rest_m, rest_m) / (e.m_per_px * e.m_per_px);
    }
    out.explained = squares > 0.0 ? std::clamp(1.0 - left / squares, 0.0, 1.0) : 0.0;
    if (!(velocity > 0.0) || round + 1 == kRounds) return;
    out.late_s = by_velocity / velocity;
  }
}

}  // namespace

TrialResiduals trial_residuals(const Body& body,
                               std::span<const Camera> cameras,
                               std::span<const CameraDetections> detections,
                               const SolvedTrial& solved) {
  MAREY_ASSERT(cameras.size() == detections.size());
  MAREY_ASSERT(solved.cameras.size() == cameras.size());
  const auto errors = corner_errors(body, cameras, detections, solved);
  const Motion& motion = solved.estimate.motion;
  const auto stretch =
      static_cast<std::size_t>(std::max(1L, std::lround(kStretch_s * motion.rate.hz)));
  const std::size_t stretches = (motion.poses.size() + stretch - 1) / stretch;
  Sizes all;
  std::vector<Sizes> by_camera(cameras.size());
  std::vector<Sizes> by_tag(body.tags.size());
  std::vector<Sizes> by_time(stretches);
  for (const CornerError& error : errors) {
    all.add(error);
    by_camera[error.camera].add(error);
    by_tag[error.tag].add(error);
    by_time[error.frame / stretch].add(error);
  }
  TrialResiduals out;
  out.all = all.size();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    CameraResidual& camera = out.cameras.emplace_back();
    camera.size = by_camera[c].size();
    find_delay(errors, c, camera);
  }
  for (std::size_t t = 0; t < body.tags.size(); ++t) {
    out.tags.push_back({body.tags[t].tag.id, body.tags[t].tag.segment, by_tag[t].size()});
  }
  for (std::size_t i = 0; i < stretches; ++i) {
    const auto first = static_cast<int>(i * stretch);
    const auto end = static_cast<int>(std::min((i + 1) * stretch, motion.poses.size()));
    out.stretches.push_back(
        {motion.first_frame + first, motion.first_frame + end - 1, by_time[i].size()});
  }
  return out;
}

}  // namespace marey::reconstruct
