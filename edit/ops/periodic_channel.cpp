// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/periodic_channel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/assert.h"
#include "core/transform.h"
#include "core/base/smooth_step.h"

namespace marey::edit {
namespace {

/// A side of the seam with fewer samples than this takes the other side's differences.
constexpr int kMinSeamSamples = 3;

glm::dvec3 channel_gap(const glm::dvec3& from, const glm::dvec3& to) {
  return to - from;
}
/// In the frame of `from`, the shorter way.
glm::dvec3 channel_gap(const glm::dquat& from, const glm::dquat& to) {
  glm::dquat q = glm::conjugate(from) * to;
  if (q.w < 0.0) q = -q;
  return rotation_vector(q);
}
glm::dvec3 displaced_by(const glm::dvec3& value, const glm::dvec3& by) {
  return value + by;
}
glm::dquat displaced_by(const glm::dquat& value, const glm::dvec3& by) {
  return glm::normalize(value * rotation_from_vector(by));
}

template <class Value>
class PeriodicChannel {
 public:
  PeriodicChannel(std::span<Value> channel, const CycleFrame& cycle)
      : channel_(channel), cycle_(cycle) {}

  void spread_gap() {
    const glm::dvec3 gap = channel_gap(first(0), last(0));
    for (int k = -cycle_.before; k < cycle_.frames + cycle_.after; ++k) {
      const double share = static_cast<double>(k) / cycle_.frames;
      first(k) = displaced_by(first(k), (0.5 - share) * gap);
    }
    // Without the rounding error of the two ways round.
    last(0) = first(0);
  }

  void blend_ends() {
    const int blend = std::clamp(cycle_.blend, 1, std::max(1, (cycle_.frames - 1) / 2));
    const int before = std::min(blend, cycle_.before);
    const int after = std::min(blend, cycle_.after - 1);
    const std::vector<glm::dvec3> left = differences(before, after, blend, -1);
    const std::vector<glm::dvec3> right = differences(after, before, blend, 1);
    blend_side(left, -1);
    blend_side(right, 1);
  }

 private:
  [[nodiscard]] Value& first(int k) {
    return channel_[static_cast<std::size_t>(cycle_.before + k)];
  }
  [[nodiscard]] Value& last(int k) { return first(cycle_.frames + k); }

  /// r at distances 1, 2, ... on one side of the seam (`sign` -1: before it), of which
  /// `own` are known there and `other` on the other side.
  std::vector<glm::dvec3> differences(int own, int other, int blend, int sign) {
    std::vector<glm::dvec3> out;
    const bool uses_own = own >= kMinSeamSamples || (own > 0 && own >= other);
    const int known = uses_own ? own : other;
    for (int k = 1; k <= known; ++k) {
      const int at = uses_own ? sign * k : -sign * k;
      const glm::dvec3 gap = channel_gap(first(at), last(at));
      out.push_back(uses_own ? gap : -gap);
    }
    if (known > 0) return out;
    const glm::dvec3 slope = slope_gap();
    for (int k = 1; k <= blend; ++k) out.push_back(static_cast<double>(sign * k) * slope);
    return out;
  }

  /// One-sided slopes, exact for parabolas, per sample.
  glm::dvec3 slope_gap() {
    const glm::dvec3 after =
        2.0 * channel_gap(first(0), first(1)) - 0.5 * channel_gap(first(0), first(2));
    const glm::dvec3 before =
        0.5 * channel_gap(last(0), last(-2)) - 2.0 * channel_gap(last(0), last(-1));
    return before - after;
  }

  void blend_side(const std::vector<glm::dvec3>& difference, int sign) {
    const int width = static_cast<int>(difference.size());
    for (int k = 1; k <= width; ++k) {
      const double share = width > 1 ? (k - 1.0) / (width - 1.0) : 0.0;
      const glm::dvec3 half = 0.5 * (1.0 - smooth_step(share)) *
                              difference[static_cast<std::size_t>(k - 1)];
      const int at = sign * k;
      if (cycle_.before + at >= 0) first(at) = displaced_by(first(at), half);
      if (at < cycle_.after) last(at) = displaced_by(last(at), -half);
    }
  }

  std::span<Value> channel_;
  CycleFrame cycle_;
};

template <class Value>
void make_any_periodic(std::span<Value> channel, const CycleFrame& cycle) {
  MAREY_ASSERT(cycle.frames >= 2 && cycle.blend >= 1 && cycle.before >= 0 &&
               cycle.after >= 1);
  MAREY_ASSERT(static_cast<int>(channel.size()) ==
               cycle.before + cycle.frames + cycle.after);
  PeriodicChannel<Value> periodic(channel, cycle);
  periodic.spread_gap();
  periodic.blend_ends();
}

}  // namespace

void make_periodic(std::span<glm::dvec3> channel, const CycleFrame& cycle) {
  make_any_periodic(channel, cycle);
}

void make_periodic(std::span<glm::dquat> channel, const CycleFrame& cycle) {
  make_any_periodic(channel, cycle);
}

}  // namespace marey::edit
