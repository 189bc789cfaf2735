// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/find_clock_offsets.h"

#include <cstddef>

#include "calib/rig/unconstrained_tags.h"

namespace marey::calib {

std::vector<ClockOffset> find_clock_offsets(std::span<const Camera> cameras,
                                            std::span<const CameraDetections> detections,
                                            const std::map<TagId, double>& sizes_m) {
  std::vector<double> start_s;
  for (const CameraDetections& camera : detections) {
    start_s.push_back(seconds(camera.offset.value_or(Timestamp{0})));
  }
  for (std::size_t c = start_s.size(); c-- > 0;) start_s[c] -= start_s.front();
  const SynchronizedDetections found =
      synchronize_detections(unconstrained_tags(cameras, detections, sizes_m), start_s);
  std::vector<ClockOffset> offsets;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    offsets.push_back({found.late_s[c], found.sigma_s[c]});
  }
  return offsets;
}

}  // namespace marey::calib
