// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_results.h"

#include <cstring>
#include <span>

namespace marey::app {
namespace {

template <class T>
void put(std::vector<std::byte>& out, const T* values, std::size_t count) {
  const std::size_t at = out.size();
  out.resize(at + count * sizeof(T));
  if (count > 0) std::memcpy(out.data() + at, values, count * sizeof(T));
}

void put_count(std::vector<std::byte>& out, std::size_t count) {
  const auto value = static_cast<std::uint32_t>(count);
  put(out, &value, 1);
}

void put_pose(std::vector<std::byte>& out, const Pose& pose) {
  put(out, &pose.root_in_world.x, 3);
  put_count(out, pose.parent_from_joint.size());
  for (const glm::dquat& q : pose.parent_from_joint) {
    const double numbers[4] = {q.x, q.y, q.z, q.w};
    put(out, static_cast<const double*>(numbers), 4);
  }
}

}  // namespace

void write_results(const LiveResult& result, std::vector<std::byte>& out) {
  out.clear();
  put_count(out, static_cast<std::size_t>(result.track.state));
  put_count(out, static_cast<std::size_t>(result.track.tags_used));
  put(out, &result.track.rms_px, 1);
  put_pose(out, *result.pose);
  put_count(out, result.uncertainty.size());
  for (const JointUncertainty& uncertainty : result.uncertainty) {
    put(out, &uncertainty.sigma_m, 1);
    put_count(out, static_cast<std::size_t>(uncertainty.source));
  }
  put_count(out, result.avatars.size());
  for (const Pose& pose : result.avatars) put_pose(out, pose);
  put_count(out, result.packets.size());
  for (const auto& stream : result.packets) {
    put_count(out, stream.size());
    for (const auto& packet : stream) {
      put_count(out, packet.size());
      put(out, packet.data(), packet.size());
    }
  }
}

}  // namespace marey::app
