// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page/page_wizard.h"

#include <algorithm>

#include "live/page/page_json.h"
#include "live/page/wizard_object.h"

namespace marey::live {
namespace {

const char* name(WizardStep step) {
  switch (step) {
    case WizardStep::kIdle:
      return "idle";
    case WizardStep::kStand:
      return "stand";
    case WizardStep::kMove:
      return "move";
    case WizardStep::kSolve:
      return "solve";
    case WizardStep::kDone:
      return "done";
    case WizardStep::kFailed:
      return "failed";
  }
  return "idle";
}

PageJson wizard_camera_object(const WizardCamera& camera) {
  return {{"name", camera.name},
          {"coverage", camera.coverage()},
          {"grid", camera.grid},
          {"rms_px", or_null(camera.rms_px)}};
}

PageJson quality_object(const Finding& finding) {
  return {{"name", finding.where},
          {"value", finding.cause},
          {"good", finding.severity == Severity::kNote}};
}

}  // namespace

double WizardCamera::coverage() const {
  const auto seen =
      std::count_if(grid.begin(), grid.end(), [](double cell) { return cell > 0.0; });
  return static_cast<double>(seen) / static_cast<double>(grid.size());
}

PageJson wizard_object(const PageWizard& wizard) {
  return {{"type", "wizard"},
          {"step", name(wizard.step)},
          {"title", wizard.title},
          {"text", wizard.text},
          {"progress", wizard.progress},
          {"cameras", array_of(wizard.cameras, wizard_camera_object)},
          {"quality", array_of(wizard.quality, quality_object)},
          {"error", wizard.error}};
}

std::string wizard_json(const PageWizard& wizard) {
  return in_one_line(wizard_object(wizard));
}

}  // namespace marey::live
