// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/adapt/adapt_commands.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/adapt/adapt_body.h"
#include "app/adapt/adapt_iterations.h"
#include "app/adapt/adapt_json.h"
#include "app/adapt/adapt_zmp.h"
#include "app/motion/raw_body.h"
#include "app/motion/retarget_files.h"
#include "app/shell/findings.h"
#include "app/shell/option_checks.h"
#include "core/base/extension.h"
#include "core/base/stopwatch.h"
#include "core/humanoid.h"
#include "core/nearest_word.h"
#include "recordings/body/constraints_file.h"
#include "recordings/body/floor_file.h"
#include "retarget/character/check_character.h"
#include "retarget/constraints/check_constraints.h"
#include "retarget/constraints/resolve_segment.h"
#include "retarget/feet/carry_to_floor.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

bool is_support(const Constraint& constraint) {
  return std::holds_alternative<Support>(constraint.goal);
}

Result<ConstraintSet> read_set(const AdaptArguments& args, Console& console) {
  if (args.constraints.empty()) return ConstraintSet{};
  auto file = recordings::read_constraints(args.constraints);
  if (!file) return file.error();
  for (const std::string& note : file->notes) console.warn(note);
  if (args.supports == SupportsFrom::kNone) {
    std::vector<Constraint>& all = file->set.constraints;
    all.erase(std::remove_if(all.begin(), all.end(), is_support), all.end());
  }
  return std::move(file->set);
}

bool has_supports(const ConstraintSet& set) {
  return std::any_of(set.constraints.begin(), set.constraints.end(), is_support);
}

/// Checks that the result replaces no input file, even under another name.
Status check_out(const AdaptArguments& args) {
  std::vector<std::pair<fs::path, const char*>> read{{args.motion, "the motion to adapt"},
                                                     {args.constraints, "--constraints"},
                                                     {args.character, "--character"},
                                                     {args.floor, "--floor"}};
  if (!args.character.empty()) {
    read.emplace_back(body_file_of(args.character), "the character's body");
  }
  for (const auto& [file, role] : read) {
    std::error_code absent;
    if (!fs::equivalent(args.out, file, absent)) continue;
    return bad_input(args.out.string(),
                     std::string("the result would replace ") + role,
                     "give the result another name");
  }
  return Done{};
}

/// Returns the feet for which the constraints have no support.
std::array<bool, 2> free_feet(const ConstraintSet& set, const AdaptBody& body) {
  std::array<bool, 2> free{true, true};
  for (const Constraint& c : set.constraints) {
    if (!is_support(c)) continue;
    const auto joint =
        retarget::resolve_segment(body.character.skeleton, c.point.segment);
    for (int side = 0; side < 2; ++side) {
      if (joint == body.map.leg(side).end) free[static_cast<std::size_t>(side)] = false;
    }
  }
  return free;
}

Status choose_balance_groups(const AdaptArguments& args, Character& character) {
  if (args.balance_groups.empty()) return Done{};
  std::vector<std::string_view> names;
  for (BodyGroup& group : character.groups) {
    group.balances = false;
    names.push_back(group.name);
  }
  for (const std::string& wanted : args.balance_groups) {
    bool found = false;
    for (BodyGroup& group : character.groups) {
      if (group.name != wanted) continue;
      group.balances = true;
      found = true;
    }
    if (!found) {
      return bad_usage("--balance-groups",
                       "the character has no group \"" + wanted + "\"",
                       suggestion(wanted, names));
    }
  }
  return Done{};
}

/// Adapts the motion with the balance of the options.
Status adapt_once(const AdaptBody& body,
                  std::span<const retarget::SupportTrack> supports,
                  const retarget::AdaptMotionOptions& options,
                  Console& console,
                  AdaptRun& run) {
  if (options.adapt.balance == retarget::BalanceMode::kZmp) {
    auto made =
        adapt_with_zmp(body, run.constraints, supports, options, console.stage("adapt"));
    if (!made) return made.error();
    run.adapted = std::move(made->adapted);
    run.zmp = made->figures;
    return Done{};
  }
  auto adapted = retarget::adapt_motion(body.reference,
                                        body.character,
                                        run.constraints,
                                        supports,
                                        options,
                                        console.stage("adapt"));
  if (!adapted) return adapted.error();
  run.adapted = *std::move(adapted);
  return Done{};
}

/// Adapts the motion. Precondition: `run` has the constraints.
Status adapt_all(const AdaptArguments& args,
                 const AdaptBody& body,
                 std::span<const retarget::SupportTrack> supports,
                 Console& console,
                 AdaptRun& run) {
  retarget::AdaptMotionOptions options;
  options.adapt = args.options;
  options.carried = args.loads;
  const Stopwatch watch;
  if (const Status ok = adapt_once(body, supports, options, console, run); !ok) {
    Error error = ok.error();
    if (!args.character.empty()) {
      error.where = args.character.string() + ": " + error.where;
    }
    return error;
  }
  run.adapt_s = watch.seconds();
  // Single frames have the balance of single postures.
  if (options.adapt.balance == retarget::BalanceMode::kZmp) {
    options.adapt.balance = retarget::BalanceMode::kHorizontal;
  }
  run.departure =
      measure_adapt_departure(body.reference, run.adapted.motion, run.constraints);
  run.posture = measure_adapt_posture(
      body.reference, run.adapted.motion, body.map, {run.floor, run.floor_height_m});
  run.more_iterations_help = try_more_iterations(
      body, supports, options, run.constraints, run.adapted.constraints);
  if (run.departure.far_frames == 0 ||
      options.adapt.balance == retarget::BalanceMode::kOff) {
    return Done{};
  }
  // Solves again without balance. The comparison shows whether balance is the cause of
  // the trunk's rotation.
  options.adapt.balance = retarget::BalanceMode::kOff;
  const auto without = retarget::adapt_motion(
      body.reference, body.character, run.constraints, supports, options);
  if (!without) return without.error();
  compare_without_balance(body.reference, run.adapted, *without, run.departure);
  return Done{};
}

Status read_floor(const AdaptArguments& args, SupportsFrom supports, AdaptRun& run) {
  if (args.floor.empty()) return Done{};
  if (supports != SupportsFrom::kAuto) {
    return bad_input("--floor",
                     "no foot stands on this floor: supports of the motion are not used",
                     "use --supports auto, or leave out --floor");
  }
  auto floor = recordings::read_floor(args.floor);
  if (!floor) return floor.error();
  run.floor = std::move(*floor);
  return Done{};
}

/// Returns the supports of the motion's feet. Moves the motion to the requested floor,
/// and counts the frames in which a leg does not reach it.
std::vector<retarget::SupportTrack> find_supports(const AdaptArguments& args,
                                                  AdaptBody& body,
                                                  AdaptRun& run) {
  retarget::PlanSupportsOptions plan;
  plan.floor_height_m = body.floor_height_m;
  plan.feet = free_feet(run.constraints, body);
  if (!args.floor.empty()) plan.floor = &run.floor;
  auto tracks = retarget::plan_supports(body.reference, body.map, body.contacts, plan);
  if (plan.floor != nullptr) {
    retarget::CarriedMotion carried = retarget::carry_to_floor(
        body.reference, body.map, body.contacts, run.floor, body.floor_height_m);
    body.reference = std::move(carried.motion);
    run.out_of_reach_frames = carried.ground.unreachable_frames;
  }
  return tracks;
}

Status run_all(const AdaptArguments& args, Console& console, AdaptRun& run) {
  if (const Status ok = check_out(args); !ok) return ok.error();
  auto set = read_set(args, console);
  if (!set) return set.error();
  run.constraints = std::move(*set);
  const SupportsFrom supports = args.supports.value_or(
      has_supports(run.constraints) ? SupportsFrom::kFile : SupportsFrom::kAuto);

  if (const Status ok = read_floor(args, supports, run); !ok) return ok.error();

  auto source = read_motion(args.motion);
  if (!source) return source.error();
  if (source->motion.poses.empty()) {
    return bad_input(
        args.motion.string(), "holds no frames", "give a file with a motion");
  }
  if (const auto note = left_out(*source)) {
    console.warn(args.motion.string() + ": " + *note);
  }
  run.source_finding = assess_exchanged_sides(
      args.motion, source->exchanged, "a .bones.toml file next to the motion");
  AdaptBodyOptions options;
  options.motion = args.motion;
  options.character = args.character;
  options.plant_feet = supports == SupportsFrom::kAuto;
  options.raise_m = args.floor_height_m;
  auto body = make_adapt_body(source->motion, options);
  if (!body) return body.error();
  if (const Status ok = check_adapted_out(*body, args.out); !ok) return ok.error();
  if (const Status ok = choose_balance_groups(args, body->character); !ok)
    return ok.error();
  if (const Status ok = retarget::check_constraints(run.constraints, body->character);
      !ok) {
    Error error = ok.error();
    error.where = args.constraints.string() + ": " + error.where;
    return error;
  }
  run.character = body->character.name;
  run.floor_height_m = body->floor_height_m;

  std::vector<retarget::SupportTrack> tracks;
  if (supports == SupportsFrom::kAuto) tracks = find_supports(args, *body, run);
  if (const Status ok = adapt_all(args, *body, tracks, console, run); !ok)
    return ok.error();
  for (const retarget::SupportTrack& track : tracks) {
    run.slides.push_back(
        retarget::slides_of(track, run.adapted.motion, body->character, run.floor));
  }
  return write_adapted(*body, run.adapted.motion, args.out);
}

template <class Value>
void add_choice(CLI::App& command,
                const std::string& option,
                Value& value,
                const std::map<std::string, Value>& words,
                const std::string& help) {
  command
      .add_option_function<std::string>(
          option,
          [&value, words](const std::string& word) { value = words.at(word); },
          help)
      ->check(one_of_keys(words))
      ->type_name("WORD");
}

void add_solve_options(CLI::App& command, retarget::AdaptOptions& options) {
  using retarget::BalanceMode;
  using retarget::Control;
  using retarget::Method;
  add_choice<Method>(command,
                     "--method",
                     options.method,
                     {{"strict", Method::kStrict}, {"thesis", Method::kThesis}},
                     "Method that solves postures; default strict");
  add_choice<Control>(command,
                      "--control",
                      options.control,
                      {{"priority", Control::kPriority}, {"blend", Control::kBlend}},
                      "Meaning of the importance of constraints; default priority");
  add_choice<BalanceMode>(command,
                          "--balance",
                          options.balance,
                          {{"off", BalanceMode::kOff},
                           {"horizontal", BalanceMode::kHorizontal},
                           {"3d", BalanceMode::k3d},
                           {"zmp", BalanceMode::kZmp}},
                          "Keep the motion's centre of mass, or (zmp) its zero moment "
                          "point above the feet; default off");
  command
      .add_option(
          "--root-share",
          options.root_for_constraints,
          "Factor on the root's translation towards constraints, 0 to 1; default 1")
      ->check(between(0.0, 1.0));
  command
      .add_option("--balance-root-share",
                  options.root_for_balance,
                  "Factor on the root's translation for balance, 0 to 1; default 1")
      ->check(between(0.0, 1.0));
  command
      .add_option("--max-iterations",
                  options.max_iterations,
                  "Maximum number of iterations per try; default 50. A frame has several "
                  "tries while "
                  "constraints fade, or by priority if not all can be met. The strict "
                  "method makes at least " +
                      std::to_string(retarget::kFirstSteps) + ", with balance " +
                      std::to_string(retarget::kFirstStepsBalanced))
      ->check(whole_between(1, 100000));
}

}  // namespace

Exit run_adapt(const AdaptArguments& args, Console& console) {
  if (const Status ok = check_out_file(args.out); !ok) return console.fail(ok.error());
  const std::string kind = kind_by_extension(args.out);
  if (kind != ".bvh" && kind != ".glb") {
    return console.fail(bad_input(args.out.string(),
                                  "cannot write a \"" + kind + "\" file",
                                  "name the result .glb or .bvh"));
  }
  AdaptRun run;
  if (const Status ok = run_all(args, console, run); !ok) return console.fail(ok.error());
  if (args.json) {
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    std::printf("%s\n", adapt_json(args, run).dump(2, ' ', false, kReplace).c_str());
  }
  print_warnings(console, assess_adapted(args, run));
  console.say(adapt_summary(args, run));
  if (const auto failure = assess_failure(args, run))
    return console.fail(failure->error());
  return Exit::kOk;
}

void add_adapt_command(CLI::App& app,
                       AdaptArguments& args,
                       std::function<Exit(Console&)>& chosen) {
  CLI::App* command = app.add_subcommand(
      "adapt", "Adapt a motion to constraints, with feet that do not slide");
  command->add_option("MOTION", args.motion, "Motion: " + body_extensions())->required();
  command->add_option("-c,--character",
                      args.character,
                      "character.toml of the body; default the motion's body");
  command->add_option("-x,--constraints", args.constraints, "Constraints (.xml)");
  command->add_option("-o,--out", args.out, "Result: .glb or .bvh")->required();
  add_choice<std::optional<SupportsFrom>>(
      *command,
      "--supports",
      args.supports,
      {{"auto", SupportsFrom::kAuto},
       {"file", SupportsFrom::kFile},
       {"none", SupportsFrom::kNone}},
      "Source of foot supports: the constraints, else the motion (auto); the constraints "
      "alone (file); or none; default file if they contain supports, else auto");
  add_solve_options(*command, args.options);
  command
      ->add_option("--balance-groups",
                   args.balance_groups,
                   "Groups that move for balance, instead of the character's; may be "
                   "repeated (\"left arm\")")
      ->allow_extra_args(false);
  command
      ->add_option("--load",
                   args.loads,
                   "Load that the character carries from the first frame; may be "
                   "repeated")
      ->allow_extra_args(false);
  command->add_option(
      "--floor", args.floor, "Steps, ramps and moving parts to stand on (.toml)");
  command
      ->add_option("--floor-height",
                   args.floor_height_m,
                   "Raises the floor, and the motion with it [m]")
      ->check(between(-1e4, 1e4));
  command->add_flag("--json", args.json, "Print the figures as JSON on standard output");
  command->callback(
      [&] { chosen = [&args](Console& console) { return run_adapt(args, console); }; });
}

}  // namespace marey::app
