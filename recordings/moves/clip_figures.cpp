// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/moves/clip_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "recordings/moves/pack_frames.h"

namespace marey::recordings {
namespace {

/// Beginning or end of a contact.
struct ContactEdge {
  double time_s = 0.0;
  std::size_t foot = 0;  ///< 0 left, 1 right.
  int change = 0;        ///< For the number of its parts that bear.
};

std::vector<ContactEdge> contact_edges(const MotionClip& clip) {
  std::vector<ContactEdge> edges;
  const double last_s = clip.duration_s();
  for (std::size_t part = 0; part < clip.contacts.size(); ++part) {
    for (const ClipSpan& span : clip.contacts[part]) {
      edges.push_back(
          {std::clamp(static_cast<double>(span.start_s), 0.0, last_s), part / 2, 1});
      edges.push_back(
          {std::clamp(static_cast<double>(span.end_s), 0.0, last_s), part / 2, -1});
    }
  }
  std::stable_sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) {
    return a.time_s < b.time_s;
  });
  return edges;
}

}  // namespace

double mean_speed_m_s(const MotionClip& clip) {
  double way_legs = 0.0;
  for (std::size_t i = 1; i < clip.path.size(); ++i) {
    const ClipRoot& a = clip.path[i - 1];
    const ClipRoot& b = clip.path[i];
    way_legs += std::hypot(static_cast<double>(b.x_legs) - a.x_legs,
                           static_cast<double>(b.z_legs) - a.z_legs);
  }
  const double seconds = clip.duration_s();
  return seconds > 0.0 ? way_legs * clip.leg_length_m / seconds : 0.0;
}

std::string supports_of(const MotionClip& clip) {
  constexpr double kMinTime_s = 0.04;
  constexpr std::string_view kLetters = "NLRD";
  std::array<double, 4> times_s{};  // By kLetters: bit 0 left, bit 1 right.
  std::array<int, 2> bearing{};
  double time_s = 0.0;
  const std::vector<ContactEdge> edges = contact_edges(clip);
  if (edges.empty()) return "X";
  const auto add_until = [&](double end_s) {
    const std::size_t letter = (bearing[0] > 0 ? 1U : 0U) + (bearing[1] > 0 ? 2U : 0U);
    times_s[letter] += end_s - time_s;
    time_s = end_s;
  };
  for (const ContactEdge& edge : edges) {
    add_until(edge.time_s);
    bearing[edge.foot] += edge.change;
  }
  add_until(clip.duration_s());
  std::string out;
  for (std::size_t k = 0; k < kLetters.size(); ++k) {
    if (times_s[k] >= kMinTime_s) out += kLetters[k];
  }
  return out;
}

std::size_t clip_bytes(const MotionClip& clip) {
  std::size_t bytes = clip.frames.size() * kFrameBytes;
  for (const auto& part : clip.contacts) bytes += 4 + 8 * part.size();
  return bytes;
}

}  // namespace marey::recordings
