// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace marey::app {

/// Arguments of `marey convert`.
struct ConvertArguments {
  std::filesystem::path in;   ///< Markers: .c3d, .trc; motions: .bvh, .amc, .glb, .vrma.
  std::filesystem::path out;  ///< Markers: .c3d, .trc; motions: .bvh, .vrma, .npz...
  // Validated axes ("+Z") and units ("mm"); empty: those of the files.
  std::string up;
  std::string unit;
  std::string to_up;
  std::string to_unit;
  // For motions only:
  std::filesystem::path skeleton;  ///< The .asf of an .amc; empty: the one next to it.
  std::optional<double> rate_hz;   ///< Rate of INPUT, if its file is wrong.
  std::optional<double> to_rate_hz;
  std::string bvh_dialect;  ///< Name of a BvhDialect, or empty.
  std::string neutral;      ///< Argument of read_neutral(), or empty.
  bool json = false;
};

}  // namespace marey::app
