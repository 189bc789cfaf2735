// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/live/live_trails.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <utility>

#include "reconstruct/tags/track_body.h"
#include "tests/support/truth/motion_delay.h"

namespace marey::benchmarks {
namespace {

constexpr double kKnown_m = 0.02;

/// Which pictures are passed over.
struct Pattern {
  const char* name;
  std::function<bool(std::size_t frame, std::size_t camera)> is_passed_over;
};

std::vector<Pattern> patterns(std::size_t frames, std::size_t cameras) {
  std::mt19937 dice(11);
  std::vector<bool> heads;
  for (std::size_t i = 0; i < frames * cameras; ++i) heads.push_back(dice() % 2 == 0);
  return {{"all pictures", [](std::size_t, std::size_t) { return false; }},
          {"half at random",
           [=](std::size_t frame, std::size_t camera) {
             return bool{heads[frame * cameras + camera]};
           }},
          {"every second instant",
           [](std::size_t frame, std::size_t) { return frame % 2 == 1; }},
          {"cameras by turns", [](std::size_t frame, std::size_t camera) {
             return frame % 2 != camera % 2;
           }}};
}

/// Returns the place of a joint between frames, on a cubic through the four nearest
/// frames. nullopt if one of them is missing.
std::optional<glm::dvec3> place_at(const testing::TruthJoints& truth,
                                   HumanBone bone,
                                   double frame) {
  const int before = static_cast<int>(std::floor(frame));
  const double u = frame - before;
  std::array<glm::dvec3, 4> p{};
  for (int i = 0; i < 4; ++i) {
    const auto found = truth.find({before - 1 + i, bone});
    if (found == truth.end()) return std::nullopt;
    p[static_cast<std::size_t>(i)] = found->second;
  }
  return p[1] + 0.5 * u *
                    (p[2] - p[0] +
                     u * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3] +
                          u * (3.0 * (p[1] - p[2]) + p[3] - p[0])));
}

/// By how much the body trails the frames' instants. [ms]
Result<double> trail_ms(const Body& body,
                        std::span<const Camera> cameras,
                        const testing::TruthJoints& truth,
                        std::span<const CameraDetections> detections,
                        const Pattern& pattern) {
  const double hz = detections.front().rate.hz;
  reconstruct::TrackBodyOptions options;
  options.lag_known.assign(cameras.size(), false);
  auto tracker =
      reconstruct::BodyTracker::create(body, cameras, detections.front().rate, options);
  if (!tracker) return tracker.error();
  std::map<HumanBone, std::vector<testing::TimedPlace>> found;
  Pose pose;
  std::vector<JointUncertainty> uncertainty;
  std::vector<reconstruct::CameraView> views(detections.size());
  int last = -1;
  for (std::size_t f = 0; f < detections.front().frames.size(); ++f) {
    bool any = false;
    for (std::size_t c = 0; c < detections.size(); ++c) {
      views[c].tags = {};
      if (pattern.is_passed_over(f, c) || f >= detections[c].frames.size()) continue;
      views[c].tags = detections[c].frames[f].tags;
      any = true;
    }
    if (!any) continue;
    const int frame = static_cast<int>(f);
    const bool is_found = tracker->step(views, (frame - last) / hz, pose, uncertainty);
    last = frame;
    // Lags are looked for in the first second; shifts need truth on both sides.
    if (!is_found || frame < hz || f + 5 > detections.front().frames.size()) continue;
    const auto world = world_from_joints(tracker->skeleton(), pose);
    for (const HumanBone bone : human_bones()) {
      if (!truth.contains({frame, bone})) continue;
      if (uncertainty[index(bone)].sigma_m >= kKnown_m) continue;
      found[bone].push_back({frame / hz, world[index(bone)].translation});
    }
  }
  std::vector<HumanBone> bones;
  std::vector<std::vector<testing::TimedPlace>> places;
  for (auto& [bone, list] : found) {
    bones.push_back(bone);
    places.push_back(std::move(list));
  }
  const auto true_place = [&](std::size_t joint, double time_s) {
    return place_at(truth, bones[joint], hz * time_s).value_or(glm::dvec3(0.0));
  };
  return 1e3 * testing::delay_s(places, true_place);
}

}  // namespace

Result<std::vector<LiveTrail>> live_trails(const Body& body,
                                           std::span<const Camera> cameras,
                                           const testing::TruthJoints& truth,
                                           std::span<const CameraDetections> detections) {
  std::vector<LiveTrail> out;
  for (const Pattern& pattern :
       patterns(detections.front().frames.size(), detections.size())) {
    const auto trail = trail_ms(body, cameras, truth, detections, pattern);
    if (!trail) return trail.error();
    out.push_back({pattern.name, *trail});
  }
  return out;
}

}  // namespace marey::benchmarks
