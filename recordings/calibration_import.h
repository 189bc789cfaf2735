// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"
#include "recordings/calibration_file.h"
#include "recordings/toml_reader.h"

namespace marey::recordings {

/// The text is YAML or XML, not TOML, by how it begins.
[[nodiscard]] bool is_yaml_or_xml(std::string_view text);

/// What is wanted of a file of cameras.
enum class CameraParts { kAll, kLenses };

/// Reads what others than marey write in YAML or XML; read_calibration() says which and
/// in what world, read_lenses() what need not be there. `path` names the file in messages; files that belong to it are looked
/// for beside it.
[[nodiscard]] Result<Calibration> import_calibration(std::string_view text,
                                                     const std::filesystem::path& path,
                                                     CameraParts parts);

// What import_calibration() tells apart. `root` is the whole file; a mistake stays in its
// document, one in a file beside it is returned.

/// A matrix as cv::FileStorage writes it is among the keys that OpenCV's samples use.
[[nodiscard]] bool is_opencv(const TomlReader& root);
[[nodiscard]] Status import_opencv(TomlReader& root,
                                   const std::filesystem::path& path,
                                   Calibration& out);

/// Has the tables cam0, cam1...: a camchain of Kalibr's, or TagSLAM's cameras.yaml.
[[nodiscard]] bool is_camchain(const TomlReader& root);
[[nodiscard]] Status import_camchain(TomlReader& root,
                                     const std::filesystem::path& path,
                                     CameraParts parts,
                                     Calibration& out);

}  // namespace marey::recordings
