// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/retarget/retarget_commands.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/motion/error_of_file.h"
#include "app/motion/neutral.h"
#include "app/motion/retarget_files.h"
#include "app/retarget/retarget_json.h"
#include "app/retarget/retarget_page.h"
#include "app/retarget/retarget_plan.h"
#include "core/resample.h"
#include "recordings/base/atomic_file.h"
#include "recordings/body/constraints_file.h"
#include "retarget/adapt/plan_supports.h"
#include "retarget/adapt/support_constraints.h"
#include "retarget/hands/touch_constraints.h"

namespace marey::app {
namespace {

/// State of a run.
struct Work {
  const RetargetArguments& args;
  const RetargetPlan& plan;
  Console& console;
  RetargetRun run;
  std::vector<std::optional<OpenedAvatar>> opened;  ///< One per avatar of the plan.
  Exit exit = Exit::kOk;                            ///< Exit code of the first failure.
  std::optional<Finding> source_finding =
      std::nullopt;  ///< If set, all results are poor.
  std::optional<retarget::BodyVolume> source_volume = std::nullopt;

  void fail(const Error& error) {
    const Exit failure = console.fail(error);
    if (exit == Exit::kOk) exit = failure;
  }
  void fail(AvatarResult& avatar, const Error& error) {
    fail(error);
    avatar.error = error;
  }
};

void open_avatars(Work& work) {
  for (const RetargetPlan::Avatar& avatar : work.plan.avatars) {
    AvatarResult result;
    result.name = avatar.name;
    result.avatar = avatar.file.path;
    auto opened = open_avatar(avatar.file);
    if (opened) {
      work.opened.emplace_back(*std::move(opened));
    } else {
      work.opened.emplace_back();
      work.fail(result, opened.error());
    }
    work.run.avatars.push_back(std::move(result));
  }
}

/// Returns the formats of the plan that this body can have. Errors: it can have none.
Result<std::vector<MotionFormat>> formats_of(Work& work, const OpenedAvatar& body) {
  std::vector<MotionFormat> out;
  std::optional<Error> first;
  for (const MotionFormat format : work.plan.formats) {
    const Status ok = can_hold(format, body.skeleton, body.look);
    if (ok) {
      out.push_back(format);
      continue;
    }
    const Error error = of_file(body.file, ok.error());
    // That a body without a mesh has no .glb is expected; one without the bones of a
    // humanoid should be checked by the user.
    const bool is_warned = work.plan.formats_are_wanted || format == MotionFormat::kVrma;
    if (is_warned && work.plan.file.empty()) {
      work.console.warn(body.file.string() + ": no ." + std::string(name(format)) + ": " +
                        error.cause);
    }
    if (!first) first = error;
  }
  if (out.empty()) return *first;
  return out;
}

MotionFileOptions file_options(const RetargetArguments& args) {
  MotionFileOptions options;
  options.clip = args.clip;
  if (const auto dialect = recordings::bvh_dialect(args.bvh_dialect)) {
    options.bvh = recordings::write_options(*dialect);
  }
  return options;
}

/// Writes foot supports and hand touches as constraints.
Status write_contacts(const RetargetArguments& args,
                      const OpenedAvatar& body,
                      const AvatarResult& avatar) {
  const Motion& motion = avatar.retargeted.motion;
  const auto map = retarget::map_body(motion.skeleton);
  if (!map) return map.error();
  // A short ramp: the feet already stand, so a longer fade-in has no use, and it would
  // delay a foot that is still in the air.
  const retarget::PlanSupportsOptions options{.ramp_s = 0.05};
  const auto tracks =
      retarget::plan_supports(motion, *map, avatar.retargeted.report.contacts, options);
  ConstraintSet set = retarget::support_constraints(tracks, motion.rate);
  const retarget::HandReport& hands = avatar.retargeted.report.hands;
  retarget::TouchConstraintsOptions fading;
  fading.world = hands.world;
  fading.nearest_alone = true;
  // Frames of motion files begin at 0.
  ConstraintSet touches = retarget::constraints_of(
      hands.touches,
      motion.skeleton,
      *map,
      body.volume ? *body.volume : retarget::average_volume(motion.skeleton, *map),
      0,
      motion.rate,
      fading);
  std::ranges::move(touches.constraints, std::back_inserter(set.constraints));
  return recordings::write_constraints(args.constraints_out, set);
}

/// Checks an avatar's result and prints warnings on its faults.
Status check_avatar_result(const OpenedAvatar& body,
                           std::span<const WrittenFile> files,
                           Work& work,
                           AvatarResult& avatar) {
  auto verdict = assess_avatar(body.file.string(),
                               work.run.source,
                               avatar.retargeted,
                               body.skin,
                               !work.args.no_ground,
                               files);
  if (!verdict) return verdict.error();
  avatar.verdict = *std::move(verdict);
  for (const Finding& problem : avatar.verdict.problems) {
    if (problem.severity == Severity::kPoor) {
      work.fail(problem.error());
    } else {
      work.console.warn(problem.message());
    }
  }
  // The console has already reported it.
  if (work.source_finding) {
    avatar.verdict.problems.push_back(*work.source_finding);
  }
  return Done{};
}

/// Processes an avatar: its motion, then its files.
Status retarget_one_avatar(const Motion& source,
                           const OpenedAvatar& body,
                           std::size_t i,
                           Work& work) {
  AvatarResult& avatar = work.run.avatars[i];
  const auto formats = formats_of(work, body);
  if (!formats) return formats.error();
  RetargetAtRateOptions options = work.args.options;
  options.retarget.soles = avatar.soles = body.soles;
  options.retarget.skin = &body.skin;
  options.retarget.compare_steps = true;
  if (options.retarget.hands) {
    options.retarget.hands->source_volume = work.source_volume;
    options.retarget.hands->avatar_volume = body.volume;
  }
  auto retargeted = retarget_at_rate(source, body.skeleton, options);
  if (!retargeted) return of_file(body.file, retargeted.error());
  avatar.retargeted = *std::move(retargeted);
  std::vector<WrittenFile> written;
  for (const MotionFormat format : *formats) {
    const auto out = work.plan.out(work.plan.avatars[i], format);
    const Status ok = write_motion_file(
        out, format, avatar.retargeted.motion, body.look, file_options(work.args));
    if (!ok) return ok;
    avatar.files.push_back(out);
    written.push_back(written_file(out, format, body.look, file_options(work.args)));
  }
  if (!work.args.constraints_out.empty()) {
    if (const Status ok = write_contacts(work.args, body, avatar); !ok) return ok;
  }
  return check_avatar_result(body, written, work, avatar);
}

void retarget_all(const Motion& source, Work& work) {
  const int count = static_cast<int>(work.opened.size());
  const Progress progress = count > 1 ? work.console.stage("retarget") : Progress();
  for (int i = 0; i < count; ++i) {
    if (progress) progress(i, count);
    const auto at = static_cast<std::size_t>(i);
    auto& body = work.opened[at];
    AvatarResult& avatar = work.run.avatars[at];
    if (!body) continue;
    const Status ok = retarget_one_avatar(source, *body, at, work);
    if (!ok) {
      work.fail(avatar, ok.error());
      continue;
    }
    for (const std::string& remark : body->remarks) {
      work.console.warn(body->file.string() + ": " + remark);
    }
    body.reset();
  }
  if (progress) progress(count, count);
}

bool has_any(const RetargetRun& run) {
  return std::ranges::any_of(run.avatars,
                             [](const auto& avatar) { return !avatar.error; });
}

/// Measures the source and the avatars, for the report.
Status measure(Work& work) {
  RetargetRun& run = work.run;
  for (const AvatarResult& avatar : run.avatars) {
    if (!avatar.error) run.contacts = avatar.retargeted.report.contacts;
  }
  if (const Status ok = measure_source(run); !ok) return ok;
  for (AvatarResult& avatar : run.avatars) {
    if (avatar.error) continue;
    if (const Status ok = measure_avatar(run, avatar); !ok) return ok;
  }
  return Done{};
}

void print_summary(const Work& work) {
  if (work.args.json) {
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    const auto figures = work.plan.file.empty()
                             ? retarget_json(work.run)
                             : avatar_json(work.run, work.run.avatars.front());
    std::printf("%s\n", figures.dump(2, ' ', false, kReplace).c_str());
  }
  for (const AvatarResult& avatar : work.run.avatars) {
    if (!avatar.error) work.console.say(summary_of(avatar));
  }
}

/// Reads the motion and reports ignored bone translation. Errors: as read_motion()'s.
Result<RawBody> read_source(const RetargetArguments& args, Console& console) {
  auto raw = read_raw_body(args.motion);
  if (!raw) return raw.error();
  if (!raw->has_motion) {
    return bad_input(
        args.motion.string(), "holds no animation", "give a file with a motion");
  }
  if (const auto note = left_out({{}, raw->ignored_translation_m})) {
    console.warn(args.motion.string() + ": " + *note);
  }
  return raw;
}

/// Returns the volume of the source's skin. A skeleton made by marey has a mannequin,
/// which is not the subject's skin.
std::optional<retarget::BodyVolume> volume_of_source(const ReadBody& source) {
  const bool is_ours = std::ranges::all_of(
      source.skeleton().joints,
      [](const Joint& joint) { return joint.bone && joint.name == name(*joint.bone); });
  return is_ours ? std::nullopt : source.volume;
}

}  // namespace

Exit run_retarget(const RetargetArguments& args, Console& console) {
  const auto plan = plan_retarget(args);
  if (!plan) return console.fail(plan.error());
  auto raw = read_source(args, console);
  if (!raw) return console.fail(raw.error());
  Work work{args, *plan, console, {}, {}, Exit::kOk};
  work.run.motion = args.motion;
  work.run.live = args.options.live;
  open_avatars(work);
  if (!has_any(work.run)) return work.exit;
  BodyFile file(args.motion, args.motion_bones);
  if (!args.neutral.empty()) {
    const auto neutral = read_neutral(args.neutral);
    if (!neutral) return console.fail(neutral.error());
    file.neutral = *neutral;
  }
  const auto source = identify_body(*std::move(raw), file);
  if (!source) return console.fail(source.error());
  for (const std::string& remark : source->remarks()) {
    console.warn(args.motion.string() + ": " + remark);
  }
  work.source_finding =
      assess_exchanged_sides(args.motion, source->exchanged, "--motion-bones");
  if (work.source_finding) work.fail(work.source_finding->error());
  work.source_volume = volume_of_source(*source);
  const Motion& motion = source->raw.motion;
  work.run.source =
      args.options.rate_hz ? resample(motion, FrameRate{*args.options.rate_hz}) : motion;
  retarget_all(motion, work);
  if (!has_any(work.run)) return work.exit;
  if (const Status ok = measure(work); !ok) {
    return console.fail(of_file(args.motion, ok.error()));
  }
  if (!plan->page.empty()) {
    const Status ok = recordings::write_file(plan->page, retarget_page(work.run));
    if (!ok) return console.fail(ok.error());
  }
  print_summary(work);
  return work.exit;
}

}  // namespace marey::app
