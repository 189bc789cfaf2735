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
  edit::ZmpTrack track = edit::zmp_track(body.reference, body.map, masses, ground);
  const std::vector<glm::dvec3> start = track.com_in_world;
  std::vector<glm::dvec2> displaced(start.size(), glm::dvec2(0.0));
  ZmpAdapted out;
  for (int round = 0; round < kZmpRounds; ++round) {
    const dynamics::KeepZmpResult step = dynamics::keep_zmp({track.com_in_world,
                                                             track.reactions,
                                                             track.supports,
                                                             body.reference.rate,
                                                             displaced,
                                                             {}},
                                                            keep);
    keep.price_m = step.price_m;
    // Targets start from where the centre of mass is: it may not have reached the last
    // ones.
    std::vector<glm::dvec3> targets = start;
    for (std::size_t t = 0; t < start.size(); ++t) {
      targets[t].x = track.com_in_world[t].x + step.shift_xz_m[t].x;
      targets[t].z = track.com_in_world[t].z + step.shift_xz_m[t].y;
      displaced[t] = {targets[t].x - start[t].x, targets[t].z - start[t].z};
    }
    options.com_in_world = targets;
    auto adapted = retarget::adapt_motion(body.reference,
                                          body.character,
                                          constraints,
                                          supports,
                                          options,
                                          round == 0 ? progress : Progress{});
    if (!adapted) return adapted.error();
    track = edit::zmp_track(adapted->motion, body.map, masses, ground);
    const auto figures = dynamics::zmp_figures(track.reactions, track.supports);
    const auto outside = [](const dynamics::ZmpFigures& of) {
      return of.supported_frames - of.inside_frames;
    };
    if (round == 0 || outside(figures) < outside(out.figures)) {
      out = {*std::move(adapted), figures};
    }
    if (outside(figures) == 0) break;
  }
  return out;
}

}  // namespace marey::app
