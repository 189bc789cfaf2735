// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "core/base/result.h"
#include "recordings/base/toml_reader.h"
#include "recordings/session/calibration.h"

namespace marey::recordings {

/// Detects from its beginning whether a text is YAML or XML rather than TOML.
[[nodiscard]] bool is_yaml_or_xml(std::string_view text);

/// The required parts of a calibration.
enum class CameraParts { kAll, kLenses };

/// Reads YAML or XML calibrations of other programs. read_calibration() lists the formats
/// and their worlds; read_lenses() lists the parts that may be missing. `path` names the
/// file in messages; related files are searched in its folder.
[[nodiscard]] Result<Calibration> import_calibration(std::string_view text,
                                                     const std::filesystem::path& path,
                                                     CameraParts parts);

// Formats of import_calibration(). `root` is the whole file. A mistake in it is kept in
// its document; a mistake in a related file is returned.

/// Detects OpenCV's sample formats: one of their keys holds a matrix in cv::FileStorage's
/// form.
[[nodiscard]] bool is_opencv(const TomlReader& root);
[[nodiscard]] Status import_opencv(TomlReader& root,
                                   const std::filesystem::path& path,
                                   Calibration& out);

/// Detects the tables cam0, cam1... of Kalibr's camchain or TagSLAM's cameras.yaml.
[[nodiscard]] bool is_camchain(const TomlReader& root);
[[nodiscard]] Status import_camchain(TomlReader& root,
                                     const std::filesystem::path& path,
                                     CameraParts parts,
                                     Calibration& out);

}  // namespace marey::recordings
