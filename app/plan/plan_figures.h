// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "calib/plan/plan_body.h"
#include "calib/plan/plan_rig.h"
#include "core/base/result.h"

namespace marey::app {

/// A plan and what it was made from.
struct PlanReport {
  std::string name;             ///< Of the file that the cameras come from.
  std::vector<Camera> cameras;  ///< At least one.
  calib::PlanOptions options;
  double stature_m = 1.75;
  /// Of the grid's heights: "ankle", "hip"...
  std::vector<std::string> height_names;
  calib::ErrorMapGrid grid;
  calib::RigPlan plan;
  calib::BodyPlan body;
  int tags_worn = 0;
  double stand_step_m = 0.5;  ///< Between the places of BodyPlan::stands.
  /// Of each camera's centre; empty when they are taken as known exactly.
  std::vector<double> centre_sigma_m;
  bool is_calibrated = false;  ///< These sigmas are of a calibration, not planned.
  /// Why a board would not calibrate the cameras, when it would not.
  std::optional<Error> not_calibrated;
};

/// "left shoulder", "right ankle": the joint at a limb bone's near end.
[[nodiscard]] std::string joint_name(HumanBone bone);

/// What plan.json holds (docs/formats/README.md).
[[nodiscard]] nlohmann::ordered_json plan_figures(const PlanReport& report);

/// The tables of heights and of the body's joints for a terminal, lines of at most 90
/// columns.
[[nodiscard]] std::string plan_table(const PlanReport& report);

}  // namespace marey::app
