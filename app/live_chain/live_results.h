// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "app/live_chain/live_chain.h"

namespace marey::app {

/// Serializes the result of an instant: the state of the track, every pose with its
/// uncertainty, every packet. The bytes are stored with the instant and compared with
/// those of a replay. Replaces `out`.
void write_results(const LiveResult& result, std::vector<std::byte>& out);

}  // namespace marey::app
