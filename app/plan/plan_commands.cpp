// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/plan/plan_commands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/plan/plan_json.h"
#include "app/plan/plan_page.h"
#include "app/shell/option_checks.h"
#include "calib/plan/body_heights.h"
#include "calib/plan/plan_calibration.h"
#include "capture/tags/corner_sigma.h"
#include "capture/tags/detect_tags.h"
#include "recordings/base/atomic_file.h"
#include "recordings/print/print_words.h"
#include "recordings/session/plan_file.h"

namespace marey::app {
namespace {

/// Returns the covariance of the cameras, calibrated or planned, and stores in the report
/// which one it is. A calibration contains only the sigmas of each camera; the
/// correlations come from the plan of a calibration, if it succeeds.
std::optional<calib::RigCovariance> rig_covariance_of(const recordings::CapturePlan& plan,
                                                      PlanReport& report) {
  auto covariance = calib::plan_calibration(report.cameras,
                                            report.grid,
                                            AprilGrid{},
                                            capture::expected_corner_sigma_px,
                                            report.options);
  report.is_calibrated = std::any_of(
      plan.quality.begin(), plan.quality.end(), [](const CameraQuality& quality) {
        return quality.centre_sigma_m > 0.0;
      });
  if (!covariance) {
    report.not_calibrated = covariance.error();
    if (!report.is_calibrated) return std::nullopt;
    covariance = calib::covariance_of_quality(plan.quality);
  } else if (report.is_calibrated) {
    calib::fit_to_quality(plan.quality, *covariance);
  }
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    report.centre_sigma_m.push_back(calib::centre_sigma_m(*covariance, c));
  }
  return *std::move(covariance);
}

PlanReport report_of(const PlanArguments& args, recordings::CapturePlan plan) {
  PlanReport report;
  report.name = args.plan.filename().string();
  report.cameras = std::move(plan.cameras);
  report.options.tag_size_m = args.tag_size_m.value_or(
      plan.tag_size_m.value_or(recordings::kDefaultPlannedTag_m));
  report.stature_m =
      args.stature_m.value_or(plan.stature_m.value_or(calib::kTypicalStature_m));
  report.grid = calib::grid_before(report.cameras);
  if (plan.volume) {
    const auto& [min_m, max_m, step_m] = *plan.volume;
    report.grid = {{min_m.x, 0.0, min_m.y}, {max_m.x, 0.0, max_m.y}, step_m, {}};
  }
  report.grid.heights_m.clear();
  for (const calib::BodyHeight& height : calib::kBodyHeights) {
    report.height_names.emplace_back(height.name);
    report.grid.heights_m.push_back(height.over_stature * report.stature_m);
  }
  const auto rig_covariance = rig_covariance_of(plan, report);
  const calib::RigCovariance* covariance = rig_covariance ? &*rig_covariance : nullptr;
  report.plan = calib::plan_rig(report.cameras,
                                covariance,
                                report.grid,
                                capture::expected_corner_sigma_px,
                                report.options);
  std::vector<TagOnSegment> tags = std::move(plan.tags);
  if (tags.empty()) tags = calib::typical_tags(report.options.tag_size_m);
  if (args.tag_size_m) {
    for (TagOnSegment& tag : tags) tag.size_m = *args.tag_size_m;
  }
  const calib::PlannedBody body = calib::make_planned_body(report.stature_m, tags);
  report.tags_worn = static_cast<int>(body.tags.size());
  calib::PlanBodyOptions options;
  options.tags = report.options;
  options.step_m = std::max(report.grid.step_m, report.stand_step_m);
  report.stand_step_m = options.step_m;
  report.body = calib::plan_body(report.cameras,
                                 covariance,
                                 body,
                                 report.grid,
                                 capture::expected_corner_sigma_px,
                                 options);
  return report;
}

void warn(const PlanReport& report, Console& console) {
  if (report.cameras.size() < 2) {
    console.warn(report.name +
                 ": one camera alone cannot locate a tag. Next: plan two or more");
  } else if (report.not_calibrated) {
    const Error& error = *report.not_calibrated;
    console.warn(report.name +
                 ": a board moved through this volume would not calibrate the cameras (" +
                 (error.where.empty() ? "" : error.where + ": ") + error.cause + "): " +
                 (report.is_calibrated
                      ? "the errors of each camera are taken as independent, as large "
                        "as in its calibration"
                      : "they are taken as known exactly") +
                 ". Next: " + error.next);
  }
}

}  // namespace

Exit run_plan(const PlanArguments& args, Console& console) {
  auto plan = recordings::read_plan(args.plan);
  if (!plan) return console.fail(plan.error());
  const PlanReport report = report_of(args, *std::move(plan));
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  const std::string json = plan_json(report).dump(1, ' ', false, kReplace) + "\n";
  if (const Status ok = recordings::write_file(args.out / "plan.json", json); !ok) {
    return console.fail(ok.error());
  }
  if (const Status ok = recordings::write_file(args.out / "plan.html", plan_page(report));
      !ok) {
    return console.fail(ok.error());
  }
  std::fputs(args.json ? json.c_str() : plan_table(report).c_str(), stdout);
  warn(report, console);
  console.say((args.out / "plan.html").string() + " shows the plan from above");
  return Exit::kOk;
}

void add_plan_command(CLI::App& app,
                      PlanArguments& args,
                      std::function<Exit(Console&)>& chosen) {
  CLI::App* command =
      app.add_subcommand("plan", "Predict coverage and accuracy of planned cameras");
  command->add_option("PLAN", args.plan, "plan.toml, or a calibration.toml")->required();
  command->add_option("-o,--out", args.out, "Folder for plan.json and plan.html")
      ->required();
  command
      ->add_option_function<std::string>(
          "--tag",
          [&args](const std::string& word) {
            auto size_m = recordings::parse_length_m(word);
            if (!size_m) {
              throw RejectedArguments("--tag: " + size_m.error().cause,
                                      size_m.error().next);
            }
            args.tag_size_m = *size_m;
          },
          "Edge of a tag's square, with its unit; default the plan's, or " +
              std::to_string(std::lround(1e3 * recordings::kDefaultPlannedTag_m)) + "mm")
      ->type_name("LENGTH");
  command
      ->add_option("--height", args.stature_m, "Stature [m]; default the plan's, or 1.75")
      ->check(between(0.3, 10.0));
  command->add_flag("--json", args.json, "Print plan.json instead of the table");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_plan(args, console); }; });
}

}  // namespace marey::app
