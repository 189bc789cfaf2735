// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "app/live_chain/live_chain.h"

namespace marey::app {

/// What came of an instant as bytes, to be kept with it and compared with a replay's:
/// the state of the track, every pose and doubt, every packet. Replaces `out`.
void write_results(const LiveResult& result, std::vector<std::byte>& out);

}  // namespace marey::app
