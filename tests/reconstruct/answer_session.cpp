// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/reconstruct/answer_session.h"

#include <cmath>
#include <utility>

#include <time.h>

#include "reconstruct/clusters/check_views.h"
#include "reconstruct/subject/fit_subject.h"
#include "reconstruct/tags/solve_motion.h"
#include "tests/support/program/thread_time.h"

namespace marey::testing {
namespace {

/// Returns SolveMotionOptions::camera_sigma_m as app/check/mean_centre_sigma.h computes
/// it. [m]
double mean_centre_sigma_m(const SimulatedSession& session) {
  double sum_m2 = 0.0;
  for (const double sigma_m : session.rig.centre_sigma_m) sum_m2 += sigma_m * sigma_m;
  return std::sqrt(sum_m2) / static_cast<double>(session.rig.centre_sigma_m.size());
}

}  // namespace

SessionAnswer answer_session(const SimulatedSession& session) {
  SessionAnswer out;
  const auto refuse = [&](const char* by, const Error& error) {
    out.refused_by = by;
    out.refusal = error;
    return out;
  };
  const std::vector<Camera>& cameras = session.rig.calibrated;
  const reconstruct::SubjectPrior prior{
      "simulated", session.body.declared_stature_m, {}, session.declared_tags()};
  for (const auto* trial : {&session.standing, &session.moving, &session.motion}) {
    const Status ok = reconstruct::check_views(cameras, trial->detections, prior.tags);
    if (!ok) return refuse("check_views", ok.error());
  }
  double start = thread_time_s();
  auto fit = reconstruct::fit_subject(
      prior, cameras, session.standing.detections, session.moving.detections);
  out.fit_s = thread_time_s() - start;
  if (!fit) return refuse("fit_subject", fit.error());
  for (const reconstruct::LeftOutSegment& left : fit->left_out) {
    out.left_out.push_back(left.segment);
    std::erase_if(fit->findings, [&](const Finding& finding) {
      return finding.cause == left.reason.cause;
    });
  }
  if (!fit->findings.empty()) {
    return refuse("fit_subject", fit->findings.front().error());
  }
  out.body = std::move(fit->body);
  start = thread_time_s();
  reconstruct::SolveMotionOptions options;
  options.camera_sigma_m = mean_centre_sigma_m(session);
  auto solved =
      reconstruct::solve_motion(out.body, cameras, session.motion.detections, options);
  out.solve_s = thread_time_s() - start;
  if (!solved) return refuse("solve_motion", solved.error());
  out.motion = std::move(solved->estimate);
  return out;
}

}  // namespace marey::testing
