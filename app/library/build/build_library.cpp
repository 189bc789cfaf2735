// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/build/build_library.h"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "app/library/build/import_source.h"
#include "app/library/build/process_pool.h"
#include "app/library/build/source_cache.h"
#include "app/library/sources/list_sources.h"
#include "app/shell/stop_signal.h"
#include "core/base/format_text.h"

namespace marey::app {
namespace {

/// Between the two parts of a child's text: the outcome, and the identified source.
constexpr char kPartEnd = '\n';

std::string imported_text(const ImportedSource& imported) {
  std::string text = outcome_text(imported.outcome);
  if (imported.known) text += kPartEnd + known_source_text(*imported.known);
  return text;
}

std::string signal_cause(int signal) {
  const char* name = sigdescr_np(signal);
  return "the reader of the file ended by signal " + std::to_string(signal) +
         (name == nullptr ? "" : " (" + std::string(name) + ")");
}

/// Returns the outcome of a source whose child process ended before its end.
SourceOutcome ended_outcome(const SourceFile& file, const TaskOutcome& task) {
  SourceOutcome out;
  out.name = file.name;
  Error error;
  error.where = file.name;
  const int signal = task.signal.value_or(0);
  // Without a signal, no process could begin; SIGKILL comes from outside, mostly since
  // the memory is full.
  out.is_machine_failure = signal == 0 || signal == SIGKILL;
  error.code = out.is_machine_failure ? Errc::kDevice : Errc::kInternal;
  error.cause = signal == 0 ? "no process could read the file" : signal_cause(signal);
  error.next = out.is_machine_failure
                   ? "free some memory, or give fewer processes (--jobs 1), and build "
                     "again; or leave the file out with skip in library.toml"
                   : "leave the file out with skip in library.toml, and report the fault "
                     "with this file";
  out.failure = std::move(error);
  return out;
}

/// Sources that no cache knows, the largest first: a large one that begins last would
/// keep one process busy alone.
std::vector<std::size_t> largest_first(const std::vector<SourceFile>& sources,
                                       std::vector<std::size_t> open) {
  std::ranges::sort(open, [&](std::size_t a, std::size_t b) {
    return sources[a].bytes != sources[b].bytes ? sources[a].bytes > sources[b].bytes
                                                : a < b;
  });
  return open;
}

void take_result(const TaskOutcome& task,
                 const SourceFile& file,
                 SourceCache& cache,
                 SourceOutcome& out) {
  const std::size_t end = task.text.find(kPartEnd);
  auto outcome = parse_outcome(std::string_view(task.text).substr(0, end));
  if (!task.is_done || !outcome) {
    out = ended_outcome(file, task);
    return;
  }
  out = std::move(*outcome);
  if (end == std::string::npos) return;
  if (auto known = parse_known_source(std::string_view(task.text).substr(end + 1))) {
    cache.add(file.path, std::move(*known));
  }
}

/// Returns each different remark once, in the order of the first source that has it.
std::vector<std::string> group_remarks(const std::vector<SourceOutcome>& outcomes) {
  std::map<std::string, std::size_t> places;
  std::vector<std::string> remarks;
  std::vector<std::string> first;
  std::vector<std::size_t> counts;
  for (const SourceOutcome& outcome : outcomes) {
    for (const std::string& remark : outcome.remarks) {
      const auto [place, is_new] = places.emplace(remark, remarks.size());
      if (is_new) {
        remarks.push_back(remark);
        first.push_back(outcome.name);
        counts.push_back(0);
      }
      ++counts[place->second];
    }
  }
  for (std::size_t i = 0; i < remarks.size(); ++i) {
    const std::string others =
        counts[i] > 1 ? format_text(" and %zu other sources", counts[i] - 1) : "";
    remarks[i] = first[i] + others + ": " + remarks[i];
  }
  return remarks;
}

/// Returns the failure of a source that the machine caused: a version without this source
/// would hide that it is missing.
std::optional<Error> machine_failure(const std::vector<SourceOutcome>& outcomes) {
  for (const SourceOutcome& outcome : outcomes) {
    if (outcome.is_machine_failure) return outcome.failure;
  }
  return std::nullopt;
}

Error stopped() {
  return {Errc::kInternal, "", "stopped", "call marey library build again to go on"};
}

}  // namespace

std::vector<std::string> source_names(const std::vector<SourceFile>& sources) {
  std::vector<std::string> out;
  for (const SourceFile& source : sources) out.push_back(source.name);
  return out;
}

std::optional<std::vector<SourceOutcome>> import_sources(
    const BuildInputs& inputs,
    const std::vector<SourceFile>& sources,
    int jobs,
    CacheUse use,
    Console& console) {
  SourceCache cache = SourceCache::read(inputs.library);
  std::vector<SourceOutcome> out(sources.size());
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const KnownSource* known = cache.find(sources[i].path);
    auto found = known ? find_outcome(inputs, sources[i], known->id) : std::nullopt;
    if (found) {
      out[i] = std::move(*found);
    } else {
      open.push_back(i);
    }
  }
  open = largest_first(sources, std::move(open));
  const Progress progress = console.stage("sources");
  const auto tasks = run_in_processes(
      open.size(),
      jobs,
      [&](std::size_t k) {
        return imported_text(import_source(inputs, sources[open[k]]));
      },
      [&](std::size_t done) {
        progress(static_cast<int>(done), static_cast<int>(open.size()));
        return !stop_wanted();
      });
  for (std::size_t k = 0; k < open.size(); ++k) {
    take_result(tasks[k], sources[open[k]], cache, out[open[k]]);
  }
  // The cache only saves time: that it cannot be written costs the next build some.
  if (use == CacheUse::kReplace) {
    const Status ok = cache.write(inputs.library);
    if (!ok) console.warn(ok.error().message());
  }
  if (stop_wanted()) return std::nullopt;
  return out;
}

Result<BuiltLibrary> finish_library(const BuildInputs& inputs,
                                    const std::vector<SourceFile>& sources,
                                    std::vector<SourceOutcome> outcomes,
                                    Console& console) {
  std::vector<std::size_t> damaged;
  if (auto failure = machine_failure(outcomes)) return std::move(*failure);
  auto merged = merge_library(inputs, sources, outcomes, damaged);
  if (!merged && !damaged.empty()) {
    std::vector<SourceFile> again;
    for (const std::size_t i : damaged) {
      console.warn(sources[i].name + ": its objects were damaged, and are made again");
      again.push_back(sources[i]);
    }
    auto made = import_sources(inputs, again, 1, CacheUse::kRead, console);
    if (!made) return stopped();
    for (std::size_t k = 0; k < damaged.size(); ++k) {
      outcomes[damaged[k]] = std::move((*made)[k]);
    }
    if (auto failure = machine_failure(outcomes)) return std::move(*failure);
    damaged.clear();
    merged = merge_library(inputs, sources, outcomes, damaged);
  }
  if (!merged) return merged.error();
  BuiltLibrary out;
  out.merged = std::move(*merged);
  out.sources = sources.size();
  for (const SourceOutcome& outcome : outcomes) {
    if (outcome.was_read) ++out.read;
    if (outcome.failure) out.failures.push_back(*outcome.failure);
  }
  out.remarks = group_remarks(outcomes);
  out.remarks.insert(
      out.remarks.end(), out.merged.remarks.begin(), out.merged.remarks.end());
  return out;
}

Result<BuiltLibrary> build_library(BuildInputs inputs, int jobs, Console& console) {
  const auto listing = list_sources(inputs.library, inputs.settings);
  if (!listing) return listing.error();
  name_label_sources(inputs, source_names(listing->files));
  auto outcomes =
      import_sources(inputs, listing->files, jobs, CacheUse::kReplace, console);
  if (!outcomes) return stopped();
  auto built = finish_library(inputs, listing->files, std::move(*outcomes), console);
  if (built) {
    built->remarks.insert(
        built->remarks.end(), listing->remarks.begin(), listing->remarks.end());
  }
  const std::string left_out = listing->left_out_text();
  if (built && !left_out.empty()) built->remarks.push_back(left_out);
  return built;
}

}  // namespace marey::app
