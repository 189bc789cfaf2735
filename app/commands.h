// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/console.h"
#include "app/inspect_body.h"
#include "app/pipeline.h"
#include "app/read_body.h"
#include "recordings/mannequin.h"

namespace marey::app {

/// `marey track | calibrate | solve | process`. With `json`, report.json goes to standard
/// output.
[[nodiscard]] Exit run_session(Stage stage,
                               const PipelineOptions& options,
                               bool json,
                               Console& console);

struct RecordArguments {
  std::filesystem::path session;  ///< session.toml or its folder.
  std::filesystem::path out;      ///< The take's folder.
  std::string trial;
  std::optional<double> seconds;
};

/// `marey record SESSION --out TAKE --trial NAME`: until Ctrl-C, or for some seconds.
[[nodiscard]] Exit run_record(const RecordArguments& arguments, Console& console);

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
};

/// `marey convert IN OUT`: labelled markers, or the motion of a skeleton, from one kind
/// of file to another.
[[nodiscard]] Exit run_convert(const ConvertArguments& arguments,
                               bool json,
                               Console& console);

/// `marey inspect FILE`: what a session, calibration, subject, motion or table holds.
[[nodiscard]] Exit run_inspect(const std::filesystem::path& file,
                               const InspectBodyOptions& options,
                               bool json,
                               Console& console);

/// `marey mannequin --out body.glb`.
[[nodiscard]] Exit run_mannequin(const recordings::MannequinOptions& options,
                                 const recordings::MannequinStyle& style,
                                 const std::filesystem::path& out,
                                 Console& console);

/// `marey doctor`: what this machine has, and whether it is enough.
[[nodiscard]] Exit run_doctor(bool json, Console& console);

/// `marey demo`: the sample session on two mannequins. `sample` is its folder.
[[nodiscard]] Exit run_demo(const std::filesystem::path& sample,
                            const std::filesystem::path& out,
                            Console& console);

}  // namespace marey::app
