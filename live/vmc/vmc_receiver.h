// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "core/base/result.h"
#include "live/udp/udp_listener.h"
#include "live/vmc/vmc_assembler.h"
#include "live/vmc/vmc_sender.h"

namespace marey::live {

/// A VMC Marionette: hears one sender's body. Belongs to one thread at a time.
class VmcReceiver {
 public:
  /// Errors: UdpListener::open()'s; a busy port is kDevice.
  [[nodiscard]] static Result<VmcReceiver> open(const UdpAddress& address = {
                                                    "127.0.0.1", kMarionettePort});

  /// Reads what has come, no more than 256 packets, and tells whether that completed a
  /// frame; `newest` is then the newest one. Never blocks; allocates nothing.
  [[nodiscard]] bool receive(VmcFrame& newest);

  /// The same for who wants every frame: the oldest one that has come and was not handed
  /// out, as long as nothing but this is called. A sender's very first, whose end nobody
  /// knows before the second has come, gives way to that.
  [[nodiscard]] bool receive_next(VmcFrame& next);

  /// Sleeps until something comes, a signal came, or `longest` is over.
  void wait(std::chrono::milliseconds longest) const { listener_.wait(longest); }

  [[nodiscard]] const VmcReceived& received() const { return assembler_.received(); }
  /// As the sender told it last, though no frame came with it.
  [[nodiscard]] const VmcStatus& status() const { return assembler_.status(); }
  [[nodiscard]] int port() const { return listener_.port(); }

 private:
  explicit VmcReceiver(UdpListener listener);
  UdpListener listener_;
  VmcAssembler assembler_;
};

}  // namespace marey::live
