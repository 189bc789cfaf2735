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

/// Targets of the packets of one stream.
struct StreamTargets {
  std::vector<live::UdpAddress> addresses;
};

/// Converts the options `vmc` to streams of the settings and their targets.
/// Errors (kBadInput): an invalid address; an unknown avatar.
[[nodiscard]] Status plan_streams(const std::vector<std::string>& vmc,
                                  live::VmcRest rest,
                                  std::optional<int> mtu_bytes,
                                  LiveSettings& settings,
                                  std::vector<StreamTargets>& targets);

}  // namespace marey::app
