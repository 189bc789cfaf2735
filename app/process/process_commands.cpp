// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/process/process_commands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "app/check/assess_results.h"
#include "app/convert/mannequin_commands.h"
#include "app/motion/raw_body.h"
#include "app/process/earlier_calibration.h"
#include "app/shell/file_url.h"
#include "app/shell/findings.h"
#include "app/shell/option_checks.h"
#include "app/shell/program_name.h"
#include "recordings/session/session.h"

namespace marey::app {
namespace {

Status run_stages(Stage stage, Pipeline& pipeline) {
  if (const Status ok = run_to(stage, pipeline); !ok) return ok;
  if (stage == Stage::kTrack || stage == Stage::kCalibrate) return Done{};
  if (const Status ok = pipeline.retarget(); !ok) return ok;
  return pipeline.write_report();
}

/// Prints the figures and warnings of the report. Poor findings are not printed here: the
/// caller prints them as errors.
void print_results(const Report& report,
                   const std::filesystem::path& out,
                   ViewHint hint,
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
  print_warnings(console, report.findings);
  if (!report.trials.empty()) {
    console.say("report: " + (out / "report.html").string());
    if (hint == ViewHint::kPrinted) {
      console.say("to see it move: " + shell_command({"marey", "view", out.string()}));
    }
  } else if (report.cameras_are_assessed) {
    console.say("report: " + (out / "calibration.html").string());
  }
}

void add_session_command(CLI::App& app,
                         const char* name,
                         const char* help,
                         Stage stage,
                         SessionArguments& args,
                         std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("SESSION", args.pipeline.session, "session.toml, or its folder")
      ->required();
  command->add_option("-o,--out", args.pipeline.out, "Folder for the results")
      ->required();
  command->add_option(
      "--media", args.media, "Folder that the session's video paths are relative to");
  if (stage == Stage::kSolve || stage == Stage::kProcess) {
    command
        ->add_option(
            "-a,--avatar",
            args.pipeline.avatars,
            "Body to retarget the motion to: " + body_extensions() + "; may be repeated")
        // One avatar per option: the next argument may be the session.
        ->allow_extra_args(false);
  }
  if (stage == Stage::kCalibrate || stage == Stage::kProcess) {
    std::vector<std::string> lenses;
    for (const auto& [word, lens] : recordings::kLensWords) lenses.emplace_back(word);
    command
        ->add_option("--lens",
                     args.pipeline.lens,
                     "Lens of the cameras, instead of the session's: auto, "
                     "brown-conrady, rational or fisheye")
        ->check(one_of(lenses));
  }
  command->add_flag("--json", args.json, "Print the figures as JSON on standard output");
  command->callback([&, stage] {
    if (!args.media.empty()) args.pipeline.media = args.media;
    chosen = [&args, stage](Console& console) {
      return run_session(stage, args.pipeline, args.json, console);
    };
  });
}

/// Checks what would end the demo after its bodies are written.
Status check_before_demo(const std::filesystem::path& sample,
                         const std::filesystem::path& out) {
  if (const Status ok = check_out_folder(out); !ok) return ok;
  const auto session = recordings::read_session(sample);
  if (!session) return session.error();
  return recordings::check_files(*session);
}

}  // namespace

Exit run_session(Stage stage,
                 const PipelineOptions& options,
                 bool json,
                 Console& console,
                 ViewHint hint) {
  if (const Status ok = check_out_folder(options.out); !ok) {
    return console.fail(ok.error());
  }
  const EarlierCalibration earlier = find_calibration(options.out);
  // An earlier calibration is kept, so the user can undo a change of the session.
  const auto warn_of_kept = [&] {
    if (stage != Stage::kCalibrate && stage != Stage::kProcess) return;
    if (const std::string kept = kept_text(earlier); !kept.empty()) console.warn(kept);
  };
  auto pipeline = Pipeline::open(stage, options, console);
  if (!pipeline) {
    warn_of_kept();
    return console.fail(pipeline.error());
  }
  if (stage == Stage::kSolve) {
    const std::string used = used_text(earlier, options.session);
    if (!used.empty()) console.say(used);
  }
  if (const Status ok = run_stages(stage, *pipeline); !ok) {
    for (const Finding& finding : pipeline->report().findings) {
      if (finding.severity == Severity::kPoor) console.warn(finding.message());
    }
    warn_of_kept();
    return console.fail(ok.error());
  }
  const Report& report = pipeline->report();
  print_results(report, options.out, hint, console);
  if (json) std::fputs(report_json_text(report).c_str(), stdout);
  // The other results are written. The exit code still shows that a result is missing.
  const Exit exit = print_failures(console, report.findings);
  if (stage != Stage::kCalibrate) return exit;
  // The other stages assess the results when they write the report.
  const Exit later = print_failures(console, assess_results(report));
  return later == Exit::kOk ? exit : later;
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
  if (const Status ok = check_before_demo(sample, out); !ok) {
    return console.fail(ok.error());
  }
  Exit made = run_mannequin(child, {}, options.avatars[0], console);
  if (made == Exit::kOk) made = run_mannequin(giant, broad, options.avatars[1], console);
  if (made != Exit::kOk) return made;
  const Exit done =
      run_session(Stage::kProcess, options, false, console, ViewHint::kOmitted);
  if (done != Exit::kOk) return done;
  const std::string page = file_url(out / "report.html");
  const std::string next = shell_command({"marey", "view", out.string()});
  std::printf("results: %s\npage:    %s\nnext:    %s\n",
              out.c_str(),
              page.c_str(),
              console.as_called(next).c_str());
  return Exit::kOk;
}

void add_session_commands(CLI::App& app,
                          SessionArguments& args,
                          std::function<Exit(Console&)>& chosen) {
  add_session_command(app,
                      "process",
                      "Run all stages: tags, cameras, subject, motion, avatars, report",
                      Stage::kProcess,
                      args,
                      chosen);
  add_session_command(
      app, "track", "Find the tags of every trial", Stage::kTrack, args, chosen);
  add_session_command(
      app, "calibrate", "Calibrate the cameras", Stage::kCalibrate, args, chosen);
  add_session_command(app,
                      "solve",
                      "Solve subject, motion and avatars with calibrated cameras",
                      Stage::kSolve,
                      args,
                      chosen);
}

void add_demo_command(CLI::App& app,
                      DemoArguments& args,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("demo", "Process the sample session on two bodies");
  command->add_option("-o,--out", args.out, "Folder for the results")
      ->default_val("out/first-light");
  command->add_option("--sample", args.sample, "Folder of the sample session");
  command->callback([&] {
    chosen = [&args](Console& console) {
      return run_demo(args.sample, args.out, console);
    };
  });
}

}  // namespace marey::app
