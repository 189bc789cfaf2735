// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_streams.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "live/vmc/vmc_sender.h"

namespace marey::app {
namespace {

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || host.rfind("127.", 0) == 0;
}

}  // namespace

Status plan_streams(const std::vector<std::string>& vmc,
                    live::VmcRest rest,
                    std::optional<int> mtu_bytes,
                    LiveSettings& settings,
                    std::vector<StreamTargets>& targets) {
  constexpr int kEthernet = 1472;
  for (const std::string& text : vmc) {
    const std::size_t equals = text.find('=');
    VmcStream stream;
    stream.rest = rest;
    if (!settings.avatars.empty()) stream.avatar = 0;
    if (equals != std::string::npos) {
      const std::string name = shown_name(text.substr(0, equals));
      const auto found = std::find_if(
          settings.avatars.begin(), settings.avatars.end(), [&](const std::string& file) {
            return file == name || std::filesystem::path(file).stem() == name;
          });
      if (found == settings.avatars.end()) {
        return bad_input("--vmc " + text,
                         "there is no avatar \"" + name + "\"",
                         "name one of --avatar by its file");
      }
      stream.avatar = static_cast<std::size_t>(found - settings.avatars.begin());
    }
    const std::string address_text =
        equals == std::string::npos ? text : text.substr(equals + 1);
    auto address = live::parse_udp_address(address_text, live::kMarionettePort);
    if (!address) return address.error();
    if (mtu_bytes) {
      if (*mtu_bytes > 0) stream.mtu_bytes = *mtu_bytes;
    } else if (!is_loopback(address->host)) {
      stream.mtu_bytes = kEthernet;
    }
    const auto same = std::find_if(
        settings.streams.begin(), settings.streams.end(), [&](const VmcStream& one) {
          return one.avatar == stream.avatar && one.mtu_bytes == stream.mtu_bytes;
        });
    if (same != settings.streams.end()) {
      const auto place = static_cast<std::size_t>(same - settings.streams.begin());
      targets[place].addresses.push_back(*std::move(address));
      continue;
    }
    settings.streams.push_back(stream);
    targets.push_back({{*std::move(address)}});
  }
  return Done{};
}

}  // namespace marey::app
