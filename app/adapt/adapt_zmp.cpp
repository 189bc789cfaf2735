// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_zmp.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "dynamics/balance/keep_zmp.h"
#include "edit/balance/zmp_track.h"
#include <glm/vec2.hpp>

namespace marey::app {
namespace {

constexpr int kZmpRounds = 6;

/// Returns the masses of the body with the loads that it carries.
std::vector<PointMass> carried_masses(const Character& character,
                                      const std::vector<std::string>& carried) {
  std::vector<PointMass> out = character.masses;
  for (const Load& load : character.loads) {
    if (std::find(carried.begin(), carried.end(), load.name) == carried.end()) continue;
    out.push_back(load.mass);
  }
  return out;
}

}  // namespace

Result<ZmpAdapted> adapt_with_zmp(const AdaptBody& body,
                                  const ConstraintSet& constraints,
                                  std::span<const retarget::SupportTrack> supports,
                                  retarget::AdaptMotionOptions options,
                                  const Progress& progress) {
  const std::vector<PointMass> masses = carried_masses(body.character, options.carried);
  const edit::ZmpGround ground =
      edit::zmp_ground(body.reference, body.map, body.contacts);
  dynamics::KeepZmpOptions keep;
  keep.zmp.floor_height_m = ground.floor_height_m;
  ZmpAdapted out;
  edit::ZmpTrack track = edit::zmp_track(body.reference, body.map, masses, ground);
  out.com_in_world = track.com_in_world;
  std::vector<glm::dvec2> displaced(track.com_in_world.size(), glm::dvec2(0.0));
  for (int round = 0; round < kZmpRounds; ++round) {
    const dynamics::KeepZmpResult step = dynamics::keep_zmp({track.com_in_world,
                                                             track.reactions,
                                                             track.supports,
                                                             body.reference.rate,
                                                             displaced,
                                                             {}},
                                                            keep);
    keep.price_m = step.price_m;
    for (std::size_t t = 0; t < displaced.size(); ++t) {
      displaced[t] += step.shift_xz_m[t];
      out.com_in_world[t] += glm::dvec3(step.shift_xz_m[t].x, 0.0, step.shift_xz_m[t].y);
    }
    options.com_in_world = out.com_in_world;
    auto adapted = retarget::adapt_motion(body.reference,
                                          body.character,
                                          constraints,
                                          supports,
                                          options,
                                          round == 0 ? progress : Progress{});
    if (!adapted) return adapted.error();
    out.adapted = *std::move(adapted);
    track = edit::zmp_track(out.adapted.motion, body.map, masses, ground);
    out.figures = dynamics::zmp_figures(track.reactions, track.supports);
    if (out.figures.inside_frames == out.figures.supported_frames) break;
  }
  return out;
}

}  // namespace marey::app
