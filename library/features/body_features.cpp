// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/features/body_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "library/features/level_frame.h"

#include "core/base/assert.h"
#include "core/resample.h"

namespace marey::library {
namespace {

constexpr std::array kMovedPoints = {BodyPoint::kHead,
                                     BodyPoint::kLeftHand,
                                     BodyPoint::kRightHand,
                                     BodyPoint::kLeftAnkle,
                                     BodyPoint::kRightAnkle};
constexpr std::size_t kRateColumn = 3 * kBodyPointCount;
constexpr std::size_t kPathColumn = kRateColumn + 3 * kMovedPoints.size();
static_assert(kPathColumn + 3 == kFeatureCount);

constexpr double kRateWeight_s = 0.2;
constexpr double kPathWeight_s = 0.5;
constexpr double kTurnWeight_s = 0.8;

// Quantities of one instant from which the features of the neighbours follow.
struct FeatureInstant {
  LevelFrame frame;
  std::array<glm::dvec3, kBodyPointCount> points{};  // In the level frame. [L]
};

FeatureInstant instant_of(const BodyPoints& body,
                          std::span<const RigidTransform> world_from_joint) {
  FeatureInstant instant{level_frame(body, world_from_joint), {}};
  for (std::size_t k = 0; k < instant.points.size(); ++k) {
    const glm::dvec3 p = position(body, static_cast<BodyPoint>(k), world_from_joint);
    instant.points[k] = instant.frame.from_world(p) / body.leg_length_m;
  }
  return instant;
}

void put(const glm::dvec3& v, float* out) {
  for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(v[k]);
}

// Writes the row of `now`. Its neighbours are `before` and `after`, `span_s` apart; the
// same as `now` at an end of the motion.
void write_row(const FeatureInstant& before,
               const FeatureInstant& now,
               const FeatureInstant& after,
               double span_s,
               double leg_length_m,
               float* row) {
  for (std::size_t k = 0; k < now.points.size(); ++k) put(now.points[k], row + 3 * k);
  if (span_s <= 0.0) return;
  for (std::size_t k = 0; k < kMovedPoints.size(); ++k) {
    const std::size_t p = index(kMovedPoints[k]);
    put(kRateWeight_s / span_s * (after.points[p] - before.points[p]),
        row + kRateColumn + 3 * k);
  }
  const glm::dvec3 path =
      now.frame.turn_from_world(kPathWeight_s / (span_s * leg_length_m) *
                                (after.frame.origin - before.frame.origin));
  row[kPathColumn] = static_cast<float>(path.x);
  row[kPathColumn + 1] = static_cast<float>(path.z);
  const double turn = heading_change_rad(before.frame, now.frame) +
                      heading_change_rad(now.frame, after.frame);
  row[kPathColumn + 2] = static_cast<float>(kTurnWeight_s / span_s * turn);
}

void mirror_row(const float* in, float* out) {
  for (int k = 0; k < kBodyPointCount; ++k) {
    const auto from = 3 * index(mirrored(static_cast<BodyPoint>(k)));
    const auto to = 3 * static_cast<std::size_t>(k);
    out[to] = -in[from];
    out[to + 1] = in[from + 1];
    out[to + 2] = in[from + 2];
  }
  // Head, left and right hand, left and right ankle.
  constexpr std::array<std::size_t, kMovedPoints.size()> kOther = {0, 2, 1, 4, 3};
  for (std::size_t k = 0; k < kOther.size(); ++k) {
    const std::size_t from = kRateColumn + 3 * kOther[k];
    const std::size_t to = kRateColumn + 3 * k;
    out[to] = -in[from];
    out[to + 1] = in[from + 1];
    out[to + 2] = in[from + 2];
  }
  out[kPathColumn] = -in[kPathColumn];
  out[kPathColumn + 1] = in[kPathColumn + 1];
  out[kPathColumn + 2] = -in[kPathColumn + 2];
}

}  // namespace

BodyFeatures body_features(const Motion& motion, const retarget::BodyMap& map) {
  MAREY_ASSERT(motion.rate.hz > 0.0 && map.leg_length_m > 0.0);
  BodyFeatures features;
  if (motion.poses.empty()) return features;
  const Motion sampled = resample(motion, FrameRate{kFeatureRate_hz});
  const bool has_instant = !sampled.poses.empty();
  const std::span<const Pose> poses =
      has_instant ? std::span(sampled.poses) : std::span(motion.poses).first(1);
  if (has_instant) {
    features.start_s = std::max(
        0.0, sampled.first_frame / kFeatureRate_hz - motion.first_frame / motion.rate.hz);
  }
  const BodyPoints body = find_body_points(motion.skeleton, map);
  std::vector<RigidTransform> world_from_joint(motion.skeleton.joints.size());
  const auto instant = [&](std::size_t k) {
    world_from_joints(motion.skeleton, poses[k], world_from_joint);
    return instant_of(body, world_from_joint);
  };
  features.rows.assign(poses.size() * kFeatureStride, 0.0F);
  FeatureInstant before = instant(0);
  FeatureInstant now = before;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const bool is_last = k + 1 == poses.size();
    const FeatureInstant after = is_last ? now : instant(k + 1);
    const int steps = (k > 0 ? 1 : 0) + (is_last ? 0 : 1);
    write_row(before,
              now,
              after,
              steps / kFeatureRate_hz,
              body.leg_length_m,
              features.rows.data() + k * kFeatureStride);
    before = now;
    now = after;
  }
  return features;
}

std::vector<float> mirrored_features(std::span<const float> rows) {
  MAREY_ASSERT(rows.size() % kFeatureStride == 0);
  std::vector<float> out(rows.size(), 0.0F);
  for (std::size_t k = 0; k < rows.size(); k += kFeatureStride) {
    mirror_row(rows.data() + k, out.data() + k);
  }
  return out;
}

}  // namespace marey::library
