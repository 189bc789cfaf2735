// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_receiver.h"

#include <utility>

namespace marey::live {
namespace {

// More than one second of any sender. The limit keeps a flood from blocking the caller.
constexpr int kMaxPackets = 256;

}  // namespace

VmcReceiver::VmcReceiver(UdpListener listener) : listener_(std::move(listener)) {}

Result<VmcReceiver> VmcReceiver::open(const UdpAddress& address) {
  Result<UdpListener> listener = UdpListener::open(address);
  if (!listener) return listener.error();
  return VmcReceiver(*std::move(listener));
}

bool VmcReceiver::receive(VmcFrame& newest) {
  for (int i = 0; i < kMaxPackets; ++i) {
    const auto packet = listener_.receive();
    if (!packet) break;
    assembler_.take(*packet);
  }
  return assembler_.take_frame(newest);
}

bool VmcReceiver::receive_next(VmcFrame& next) {
  for (int i = 0; i < kMaxPackets; ++i) {
    const auto packet = listener_.receive();
    if (!packet) return false;
    assembler_.take(*packet);
    if (assembler_.take_frame(next)) return true;
  }
  return false;
}

}  // namespace marey::live
