// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_sender.h"

#include <utility>

namespace marey::live {
namespace {

// Commands are rare. The limit keeps a flood from delaying the frame.
constexpr int kMaxCommandPackets = 64;

}  // namespace

VmcSender::VmcSender(UdpSender udp,
                     std::optional<UdpListener> listener,
                     VmcEncoder encoder)
    : udp_(std::move(udp)),
      listener_(std::move(listener)),
      encoder_(std::move(encoder)) {}

Result<VmcSender> VmcSender::open(VmcSenderOptions options) {
  Result<UdpSender> udp = UdpSender::open(options.targets);
  if (!udp) return udp.error();
  std::optional<UdpListener> listener;
  if (options.listen) {
    Result<UdpListener> opened = UdpListener::open(*options.listen);
    if (!opened) return opened.error();
    listener = *std::move(opened);
    options.encoder.info.listen_port = listener->port();
  }
  Result<VmcEncoder> encoder = VmcEncoder::make(options.encoder);
  if (!encoder) return encoder.error();
  return VmcSender(*std::move(udp), std::move(listener), *std::move(encoder));
}

void VmcSender::receive_commands() {
  for (int i = 0; listener_ && i < kMaxCommandPackets; ++i) {
    const auto packet = listener_->receive();
    if (!packet) break;
    read_commands(*packet, commands_);
  }
  if (commands_.periods) encoder_.set_periods(*commands_.periods);
  commands_.periods.reset();
  if (std::exchange(commands_.info, false)) encoder_.request_info();
}

void VmcSender::send(Timestamp time, const VmcPose& pose, const VmcStatus& status) {
  receive_commands();
  for (const auto packet : encoder_.encode(time, pose, status)) udp_.send(packet);
}

VmcCommands VmcSender::take_commands() {
  VmcCommands taken = commands_;
  commands_.calibration_ready = false;
  commands_.calibration.reset();
  return taken;
}

std::optional<int> VmcSender::listen_port() const {
  if (!listener_) return std::nullopt;
  return listener_->port();
}

}  // namespace marey::live
