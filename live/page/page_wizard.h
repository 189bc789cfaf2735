// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace marey::live {

/// Where calibration and fitting of a subject stand.
enum class WizardStep { kIdle, kStand, kMove, kSolve, kDone, kFailed };

/// What one camera has seen so far. Its picture is divided into 8 columns and 6 rows,
/// from the top left, row by row.
struct WizardCamera {
  static constexpr std::size_t kColumns = 8;
  static constexpr std::size_t kRows = 6;

  std::string name{};
  /// How much of each cell was covered by tags, 0 to 1.
  std::array<double, kColumns * kRows> grid{};
  std::optional<double> rms_px{};

  /// The share of cells in which tags were seen at all.
  [[nodiscard]] double coverage() const;
};

/// One thing that was found: "left forearm", "24.1 cm ± 0.3".
struct WizardQuality {
  std::string name{};
  std::string value{};
  bool good = true;
};

struct PageWizard {
  WizardStep step = WizardStep::kIdle;
  std::string title{};
  std::string text{};
  double progress = 0.0;  ///< 0 to 1.
  std::vector<WizardCamera> cameras{};
  std::vector<WizardQuality> quality{};
  std::string error{};
};

/// As scene_json().
[[nodiscard]] std::string wizard_json(const PageWizard& wizard);

}  // namespace marey::live
