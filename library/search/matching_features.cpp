// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/search/matching_features.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "library/features/level_frame.h"
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr std::array<double, 3> kAhead_s = {1.0 / 3.0, 2.0 / 3.0, 1.0};
constexpr double kHalfAverage_s = 0.25;

struct MatchingGroup {
  int first = 0;
  int count = 0;
  double weight = 1.0;
};

constexpr std::array<MatchingGroup, 7> kGroups = {{{0, 3, 0.75},
                                                   {3, 3, 0.75},
                                                   {6, 3, 1.0},
                                                   {9, 3, 1.0},
                                                   {12, 3, 1.0},
                                                   {15, 6, 1.0},
                                                   {21, 6, 1.5}}};

// Points of all frames in the world, and the character's frame.
struct MatchingTracks {
  std::array<std::vector<glm::dvec3>, 3> points;  // Left ankle, right ankle, hips.
  std::vector<LevelFrame> characters;
};

// Averages place and facing over the frames around each one.
std::vector<LevelFrame> smoothed(const std::vector<LevelFrame>& frames, double hz) {
  const int count = static_cast<int>(frames.size());
  const int reach = static_cast<int>(std::lround(kHalfAverage_s * hz));
  std::vector<LevelFrame> out = frames;
  for (int k = 0; k < count; ++k) {
    // As many frames before as after: the average has no lag.
    const int here = std::min({reach, k, count - 1 - k});
    glm::dvec3 place(0.0);
    glm::dvec3 facing(0.0);
    for (int n = k - here; n <= k + here; ++n) {
      place += frames[static_cast<std::size_t>(n)].origin;
      facing += frames[static_cast<std::size_t>(n)].forward;
    }
    LevelFrame& to = out[static_cast<std::size_t>(k)];
    to.origin = place / (2.0 * here + 1.0);
    const double length = glm::length(facing);
    if (length < 1e-6) continue;
    to.forward = facing / length;
    to.across = glm::cross(glm::dvec3(0.0, 1.0, 0.0), to.forward);
  }
  return out;
}

MatchingTracks matching_tracks(const Motion& motion, const retarget::BodyMap& map) {
  const BodyPoints body = find_body_points(motion.skeleton, map);
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  std::vector<LevelFrame> frames;
  MatchingTracks tracks;
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    tracks.points[0].push_back(position(body, BodyPoint::kLeftAnkle, world));
    tracks.points[1].push_back(position(body, BodyPoint::kRightAnkle, world));
    tracks.points[2].push_back(position(body, BodyPoint::kHips, world));
    frames.push_back(level_frame(body, world));
  }
  tracks.characters = smoothed(frames, motion.rate.hz);
  return tracks;
}

glm::dvec3 velocity_at(const std::vector<glm::dvec3>& track, std::size_t k, double hz) {
  const std::size_t a = k == 0 ? 0 : k - 1;
  const std::size_t b = std::min(k + 1, track.size() - 1);
  if (a == b) return glm::dvec3(0.0);
  return (track[b] - track[a]) * (hz / static_cast<double>(b - a));
}

void put_matching(const glm::dvec3& v, float* out) {
  for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(v[c]);
}

void put_level(const glm::dvec3& v, float* out) {
  out[0] = static_cast<float>(v.x);
  out[1] = static_cast<float>(v.z);
}

void write_matching_row(const MatchingTracks& tracks,
                        std::size_t k,
                        double hz,
                        float* row) {
  const LevelFrame& character = tracks.characters[k];
  put_matching(character.from_world(tracks.points[0][k]), row);
  put_matching(character.from_world(tracks.points[1][k]), row + 3);
  for (std::size_t p = 0; p < 3; ++p) {
    put_matching(character.turn_from_world(velocity_at(tracks.points[p], k, hz)),
                 row + 6 + 3 * p);
  }
  for (std::size_t a = 0; a < kAhead_s.size(); ++a) {
    const auto ahead = static_cast<std::size_t>(std::lround(kAhead_s[a] * hz));
    const std::size_t then = std::min(k + ahead, tracks.characters.size() - 1);
    put_level(character.from_world(tracks.characters[then].origin), row + 15 + 2 * a);
    put_level(character.turn_from_world(tracks.characters[then].forward),
              row + 21 + 2 * a);
  }
}

}  // namespace

std::vector<float> matching_features(const Motion& motion, const retarget::BodyMap& map) {
  MAREY_ASSERT(motion.rate.hz > 0.0);
  const MatchingTracks tracks = matching_tracks(motion, map);
  std::vector<float> out(motion.poses.size() * kMatchingCount);
  for (std::size_t k = 0; k < motion.poses.size(); ++k) {
    write_matching_row(tracks, k, motion.rate.hz, out.data() + k * kMatchingCount);
  }
  return out;
}

void MatchingStatistics::add(std::span<const float> features) {
  MAREY_ASSERT(features.size() % kMatchingCount == 0);
  for (std::size_t row = 0; row < features.size(); row += kMatchingCount) {
    count_ += 1.0;
    for (std::size_t c = 0; c < kMatchingCount; ++c) {
      const double value = static_cast<double>(features[row + c]);
      const double off = value - mean_[c];
      mean_[c] += off / count_;
      squares_[c] += off * (value - mean_[c]);
    }
  }
}

MatchingScale MatchingStatistics::scale() const {
  MatchingScale out;
  out.scale.fill(1.0F);
  if (count_ <= 0.0) return out;
  for (const MatchingGroup& group : kGroups) {
    double sum = 0.0;
    for (int k = 0; k < group.count; ++k) {
      const auto c = static_cast<std::size_t>(group.first + k);
      out.offset[c] = static_cast<float>(mean_[c]);
      sum += std::sqrt(squares_[c] / count_);
    }
    const double scale = sum / group.count / group.weight;
    if (!(scale > 1e-9)) continue;
    for (int k = 0; k < group.count; ++k) {
      out.scale[static_cast<std::size_t>(group.first + k)] = static_cast<float>(scale);
    }
  }
  return out;
}

}  // namespace marey::library
