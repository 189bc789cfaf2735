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

/// A plan with its inputs.
struct PlanReport {
  std::string name;             ///< Name of the file with the cameras.
  std::vector<Camera> cameras;  ///< At least one.
  calib::PlanOptions options;
  double stature_m = 1.75;
  /// Names of the heights of the grid: "ankle", "hip"...
  std::vector<std::string> height_names;
  calib::ErrorMapGrid grid;
  calib::RigPlan plan;
  calib::BodyPlan body;
  int tags_worn = 0;
  double stand_step_m = 0.5;  ///< Distance between the places of BodyPlan::stands.
  /// Sigma of the centre of each camera; empty if the cameras are taken as exact.
  std::vector<double> centre_sigma_m;
  bool is_calibrated = false;  ///< The sigmas come from a calibration.
  /// Reason why a board would not calibrate the cameras; nullopt if it would.
  std::optional<Error> not_calibrated;
};

/// Returns the name of the joint at the proximal end of a limb bone: "left shoulder",
/// "right ankle".
[[nodiscard]] std::string joint_name(HumanBone bone);

/// Returns the content of plan.json (docs/formats/plan.md).
[[nodiscard]] nlohmann::ordered_json plan_json(const PlanReport& report);

/// Returns the tables of heights and of the body's joints for a terminal, with lines of
/// at most 90 columns.
[[nodiscard]] std::string plan_table(const PlanReport& report);

}  // namespace marey::app
