// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/bone_lengths.h"

#include <algorithm>
#include <cmath>

#include "library/quality/quality_frames.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::library {

FoundFigure bone_length_range_mm(
    std::span<const std::vector<glm::dvec3>> parent_from_joint_m,
    std::span<const std::optional<HumanBone>> bones,
    double warn_mm) {
  MAREY_ASSERT(bones.empty() || bones.size() == parent_from_joint_m.size());
  FoundFigure out{"bones_mm"};
  std::vector<double> length_mm;
  std::vector<double> scratch;
  for (std::size_t b = 0; b < parent_from_joint_m.size(); ++b) {
    if (parent_from_joint_m[b].empty()) continue;
    length_mm.clear();
    for (const glm::dvec3& p : parent_from_joint_m[b]) {
      length_mm.push_back(1000.0 * glm::length(p));
    }
    const auto bone = bones.empty() ? std::nullopt : bones[b];
    const auto [low, high] = std::minmax_element(length_mm.begin(), length_mm.end());
    const double range_mm = *high - *low;
    scratch = length_mm;
    const double usual_mm = quantile_in_place(scratch, 0.5);
    if (range_mm > out.value) {
      out.value = range_mm;
      out.bone = bone;
      const auto worst = usual_mm - *low > *high - usual_mm ? low : high;
      const auto frame = static_cast<int>(worst - length_mm.begin());
      out.frames = FrameRange{frame, frame};
    }
    if (range_mm <= warn_mm) continue;
    std::vector<FoundPlace> places;
    for (std::size_t t = 0; t < length_mm.size(); ++t) {
      const double off_mm = std::abs(length_mm[t] - usual_mm);
      // Half of the range may be on either side of the median.
      if (off_mm <= 0.5 * warn_mm) continue;
      const auto frame = static_cast<int>(t);
      add_place(places, {{frame, frame}, bone, off_mm}, 2);
    }
    out.places.insert(out.places.end(), places.begin(), places.end());
  }
  std::stable_sort(
      out.places.begin(), out.places.end(), [](const auto& a, const auto& b) {
        return a.frames.first < b.frames.first;
      });
  return out;
}

FoundFigure bones_from_ignored_translation(double ignored_translation_m) {
  return {"bones_mm", 1000.0 * ignored_translation_m};
}

}  // namespace marey::library
