// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_outputs.h"

#include <utility>

#include "core/base/assert.h"
#include "live/vmc/vmc_commands.h"
#include "live/vmc/vmc_encoder.h"

namespace marey::app {

Result<LiveOutputs> LiveOutputs::open(const std::vector<VmcStream>& streams,
                                      const std::vector<StreamTargets>& targets,
                                      const std::vector<live::UdpAddress>& vrchat) {
  MAREY_ASSERT(streams.size() == targets.size());
  LiveOutputs out;
  out.targets_ = targets;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    auto sender = live::UdpSender::open(targets[s].addresses);
    if (!sender) return sender.error();
    out.senders_.push_back(*std::move(sender));
    if (!streams[s].listen_port || out.listener_) continue;
    auto listener = live::UdpListener::open({"127.0.0.1", *streams[s].listen_port});
    if (!listener) return listener.error();
    out.listener_.emplace(*std::move(listener));
    out.listening_stream_ = s;
  }
  out.vmc_streams_ = streams.size();
  if (!vrchat.empty()) {
    auto sender = live::UdpSender::open(vrchat);
    if (!sender) return sender.error();
    out.senders_.push_back(*std::move(sender));
    out.targets_.push_back({vrchat});
  }
  return out;
}

LiveRequests& LiveOutputs::take_requests() {
  constexpr int kMaxPackets = 64;
  requests_.clear();
  if (!listener_) return requests_;
  live::VmcCommands commands;
  for (int i = 0; i < kMaxPackets; ++i) {
    const auto packet = listener_->receive();
    if (!packet) break;
    live::read_commands(*packet, commands);
  }
  if (!commands.periods && !commands.info) return requests_;
  requests_.streams.resize(listening_stream_ + 1);
  requests_.streams.back() = {commands.periods, commands.info};
  return requests_;
}

void LiveOutputs::send(const LiveResult& result) {
  // A replay may have fewer targets than the recorded run.
  MAREY_ASSERT(result.packets.size() >= senders_.size());
  for (std::size_t s = 0; s < senders_.size(); ++s) {
    for (const auto& packet : result.packets[s]) senders_[s].send(packet);
  }
}

void LiveOutputs::send_not_tracking() {
  live::VmcStatus status;
  status.tracking = false;
  const std::vector<std::uint8_t> packet = live::vmc_status_packet(status);
  for (std::size_t s = 0; s < vmc_streams_; ++s) senders_[s].send(packet);
}

std::vector<OutputCounts> LiveOutputs::counts() const {
  std::vector<OutputCounts> out;
  for (std::size_t s = 0; s < senders_.size(); ++s) {
    for (std::size_t t = 0; t < targets_[s].addresses.size(); ++t) {
      const char* const what = s < vmc_streams_ ? "VMC " : "VRChat ";
      out.push_back(
          {what + live::text_of(targets_[s].addresses[t]), senders_[s].counts()[t]});
    }
  }
  return out;
}

}  // namespace marey::app
