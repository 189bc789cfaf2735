// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/engine/engine_rival.h"

#include <cmath>
#include <utility>

#include "engine/clips/make_clip.h"
#include "engine/engine.h"

#include "benchmarks/parts/taken.h"
#include "retarget/character/make_character.h"
#include "retarget/contacts/detect_contacts.h"

namespace marey {
namespace {

using engine::Action;
using engine::ActionWish;
using engine::Engine;

engine::ClipSource source_of(const TransitionClip& clip, const std::string& name) {
  engine::ClipSource source;
  source.name = name;
  source.motion = clip.motion;
  source.map = clip.map;
  source.contacts = retarget::detect_contacts(clip.motion, clip.map);
  return source;
}

struct Way {
  std::string name;
  engine::TransitionKind kind = engine::TransitionKind::kAuto;
  bool anchors = true;
  engine::DetailLevel level = engine::DetailLevel::kKinematic;
};

class SwitchPlayer {
 public:
  explicit SwitchPlayer(const SwitchCase& first) {
    const std::vector<engine::ClipSource> sources{source_of(*first.from, "from"),
                                                  source_of(*first.to, "to")};
    base_ = taken(engine::MotionBase::make(taken(engine::make_moves(sources))));
    map_ = first.from->map;
    character_ =
        taken(retarget::make_character("actor", first.from->motion.skeleton, map_));
  }

  [[nodiscard]] TransitionResult play(const SwitchCase& played, const Way& way) const {
    Engine engine = taken(Engine::make(base_, {.step_hz = kTransitionRate_hz}));
    engine::CharacterSpec spec;
    spec.character = character_;
    spec.map = map_;
    spec.level = way.level;
    spec.blend.anchors_root = way.anchors;
    const auto who = taken(engine.add(std::move(spec)));
    const int around =
        static_cast<int>(std::lround(kPlayedAround_s * kTransitionRate_hz));
    ActionWish first;
    first.clip = "from";
    first.fade_out_s = 0.0;
    first.entry_s = std::max(0.0, played.leave_s - kPlayedAround_s);
    const auto before = taken(engine.play(who, first));
    TransitionResult result;
    result.motion.skeleton = character_.skeleton;
    result.motion.rate = {kTransitionRate_hz};
    result.switch_s = kPlayedAround_s;
    std::optional<engine::ActionId> after;
    for (int i = 0; i <= 2 * around; ++i) {
      if (i == around + 1) {
        ActionWish next;
        next.clip = "to";
        next.fade_out_s = 0.0;
        next.entry_s = played.enter_s;
        next.entry_search_s = played.to->is_cyclic ? 0.7 : 0.5;
        next.transition = way.kind;
        after = taken(engine.play(who, next));
      }
      engine.advance();
      const engine::CharacterPlayer& player = engine.player(who);
      result.motion.poses.push_back(player.pose());
      TransitionFrame frame;
      const Action* a = player.blend().find(before);
      const Action* b = after ? player.blend().find(*after) : nullptr;
      const double from = a != nullptr && a->is_alive() ? a->fade(engine.time_s()) : 0.0;
      const double to = b != nullptr && b->is_alive() ? b->fade(engine.time_s()) : 0.0;
      frame.source_s[0] = a != nullptr ? a->warp.source_s(engine.time_s()) : 0.0;
      frame.source_s[1] = b != nullptr ? b->warp.source_s(engine.time_s()) : 0.0;
      const double sum = from + to;
      frame.weight = {sum > 0.0 ? from / sum : 0.0, sum > 0.0 ? to / sum : 1.0};
      if (player.report().transition.is_inertial && b != nullptr) {
        const double since = engine.time_s() - b->started_s;
        const double y = 2.0 * 0.6931471805599453 / 0.1;
        frame.arrived = 1.0 - (1.0 + y * since) * std::exp(-y * since);
      }
      result.frames.push_back(frame);
      // The blend on the floor, before feet lower or move the hips.
      glm::dvec3 hips_in_world = player.reference().root_in_world;
      if (way.level != engine::DetailLevel::kBlended) {
        hips_in_world.y = player.lift_m() +
                          player.map().leg_length_m *
                              static_cast<double>(player.blend().posture().height_legs);
      }
      result.blend_hips_in_world.push_back(hips_in_world);
    }
    return result;
  }

 private:
  std::shared_ptr<const engine::MotionBase> base_;
  retarget::BodyMap map_;
  Character character_;
};

}  // namespace

std::vector<EngineTransitions> engine_transitions(const std::vector<SwitchCase>& cases,
                                                  const std::string& only) {
  const SwitchPlayer player(cases.front());
  using engine::DetailLevel;
  using engine::TransitionKind;
  const std::vector<Way> ways{
      {"engine: cut", TransitionKind::kCut, false, DetailLevel::kBlended},
      {"engine: crossfade, any phase",
       TransitionKind::kCrossfade,
       false,
       DetailLevel::kBlended},
      {"engine: inertial, not anchored",
       TransitionKind::kInertial,
       false,
       DetailLevel::kBlended},
      {"engine: auto, not anchored", TransitionKind::kAuto, false, DetailLevel::kBlended},
      {"engine: auto, anchored root", TransitionKind::kAuto, true, DetailLevel::kBlended},
      {"engine: auto, supports", TransitionKind::kAuto, true, DetailLevel::kKinematic},
      {"engine: inertial, supports",
       TransitionKind::kInertial,
       true,
       DetailLevel::kKinematic},
      {"engine: synchronised, supports",
       TransitionKind::kSynchronised,
       true,
       DetailLevel::kKinematic},
  };
  std::vector<EngineTransitions> out;
  for (const Way& way : ways) {
    if (!only.empty() && way.name != only) continue;
    EngineTransitions method{way.name, {}};
    for (const SwitchCase& played : cases)
      method.results.push_back(player.play(played, way));
    out.push_back(std::move(method));
  }
  return out;
}

std::vector<EngineLoop> engine_loops(const LoopClip& loop) {
  engine::ClipSource source;
  source.name = "loop";
  source.motion = loop.motion;
  source.map = loop.map;
  source.contacts = loop.contacts;
  source.loops = true;
  const std::vector<engine::ClipSource> sources{source};
  auto base = taken(engine::MotionBase::make(taken(engine::make_moves(sources))));
  engine::CharacterSpec spec;
  spec.map = loop.map;
  spec.character =
      taken(retarget::make_character("actor", loop.motion.skeleton, loop.map));
  spec.level = engine::DetailLevel::kBlended;
  spec.start = engine::path_at(base->clip(0), 0.0);
  spec.start.x_m *= loop.map.leg_length_m;
  spec.start.z_m *= loop.map.leg_length_m;
  const auto played = std::make_shared<Engine>(
      taken(Engine::make(base, {.step_hz = loop.motion.rate.hz})));
  const auto who = taken(played->add(std::move(spec)));
  ActionWish wish;
  wish.clip = "loop";
  wish.entry_s = 0.0;
  (void)taken(played->play(who, wish));
  return {
      {"engine, blended", [played, who, first = loop.motion.poses.front()](int frame) {
         if (frame == 0) return first;
         played->advance();
         return played->pose(who);
       }}};
}

}  // namespace marey
