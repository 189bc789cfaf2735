// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/bundle/subject_bundle.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/base/quantile.h"

namespace marey::reconstruct {

SightingNoise SubjectBundle::noise(std::size_t tag,
                                   const Posture& posture,
                                   const UnfoldedPosture& unfolded) const {
  const HumanBone bone = model.bone(tag);
  SightingNoise noise{noise_scale, slips_m[index(bone)], Eigen::Vector3d::Zero()};
  const auto slide = slides.find(tag);
  if (slide != slides.end()) {
    noise.slide_m = slide->second.at(slide_angles(bone, posture, unfolded));
  }
  return noise;
}

void measure(SubjectBundle& bundle, std::span<const Camera> cameras) {
  std::vector<double> errors;
  double sum = 0.0;
  for (const BundleFrame& frame : bundle.frames) {
    for (const TagSighting& s : frame.sightings) {
      if (!bundle.model.place(s.tag)) continue;
      for (const double error :
           corner_errors_px(bundle.model, s, cameras, frame.posture)) {
        errors.push_back(error);
        sum += error * error;
      }
    }
  }
  if (errors.empty()) return;
  bundle.rms_px = std::sqrt(sum / static_cast<double>(errors.size()));
  bundle.median_px = median(std::move(errors));
}

}  // namespace marey::reconstruct
