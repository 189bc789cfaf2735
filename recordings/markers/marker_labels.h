// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace marey::recordings {

/// Returns `count` labels made from `labels`: none is empty ("unnamed_3"), all are
/// different ("toe_2"), and labels beyond `count` are dropped. Changes are reported in
/// `notes`. The function is idempotent.
[[nodiscard]] std::vector<std::string> distinct_labels(std::vector<std::string> labels,
                                                       std::size_t count,
                                                       std::vector<std::string>& notes);

}  // namespace marey::recordings
