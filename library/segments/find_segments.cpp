// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/segments/find_segments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "library/features/body_features.h"
#include "library/quality/quality_frames.h"
#include "library/segments/novelty.h"
#include "library/segments/still_frames.h"

#include "core/base/assert.h"

namespace marey::library {
namespace {

constexpr double kMinStill_s = 0.5;
constexpr double kKeptStill_s = 0.25;
constexpr double kMinLabel_s = 0.1;
constexpr double kMinCycle_s = 0.4;
constexpr double kMaxCycle_s = 3.0;

std::vector<FrameRange> by_labels(std::span<const ClipLabel> labels,
                                  int count,
                                  double hz) {
  std::vector<FrameRange> out;
  for (const ClipLabel& label : labels) {
    if (label.by == "marey" || label.end_s - label.start_s < kMinLabel_s) continue;
    const double first = std::round(label.start_s * hz);
    const double last = std::round(label.end_s * hz);
    if (first > count - 1 || last < 0.0) continue;
    out.push_back({static_cast<int>(std::max(0.0, first)),
                   static_cast<int>(std::min<double>(count - 1, last))});
  }
  const auto key = [](const FrameRange& r) { return std::tie(r.first, r.last); };
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    return key(a) < key(b);
  });
  out.erase(std::unique(out.begin(),
                        out.end(),
                        [&](const auto& a, const auto& b) { return key(a) == key(b); }),
            out.end());
  return out;
}

std::vector<FrameRange> by_stillness(const QualityFrames& frames) {
  const auto kept = static_cast<int>(std::lround(kKeptStill_s * frames.hz));
  std::vector<FrameRange> out;
  int first = 0;
  for (const FrameRange& still : runs_of(still_frames(frames), frames.hz, kMinStill_s)) {
    if (still.first > 0) out.push_back({first, still.first + kept - 1});
    first = std::max(still.last - kept + 1, still.first + kept);
    if (still.last == frames.count - 1) return out;
  }
  out.push_back({first, frames.count - 1});
  return out;
}

std::vector<FrameRange> by_change(const Motion& motion, const retarget::BodyMap& map) {
  const BodyFeatures features = body_features(motion, map);
  const auto last = static_cast<int>(motion.poses.size()) - 1;
  std::vector<FrameRange> out;
  int first = 0;
  for (const int row : find_changes(features.rows)) {
    const double time_s = features.start_s + (row - 0.5) / kFeatureRate_hz;
    const int next = static_cast<int>(std::ceil(time_s * motion.rate.hz - 1e-9));
    if (next <= first || next > last) continue;
    out.push_back({first, next - 1});
    first = next;
  }
  out.push_back({first, last});
  return out;
}

}  // namespace

std::vector<int> find_strikes(const std::vector<FootParts>& contacts, int side) {
  const auto heel = static_cast<std::size_t>(2 * side);
  const auto bears = [&](std::size_t t) {
    return contacts[t][heel] != 0 || contacts[t][heel + 1] != 0;
  };
  std::vector<int> out;
  for (std::size_t t = 1; t < contacts.size(); ++t) {
    if (bears(t) && !bears(t - 1)) out.push_back(static_cast<int>(t));
  }
  return out;
}

std::vector<FrameRange> find_cycles(const std::vector<FootParts>& contacts, double hz) {
  const std::vector<int> left = find_strikes(contacts, 0);
  const std::vector<int> right = find_strikes(contacts, 1);
  std::vector<FrameRange> out;
  for (std::size_t k = 0; k + 1 < left.size(); ++k) {
    const double length_s = (left[k + 1] - left[k]) / hz;
    if (length_s < kMinCycle_s || length_s > kMaxCycle_s) continue;
    const auto other = std::lower_bound(right.begin(), right.end(), left[k]);
    if (other == right.end() || *other >= left[k + 1]) continue;
    out.push_back({left[k], left[k + 1] - 1});
  }
  return out;
}

std::vector<FrameRange> find_segments(const LibraryMotion& motion,
                                      const retarget::BodyMap& map,
                                      SegmentBy by,
                                      std::span<const ClipLabel> labels) {
  const auto count = static_cast<int>(motion.motion.poses.size());
  const double hz = motion.motion.rate.hz;
  MAREY_ASSERT(count > 0 && motion.contacts.size() == motion.motion.poses.size());
  switch (by) {
    case SegmentBy::kNone:
      break;
    case SegmentBy::kLabels:
      return by_labels(labels, count, hz);
    case SegmentBy::kStillness:
      return by_stillness(quality_frames(motion.motion, map));
    case SegmentBy::kSteps:
      return find_cycles(motion.contacts, hz);
    case SegmentBy::kChange:
      return by_change(motion.motion, map);
  }
  return {{0, count - 1}};
}

}  // namespace marey::library
