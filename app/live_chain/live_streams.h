// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/live_chain/live_settings.h"
#include "core/base/result.h"
#include "live/udp/udp_address.h"

namespace marey::app {

/// Where the packets of one stream go.
struct StreamTargets {
  std::vector<live::UdpAddress> addresses;
};

/// Where the packets for `vmc` go, as streams of settings and their targets.
/// Errors (kBadInput): an address; an avatar of no such name.
[[nodiscard]] Status plan_streams(const std::vector<std::string>& vmc,
                                  live::VmcRest rest,
                                  std::optional<int> mtu_bytes,
                                  LiveSettings& settings,
                                  std::vector<StreamTargets>& targets);

}  // namespace marey::app
