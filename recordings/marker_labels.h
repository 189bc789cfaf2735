// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace marey::recordings {

/// `labels`, `count` of them: none empty ("unnamed_3"), all different ("toe_2"); more
/// than `count` are left out. What was changed is told in `notes`. Gives the same labels
/// when asked again of its own.
[[nodiscard]] std::vector<std::string> distinct_labels(std::vector<std::string> labels,
                                                       std::size_t count,
                                                       std::vector<std::string>& notes);

}  // namespace marey::recordings
