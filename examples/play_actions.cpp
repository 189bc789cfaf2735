// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Plays a walk, then a run, on a character, and writes the result as BVH.
//
//     play_actions WALK.bvh RUN.bvh OUT.bvh
//
// The bones of both files must have VRM's names, as the files that marey writes. The
// character has the body of the walk. Prints the transition that was used.
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "engine/clips/make_clip.h"
#include "engine/engine.h"

#include "core/motion.h"
#include "recordings/motion/bvh.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"

using namespace marey;

namespace {

constexpr int kSwitchSteps = 60;
constexpr int kSteps = 150;

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return fail(bad_input("", "arguments are missing", "see the source"));
  std::vector<engine::ClipSource> sources;
  for (const int i : {1, 2}) {
    auto source = read_clip(i == 1 ? "walk" : "run", argv[i]);
    if (!source) return fail(source.error());
    sources.push_back(*std::move(source));
  }
  auto moves = engine::make_moves(sources);
  if (!moves) return fail(moves.error());
  auto base = engine::MotionBase::make(*std::move(moves));
  if (!base) return fail(base.error());
  auto engine = engine::Engine::make(*base, {.step_hz = 60});
  if (!engine) return fail(engine.error());

  const engine::ClipSource& walker = sources.front();
  auto character = retarget::make_character("ann", walker.motion.skeleton, walker.map);
  if (!character) return fail(character.error());
  engine::CharacterSpec spec;
  spec.character = *std::move(character);
  spec.map = walker.map;
  const auto ann = engine->add(std::move(spec));
  if (!ann) return fail(ann.error());

  Motion out;
  out.skeleton = walker.motion.skeleton;
  out.rate.hz = 60.0;
  engine::ActionWish wish;
  wish.clip = "walk";
  if (const auto walk = engine->play(*ann, wish); !walk) return fail(walk.error());
  for (int i = 0; i < kSteps; ++i) {
    if (i == kSwitchSteps) {
      wish.clip = "run";
      if (const auto run = engine->play(*ann, wish); !run) return fail(run.error());
    }
    engine->advance();
    out.poses.push_back(engine->pose(*ann));
  }
  if (const Status ok = recordings::write_bvh(argv[3], out); !ok) return fail(ok.error());
  const engine::TransitionReport& report = engine->player(*ann).report().transition;
  std::printf("synchronised %d\n", report.is_synchronised ? 1 : 0);
  std::printf("incompatible_s %.3f\n", report.incompatible_s);
  return 0;
}
