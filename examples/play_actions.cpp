// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Plays a walk and a reach on a character: asks whether the hand can arrive before it
// plays, moves the target on the way, and writes the result as BVH.
//
//     play_actions WALK.bvh REACH.bvh ARRIVE_S OUT.bvh
//
// ARRIVE_S is the time in REACH.bvh at which its right hand arrives. The bones of both
// files have VRM's names, as in the files that marey writes. The character has the body
// of the walk.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "engine/clips/make_clip.h"
#include "engine/engine.h"
#include <glm/geometric.hpp>

#include "core/motion.h"
#include "recordings/motion/bvh.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"

using namespace marey;

namespace {

constexpr int kRightHand = 1;

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

/// Reads a clip. Programs that have a base of `marey base build` call
/// recordings::read_moves() instead.
Result<engine::ClipSource> read_clip(const std::string& name, const std::string& file) {
  auto read = recordings::read_bvh(file);
  if (!read) return read.error();
  auto map = retarget::map_body(read->motion.skeleton);
  if (!map) return map.error();
  engine::ClipSource source;
  source.name = name;
  source.map = *std::move(map);
  source.motion = std::move(read->motion);
  source.contacts = retarget::detect_contacts(source.motion, source.map);
  return source;
}

Result<engine::CharacterSpec> make_spec(const engine::ClipSource& body) {
  auto character = retarget::make_character("ann", body.motion.skeleton, body.map);
  if (!character) return character.error();
  engine::CharacterSpec spec;
  spec.character = *std::move(character);
  spec.map = body.map;
  spec.reaches = true;
  return spec;
}

/// Returns a place in front of the right shoulder, seen by a character that faces +Z.
glm::dvec3 in_front(const engine::CharacterPlayer& player, double forward_arms) {
  const auto joints = player.world_from_joint();
  const auto shoulder = joints[index(player.map().limbs[kRightHand]->upper)].translation;
  const double arm_m = player.map().arm_length_m;
  return shoulder + arm_m * glm::dvec3(0.1, -0.2, forward_arms);
}

/// Returns the distance of the palm from a place.
double palm_to_m(const engine::CharacterPlayer& player, const glm::dvec3& p_in_world) {
  const auto joints = player.world_from_joint();
  const auto wrist = joints[index(player.map().limbs[kRightHand]->end)].translation;
  const double palm_m =
      engine::reach_lengths(player.character().skeleton, player.map(), kRightHand).palm_m;
  return glm::distance(wrist, p_in_world) - palm_m;
}

/// Advances by steps and keeps the postures.
void play_on(engine::Engine& engine, engine::CharacterId who, int steps, Motion& out) {
  for (int i = 0; i < steps; ++i) {
    engine.advance();
    out.poses.push_back(engine.pose(who));
  }
}

Status play_scene(engine::Engine& engine, engine::CharacterId ann, Motion& out) {
  engine::ActionWish walk;
  walk.clip = "walk";
  if (const auto played = engine.play(ann, walk); !played) return played.error();
  play_on(engine, ann, 60, out);

  engine::ReachWish reach;
  reach.action.clip = "reach";
  reach.side = kRightHand;
  reach.target.p_in_world = in_front(engine.player(ann), 5.0);
  const auto too_far = engine.ask(ann, reach);
  if (!too_far) return too_far.error();
  std::printf("far_reachable %d\n", too_far->reachable ? 1 : 0);
  std::printf("far_missing_m %.2f\n", too_far->missing_m);

  reach.target.p_in_world = in_front(engine.player(ann), 0.8);
  const auto near = engine.ask(ann, reach);
  if (!near) return near.error();
  std::printf("near_reachable %d\n", near->reachable ? 1 : 0);
  if (!near->reachable) return Done{};
  if (const auto played = engine.play(ann, reach); !played) return played.error();
  play_on(engine, ann, 30, out);

  // The cup is lifted by 5 cm while the hand is on its way.
  reach.target.p_in_world.y += 0.05;
  if (const Status ok = engine.aim(ann, kRightHand, reach.target); !ok) return ok;
  play_on(engine, ann, 60, out);
  const double miss_m = palm_to_m(engine.player(ann), reach.target.p_in_world);
  std::printf("palm_to_cup_mm %.3f\n", 1000.0 * std::abs(miss_m));
  return Done{};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return fail(bad_input("", "arguments are missing", "see the source"));
  std::vector<engine::ClipSource> sources;
  for (const int i : {1, 2}) {
    auto source = read_clip(i == 1 ? "walk" : "reach", argv[i]);
    if (!source) return fail(source.error());
    sources.push_back(*std::move(source));
  }
  const double arrive_s = std::atof(argv[3]);
  sources.back().annotations.notes.push_back({"arrive", arrive_s, arrive_s});
  auto moves = engine::make_moves(sources);
  if (!moves) return fail(moves.error());
  auto base = engine::MotionBase::make(*std::move(moves));
  if (!base) return fail(base.error());
  auto engine = engine::Engine::make(*base, {.step_hz = 60.0});
  if (!engine) return fail(engine.error());
  auto spec = make_spec(sources.front());
  if (!spec) return fail(spec.error());
  const auto ann = engine->add(*std::move(spec));
  if (!ann) return fail(ann.error());

  Motion out;
  out.skeleton = sources.front().motion.skeleton;
  out.rate.hz = 60.0;
  if (const Status ok = play_scene(*engine, *ann, out); !ok) return fail(ok.error());
  if (const Status ok = recordings::write_bvh(argv[4], out); !ok) return fail(ok.error());
  return 0;
}
