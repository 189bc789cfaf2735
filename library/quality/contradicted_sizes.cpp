// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/contradicted_sizes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "library/quality/quality_frames.h"

namespace marey::library {
namespace {

constexpr double kSameProportions = 0.001;
constexpr double kSameSize = 1.01;
constexpr std::size_t kMinClips = 3;

double ratio_of_sizes(double a, double b) {
  return std::max(a / b, b / a);
}

void compare_group(std::span<const ClipBody> clips,
                   std::span<const std::size_t> group,
                   std::vector<ContradictedSize>& out) {
  if (group.size() < kMinClips) return;
  std::vector<double> statures_m;
  for (const std::size_t k : group) statures_m.push_back(clips[k].stature_m);
  const double usual_m = quantile_in_place(statures_m, 0.5);
  const auto agreeing = static_cast<std::size_t>(
      std::count_if(group.begin(), group.end(), [&](std::size_t k) {
        return ratio_of_sizes(clips[k].stature_m, usual_m) <= kSameSize;
      }));
  if (2 * agreeing <= group.size()) return;
  for (const std::size_t k : group) {
    if (ratio_of_sizes(clips[k].stature_m, usual_m) <= kMaxSizeRatio) continue;
    out.push_back({k, clips[k].stature_m / usual_m, usual_m, agreeing});
  }
}

}  // namespace

ClipBody body_of(const ClipRecord& record) {
  ClipBody out{record.provenance.subject};
  for (const ClipFigure& figure : record.figures) {
    if (figure.name == "stature_m") out.stature_m = figure.value;
    if (figure.name == "proportions") out.proportions = figure.value;
  }
  return out;
}

std::vector<ContradictedSize> find_contradicted_sizes(std::span<const ClipBody> clips) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < clips.size(); ++k) {
    if (clips[k].stature_m <= 0.0) continue;
    if (clips[k].subject.empty() && clips[k].proportions == 0.0) continue;
    order.push_back(k);
  }
  const auto key = [&](std::size_t k) {
    const ClipBody& clip = clips[k];
    return std::tuple(clip.subject, clip.subject.empty() ? clip.proportions : 0.0, k);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return key(a) < key(b);
  });
  std::vector<ContradictedSize> out;
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    const ClipBody& start = clips[order[first]];
    for (; end < order.size(); ++end) {
      const ClipBody& next = clips[order[end]];
      if (next.subject != start.subject) break;
      if (start.subject.empty() &&
          next.proportions - start.proportions > kSameProportions) {
        break;
      }
    }
    compare_group(clips, std::span(order).subspan(first, end - first), out);
    first = end;
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return a.clip < b.clip;
  });
  return out;
}

ClipProblem problem_of(const ContradictedSize& size, int frame_count) {
  return {
      {0, std::max(0, frame_count - 1)}, "scale", "", ratio_of_sizes(size.ratio, 1.0)};
}

}  // namespace marey::library
