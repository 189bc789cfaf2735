// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "recordings/base/toml_reader.h"

namespace marey::recordings {

/// Parses the XML of OpenCV's FileStorage like parse_yaml(). Errors, with the line: not
/// XML, or not OpenCV's.
[[nodiscard]] Result<TomlDocument> parse_opencv_xml(std::string_view text,
                                                    const std::string& file);

}  // namespace marey::recordings
