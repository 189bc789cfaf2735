// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace marey::live {

/// Returns the IPv4 addresses of this machine in the system's order, without the
/// loopback. Empty: no network is up.
[[nodiscard]] std::vector<std::string> local_addresses();

}  // namespace marey::live
