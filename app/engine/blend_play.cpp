// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/engine/blend_play.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "engine/clips/sample_clip.h"
#include "engine/engine.h"

#include "app/engine/clip_on_body.h"
#include "core/base/format_text.h"
#include "core/base/in_quotes.h"
#include "core/pose.h"

namespace marey::app {
namespace {

using engine::TransitionKind;

constexpr double kMost_s = 60.0;

const std::map<std::string, TransitionKind>& blend_kind_words() {
  static const std::map<std::string, TransitionKind> words{
      {"auto", TransitionKind::kAuto},
      {"crossfade", TransitionKind::kCrossfade},
      {"synchronised", TransitionKind::kSynchronised},
      {"inertial", TransitionKind::kInertial},
      {"cut", TransitionKind::kCut}};
  return words;
}

int steps_of(double time_s) {
  return static_cast<int>(std::lround(time_s * kBlendRate_hz));
}

Status check_blend_times(const BlendArguments& args, const MotionClip& from) {
  if (!from.loops && args.at_s > from.duration_s()) {
    return bad_usage(
        "--at",
        format_text("%g s is after the end of ", args.at_s) + in_quotes(from.name),
        format_text("give a time up to %.2f s", from.duration_s()));
  }
  if (steps_of(args.at_s) < 1) {
    return bad_usage("--at",
                     format_text("%g s is before the first step", args.at_s),
                     format_text("give at least %.3f s", 1.0 / kBlendRate_hz));
  }
  if (args.seconds && steps_of(*args.seconds) <= steps_of(args.at_s)) {
    return bad_usage("--seconds",
                     format_text("%g s end before the switch", *args.seconds),
                     format_text("give more than %g s", args.at_s));
  }
  return Done{};
}

/// The place of a clip's first frame, in metres of the body.
engine::RootPlace start_of(const MotionClip& clip, double leg_length_m) {
  engine::RootPlace start = engine::path_at(clip, 0.0);
  start.x_m *= leg_length_m;
  start.z_m *= leg_length_m;
  return start;
}

/// Plays step by step and records.
class BlendRecorder {
 public:
  BlendRecorder(const BlendInputs& inputs,
                engine::Engine& engine,
                engine::CharacterId who,
                engine::ActionId from)
      : inputs_(inputs), engine_(engine), who_(who), from_(from) {
    out_.motion.skeleton = inputs.character.skeleton;
    out_.motion.rate = {kBlendRate_hz};
  }

  void switch_to(engine::ActionId to) {
    to_ = to;
    out_.switch_frame = static_cast<int>(out_.motion.poses.size()) - 1;
  }

  void step() {
    engine_.advance();
    const engine::CharacterPlayer& player = engine_.player(who_);
    out_.motion.poses.push_back(player.pose());
    const auto world = world_from_joints(inputs_.character.skeleton, player.reference());
    out_.blend_hips_in_world.push_back(world[index(player.map().hips())].translation);
    const engine::Action* a = player.blend().find(from_);
    const engine::Action* b = to_ ? player.blend().find(*to_) : nullptr;
    const double now_s = engine_.time_s();
    const double from = a != nullptr ? a->fade(now_s) : 0.0;
    const double to = b != nullptr ? b->fade(now_s) : 0.0;
    BlendFrame frame;
    if (a != nullptr) frame.source_s[0] = a->warp.source_s(now_s);
    if (b != nullptr) frame.source_s[1] = b->warp.source_s(now_s);
    const double sum = from + to;
    frame.weight = sum > 0.0 ? std::array{from / sum, to / sum} : std::array{0.0, 1.0};
    out_.frames.push_back(frame);
    if (b != nullptr && b->is_alive() && !is_entered_) {
      is_entered_ = true;
      out_.entry_s = b->warp.source_s(b->started_s);
      out_.transition = player.report().transition;
    }
  }

  /// True when B has ended.
  [[nodiscard]] bool is_over() const {
    const MotionClip& clip = inputs_.to_clip();
    const double cycles = clip.loops ? 2.0 : 1.0;
    const double first_s = clip.loops ? out_.entry_s : 0.0;
    const double played_s = out_.frames.back().source_s[1] - first_s;
    return engine_.phase(who_, *to_) == engine::ActionPhase::kDone ||
           played_s >= cycles * clip.duration_s() - 1e-6;
  }
  [[nodiscard]] int frame_count() const {
    return static_cast<int>(out_.motion.poses.size());
  }
  [[nodiscard]] PlayedBlend take() { return std::move(out_); }

 private:
  const BlendInputs& inputs_;
  engine::Engine& engine_;
  engine::CharacterId who_;
  engine::ActionId from_;
  std::optional<engine::ActionId> to_;
  bool is_entered_ = false;
  PlayedBlend out_;
};

}  // namespace

std::vector<std::string> blend_kinds() {
  return {"auto", "crossfade", "synchronised", "inertial", "cut"};
}

Result<PlayedBlend> play_blend(const BlendArguments& args, const BlendInputs& inputs) {
  if (const Status ok = check_blend_times(args, inputs.from_clip()); !ok) {
    return ok.error();
  }
  auto engine = engine::Engine::make(inputs.base, {.step_hz = kBlendRate_hz});
  if (!engine) return engine.error();
  engine::CharacterSpec spec;
  spec.character = inputs.character;
  spec.map = inputs.map;
  spec.start = start_of(inputs.from_clip(), inputs.map.leg_length_m);
  const auto who = engine->add(std::move(spec));
  if (!who) return who.error();
  engine::ActionWish wish;
  wish.clip = inputs.from_clip().name;
  wish.entry_s = 0.0;
  const auto from = engine->play(*who, wish);
  if (!from) return from.error();
  BlendRecorder recorder(inputs, *engine, *who, *from);
  for (int i = 0; i < steps_of(args.at_s); ++i) recorder.step();

  wish.clip = inputs.to_clip().name;
  wish.entry_s.reset();
  wish.fade_in_s = args.fade_s;
  wish.transition = blend_kind_words().at(args.kind);
  const auto to = engine->play(*who, wish);
  if (!to) return to.error();
  recorder.switch_to(*to);
  const int last = steps_of(args.seconds.value_or(args.at_s + kMost_s));
  do {
    recorder.step();
  } while (recorder.frame_count() < last && (args.seconds || !recorder.is_over()));
  return recorder.take();
}

Motion clip_on_body(const BlendInputs& inputs, std::size_t clip) {
  const MotionClip& source = inputs.base->clip(clip);
  const Skeleton& skeleton = inputs.character.skeleton;
  ClipOnBody player(source, inputs.base->layout(), skeleton, inputs.map);
  Motion out{skeleton, {kBlendRate_hz}, 0, {}};
  const int last =
      static_cast<int>(std::floor(source.duration_s() * kBlendRate_hz + 1e-6));
  for (int i = 0; i <= last; ++i) {
    (void)player.joints_at(std::min(i / kBlendRate_hz, source.duration_s()));
    out.poses.push_back(player.pose());
  }
  return out;
}

}  // namespace marey::app
