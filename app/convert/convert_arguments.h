// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace marey::app {

/// What `marey convert` was asked for.
struct ConvertArguments {
  std::filesystem::path in;   ///< Markers: .c3d, .trc; motions: .bvh, .amc, .glb, .vrma.
  std::filesystem::path out;  ///< Markers: .c3d, .trc; motions: .bvh, .vrma, .npz...
  // Axes ("+Z") and units ("mm"), checked; empty where the files decide.
  std::string up;
  std::string unit;
  std::string to_up;
  std::string to_unit;
  // Of motions alone:
  std::filesystem::path skeleton;  ///< The .asf of an .amc; empty: the one beside it.
  std::optional<double> rate_hz;   ///< What IN's rate is, if not as it says.
  std::optional<double> to_rate_hz;
  std::string bvh_dialect;  ///< A BvhDialect's name, or empty.
  std::string neutral;      ///< read_neutral()'s word, or empty.
  bool json = false;
};

}  // namespace marey::app
