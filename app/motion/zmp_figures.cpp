// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/motion/zmp_figures.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "edit/balance/zmp_track.h"
#include <nlohmann/json.hpp>

#include "retarget/body/place_masses.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey::app {
namespace {

double rounded_to_tenths(double value) {
  return std::round(10.0 * value) / 10.0;
}

}  // namespace

MotionZmp motion_zmp(const Motion& motion,
                     const retarget::BodyMap& map,
                     const Contacts& contacts,
                     std::span<const PointMass> masses) {
  edit::ZmpTrack track =
      edit::zmp_track(motion, map, masses, edit::zmp_ground(motion, map, contacts));
  MotionZmp out;
  out.figures = dynamics::zmp_figures(track.reactions, track.supports);
  for (std::size_t t = 0; t < track.reactions.size(); ++t) {
    out.frames.push_back({track.com_in_world[t],
                          std::move(track.supports[t]),
                          track.reactions[t].zmp_xz_m});
  }
  return out;
}

std::optional<MotionZmp> find_motion_zmp(const Motion& motion) {
  const auto map = retarget::map_body(motion.skeleton);
  if (!map || motion.poses.size() < 2) return std::nullopt;
  const auto masses = retarget::place_masses(motion.skeleton, *map, {});
  if (!masses) return std::nullopt;
  return motion_zmp(motion, *map, retarget::detect_contacts(motion, *map), *masses);
}

nlohmann::ordered_json zmp_json(const dynamics::ZmpFigures& figures) {
  nlohmann::ordered_json out{
      {"loaded_frames", figures.loaded_frames},
      {"supported_frames", figures.supported_frames},
      {"outside_frames", figures.supported_frames - figures.inside_frames},
      {"inside_percent", rounded_to_tenths(100.0 * figures.inside_share())},
      {"worst_outside_mm", rounded_to_tenths(1e3 * figures.worst_outside_m)}};
  if (figures.worst_frame) out["worst_frame"] = *figures.worst_frame;
  return out;
}

}  // namespace marey::app
