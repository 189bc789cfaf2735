// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/pages/sample_report.h"

#include <string>
#include <vector>

#include "core/human/average_proportions.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app {
namespace {

/// A picture of 2 x 2 pixels would do; the page never decodes it in these tests.
const std::string kJpegStart = "\xFF\xD8\xFF\xE0";

ReportBody subject() {
  ReportBody body;
  body.name = "subject";
  body.motion = marey::testing::synthetic_walk(kFrames, 30.0).motion;
  const std::size_t joints = body.motion.skeleton.joints.size();
  for (int frame = 0; frame < kFrames; ++frame) {
    const auto source = frame < 20   ? Source::kMeasured
                        : frame < 30 ? Source::kRepaired
                                     : Source::kInferred;
    body.uncertainty.emplace_back(joints, JointUncertainty{0.001 * (frame + 1), source});
  }
  body.files = {"walk/motion.bvh", "javascript:alert(1)/<b>x.glb"};
  return body;
}

ReportBody avatar(const std::string& name) {
  ReportBody body = subject();
  body.name = name;
  body.uncertainty.clear();
  body.slide_before_cm_per_s = 12.3456;
  body.slide_after_cm_per_s = 0.1234;
  body.penetration_mm = 1.5;
  return body;
}

ReportTrial trial(const std::string& name) {
  ReportTrial out;
  out.name = name;
  out.rate = {30.0};
  out.first_frame = 5;
  out.frames = kFrames;
  out.frames_solved = 39;
  out.rms_px = 0.51239;
  out.median_px = 0.4;
  out.cameras = {{"left", 0.5, 0.3, 1000, 0.0, ClockSource::kReference, {12, 0}},
                 {kHostile, 0.6, 0.4, 900, 0.00731, ClockSource::kEstimated, {7, 2}}};
  out.frame_rms_px.assign(kFrames, 0.5);
  out.frame_rms_px[7] = 0.0;
  out.tags = {{41, "hips", std::vector<int>(kFrames, 2)},
              {42, kHostile, std::vector<int>(kFrames, 0)}};
  out.tags[1].cameras_seeing[3] = 1;
  out.gaps = {{"leftFoot", 25, 34, Source::kRepaired},
              {kHostile, 40, 44, Source::kInferred}};
  ReportPicture picture;
  picture.camera = kHostile;
  picture.frame = 12;
  picture.width_px = 640;
  picture.height_px = 360;
  picture.jpeg = kJpegStart;
  picture.bones = {{{10, 20}, {30, 40}, Source::kMeasured},
                   {{30, 40}, {50, 60}, Source::kInferred}};
  picture.tags = {{41, {{1, 2}, {3, 2}, {3, 4}, {1, 4}}}};
  out.pictures = {picture};
  out.bodies = {subject(), avatar(kHostile), avatar("robot")};
  return out;
}

}  // namespace

Report report() {
  Report out;
  out.session = kHostile;
  out.version = "0.1.0";
  for (const double x : {-2.0, 2.0}) {
    ReportCamera camera;
    camera.camera.name = x < 0 ? "left" : kHostile;
    camera.camera.intrinsics.width_px = 1280;
    camera.camera.intrinsics.height_px = 720;
    camera.camera.intrinsics.centre_px = {639.5, 359.5};
    // Looks along -Z from x, 1.5, 4: half a turn about X.
    camera.camera.camera_from_world =
        inverse(RigidTransform{{0.0, 1.0, 0.0, 0.0}, {x, 1.5, 4.0}});
    camera.quality.rms_px = 0.21;
    camera.quality.centre_sigma_m = 0.0012;
    camera.quality.focal_sigma_px = 0.8;
    camera.quality.coverage = 0.62;
    camera.quality.views = 51;
    out.cameras.push_back(camera);
  }
  out.calibration_rms_px = 0.2149;
  out.subject.emplace();
  out.subject->name = kHostile;
  out.subject->stature_m = 1.75;
  out.subject->proportions = average_proportions(1.75);
  out.subject->joint_centre_sigma_m.fill(0.002);
  out.subject->tags = {{{TagId{41}, HumanBone::kHips, 0.09}, {}, 0.0011, 0.01, 77}};
  out.subject_rms_px = 0.44;
  out.limb_ratio = 1.02;
  out.unplaced_tags = {99};
  out.trials = {trial("walk"), trial(kHostile)};
  out.timings = {{"tags", 3.0}, {kHostile, 1.0}};
  out.recorded_s = 2.0;
  out.findings = {
      fair_finding("unplaced", "", std::string("tag 99 was never seen ") + kHostile)};
  return out;
}

}  // namespace marey::app
