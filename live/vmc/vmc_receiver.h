// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "core/base/result.h"
#include "live/udp/udp_listener.h"
#include "live/vmc/vmc_assembler.h"
#include "live/vmc/vmc_sender.h"

namespace marey::live {

/// A VMC Marionette: receives the body of one sender. Used by one thread at a time.
class VmcReceiver {
 public:
  /// Opens the port. Errors: those of UdpListener::open(); a busy port is kDevice.
  [[nodiscard]] static Result<VmcReceiver> open(const UdpAddress& address = {
                                                    "127.0.0.1", kMarionettePort});

  /// Reads up to 256 waiting packets. Returns true if they completed a frame; `newest` is
  /// then the newest one. Never blocks; allocates nothing.
  [[nodiscard]] bool receive(VmcFrame& newest);

  /// Like receive(), but returns every frame: the oldest complete one that was not
  /// returned yet, provided that receive() is not called in between. The very first frame
  /// of a sender ends only when the second arrives, and is replaced by it.
  [[nodiscard]] bool receive_next(VmcFrame& next);

  /// Blocks until a packet has arrived, a signal arrives, or `longest` has passed.
  void wait(std::chrono::milliseconds longest) const { listener_.wait(longest); }

  [[nodiscard]] const VmcReceived& received() const { return assembler_.received(); }
  /// Returns the last received status, also if no frame was complete since.
  [[nodiscard]] const VmcStatus& status() const { return assembler_.status(); }
  [[nodiscard]] int port() const { return listener_.port(); }

 private:
  explicit VmcReceiver(UdpListener listener);
  UdpListener listener_;
  VmcAssembler assembler_;
};

}  // namespace marey::live
