// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace marey::fuzz {

/// Inputs of fuzz_osc: three frames of three bones, in bundles of two sizes; and
/// commands, with arguments of every type.
[[nodiscard]] std::string osc_pose();
[[nodiscard]] std::string osc_commands();

}  // namespace marey::fuzz
