// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/balance/support_polygon.h"
#include <nlohmann/json_fwd.hpp>

#include "app/motion/assess_avatar.h"
#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/balance/measure_balance.h"
#include "retarget/body/body_map.h"
#include "retarget/body/find_soles.h"
#include "retarget/contacts/measure_contacts.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {

/// Result for one avatar.
struct AvatarResult {
  std::string name;  ///< Name of its file, without extension.
  std::filesystem::path avatar;
  std::vector<std::filesystem::path> files;
  std::optional<Error> error;
  // Valid only without an error:
  retarget::Soles soles;  ///< Measured from the avatar's skin.
  retarget::RetargetedMotion retargeted;
  AvatarVerdict verdict;
  retarget::BodyMap map;  ///< With the soles applied.
  Contacts own_contacts;  ///< Detected by detect_contacts() on the avatar.
  retarget::ContactFigures contacts;
  /// Mean jerk of the bones that both bodies have, divided by the source's, scaled to
  /// this avatar's height.
  double jerk_ratio = 0.0;
  retarget::BalanceTrack balance;  ///< Balance of the written motion.
  dynamics::ZmpFigures zmp;        ///< Zero moment points of the written motion.
};

/// Result of `marey retarget`.
struct RetargetRun {
  std::filesystem::path motion;
  bool live = false;
  /// The source motion at the rate and with the frames of the results. Avatars are
  /// compared with its contacts and figures.
  Motion source;
  retarget::BodyMap map;
  Contacts contacts;
  retarget::ContactLabels labels;
  retarget::ContactFigures figures;
  retarget::BalanceTrack balance;
  std::vector<AvatarResult> avatars;
};

/// Computes the measurements of the source from `source` and `contacts`.
/// Errors: map_body()'s.
[[nodiscard]] Status measure_source(RetargetRun& run);
/// Computes the measurements of an avatar without an error from `soles` and `retargeted`.
/// Precondition: measure_source() was called; source and avatar have equally many frames.
[[nodiscard]] Status measure_avatar(const RetargetRun& run, AvatarResult& avatar);

/// Returns the figures of one avatar for `--json`; docs/formats/retarget.md has the keys.
[[nodiscard]] nlohmann::ordered_json avatar_json(const RetargetRun& run,
                                                 const AvatarResult& avatar);
/// Returns the figures of all avatars for `--json`.
[[nodiscard]] nlohmann::ordered_json retarget_json(const RetargetRun& run);

/// Returns a line for the console.
[[nodiscard]] std::string summary_of(const AvatarResult& avatar);

}  // namespace marey::app
