// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Measures the errors of a calibration.
//
//   measure_calibration wand ../shared/data/camera/tagslam_tracks/test_4
//   measure_calibration room ../shared/data/camera/tagslam_tracks/test_5
//   measure_calibration rendered ../shared/data/blender/dev
//   measure_calibration stereo ../shared/data/camera/opencv_samples
//   measure_calibration webcams ../shared/data/camera/caliscope/sessions/4_cam_recording
#include <cstdio>
#include <string>

#include <glm/geometric.hpp>

#include "benchmarks/calibration/calibration_cases.h"
#include "core/base/degrees.h"

namespace marey::calib {

void print_rig(const CalibratedRig& rig) {
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const Intrinsics& k = rig.cameras[c].intrinsics;
    const CameraQuality& q = rig.quality[c];
    const glm::dvec3 centre = centre_in_world(rig.cameras[c]);
    std::printf(
        "%-14s f %8.2f %8.2f +- %.2f  c %8.2f %8.2f  k %7.4f %7.4f %7.4f %7.4f %7.4f  at "
        "%7.4f %7.4f %7.4f +- %.2f mm  rms %.3f p95 %.3f px, %d corners\n",
        rig.cameras[c].name.c_str(),
        k.focal_px.x,
        k.focal_px.y,
        q.focal_sigma_px,
        k.centre_px.x,
        k.centre_px.y,
        k.distortion[0],
        k.distortion[1],
        k.distortion[2],
        k.distortion[3],
        k.distortion[4],
        centre.x,
        centre.y,
        centre.z,
        1e3 * q.centre_sigma_m,
        q.rms_px,
        q.p95_px,
        q.corners);
  }
  std::printf(
      "all: rms %.3f px, median %.3f px, without outliers %.3f px; %d of %d "
      "sightings are outliers; sigmas are %.2f times those of independent corners\n",
      rig.rms_px,
      rig.median_px,
      rig.inlier_rms_px,
      rig.outliers,
      rig.sightings,
      rig.sigma_factor);
}

void print_cross_validation(const CalibratedRig& rig) {
  if (!rig.cross_validation) return;
  const CrossValidation& v = *rig.cross_validation;
  std::printf("even frames %.3f px, held-out odd frames %.3f px\n",
              v.seen_rms_px,
              v.held_out_rms_px);
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    std::printf("  %s: odd less even: centre %.2f mm, turn %.4f deg, focal %+.2f px",
                rig.cameras[c].name.c_str(),
                1e3 * v.centre_apart_m[c],
                kDegreesPerRadian * v.turn_apart_rad[c],
                v.focal_apart_px[c]);
    if (v.held_out_camera_px[c]) {
      std::printf("; held-out camera: median %.3f px", *v.held_out_camera_px[c]);
    }
    std::printf("\n");
  }
}

}  // namespace marey::calib

int main(int argc, char** argv) {
  using namespace marey::calib;
  const std::string what = argc > 2 ? argv[1] : "";
  if (what == "wand") return measure_wand(argv[2]);
  if (what == "room") return measure_room(argv[2]);
  if (what == "rendered") return measure_rendered(argv[2]);
  if (what == "stereo") return measure_stereo(argv[2]);
  if (what == "webcams") return measure_webcams(argv[2]);
  std::fprintf(stderr, "measure_calibration wand|room|rendered|stereo|webcams FOLDER\n");
  return 2;
}
