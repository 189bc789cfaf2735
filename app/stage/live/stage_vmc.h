// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/stage/run/scene_run.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "live/udp/udp_address.h"
#include "live/vmc/vmc_body.h"
#include "live/vmc/vmc_pose.h"
#include "live/vmc/vmc_sender.h"

namespace marey::app {

/// A body of a scene and the receiver of its postures.
struct VmcRoute {
  std::size_t body = 0;
  live::UdpAddress address{};
};

/// Returns the receivers: those of the scene's [[out.vmc]] on this machine, and those of
/// the options `vmc`, each [BODY=]HOST[:PORT]. An option without a body sends the bodies
/// of [[out.vmc]] to HOST, at their ports, or the first body of a scene without them; a
/// port in the option replaces theirs.
/// Errors (bad input): an invalid address; an unknown body; a group.
[[nodiscard]] Result<std::vector<VmcRoute>> plan_vmc(const Scene& scene,
                                                     const std::vector<std::string>& vmc);

/// Sends bodies of a scene by VMC, each to one receiver. Receives no commands.
class StageVmc {
 public:
  /// Errors: those of VmcSender::open() and VmcBody::make().
  [[nodiscard]] static Result<StageVmc> open(const std::vector<VmcRoute>& routes,
                                             const SceneRun& run);

  /// Sends the present postures. Never blocks; a missing receiver is no error.
  void send(Timestamp time, const SceneRun& run);
  [[nodiscard]] std::size_t size() const { return streams_.size(); }
  /// Returns the number of packets that were not sent.
  [[nodiscard]] std::int64_t failed() const;

 private:
  struct Stream {
    std::size_t body = 0;
    live::VmcBody converter;
    live::VmcSender sender;
    live::VmcPose pose{};
  };
  std::vector<Stream> streams_;
};

}  // namespace marey::app
