// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Cost and memory of a character in the engine (bars 8, 9 and 13).
//
//   engine_step ../shared/data/mocap [CHARACTERS]
//
// Characters of 22 bones with heights from 1.2 to 2.2 m play two actions each: a walk or
// a dance (Bandai Namco), and an arm action above it; every fifth one reaches for a far
// target by a constraint of its right hand. Processor time of one thread over 120 steps
// after 30 steps, median of five runs. Memory: live bytes of the heap. The last
// column compares the postures of one and two threads byte by byte.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/clips/make_clip.h"
#include "engine/engine.h"
#include <malloc.h>
#include <time.h>

#include "benchmarks/engine/transition_clips.h"
#include "benchmarks/parts/result_table.h"
#include "benchmarks/parts/taken.h"
#include "core/base/quantile.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey {
namespace {

using engine::DetailLevel;
using engine::Engine;

constexpr int kWarm = 30;
constexpr int kSteps = 120;

double thread_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

std::shared_ptr<const engine::MotionBase> base_of(const TransitionClips& clips) {
  std::vector<engine::ClipSource> sources;
  for (const TransitionClip* clip :
       {&clips.bandai_walk, &clips.bandai_dance, &clips.bandai_kick}) {
    engine::ClipSource source;
    source.name = clip->name;
    source.motion = clip->motion;
    source.map = clip->map;
    source.contacts = retarget::detect_contacts(clip->motion, clip->map);
    sources.push_back(std::move(source));
  }
  return taken(engine::MotionBase::make(taken(engine::make_moves(sources))));
}

Skeleton scaled_body(const Skeleton& skeleton, double scale) {
  Skeleton out = skeleton;
  for (Joint& joint : out.joints) joint.parent_from_joint.translation *= scale;
  return out;
}

struct Scene {
  Engine engine;
  std::size_t bytes = 0;
};

Scene make_scene(const std::shared_ptr<const engine::MotionBase>& base,
                 const Skeleton& skeleton,
                 int characters,
                 DetailLevel level,
                 bool targets,
                 int threads) {
  Scene scene{taken(Engine::make(base, {.step_hz = 60.0, .threads = threads}))};
  const std::size_t before = mallinfo2().uordblks;
  for (int i = 0; i < characters; ++i) {
    const double scale = 0.7 + 0.6 * (i % 37) / 36.0;
    const Skeleton body = scaled_body(skeleton, scale);
    engine::CharacterSpec spec;
    spec.map = taken(retarget::map_body(body));
    spec.character = taken(retarget::make_character("actor", body, spec.map));
    spec.level = level;
    spec.start = {2.0 * (i % 40), 2.0 * (i / 40), 0.1 * i};
    if (targets && i % 5 == 0) {
      Constraint reach;
      reach.id = "far";
      reach.point.segment = "rightHand";
      reach.goal =
          DistanceToPoint{0.0, {spec.start.x_m + 1.0, 2.0 * scale, spec.start.z_m + 1.0}};
      spec.constraints.constraints.push_back(reach);
    }
    const auto who = taken(scene.engine.add(std::move(spec)));
    engine::ActionWish first;
    first.clip = base->clip(i % 3 == 0 ? 0 : 2).name;
    first.entry_s = 0.01 * (i % 20);
    (void)taken(scene.engine.play(who, first));
    engine::ActionWish arms;
    arms.clip = base->clip(1).name;
    arms.priority = engine::only(EditGroup::kLeftArm);
    arms.priority[static_cast<std::size_t>(EditGroup::kRightArm)] = 0.5F;
    (void)taken(scene.engine.play(who, arms));
  }
  scene.bytes = mallinfo2().uordblks - before;
  return scene;
}

std::vector<TableCell> row_of(const std::string& name,
                              const std::shared_ptr<const engine::MotionBase>& base,
                              const Skeleton& skeleton,
                              int characters,
                              DetailLevel level,
                              bool targets) {
  std::vector<double> runs;
  double kib = 0.0;
  for (int run = 0; run < 5; ++run) {
    Scene scene = make_scene(base, skeleton, characters, level, targets, 1);
    kib = static_cast<double>(scene.bytes) / characters / 1024.0;
    scene.engine.advance(kWarm);
    const double start = thread_us();
    scene.engine.advance(kSteps);
    runs.push_back((thread_us() - start) / (characters * kSteps));
  }
  std::sort(runs.begin(), runs.end());
  const int few = std::min(characters, 50);
  Scene one = make_scene(base, skeleton, few, level, targets, 1);
  Scene two = make_scene(base, skeleton, few, level, targets, 2);
  one.engine.advance(kWarm);
  two.engine.advance(kWarm);
  double differ = 0.0;
  for (int i = 0; i < few; ++i) {
    const Pose& a = one.engine.pose(engine::CharacterId{i});
    const Pose& b = two.engine.pose(engine::CharacterId{i});
    if (a.root_in_world != b.root_in_world ||
        a.parent_from_joint != b.parent_from_joint) {
      differ += 1.0;
    }
  }
  return {name, runs[2], kib, differ};
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  using namespace marey;
  const std::filesystem::path mocap = argc > 1 ? argv[1] : "../shared/data/mocap";
  const int characters = argc > 2 ? std::max(1, std::atoi(argv[2])) : 1000;
  const TransitionClips clips = taken(read_transition_clips(mocap));
  const auto base = base_of(clips);
  const Skeleton& skeleton = clips.bandai_walk.motion.skeleton;
  ResultTable table{"engine_step",
                    std::to_string(characters) + " characters, two actions each",
                    {{"level"}, {"us a step", 2}, {"KiB", 1}, {"differ, 2 threads", 0}},
                    {},
                    {}};
  table.rows.push_back(
      row_of("0: blended", base, skeleton, characters, DetailLevel::kBlended, false));
  table.rows.push_back(
      row_of("1: feet", base, skeleton, characters, DetailLevel::kKinematic, false));
  table.rows.push_back(row_of("1: feet, 20 % far targets",
                              base,
                              skeleton,
                              characters,
                              DetailLevel::kKinematic,
                              true));
  table.rows.push_back(row_of("2: balance, 20 % far targets",
                              base,
                              skeleton,
                              characters,
                              DetailLevel::kKinetic,
                              true));
  print_table(table);
  return 0;
}
