// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_vmc.h"

#include <optional>
#include <utility>

#include "core/base/in_quotes.h"

namespace marey::app {
namespace {

constexpr const char* kThisMachine = "127.0.0.1";

Result<std::size_t> body_to_send(const Scene& scene, const std::string& name) {
  const auto members = members_of(scene, name);
  if (members && members->count == 1) return members->first;
  return bad_input(
      "--vmc",
      members ? in_quotes(name) + " is a group" : "there is no body " + in_quotes(name),
      members ? "name one member: " + name + ".1" : "name a body of the scene");
}

/// Adds the receivers of one option.
Status add_routes(const Scene& scene,
                  const std::string& option,
                  std::vector<VmcRoute>& routes) {
  const std::size_t equals = option.find('=');
  const std::string host =
      equals == std::string::npos ? option : option.substr(equals + 1);
  // Port 0 stands for a port that the option leaves out.
  const auto address = live::parse_udp_address(host, 0);
  if (!address) return address.error();
  const auto route = [&](std::size_t body, int port) {
    VmcRoute& out = routes.emplace_back(VmcRoute{body, *address});
    if (out.address.port == 0) out.address.port = port;
  };
  if (equals != std::string::npos) {
    const auto body = body_to_send(scene, option.substr(0, equals));
    if (!body) return body.error();
    route(*body, live::kMarionettePort);
    return Done{};
  }
  if (scene.out.vmc.empty()) route(0, live::kMarionettePort);
  for (const SceneVmc& one : scene.out.vmc) {
    const auto body = body_to_send(scene, one.body);
    if (!body) return body.error();
    route(*body, one.port);
  }
  return Done{};
}

}  // namespace

Result<std::vector<VmcRoute>> plan_vmc(const Scene& scene,
                                       const std::vector<std::string>& vmc) {
  std::vector<VmcRoute> routes;
  for (const SceneVmc& one : scene.out.vmc) {
    const auto body = body_to_send(scene, one.body);
    if (!body) return body.error();
    routes.push_back({*body, {kThisMachine, one.port}});
  }
  for (const std::string& option : vmc) {
    if (const Status ok = add_routes(scene, option, routes); !ok) return ok.error();
  }
  return routes;
}

Result<StageVmc> StageVmc::open(const std::vector<VmcRoute>& routes,
                                const SceneRun& run) {
  StageVmc out;
  for (const VmcRoute& route : routes) {
    const Character& character = run.body(route.body).character;
    live::VmcBodyOptions options;
    options.t_pose_from_joint = character.t_pose_from_joint;
    auto converter = live::VmcBody::make(character.skeleton, options);
    if (!converter) return converter.error();
    auto sender =
        live::VmcSender::open({.targets = {route.address}, .listen = std::nullopt});
    if (!sender) return sender.error();
    out.streams_.push_back({route.body, *std::move(converter), *std::move(sender)});
  }
  return out;
}

void StageVmc::send(Timestamp time, const SceneRun& run) {
  for (Stream& stream : streams_) {
    stream.converter.to_vmc(run.pose(stream.body), stream.pose);
    stream.sender.send(time, stream.pose);
  }
}

std::int64_t StageVmc::failed() const {
  std::int64_t sum = 0;
  for (const Stream& stream : streams_) {
    for (const live::UdpCounts& count : stream.sender.counts()) sum += count.failed;
  }
  return sum;
}

}  // namespace marey::app
