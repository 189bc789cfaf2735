// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/report_trial.h"

#include <algorithm>
#include <string>

#include "app/process/draw_frames.h"

namespace marey::app {

Result<ReportTrial> report_trial(const recordings::Trial& trial,
                                 std::span<const Camera> cameras,
                                 std::span<const TagOnSegment> tags,
                                 std::span<const CameraDetections> detections,
                                 const reconstruct::SolvedTrial& solved) {
  const Motion& poses = solved.estimate.motion;
  ReportTrial out;
  out.name = trial.name;
  out.rate = poses.rate;
  out.first_frame = poses.first_frame;
  out.frames = static_cast<int>(poses.poses.size());
  out.frames_solved = solved.frames_solved;
  out.rms_px = solved.rms_px;
  out.median_px = solved.median_px;
  out.frame_rms_px = solved.frame_rms_px;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const reconstruct::CameraFit& fit = solved.cameras[c];
    out.cameras.push_back({cameras[c].name,
                           fit.rms_px,
                           fit.median_px,
                           fit.corners,
                           fit.offset_s,
                           fit.clock,
                           detections[c].dropped});
  }
  for (const reconstruct::Gap& gap : solved.gaps) {
    out.gaps.push_back({std::string(name(gap.segment)),
                        gap.first_frame,
                        gap.last_frame,
                        gap.bridged_as});
  }
  out.tags = tags_over_time(tags, detections, poses);
  for (const reconstruct::TagFit& fit : solved.tag_fits) {
    const auto tag = std::ranges::find(out.tags, number(fit.id), &ReportTag::id);
    if (tag == out.tags.end() || fit.corners == 0) continue;
    tag->rms_px = fit.rms_px;
    tag->median_px = fit.median_px;
    tag->corners = fit.corners;
  }
  auto pictures = draw_frames(trial, cameras, detections, solved.estimate);
  if (!pictures) return pictures.error();
  out.pictures = std::move(*pictures);
  ReportBody& subject = out.bodies.emplace_back();
  subject.name = "subject";
  subject.motion = poses;
  subject.uncertainty = solved.estimate.uncertainty;
  for (const char* file : {"motion.bvh",
                           "motion.glb",
                           "motion.npz",
                           "joints.csv",
                           "segments.csv",
                           "markers.c3d",
                           "markers.trc"}) {
    subject.files.push_back(trial.name + "/" + file);
  }
  return out;
}

}  // namespace marey::app
