// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey::live {

/// The IPv4 addresses by which others can reach this machine, in the order in which the
/// system lists them, its own loopback left out. Empty: no network is up.
[[nodiscard]] std::vector<std::string> local_addresses();

}  // namespace marey::live
