// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/edit/annotation.h"

namespace marey::recordings {

/// Checks the annotations as annotations_text() documents. `file` is the name of the file
/// in messages.
[[nodiscard]] Status check_annotations(const Annotations& annotations,
                                       const std::string& file);

}  // namespace marey::recordings
