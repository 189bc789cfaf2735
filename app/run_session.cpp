// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/earlier_calibration.h"
#include "app/judge_quality.h"
#include "app/option_checks.h"

namespace marey::app {
namespace {

Status run_stages(Stage stage, Pipeline& pipeline) {
  if (const Status ok = pipeline.track(); !ok) return ok;
  if (stage == Stage::kTrack) return Done{};
  if (stage != Stage::kSolve) {
    if (const Status ok = pipeline.calibrate(); !ok) return ok;
    if (stage == Stage::kCalibrate) return Done{};
  }
  if (const Status ok = pipeline.fit(); !ok) return ok;
  if (const Status ok = pipeline.solve(); !ok) return ok;
  if (const Status ok = pipeline.retarget(); !ok) return ok;
  return pipeline.write_report();
}

/// Failures are told apart, as errors.
void tell(const Report& report,
          const std::vector<Error>& failures,
          const std::filesystem::path& out,
          Console& console) {
  std::array<char, 200> text{};
  for (const ReportCamera& camera : report.cameras) {
    std::snprintf(
        text.data(),
        text.size(),
        "camera %s: reprojection %.2f px, centre known to %.1f mm, focal length "
        "to %.2f %%",
        camera.camera.name.c_str(),
        camera.quality.rms_px,
        1000.0 * camera.quality.centre_sigma_m,
        100.0 * camera.quality.focal_sigma_px / camera.camera.intrinsics.focal_px.x);
    console.say(text.data());
  }
  for (const ReportTrial& trial : report.trials) {
    std::snprintf(text.data(),
                  text.size(),
                  "%s: %d of %d frames solved, reprojection %.2f px (median %.2f)",
                  trial.name.c_str(),
                  trial.frames_solved,
                  trial.frames,
                  trial.rms_px,
                  trial.median_px);
    console.say(text.data());
  }
  for (const std::string& warning : report.warnings) {
    const bool told = std::any_of(failures.begin(), failures.end(), [&](const Error& f) {
      return f.message() == warning;
    });
    if (!told) console.warn(warning);
  }
  if (!report.trials.empty()) {
    console.say("report: " + (out / "report.html").string());
    console.say("to see it move: marey view " + out.string());
  } else if (report.cameras_are_judged) {
    console.say("report: " + (out / "calibration.html").string());
  }
}

}  // namespace

Exit run_session(Stage stage,
                 const PipelineOptions& options,
                 bool json,
                 Console& console) {
  if (const Status ok = check_out_folder(options.out); !ok) {
    return console.fail(ok.error());
  }
  const EarlierCalibration earlier = find_calibration(options.out);
  // Results of an earlier run stay: who changes a session may want to go back.
  const auto tell_kept = [&] {
    if (stage != Stage::kCalibrate && stage != Stage::kProcess) return;
    if (const std::string kept = kept_words(earlier); !kept.empty()) console.warn(kept);
  };
  auto pipeline = Pipeline::open(stage, options, console);
  if (!pipeline) {
    tell_kept();
    return console.fail(pipeline.error());
  }
  if (stage == Stage::kSolve) {
    const std::string used = used_words(earlier, options.session);
    if (!used.empty()) console.say(used);
  }
  if (const Status ok = run_stages(stage, *pipeline); !ok) {
    for (const Error& failure : pipeline->failures()) {
      if (failure.message() != ok.error().message()) console.warn(failure.message());
    }
    tell_kept();
    return console.fail(ok.error());
  }
  std::vector<Error> failures = pipeline->failures();
  if (stage == Stage::kCalibrate) {
    // Where a report is written, it is judged already.
    for (Error& poor : judge_quality(pipeline->report())) {
      failures.push_back(std::move(poor));
    }
  }
  tell(pipeline->report(), failures, options.out, console);
  if (json) std::fputs(report_json(pipeline->report()).c_str(), stdout);
  // The rest is done and written; that something is missing must still not pass for
  // whole.
  Exit exit = Exit::kOk;
  for (const Error& failure : failures) exit = console.fail(failure);
  return exit;
}

Exit run_demo(const std::filesystem::path& sample,
              const std::filesystem::path& out,
              Console& console) {
  const std::filesystem::path bodies = out / "avatars";
  recordings::MannequinOptions child;
  child.stature_m = 1.1;
  child.head = 1.35;
  child.leg = 0.9;
  recordings::MannequinOptions giant;
  giant.stature_m = 2.4;
  giant.arm = 1.25;
  giant.shoulder_width = 1.2;
  recordings::MannequinStyle broad;
  broad.girth = 1.2;
  PipelineOptions options;
  options.session = sample;
  options.out = out;
  options.avatars = {bodies / "child.glb", bodies / "giant.glb"};
  Exit made = run_mannequin(child, {}, options.avatars[0], console);
  if (made == Exit::kOk) made = run_mannequin(giant, broad, options.avatars[1], console);
  if (made != Exit::kOk) return made;
  const Exit done = run_session(Stage::kProcess, options, false, console);
  if (done != Exit::kOk) return done;
  std::error_code ignored;
  const auto page = std::filesystem::absolute(out / "report.html", ignored);
  std::printf("results: %s\npage:    file://%s\nnext:    marey view %s\n",
              out.c_str(),
              page.c_str(),
              out.c_str());
  return Exit::kOk;
}

}  // namespace marey::app
