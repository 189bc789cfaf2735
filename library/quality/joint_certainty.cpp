// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/joint_certainty.h"

#include <algorithm>
#include <optional>

#include "library/quality/quality_frames.h"

namespace marey::library {
namespace {

bool is_measured(const LibraryMotion& clip, JointIndex joint) {
  return std::ranges::any_of(clip.uncertainty, [&](const auto& frame) {
    return frame[index(joint)].source != Source::kInferred;
  });
}

}  // namespace

std::array<FoundFigure, 3> measure_certainty(const LibraryMotion& clip,
                                             const retarget::BodyMap& map,
                                             const QualityLimits& limits) {
  FoundFigure share{"gap_share"};
  FoundFigure longest{"longest_gap_s"};
  FoundFigure sigma{"sigma_p95_mm"};
  const auto count = static_cast<int>(clip.uncertainty.size());
  std::vector<double> sigma_mm;
  sigma_mm.reserve(12 * clip.uncertainty.size());
  double inferred = 0.0;
  double all = 0.0;
  for (const HumanLimb& limb : human_limbs()) {
    for (const HumanBone bone : {limb.upper, limb.lower, limb.end}) {
      const auto joint = map.joint_of[marey::index(bone)];
      // A joint without markers, such as the arms of a gait lab, has no gaps.
      if (!joint || !is_measured(clip, *joint)) continue;
      int first = 0;
      for (int t = 0; t <= count; ++t) {
        const JointUncertainty* now =
            t < count ? &clip.uncertainty[static_cast<std::size_t>(t)][index(*joint)]
                      : nullptr;
        if (now != nullptr) {
          all += 1.0;
          sigma_mm.push_back(1000.0 * now->sigma_m);
          if (now->source == Source::kInferred) {
            inferred += 1.0;
            continue;
          }
        }
        const double run_s = (t - first) / clip.motion.rate.hz;
        if (t > first && run_s > longest.value) {
          longest.value = run_s;
          longest.bone = bone;
          longest.frames = FrameRange{first, t - 1};
        }
        if (t > first && run_s > limits["longest_gap_s"].warn) {
          longest.places.push_back({{first, t - 1}, bone, run_s});
        }
        first = t + 1;
      }
    }
  }
  if (all > 0.0) share.value = inferred / all;
  sigma.value = quantile_in_place(sigma_mm, 0.95);
  for (FoundFigure* whole : {&share, &sigma}) {
    if (whole->value <= limits[whole->name].warn) continue;
    whole->frames = FrameRange{0, std::max(0, count - 1)};
    whole->places.push_back({*whole->frames, std::nullopt, whole->value});
  }
  return {std::move(share), std::move(longest), std::move(sigma)};
}

}  // namespace marey::library
