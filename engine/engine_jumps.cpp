// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "engine/engine.h"
#include <glm/geometric.hpp>

// Requests of jumps, and answers about them.

namespace marey::engine {
namespace {

Status check_jump_wish(const JumpWish& wish) {
  const std::string where = "jump \"" + wish.action.clip + "\"";
  if (wish.changes.landing_in_world) {
    return bad_input(where,
                     "the landing is given among the changes",
                     "give JumpWish::landing_in_world");
  }
  if (!wish.landing_in_world) return Done{};
  const glm::dvec3& p = *wish.landing_in_world;
  if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) return Done{};
  return bad_input(where, "the landing is not finite", "give a point in metres");
}

// The wish in the frame of the clip's first root.
dynamics::JumpWish in_clip(const JumpWish& wish, const RootPlace& root) {
  dynamics::JumpWish out = wish.changes;
  if (wish.landing_in_world) {
    out.landing_in_world = glm::angleAxis(-root.heading_rad, glm::dvec3(0.0, 1.0, 0.0)) *
                           (*wish.landing_in_world - glm::dvec3(root.x_m, 0.0, root.z_m));
  }
  return out;
}

}  // namespace

Result<ActionId> Engine::play(CharacterId character, const JumpWish& wish) {
  auto action = checked(character, wish.action);
  if (!action) return action.error();
  if (const Status good = check_jump_wish(wish); !good) return good.error();
  CharacterPlayer& who = player(character);
  const auto body = who.jump_body(action->clip, wish.jump);
  if (!body) return body.error();
  const auto plan = (*body)->plan(in_clip(wish, who.blend().root()), wish.traits);
  if (!plan) return plan.error();
  if (!plan->is_identity()) {
    action->clip = who.add_clip((*body)->planned_clip(base_->clip(action->clip), *plan));
  }
  return add_action(character, *std::move(action));
}

Result<JumpFeasibility> Engine::ask(CharacterId character, const JumpWish& wish) {
  const auto action = checked(character, wish.action);
  if (!action) return action.error();
  if (const Status good = check_jump_wish(wish); !good) return good.error();
  CharacterPlayer& who = player(character);
  const auto body = who.jump_body(action->clip, wish.jump);
  if (!body) return body.error();
  const dynamics::JumpWish changes = in_clip(wish, who.blend().root());
  const auto plan = (*body)->plan(changes, wish.traits);
  JumpFeasibility out;
  if (!plan) {
    out.why = plan.error().message();
    const auto& landing = (*body)->captured().landing_feet_in_world;
    if (landing && changes.landing_in_world) {
      out.missing_m = glm::distance(*landing, *changes.landing_in_world);
    }
    return out;
  }
  out.reachable = true;
  out.apex_m = plan->apex_m() - (*body)->captured().takeoff_feet_in_world.y;
  const double landing_s =
      plan->touchdown() ? plan->touchdown()->time_s : plan->takeoff().time_s;
  out.duration_s = landing_s / action->rate;
  out.airtime_s = (landing_s - plan->takeoff().time_s) / action->rate;
  out.steps = static_cast<int>(std::ceil(out.duration_s / step_s() - 1e-9));
  return out;
}

}  // namespace marey::engine
