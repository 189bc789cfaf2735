// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/run/scene_run.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "engine/engine.h"

#include "app/stage/run/action_wishes.h"
#include "app/stage/run/script_player.h"
#include "app/stage/run/target_places.h"
#include "core/base/assert.h"
#include "core/engine/scene_order.h"

namespace marey::app {
namespace {

// A layer below those of scripts.
constexpr int kIdleLayer = -1;

engine::CharacterId id_of(std::size_t body) {
  return engine::CharacterId{static_cast<int>(body)};
}

engine::DetailLevel level_of(const SceneBody& body) {
  switch (body.level.value_or(2)) {
    case 0:
      return engine::DetailLevel::kBlended;
    case 1:
      return engine::DetailLevel::kKinematic;
    default:
      return engine::DetailLevel::kKinetic;
  }
}

bool uses_hand_models(const SceneAction& action) {
  return std::holds_alternative<SceneReach>(action.deed) ||
         std::holds_alternative<SceneThrow>(action.deed);
}

engine::CharacterSpec spec_of(const Scene& scene,
                              const SceneBody& line,
                              const StageBody& body,
                              std::size_t place,
                              const std::shared_ptr<const Floor>& floor) {
  engine::CharacterSpec spec;
  spec.floor = floor;
  spec.character = body.character;
  spec.map = body.map;
  spec.start = body.start;
  spec.importance = line.importance;
  spec.level = level_of(line);
  for (std::size_t k = 0; k < scene.script.size(); ++k) {
    const SceneAction& action = scene.script[k];
    const auto members = members_of(scene, action.body);
    if (!members || place < members->first || place >= members->first + members->count) {
      continue;
    }
    spec.reaches = spec.reaches || uses_hand_models(action);
    if (auto constraint = constraint_of(action, k)) {
      spec.constraints.constraints.push_back(std::move(*constraint));
    }
    if (const auto* carry = std::get_if<SceneCarry>(&action.deed)) {
      const auto hand =
          body.map
              .joint_of[index(carry->hand == SceneHand::kLeft ? HumanBone::kLeftHand
                                                              : HumanBone::kRightHand)];
      if (hand) {
        spec.character.loads.push_back(
            {load_name(k), {*hand, carry->offset_in_t_pose, carry->mass_kg}});
      }
    }
  }
  for (const Constraint& constraint : body.constraints.constraints) {
    spec.constraints.constraints.push_back(constraint);
  }
  return spec;
}

// The idle clip of a body: its own, else "idle", else the first clip with that tag.
std::optional<std::size_t> idle_clip(const engine::MotionBase& base,
                                     const SceneBody& body) {
  if (!body.idle.empty()) return base.find(body.idle);
  if (const auto named = base.find("idle")) return named;
  for (std::size_t i = 0; i < base.clips().size(); ++i) {
    const auto& tags = base.clip(i).tags;
    if (std::find(tags.begin(), tags.end(), "idle") != tags.end()) return i;
  }
  return std::nullopt;
}

Status play_idle(const Scene& scene,
                 const SceneBody& line,
                 std::size_t place,
                 engine::Engine& engine) {
  const auto clip = idle_clip(engine.base(), line);
  if (!clip) {
    return bad_input("scene \"" + scene.name + "\", body \"" + line.id + "\"",
                     line.idle.empty()
                         ? "the base \"" + scene.base + "\" has no clip \"idle\""
                         : "the base has no clip \"" + line.idle + "\"",
                     "name a standing clip with the key idle; marey base list " +
                         scene.base + " shows the clips");
  }
  engine::ActionWish wish;
  wish.clip = engine.base().clip(*clip).name;
  wish.layer = kIdleLayer;
  const auto id = engine.play(id_of(place), wish);
  return id ? Status(Done{}) : Status(id.error());
}

}  // namespace

struct SceneRun::State {
  State(SceneRunInput given, engine::Engine made_engine)
      : input(std::move(given)),
        engine(std::move(made_engine)),
        lines(scene_bodies(input.scene)),
        places(input.scene, input.bodies),
        uses(target_uses(input.scene)),
        dependencies(scene_dependencies(input.scene)) {
    // A run may go on after the duration.
    for (SceneDependency& link : dependencies) {
      if (link.end_s >= input.scene.duration_s) {
        link.end_s = std::numeric_limits<double>::infinity();
      }
    }
  }

  void order_bodies(double time_s);
  [[nodiscard]] bool is_awaited(std::size_t body) const {
    return !rounds.empty() && rounds[body] < rounds[order.back()];
  }
  void keep_step();
  /// Limits the figures to the recorded steps, so that no event outside counts.
  void limit_figures() const;

  SceneRunInput input;
  engine::Engine engine;
  std::vector<SceneBody> lines;
  TargetPlaces places;
  std::vector<TargetUse> uses;
  std::vector<SceneDependency> dependencies;
  std::optional<ScriptPlayer> script{};
  std::vector<std::size_t> rounds{};
  std::vector<std::size_t> order{};
  mutable StageRecord record{};
  bool has_forgotten = false;
  double spent_ms = 0.0;
  std::size_t steps = 0;
};

void SceneRun::State::order_bodies(double time_s) {
  if (dependencies.empty()) return;
  solve_rounds(dependencies, time_s, input.bodies.size(), rounds);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return rounds[a] != rounds[b] ? rounds[a] < rounds[b] : a < b;
  });
}

void SceneRun::State::keep_step() {
  for (std::size_t i = 0; i < record.tracks.size(); ++i) {
    const engine::CharacterPlayer& player = engine.player(id_of(i));
    StageTrack& track = record.tracks[i];
    track.poses.push_back(player.pose());
    track.references.push_back(player.reference());
    track.stands.push_back(player.report().stands);
    track.floor_moved_m.push_back(player.report().floor_moved_m);
  }
  for (StageTargetTrack& track : record.targets) {
    const auto use = std::find_if(uses.begin(), uses.end(), [&](const TargetUse& u) {
      return u.target == track.target && u.user == track.body;
    });
    track.p_in_world.push_back(places.in_world(*use, engine.time_s(), engine));
  }
}

void SceneRun::State::limit_figures() const {
  constexpr double kAfter_s = 1e-6;  // An event at the begin was in the record before.
  for (std::size_t f = 0; f < record.scene.figures.size(); ++f) {
    const SceneFigure& given = input.scene.figures[f];
    SceneFigure& limited = record.scene.figures[f];
    limited.from_s = std::max(given.from_s, record.begin_s + kAfter_s);
    limited.to_s = std::min(given.to_s.value_or(engine.time_s()), engine.time_s());
  }
}

SceneRun::SceneRun(std::unique_ptr<State> state) : state_(std::move(state)) {}
SceneRun::SceneRun(SceneRun&&) noexcept = default;
SceneRun& SceneRun::operator=(SceneRun&&) noexcept = default;
SceneRun::~SceneRun() = default;

Result<SceneRun> SceneRun::make(SceneRunInput input) {
  auto engine = engine::Engine::make(
      input.base, {.step_hz = input.scene.step_hz, .threads = input.threads});
  if (!engine) return engine.error();
  auto state = std::make_unique<State>(std::move(input), *std::move(engine));
  const SceneRunInput& in = state->input;
  MAREY_ASSERT(in.bodies.size() == state->lines.size());
  auto script = ScriptPlayer::make(in.scene, in.bodies, *in.base, in.trials);
  if (!script) return script.error();
  state->script = *std::move(script);
  std::shared_ptr<const Floor> floor;  // nullptr: level, at height 0.
  if (!in.floor.parts.empty() || in.floor.base_height_m != 0.0) {
    floor = std::make_shared<const Floor>(in.floor);
  }
  for (std::size_t i = 0; i < in.bodies.size(); ++i) {
    const SceneBody& line = state->lines[i];
    const auto id = state->engine.add(spec_of(in.scene, line, in.bodies[i], i, floor));
    if (!id) return id.error();
    for (const Load& load : in.bodies[i].character.loads) {
      (void)state->engine.player(*id).carry(load.name, true);
    }
    if (const Status ok = play_idle(in.scene, line, i, state->engine); !ok) {
      return ok.error();
    }
    state->order.push_back(i);
  }
  StageRecord& record = state->record;
  record.scene = in.scene;
  record.floor = in.floor;
  record.base = in.base;
  record.trials = in.trials;
  if (in.records) {
    record.bodies = in.bodies;
    record.tracks.resize(in.bodies.size());
    for (const TargetUse& use : state->uses) {
      record.targets.push_back({use.target, use.user, {}});
    }
  }
  return SceneRun(std::move(state));
}

void SceneRun::advance() {
  State& s = *state_;
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const double step_s = s.engine.step_s();
  const double now_s = s.engine.time_s() + step_s;
  s.script->begin_step(now_s, step_s, s.places, s.engine);
  s.order_bodies(now_s);
  s.engine.begin_step();
  for (const std::size_t body : s.order) {
    s.script->aim(body, now_s, step_s, s.places, s.engine);
    // No body waits for the bodies of the last round: end_step() solves them together.
    if (s.is_awaited(body)) s.engine.step(id_of(body));
  }
  s.engine.end_step();
  s.script->end_step(now_s, s.engine);
  s.spent_ms += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  ++s.steps;
  if (s.input.records) s.keep_step();
}

double SceneRun::time_s() const {
  return state_->engine.time_s();
}

bool SceneRun::is_over() const {
  return time_s() >= state_->input.scene.duration_s - 0.5 * state_->engine.step_s();
}

std::size_t SceneRun::size() const {
  return state_->input.bodies.size();
}

const StageBody& SceneRun::body(std::size_t i) const {
  MAREY_ASSERT(i < size());
  return state_->input.bodies[i];
}

const Pose& SceneRun::pose(std::size_t body) const {
  MAREY_ASSERT(body < size());
  return state_->engine.pose(id_of(body));
}

const Scene& SceneRun::scene() const {
  return state_->input.scene;
}

glm::dvec3 SceneRun::target_in_world(std::size_t target, std::size_t user) const {
  MAREY_ASSERT(target < scene().targets.size() && user < size());
  TargetUse use{target, user, 0};
  for (const TargetUse& known : state_->uses) {
    if (known.target == target && known.user == user) use = known;
  }
  return state_->places.in_world(use, time_s(), state_->engine);
}

bool SceneRun::set_target(std::size_t target,
                          const std::optional<glm::dvec3>& p_in_world,
                          std::optional<std::size_t> user) {
  return state_->places.hold(target, p_in_world, user);
}

const StageRecord& SceneRun::record() const {
  State& s = *state_;
  MAREY_ASSERT(s.input.records);
  s.record.actions = s.script->runs();
  s.record.throws = s.script->throws();
  if (s.has_forgotten) s.limit_figures();
  s.record.mean_step_ms = s.steps == 0 ? 0.0 : s.spent_ms / static_cast<double>(s.steps);
  return s.record;
}

double SceneRun::recorded_from_s() const {
  return state_->record.begin_s;
}

void SceneRun::forget_steps() {
  State& s = *state_;
  MAREY_ASSERT(s.input.records);
  for (StageTrack& track : s.record.tracks) {
    track.poses.clear();
    track.references.clear();
    track.stands.clear();
    track.floor_moved_m.clear();
  }
  for (StageTargetTrack& track : s.record.targets) track.p_in_world.clear();
  s.record.begin_s = time_s();
  s.has_forgotten = true;
  s.spent_ms = 0.0;
  s.steps = 0;
}

const std::vector<Error>& SceneRun::problems() const {
  return state_->script->problems();
}

}  // namespace marey::app
