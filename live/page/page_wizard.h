// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"

namespace marey::live {

/// Current step of the calibration and fitting of a subject.
enum class WizardStep { kIdle, kStand, kMove, kSolve, kDone, kFailed };

/// Coverage of one camera so far. Its picture is divided into 8 columns and 6 rows; cells
/// are stored row by row from the top left.
struct WizardCamera {
  static constexpr std::size_t kColumns = 8;
  static constexpr std::size_t kRows = 6;

  std::string name{};
  /// Share of each cell that was covered by tags, 0 to 1.
  std::array<double, kColumns * kRows> grid{};
  std::optional<double> rms_px{};

  /// Returns the share of cells in which tags were seen.
  [[nodiscard]] double coverage() const;
};

struct PageWizard {
  WizardStep step = WizardStep::kIdle;
  std::string title{};
  std::string text{};
  double progress = 0.0;  ///< 0 to 1.
  std::vector<WizardCamera> cameras{};
  /// Results: `where` is the name, "left forearm", `cause` the value, "24.1 cm ± 0.3". A
  /// note is good.
  std::vector<Finding> quality{};
  std::string error{};
};

/// Returns the wizard message; encoding as in scene_json().
[[nodiscard]] std::string wizard_json(const PageWizard& wizard);

}  // namespace marey::live
