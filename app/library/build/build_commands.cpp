// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/build_commands.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/library/build/build_inputs.h"
#include "app/library/build/build_library.h"
#include "app/library/build/library_json.h"
#include "app/library/build/library_lock.h"
#include "app/library/build/shard_plan.h"
#include "app/library/sources/list_sources.h"
#include "app/shell/option_checks.h"
#include "app/shell/program_name.h"
#include "app/shell/stop_signal.h"
#include "core/base/format_text.h"
#include "recordings/base/atomic_file.h"
#include "recordings/library/library_paths.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;

constexpr long kMaxJobs = 1024;
constexpr long kMaxShards = 9999;
/// Failed sources that are printed; all are in failed/.
constexpr std::size_t kMaxPrinted = 10;

int jobs_of(const LibraryBuildArguments& args) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return args.jobs > 0 ? args.jobs : std::max(cores, 1);
}

/// Removes what killed builds left unfinished.
void remove_left_files(const fs::path& library) {
  const recordings::LibraryPaths paths(library);
  for (const fs::path& folder : {paths.objects(), paths.search(), paths.versions()}) {
    recordings::remove_abandoned_files(folder);
  }
}

Exit report_build(const Result<BuiltLibrary>& built,
                  const LibraryBuildArguments& args,
                  Console& console);

/// Builds a library whose lock this process holds.
Exit build_locked(const LibraryBuildArguments& args, Console& console) {
  auto inputs = read_build_inputs(args.library);
  if (!inputs) return console.fail(inputs.error());
  remove_left_files(inputs->library);
  return report_build(
      build_library(std::move(*inputs), jobs_of(args), console), args, console);
}

Exit report_build(const Result<BuiltLibrary>& built,
                  const LibraryBuildArguments& args,
                  Console& console) {
  if (!built) {
    if (stop_wanted()) {
      console.say("stopped; marey library build goes on from here");
      return Exit::kInterrupted;
    }
    return console.fail(built.error());
  }
  if (args.json) std::printf("%s\n", library_json(*built).dump(2).c_str());
  for (const std::string& remark : built->remarks) console.warn(remark);
  for (std::size_t i = 0; i < std::min(built->failures.size(), kMaxPrinted); ++i) {
    console.fail(built->failures[i]);
  }
  console.say(library_sentence(*built));
  if (built->failures.empty()) return Exit::kOk;
  const std::string folder = (recordings::LibraryPaths(args.library).failed()).string();
  return console.fail(
      {Errc::kQuality,
       args.library.string(),
       format_text(
           "%zu of %zu sources gave no clip", built->failures.size(), built->sources),
       "read " + folder + ", where each has its cause"});
}

/// Returns the library's folder as a word of a shell.
std::string in_shell(const BuildInputs& inputs) {
  return shell_command({inputs.library.string()});
}

void print_slurm_script(const BuildInputs& inputs, int shards) {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const std::string name = failed ? "marey" : program.string();
  std::printf("%s", slurm_script(name, inputs.library, shards).c_str());
}

/// Prints a plan that exists already.
Exit say_planned(const BuildInputs& inputs, const ShardPlan& plan, Console& console) {
  const std::size_t open = unfinished_shards(inputs.library, plan).size();
  console.say(
      format_text("the work is divided into %d shards already; %zu of them are "
                  "not finished",
                  plan.shards,
                  open));
  return Exit::kOk;
}

std::string list_of(const std::vector<int>& numbers) {
  constexpr std::size_t kMaxListed = 20;
  std::string out;
  for (std::size_t i = 0; i < std::min(numbers.size(), kMaxListed); ++i) {
    out += (i == 0 ? "" : ", ") + std::to_string(numbers[i]);
  }
  return numbers.size() > kMaxListed ? out + "..." : out;
}

/// Reads the plan, and checks that nothing it was made from has changed.
Result<ShardPlan> read_current_plan(const BuildInputs& inputs) {
  auto plan = read_shard_plan(inputs.library);
  if (!plan || plan->inputs == inputs.digest) return plan;
  return bad_input(inputs.library.string(),
                   "library.toml, a table or labels changed since the work was divided",
                   "delete the folder shards, then call marey library plan LIB --shards "
                   "N; finished objects are kept");
}

/// Names the sources of labels that divide motions, from the lists of all shards.
Status name_sources_of_plan(BuildInputs& inputs, const ShardPlan& plan) {
  if (!inputs.segment_labels) return Done{};
  std::vector<std::string> names;
  for (int shard = 1; shard <= plan.shards; ++shard) {
    const auto files =
        read_shard_list(inputs.library, plan, shard, inputs.settings.sources.size());
    if (!files) return files.error();
    for (std::string& name : source_names(*files)) names.push_back(std::move(name));
  }
  name_label_sources(inputs, names);
  return Done{};
}

Exit work_on(BuildInputs inputs, const LibraryBuildArguments& args, Console& console) {
  const auto plan = read_current_plan(inputs);
  if (!plan) return console.fail(plan.error());
  if (args.shard > plan->shards) {
    return console.fail(bad_usage("--shard",
                                  format_text("there are only %d shards", plan->shards),
                                  "give a number from 1 to that"));
  }
  const std::vector<int> open = unfinished_shards(inputs.library, *plan);
  if (std::ranges::find(open, args.shard) == open.end()) {
    console.say(format_text("shard %d is finished already", args.shard));
    return Exit::kOk;
  }
  const auto sources =
      read_shard_list(inputs.library, *plan, args.shard, inputs.settings.sources.size());
  if (!sources) return console.fail(sources.error());
  if (const Status ok = name_sources_of_plan(inputs, *plan); !ok) {
    return console.fail(ok.error());
  }
  const auto outcomes =
      import_sources(inputs, *sources, jobs_of(args), CacheUse::kRead, console);
  if (!outcomes) {
    console.say("stopped; the same command goes on from here");
    return Exit::kInterrupted;
  }
  for (const SourceOutcome& outcome : *outcomes) {
    // Without outcomes, the shard counts as not finished, and can be repeated.
    if (outcome.is_machine_failure) return console.fail(*outcome.failure);
  }
  const Status ok = write_shard_outcomes(inputs.library, *plan, args.shard, *outcomes);
  if (!ok) return console.fail(ok.error());
  console.say(format_text("shard %d: %zu sources", args.shard, sources->size()));
  return Exit::kOk;
}

/// Reads the outcomes of all shards, in ascending order of the sources' names.
Status read_all_shards(const BuildInputs& inputs,
                       const ShardPlan& plan,
                       std::vector<SourceFile>& sources,
                       std::vector<SourceOutcome>& outcomes) {
  std::vector<std::pair<SourceFile, SourceOutcome>> all;
  for (int shard = 1; shard <= plan.shards; ++shard) {
    auto files =
        read_shard_list(inputs.library, plan, shard, inputs.settings.sources.size());
    if (!files) return files.error();
    auto results = read_shard_outcomes(inputs.library, plan, shard);
    if (!results) return results.error();
    const bool is_same =
        std::ranges::equal(*files, *results, {}, &SourceFile::name, &SourceOutcome::name);
    if (!is_same) {
      return bad_input(format_text("shard %d", shard),
                       "its outcomes belong to another list of sources",
                       "delete the folder shards, then plan again");
    }
    for (std::size_t i = 0; i < files->size(); ++i) {
      all.emplace_back(std::move((*files)[i]), std::move((*results)[i]));
    }
  }
  std::ranges::sort(all, {}, [](const auto& one) { return one.first.name; });
  for (auto& [file, outcome] : all) {
    sources.push_back(std::move(file));
    outcomes.push_back(std::move(outcome));
  }
  return Done{};
}

/// Adds `marey library add`.
void add_add_command(CLI::App& library,
                     LibraryBuildArguments& args,
                     std::function<Exit(Console&)>& chosen) {
  CLI::App* add = library.add_subcommand("add", "Add files or folders to a library");
  AddSourcesArguments& added = args.added;
  add->add_option("LIB", args.library, "folder of the library; made if absent")
      ->required();
  add->add_option("PATH", added.paths, "files and folders with motions")->required();
  add->add_option("--licence", added.licence, "SPDX expression, unknown, or a file")
      ->required();
  add->add_option("--source", added.origin, "repository, address or person")->required();
  add->add_option("--commit", added.commit, "version of the source");
  add->add_option("--attribution", added.attribution, "whom to name");
  add->add_option("--kind", added.kind, "only files of this kind, such as bvh");
  add->add_option("--rate", added.rate_hz, "rate in Hz, instead of the files'");
  add->add_option("--index", added.index, "table of rates and descriptions");
  add->add_option("--subject", added.subject, "person, or a pattern with {subject}");
  add->add_option("--pattern", added.pattern, "pattern of names: each {word} is a label");
  add->add_option("--skip", added.skip, "patterns of files that are left out");
  add->add_option("--jobs", args.jobs, "processes; all cores if absent")
      ->check(whole_between(1, kMaxJobs));
  add->add_flag("--json", args.json, "print the result as JSON");
  add->callback([&] {
    chosen = [&args](Console& console) { return run_library_add(args, console); };
  });
}

}  // namespace

Exit run_library_build(const LibraryBuildArguments& args, Console& console) {
  catch_stop_signals();
  // Before the lock, which belongs into an existing library only.
  const auto found = read_build_inputs(args.library);
  if (!found) return console.fail(found.error());
  const auto lock = LibraryLock::take(found->library);
  if (!lock) return console.fail(lock.error());
  return build_locked(args, console);
}

Exit run_library_add(const LibraryBuildArguments& args, Console& console) {
  AddSourcesArguments added = args.added;
  added.library = args.library;
  catch_stop_signals();
  std::error_code failed;
  fs::create_directories(args.library, failed);
  const auto lock = LibraryLock::take(fs::absolute(args.library, failed));
  if (!lock) return console.fail(lock.error());
  if (const Status ok = add_sources(added); !ok) {
    return console.fail(ok.error());
  }
  return build_locked(args, console);
}

Exit run_library_plan(const LibraryBuildArguments& args, Console& console) {
  const auto inputs = read_build_inputs(args.library);
  if (!inputs) return console.fail(inputs.error());
  const auto lock = LibraryLock::take(inputs->library);
  if (!lock) return console.fail(lock.error());
  const auto old = read_shard_plan(inputs->library);
  if (old && old->inputs == inputs->digest && old->shards == args.shards) {
    if (args.slurm) print_slurm_script(*inputs, args.shards);
    return say_planned(*inputs, *old, console);
  }
  if (old && old->inputs == inputs->digest) {
    return console.fail(
        bad_input(inputs->library.string(),
                  format_text("the work is divided into %d shards already", old->shards),
                  "go on with these, or delete the folder shards"));
  }
  const auto listing = list_sources(inputs->library, inputs->settings);
  if (!listing) return console.fail(listing.error());
  remove_shards(inputs->library);
  const auto lists = divide_sources(listing->files, args.shards);
  const Status ok =
      write_shard_plan(inputs->library, {inputs->digest, args.shards}, lists);
  if (!ok) return console.fail(ok.error());
  if (args.slurm) print_slurm_script(*inputs, args.shards);
  const std::string library = in_shell(*inputs);
  console.say(
      format_text("%zu sources in %d shards; next: marey library work %s "
                  "--shard N for each, then marey library merge %s",
                  listing->files.size(),
                  args.shards,
                  library.c_str(),
                  library.c_str()));
  return Exit::kOk;
}

Exit run_library_work(const LibraryBuildArguments& args, Console& console) {
  catch_stop_signals();
  const auto inputs = read_build_inputs(args.library);
  if (!inputs) return console.fail(inputs.error());
  return work_on(*inputs, args, console);
}

Exit run_library_merge(const LibraryBuildArguments& args, Console& console) {
  const auto inputs = read_build_inputs(args.library);
  if (!inputs) return console.fail(inputs.error());
  const auto lock = LibraryLock::take(inputs->library);
  if (!lock) return console.fail(lock.error());
  const auto plan = read_current_plan(*inputs);
  if (!plan) return console.fail(plan.error());
  const std::vector<int> open = unfinished_shards(inputs->library, *plan);
  if (!open.empty()) {
    return console.fail(bad_input(
        inputs->library.string(),
        format_text("%zu of %d shards are not finished: ", open.size(), plan->shards) +
            list_of(open),
        "run marey library work " + in_shell(*inputs) + " --shard N for these"));
  }
  std::vector<SourceFile> sources;
  std::vector<SourceOutcome> outcomes;
  const Status ok = read_all_shards(*inputs, *plan, sources, outcomes);
  if (!ok) return console.fail(ok.error());
  const auto built = finish_library(*inputs, sources, std::move(outcomes), console);
  if (built) remove_shards(inputs->library);
  return report_build(built, args, console);
}

void add_library_build_commands(CLI::App& library,
                                LibraryBuildArguments& args,
                                std::function<Exit(Console&)>& chosen) {
  const auto add = [&](const char* name, const char* help, auto run) {
    CLI::App* command = library.add_subcommand(name, help);
    command->add_option("LIB", args.library, "folder of the library")->required();
    command->callback([&args, &chosen, run] {
      chosen = [&args, run](Console& console) { return run(args, console); };
    });
    return command;
  };
  const auto add_jobs = [&](CLI::App* command) {
    command->add_option("--jobs", args.jobs, "processes; all cores if absent")
        ->check(whole_between(1, kMaxJobs));
  };
  CLI::App* build = add("build", "Bring a library up to date", run_library_build);
  add_jobs(build);
  build->add_flag("--json", args.json, "print the result as JSON");
  add_add_command(library, args, chosen);
  CLI::App* plan = add("plan", "Divide the work on a library", run_library_plan);
  plan->add_option("--shards", args.shards, "number of parts")
      ->required()
      ->check(whole_between(1, kMaxShards));
  plan->add_flag("--slurm", args.slurm, "print a script that runs the plan with Slurm");
  CLI::App* work = add("work", "Do one part of a divided work", run_library_work);
  work->add_option("--shard", args.shard, "number of the part, from 1")
      ->required()
      ->check(whole_between(1, kMaxShards));
  add_jobs(work);
  CLI::App* merge = add("merge", "Finish a divided work", run_library_merge);
  merge->add_flag("--json", args.json, "print the result as JSON");
}

}  // namespace marey::app
