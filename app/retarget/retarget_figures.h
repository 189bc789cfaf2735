// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/motion/assess_avatar.h"
#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"
#include "retarget/body/find_soles.h"
#include "retarget/contacts/contact_figures.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {

/// What came of one avatar.
struct AvatarResult {
  std::string name;  ///< Of its file, without extension.
  std::filesystem::path avatar;
  std::vector<std::filesystem::path> files;
  std::optional<Error> error;
  // Without an error:
  retarget::Soles soles;  ///< By its skin.
  retarget::RetargetedMotion retargeted;
  AvatarVerdict verdict;
  retarget::BodyMap map;            ///< That wears the soles.
  retarget::Contacts own_contacts;  ///< As detect_contacts() has them on the avatar.
  retarget::ContactFigures contacts;
  /// Mean jerk of the bones that both bodies have, over the source's at this height.
  double jerk_ratio = 0.0;
  retarget::BalanceTrack balance;  ///< As delivered.
};

/// What came of `marey retarget`.
struct RetargetRun {
  std::filesystem::path motion;
  bool live = false;
  /// At the rate and with the frames of the results. Its contacts and figures are what
  /// avatars are held against.
  Motion source;
  retarget::BodyMap map;
  retarget::Contacts contacts;
  retarget::ContactLabels labels;
  retarget::ContactFigures figures;
  retarget::BalanceTrack balance;
  std::vector<AvatarResult> avatars;
};

/// Fills in what is measured of the source, of which `source` and `contacts` are given.
/// Errors: map_body()'s.
[[nodiscard]] Status measure_source(RetargetRun& run);
/// Likewise of an avatar without an error, of which `soles` and `retargeted` are given.
/// Precondition: measure_source() was called; as many frames.
[[nodiscard]] Status measure_avatar(const RetargetRun& run, AvatarResult& avatar);

/// One avatar for `--json`: docs/formats/README.md has the keys.
[[nodiscard]] nlohmann::ordered_json avatar_figures(const RetargetRun& run,
                                                    const AvatarResult& avatar);
/// All of them.
[[nodiscard]] nlohmann::ordered_json retarget_figures(const RetargetRun& run);

/// One line for the console.
[[nodiscard]] std::string summary_of(const AvatarResult& avatar);

}  // namespace marey::app
